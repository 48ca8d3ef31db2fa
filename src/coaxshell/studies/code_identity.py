"""The identity of all code that a function of the user's depends on: two functions of one identity give the same number.

It follows what runs, not what is written: the compiled code of the function, its defaults and closure, every global that it names,
and so on through other functions, methods, classes and modules of the user's own. Beside it stand the files that these modules come
from and those that they import, so that code imported later counts too. Python's own library and what is installed count by name and
version, coaxshell by its own digest. What a function reads from data files is not seen.
"""

from __future__ import annotations

import ast
import functools
import hashlib
import importlib.util
import inspect
import sys
import sysconfig
import types
from collections.abc import Iterator, Mapping
from contextlib import suppress
from importlib.metadata import PackageNotFoundError, packages_distributions, version
from pathlib import Path
from typing import Any

import numpy as np

_DEEPEST = 200
"""Steps from the function to what it depends on: beyond, the identity would cost more than it tells."""


def code_identity(function: Any) -> str:
    """Return the identity of a callable: of what it runs now, and of the files of all own modules it can reach.

    Parameters
    ----------
    function : callable
        A function, lambda, method, partial, or an instance with ``__call__``.
    """
    walk = _Walk()
    walk.add(function)
    digest = walk.digest
    for path in sorted(own_files(walk.modules)):
        digest.update(b"file" + _read(path))
    return digest.hexdigest()


def own_files(modules: Mapping[str, types.ModuleType]) -> set[Path]:
    """Return the source files of some modules and of all own modules that they import, directly or not."""
    found: set[Path] = set()
    waiting = [(Path(file), module.__name__) for module in modules.values() if (file := getattr(module, "__file__", None))]
    while waiting:
        path, name = waiting.pop()
        if path in found or not is_own(path) or not path.is_file():
            continue
        found.add(path)
        waiting += list(_imported(path, name))
    return found


@functools.cache
def is_own(path: Path) -> bool:
    """Return whether a file is the user's: neither Python's, nor installed, nor coaxshell's."""
    if path.suffix != ".py":
        return False
    resolved = path.resolve()
    return not any(resolved.is_relative_to(place) for place in _others())


@functools.cache
def _others() -> tuple[Path, ...]:
    places = {Path(sysconfig.get_path(name)).resolve() for name in ("stdlib", "platstdlib", "purelib", "platlib")}
    return (*places, Path(__file__).resolve().parents[1])


def _imported(path: Path, name: str) -> Iterator[tuple[Path, str]]:
    """Yield file and name of every module that a source file names in an import, or in import_module("...") or __import__("...")."""
    try:
        tree = ast.parse(_read(path))
    except (SyntaxError, ValueError):
        return
    package = name if path.name == "__init__.py" else name.rpartition(".")[0]
    for node in ast.walk(tree):
        names: list[str] = []
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            base = "." * node.level + (node.module or "")
            names = [base, *(f"{base}{'' if base.endswith('.') else '.'}{alias.name}" for alias in node.names)]
        elif isinstance(node, ast.Call) and node.args and isinstance(node.args[0], ast.Constant) and isinstance(node.args[0].value, str):
            called = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
            names = [node.args[0].value] if called in ("import_module", "__import__") else []
        for wanted in names:
            yield from _located(wanted, package, path.parent)


def _located(name: str, package: str, folder: Path) -> Iterator[tuple[Path, str]]:
    """Yield file and full name of a module, which may lie beside the file that names it."""
    with suppress(ImportError, ValueError, AttributeError):
        full = importlib.util.resolve_name(name, package) if name.startswith(".") else name
        beside = folder.joinpath(*full.split("."))
        for file in (beside.with_suffix(".py"), beside / "__init__.py"):
            if file.is_file():
                yield file, full
                return
        module = sys.modules.get(full)
        spec = getattr(module, "__spec__", None) if module is not None else importlib.util.find_spec(full)
        file_ = getattr(module, "__file__", None) or (spec.origin if spec is not None else None)
        if file_ and Path(file_).suffix == ".py":
            yield Path(file_), full


