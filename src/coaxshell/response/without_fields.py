"""What is read of runs in two dimensions only: refused by name, so that nobody takes a plane's answer for that of space."""

from __future__ import annotations

from typing import Any, NoReturn

from coaxshell.errors import InputError


class WithoutFields:
    """Refuse, of a run in three dimensions, the fields of the fluids but the pressure."""

    def pressure_rms(self, *_: Any, **__: Any) -> NoReturn:
        """Refuse it; InputError."""
        _refuse("pressure_rms")

    def velocity(self, *_: Any, **__: Any) -> NoReturn:
        """Refuse it; InputError."""
        _refuse("velocity")

    def intensity(self, *_: Any, **__: Any) -> NoReturn:
        """Refuse it; InputError."""
        _refuse("intensity")


def _refuse(name: str) -> NoReturn:
    remedy = "use dimensions=2, or read the pressure on cuts, or the walls at stations: stress, displacement, history"
    raise InputError(name, "is of runs in two dimensions only", remedy)
