"""What is read of runs in two dimensions only: refused by name, so that nobody takes a plane's answer for that of space."""

from __future__ import annotations

from typing import Any, NoReturn

from coaxshell.errors import InputError


class WithoutFields:
    """Refuse the fields of the fluids of a run in three dimensions."""

    def pressure(self, *_: Any, **__: Any) -> NoReturn:
        """Refuse it; InputError."""
        _refuse("pressure")

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
    raise InputError(
        name, "is of runs in two dimensions only", "use dimensions=2, or read the walls at stations: stress, displacement, history"
    )