class _Walk:
    """Goes through all that a callable can reach and feeds a digest; nothing twice."""

    def __init__(self) -> None:
        self.digest = hashlib.sha256()
        self.modules: dict[str, types.ModuleType] = {}
        self._seen: dict[int, int] = {}
        self._kept: list[Any] = []  # what has been seen stays alive, so that no identity is given twice
        self._depth = 0

    def add(self, item: Any) -> None:
        """Feed one thing."""
        if item is None or isinstance(item, bool | int | float | complex | str | bytes | range):
            self._tell(type(item).__name__, repr(item))
            return
        if id(item) in self._seen:
            self._tell("seen", str(self._seen[id(item)]))
            return
        self._seen[id(item)] = len(self._seen)
        self._kept.append(item)
        self._depth += 1
        if self._depth < _DEEPEST:
            self._add(item)
        self._depth -= 1

    def _tell(self, *texts: str) -> None:
        for text in texts:
            data = text.encode("utf-8", "surrogatepass")
            self.digest.update(len(data).to_bytes(8, "little") + data)

    def _add(self, item: Any) -> None:
        if isinstance(item, types.ModuleType):
            self._module(item)
        elif isinstance(item, types.FunctionType):
            self._function(item)
        elif isinstance(item, types.CodeType):
            self._code(item)
        elif isinstance(item, functools.partial):
            self._all("partial", item.func, item.args, item.keywords)
        elif isinstance(item, types.MethodType):
            self._all("method", item.__func__, item.__self__)
        elif isinstance(item, staticmethod | classmethod):
            self._all(type(item).__name__, item.__func__)
        elif isinstance(item, property):
            self._all("property", item.fget, item.fset)
        elif isinstance(item, type):
            self._class(item)
        elif hasattr(item, "__wrapped__") and callable(item):
            self._all("wrapped", item.__wrapped__)  # a cache: what it holds changes no number
        else:
            self._data(item)

    def _all(self, kind: str, *items: Any) -> None:
        self._tell(kind)
        for item in items:
            self.add(item)

    def _data(self, item: Any) -> None:
        if isinstance(item, np.ndarray):
            self._tell("array", str(item.dtype), str(item.shape))
            self.digest.update(np.ascontiguousarray(item).tobytes() if item.dtype != object else repr(item.tolist()).encode())
        elif isinstance(item, Mapping) and isinstance(item, dict):
            self._all("dict", *(part for pair in item.items() for part in pair))
        elif isinstance(item, list | tuple):
            self._all(type(item).__name__, *item)
        elif isinstance(item, set | frozenset):
            self._tell("set", *sorted(map(repr, item)))
        elif isinstance(item, types.BuiltinFunctionType):
            self._tell("builtin", f"{item.__module__}.{item.__qualname__}", _release(item.__module__))
        else:
            self._all("instance", type(item))
            state = getattr(item, "__dict__", None)
            if state:
                self.add(dict(state))
            elif " object at 0x" not in (text := repr(item)):
                self._tell(text)

    def _module(self, module: types.ModuleType) -> None:
        self._tell("module", module.__name__.rpartition(".")[2])
        if not _is_own_module(module):
            self._tell(_release(module.__name__))
            return
        self.modules[module.__name__] = module
        for name, value in sorted(vars(module).items()):
            if not name.startswith("__"):
                self._all(name, value)

    def _class(self, kind: type) -> None:
        self._tell("class", kind.__qualname__)
        module = sys.modules.get(kind.__module__)
        if module is None or not _is_own_module(module):
            self._tell(kind.__module__, _release(kind.__module__))
            return
        self.modules[module.__name__] = module
        for name, value in sorted(vars(kind).items()):
            if name not in ("__dict__", "__weakref__", "__module__", "__doc__", "__firstlineno__", "__static_attributes__"):
                self._all(name, value)
        self._all("bases", *kind.__bases__)

    def _function(self, function: types.FunctionType) -> None:
        module = sys.modules.get(function.__module__ or "")
        if module is not None and not _is_own_module(module):
            self._tell("foreign", f"{function.__module__}.{function.__qualname__}", _release(function.__module__))
            return
        if module is not None:
            self.modules[module.__name__] = module
        self._all("function", function.__code__, function.__defaults__, function.__kwdefaults__)
        for cell in function.__closure__ or ():
            try:
                self.add(cell.cell_contents)
            except ValueError:  # not filled in yet
                self._tell("empty")
        for name in sorted(_names(function.__code__)):
            if name in function.__globals__:
                self._all(name, function.__globals__[name])
            elif name in sys.modules and _is_own_module(sys.modules[name]):  # imported when it is called
                self._all(name, sys.modules[name])

    def _code(self, code: types.CodeType) -> None:
        self.digest.update(code.co_code)
        self._tell(str(code.co_argcount), str(code.co_kwonlyargcount), str(code.co_flags), *code.co_names, *code.co_varnames)
        for constant in code.co_consts:
            self.add(constant)


def _names(code: types.CodeType) -> set[str]:
    """Return all names that some code and the functions within it use."""
    found = set(code.co_names)
    for constant in code.co_consts:
        if isinstance(constant, types.CodeType):
            found |= _names(constant)
    return found


def _is_own_module(module: types.ModuleType) -> bool:
    file = getattr(module, "__file__", None)
    if file is None:
        return module.__name__ in ("__main__", "__mp_main__")  # typed in: python -c, a notebook
    return module.__name__ in ("__main__", "__mp_main__") or is_own(Path(file))


@functools.cache
def _release(module: str | None) -> str:
    """Return name and version of what was installed and holds a module; its name alone for Python's own."""
    top = (module or "").partition(".")[0]
    for name in _distributions().get(top, ()):
        with suppress(PackageNotFoundError):
            return f"{name} {version(name)}"
    return top


@functools.cache
def _distributions() -> Mapping[str, list[str]]:
    return packages_distributions()


def _read(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError:
        return b""


def documented(function: Any) -> str:
    """Return the docstring of a callable, of the function within a partial."""
    while isinstance(function, functools.partial):
        function = function.func
    return inspect.getdoc(function) or ""
