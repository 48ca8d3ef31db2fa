"""Modules at the places where the version before had them: the same objects, with a warning."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Sequence
from importlib import import_module
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from importlib.util import spec_from_loader
from types import ModuleType

MOVED = ("cli", "paper", "studio", "verification")
"""Rooms that went from the package into ``coaxshell.apps``."""


class _Elsewhere(Loader):
    """Give the module of another name."""

    def create_module(self, spec: ModuleSpec) -> ModuleType:
        """Return the module itself, loaded at its place."""
        _, room, *inside = spec.name.split(".")
        module = import_module(".".join(["coaxshell", "apps", room, *inside]))
        self._spec = module.__spec__
        if not inside:
            told = f"coaxshell.{room} is coaxshell.apps.{room}; the old name goes with the version after this"
            warnings.warn(told, DeprecationWarning, stacklevel=2)
        return module

    def exec_module(self, module: ModuleType) -> None:
        """Leave the module as it is; the import system has written the old name's spec into it."""
        module.__spec__ = self._spec


class _Finder(MetaPathFinder):
    """Find what moved."""

    def find_spec(self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None) -> ModuleSpec | None:
        """Return the spec of an old name, None for any other."""
        parts = fullname.split(".")
        if len(parts) > 1 and parts[0] == "coaxshell" and parts[1] in MOVED:
            return spec_from_loader(fullname, _Elsewhere(), is_package=True)
        return None


def keep_old_names() -> None:
    """Let imports by the old names find the modules."""
    if not any(isinstance(finder, _Finder) for finder in sys.meta_path):
        sys.meta_path.append(_Finder())
