"""Functions of the user's as metrics: any callable from a Response to a number, or "file.py:function"."""

from __future__ import annotations

import hashlib
import importlib.util
import inspect
import math
import pickle
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any

from coaxshell.errors import InputError
from coaxshell.model.base import shown
from coaxshell.model.naming import suggestion
from coaxshell.response import Response


@dataclass(frozen=True)
class UserFunction:
    """A function of the user's; sent to another process by reference, not by value.

    Attributes
    ----------
    name, units, long_name : str
        Its own name, its attribute ``units`` if it has one, and the first line of its docstring.
    identity : str
        Changes with its source text.
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
        function = self.target or getattr(_module(self.file), self.function)
        try:
            value = float(function(response))
        except InputError:
            raise
        except Exception as error:
            raise InputError(metric, f"the function raised {type(error).__name__}: {error}", "correct it") from error
        if not math.isfinite(value):
            raise InputError(metric, f"the function gave {value!r}", "it must return a finite number")
        return value

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


def from_callable(function: Callable[[Response], float], where: str, name: str | None = None) -> UserFunction:
    """Return a callable as a metric; InputError if it has neither a name of its own nor is given one."""
    name = name or str(getattr(function, "__name__", ""))
    if not name or name == "<lambda>":
        raise InputError(where, f"{shown(function)} has no name", 'give it one: metrics={"name": function}')
    try:
        source = inspect.getsource(function)
    except (OSError, TypeError):
        source = f"{getattr(function, '__module__', '')}.{getattr(function, '__qualname__', name)}"
    return _described(function, name, _digest(source), target=function)


def from_text(text: str, where: str, folder: str | None = None) -> UserFunction:
    """Return the function named by "file.py:function"; InputError if there is no such file or function."""
    file, _, name = text.rpartition(":")
    path = Path(folder or ".", file)
    if path.suffix != ".py" or not path.is_file():
        raise InputError(where, f"there is no Python file {str(path)!r}", "write file.py:function, the file beside the study")
    try:
        module = _module(str(path.resolve()))
    except Exception as error:
        raise InputError(where, f"{str(path)!r} raised {type(error).__name__}: {error}", "correct it") from error
    function = getattr(module, name, None)
    if not callable(function):
        known = [key for key, value in vars(module).items() if inspect.isfunction(value) and not key.startswith("_")]
        raise InputError(where, f"{str(path)!r} has no function {name!r}", suggestion(name, known))
    return _described(function, name, _digest(path.read_text(encoding="utf-8") + name), file=str(path.resolve()), function=name)


def _described(found: Any, name: str, identity: str, **rest: Any) -> UserFunction:
    first = (inspect.getdoc(found) or name).splitlines()[0].rstrip(".")
    return UserFunction(name, str(getattr(found, "units", "")), first, identity, **rest)


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()


@cache
def _module(path: str) -> ModuleType:
    spec = importlib.util.spec_from_file_location(f"coaxshell_user_{_digest(path)[:12]}", path)
    assert spec is not None  # the path ends in .py and exists
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module
