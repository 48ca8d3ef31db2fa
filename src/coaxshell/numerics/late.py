"""What takes long to import, imported when something of it is first used.

xarray brings pandas, half a second and more, scipy.stats as much; a run that only prints its peaks needs neither. Functions that a room
offers although they live above it, such as the figure of a response, are supplied by the root of the package, which alone knows all rooms.
"""

from __future__ import annotations

from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING, Any

__all__ = ["integrate", "linalg", "signal", "stats", "supplied", "supply", "xarray"]


class Late(ModuleType):
    """Stand in for a module until one of its names is asked for."""

    def __getattr__(self, name: str) -> Any:
        """Import the module and return its own attribute."""
        if name.startswith("__"):  # what inspects modules asks for these; they need no import
            raise AttributeError(f"module {self.__name__!r} is not imported yet: {name}")
        return getattr(import_module(self.__name__), name)


if TYPE_CHECKING:
    import xarray
    from scipy import integrate, linalg, signal, stats
else:
    integrate, linalg, signal, stats, xarray = map(Late, ("scipy.integrate", "scipy.linalg", "scipy.signal", "scipy.stats", "xarray"))

_HOMES: dict[str, str] = {}


def supply(**homes: str) -> None:
    """Tell in which modules functions live that rooms below offer by their names."""
    _HOMES.update(homes)


def supplied(name: str) -> Any:
    """Return a function that was supplied, its module imported now."""
    return getattr(import_module(_HOMES[name]), name)
