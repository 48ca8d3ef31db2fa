"""Libraries that take long to import, imported when something of them is first used.

xarray brings pandas, half a second and more; a run that only prints its peaks labels nothing.
"""

from __future__ import annotations

from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING, Any

__all__ = ["integrate", "linalg", "signal", "xarray"]


class Late(ModuleType):
    """Stand in for a module until one of its names is asked for."""

    def __getattr__(self, name: str) -> Any:
        """Import the module and return its own attribute."""
        if name.startswith("__"):  # what inspects modules asks for these; they need no import
            raise AttributeError(f"module {self.__name__!r} is not imported yet: {name}")
        return getattr(import_module(self.__name__), name)


if TYPE_CHECKING:
    import xarray
    from scipy import integrate, linalg, signal
else:
    integrate, linalg, signal, xarray = map(Late, ("scipy.integrate", "scipy.linalg", "scipy.signal", "xarray"))
