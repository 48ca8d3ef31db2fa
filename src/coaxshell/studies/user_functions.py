"""Functions of the user's as metrics: any callable from a Response to a number, or "file.py:function"."""

from __future__ import annotations

import hashlib
import importlib.util
import inspect
import math
import pickle
import sys
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

from coaxshell.errors import InputError
from coaxshell.model.base import shown
from coaxshell.model.naming import suggestion
from coaxshell.response import Response
from coaxshell.studies.code_identity import code_identity, documented, own_files


class OtherCodeError(InputError):
    """A process has other code than the one that asks it."""


_known: dict[str, Callable[[Response], float]] = {}
"""Functions of this process by the identity that their code was found to have."""


@dataclass(frozen=True)
class UserFunction:
    """A function of the user's; sent to another process by reference, not by value.

    Attributes
    ----------
    name, units, long_name : str
        Its own name, its attribute ``units`` if it has one, and the first line of its docstring.
    identity : str
        Changes with any code that it depends on: see :mod:`coaxshell.studies.code_identity`.
    target : callable, optional
        The function itself, or None when it is read from a file.
    file : str
        Path of the file it is read from, "" otherwise.
    function : str
        Its name in that file.
    """

    name: str
    units: str
    long_name: str
    identity: str
    target: Callable[[Response], float] | None = None
    file: str = ""
    function: str = ""

    def __call__(self, response: Response, metric: str) -> float:
        """Return its value for a response; InputError if it fails or gives anything but a finite number."""
        function = self.found()
        try:
            value = float(function(response))
        except InputError:
            raise
        except Exception as error:
            raise InputError(metric, f"the function raised {type(error).__name__}: {error}", "correct it") from error
        if not math.isfinite(value):
            raise InputError(metric, f"the function gave {value!r}", "it must return a finite number")
        return value

    def found(self) -> Callable[[Response], float]:
        """Return the function itself, read from its file if it comes from one and is not known here yet."""
        if self.identity not in _known:
            return self.target or getattr(_module(self.file, file_digest(self.file)), self.function)
        return _known[self.identity]

    def require_same(self, metric: str) -> None:
        """Raise InputError if the code that would run in this process is not that which the study was begun with."""
        if self.identity not in _known:
            function = self.found()
            if code_identity(function) != self.identity:
                remedy = (
                    "was a file changed meanwhile, or is another one found there? Start the study again, with the same files everywhere"
                )
                raise OtherCodeError(f"metrics.{metric}", "the code in a worker is not that of the process that began the study", remedy)
            _known[self.identity] = function

    @property
    def pickles(self) -> bool:
        """Whether it can be sent to another process."""
        if self.target is None:
            return True
        try:
            pickle.dumps(self.target)
        except (pickle.PicklingError, AttributeError, TypeError):
            return False
        return True

    @property
    def only_here(self) -> bool:
        """Whether it stands in a main program that no other process can read: a notebook, an interactive session, a text after ``-c``."""
        main = sys.modules["__main__"]
        readable = getattr(main, "__file__", None) is not None or getattr(main, "__spec__", None) is not None
        return self.target is not None and not readable and self.pickles and b"__main__" in pickle.dumps(self.target)


class UserCode(NamedTuple):
    """Where files of the user's may lie, and whether they may be run yet.

    Attributes
    ----------
    folder : str
        That of the study: paths are relative to it.
    anywhere : bool
        Whether files outside that folder are allowed.
    run : bool
        False while a study is only looked through: its functions are then stand-ins without units.
    """

    folder: str = "."
    anywhere: bool = True
    run: bool = True


def from_callable(function: Callable[[Response], float], where: str, name: str | None = None) -> UserFunction:
    """Return a callable as a metric; InputError if it has neither a name of its own nor is given one."""
    name = name or str(getattr(function, "__name__", ""))
    if not name or name == "<lambda>":
        raise InputError(where, f"{shown(function)} has no name", 'give it one: metrics={"name": function}')
    return _described(function, name, target=function)


def from_text(text: str, where: str, code: UserCode) -> UserFunction:
    """Return the function named by "file.py:function", whose file is run now if it may be.

    Raises
    ------
    InputError
        There is no such file or function, it lies outside the folder though it may not, or the file fails.
    """
    file, _, name = text.rpartition(":")
    base = Path(code.folder)
    path = base / file
    if path.suffix != ".py" or "\0" in file or not path.is_file():
        raise InputError(where, f"there is no Python file {str(path)[:200]!r}", "write file.py:function, the file beside the study")
    path = path.resolve()
    if not code.anywhere and not path.is_relative_to(base.resolve()):
        remedy = "its code would be run: move it beside the study, or allow it (--allow-code, or allow_code=True)"
        raise InputError(where, f"{file!r} lies outside the folder of the study", remedy)
    if not code.run:
        return UserFunction(name, "", name, "", file=str(path), function=name)
    try:
        module = _module(str(path), file_digest(str(path)))
    except Exception as error:
        raise InputError(where, f"{str(path)!r} raised {type(error).__name__}: {error}", "correct it") from error
    function = getattr(module, name, None)
    if not callable(function):
        known = [key for key, value in vars(module).items() if inspect.isfunction(value) and not key.startswith("_")]
        raise InputError(where, f"{str(path)!r} has no function {name!r}", suggestion(name, known))
    return _described(function, name, file=str(path), function=name)


def _described(found: Any, name: str, **rest: Any) -> UserFunction:
    first = (documented(found) or name).splitlines()[0].rstrip(".")
    identity = code_identity(found)
    _known[identity] = found
    return UserFunction(name, str(getattr(found, "units", "")), first, identity, **rest)


def file_digest(path: str) -> str:
    """Return a digest of a file and of all own files that it imports, directly or not, as they are now."""
    module = ModuleType(_name_of(path))
    module.__file__ = path
    digest = hashlib.sha256()
    for file in sorted(own_files({module.__name__: module})):
        digest.update(str(file).encode() + file.read_bytes())
    return digest.hexdigest()


def _name_of(path: str) -> str:
    return f"coaxshell_user_{hashlib.sha256(path.encode()).hexdigest()[:12]}"


@cache
def _module(path: str, digest: str) -> ModuleType:
    """Return a file as a module; run anew, with what it imports of the user's, whenever any of their files has changed.

    What it imports may lie beside it.
    """
    for name, imported in list(sys.modules.items()):  # with the text before the change
        if getattr(imported, "__file__", None) in _files.get(path, ()):
            del sys.modules[name]
    for file in _files.get(path, ()):  # Python takes kept byte code for that of a file changed within its second to the same size
        with suppress(OSError, NotImplementedError):
            Path(importlib.util.cache_from_source(file)).unlink()
    spec = importlib.util.spec_from_file_location(_name_of(path), path)
    assert spec is not None  # the path ends in .py and exists
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[module.__name__] = module
    folder = str(Path(path).parent)
    sys.path.insert(0, folder)
    try:
        spec.loader.exec_module(module)
    finally:
        with suppress(ValueError):
            sys.path.remove(folder)
    _files[path] = {str(file) for file in own_files({module.__name__: module})}
    return module


_files: dict[str, set[str]] = {}
"""Files of the user's that a file and all that it imports consist of, by its path."""
