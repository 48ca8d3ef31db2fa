"""The resolution at which all cases of a study are run."""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace
from typing import Any, Literal

from coaxshell.model.durations import transits
from coaxshell.model.system import System
from coaxshell.numerics.scalars import plain
from coaxshell.solver.settings import Settings


@dataclass(frozen=True)
class Resolution:
    """Settings of a run, those of :func:`coaxshell.response.simulate`; the paper's unless given."""

    duration: float = 5.0
    time_step: float = 1e-3
    modes: int | Literal["auto"] = 150
    tolerance: float = 1e-3
    engine: str = "spectral"
    refinement: int = 1

    def __post_init__(self) -> None:
        for name in ("duration", "time_step", "modes", "tolerance", "refinement"):
            object.__setattr__(self, name, plain(getattr(self, name)))
        for name in ("duration", "time_step", "tolerance"):  # 1 and 1.0 are one resolution, also to a hash of its text
            if type(getattr(self, name)) is int:
                object.__setattr__(self, name, float(getattr(self, name)))

    @classmethod
    def of(
        cls,
        system: System,
        duration: float | str = 5.0,
        time_step: float | str = 1e-3,
        modes: int | Literal["auto"] = 150,
        tolerance: float = 1e-3,
        engine: str = "spectral",
        refinement: int = 1,
    ) -> Resolution:
        """Return a resolution that runs accept; times as text, "3 ms", are those of the base *system*, whose transits all cases then count.

        Raises
        ------
        InputError
            A setting that no run accepts.
        """
        times = (transits(duration, system), transits(time_step, system, "time_step"))
        return cls(*times, modes, tolerance, engine, refinement).checked()

    def up_to(self, duration: float) -> Resolution:
        """Return the same, but no longer than *duration* transits."""
        return replace(self, duration=min(self.duration, duration))

    def checked(self) -> Resolution:
        """Return the same; InputError names a setting that no run accepts."""
        Settings(**asdict(self))
        return self

    def arguments(self) -> dict[str, Any]:
        """Return them as keyword arguments of :func:`coaxshell.response.simulate`."""
        return asdict(self)
