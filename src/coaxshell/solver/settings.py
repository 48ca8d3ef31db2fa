"""What the user asks of a run beside the system itself."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from coaxshell.errors import InputError
from coaxshell.numerics.scalars import plain

MAX_MODES = 2000
MAX_STEPS = 2_000_000
ENGINES = ("spectral", "direct")
NUMERICS_VERSION = 6
"""Raised whenever a change alters the numbers that a run gives, so that kept results of another version are told from ours."""


@dataclass(frozen=True)
class Settings:
    """Resolution of a run.

    Attributes
    ----------
    duration, time_step : float
        In acoustic transit times a/c_e of the outermost radius, as in the paper.
    modes : int
        Highest circumferential order M; orders 0..M are kept. "auto" has been resolved to a number by then.
    engine : str
        "spectral" (Laplace domain, default) or "direct" (the paper's time marching).
    tolerance : float
        Relative error aimed at by ``modes="auto"``.
    refinement : int
        The run is made at time_step/refinement and every refinement-th instant is kept: for stiff absorbers.
    """

    duration: float = 5.0
    time_step: float = 1e-3
    modes: int | Literal["auto"] = 150
    engine: str = "spectral"
    tolerance: float = 1e-3
    refinement: int = 1

    def __post_init__(self) -> None:
        for name in ("duration", "time_step", "modes", "tolerance", "refinement"):
            object.__setattr__(self, name, plain(getattr(self, name)))
        _finite_positive("duration", self.duration, "acoustic transit times a/c_e")
        _finite_positive("time_step", self.time_step, "acoustic transit times a/c_e")
        _finite_positive("tolerance", self.tolerance, "relative error")
        if not isinstance(self.modes, str) or self.modes != "auto":
            if isinstance(self.modes, bool) or not isinstance(self.modes, int) or not 1 <= self.modes <= MAX_MODES:
                raise InputError("modes", f"{self.modes!r} is not allowed", f'give a whole number from 1 to {MAX_MODES} or "auto"')
        if isinstance(self.refinement, bool) or not isinstance(self.refinement, int) or not 1 <= self.refinement <= 64:
            raise InputError("refinement", f"{self.refinement!r} is not allowed", "give a whole number from 1 to 64")
        if self.engine not in ENGINES:
            raise InputError("engine", f"{self.engine!r} is unknown", f"allowed: {', '.join(ENGINES)}")
        if self.duration < 4 * self.time_step:
            raise InputError(
                "time_step", f"{self.time_step:g} is too coarse for duration {self.duration:g}", f"at most {self.duration / 4:g} is allowed"
            )
        if self.duration / self.time_step * self.refinement > MAX_STEPS:
            raise InputError(
                "time_step",
                f"{self.time_step:g} over duration {self.duration:g} asks for {self.duration / self.time_step * self.refinement:.3g} steps",
                f"at most {MAX_STEPS} are allowed: use a step of {self.duration * self.refinement / MAX_STEPS:.2g} or more",
            )

    @property
    def steps(self) -> int:
        """Number of time steps: the last instant is steps * time_step, within rounding of the duration or just below it."""
        return math.floor(self.duration / self.time_step * (1 + 1e-12) + 1e-9)


def _finite_positive(name: str, value: float, unit: str) -> None:
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value) or value <= 0:
        raise InputError(name, f"{value!r} is not allowed", f"give a finite number greater than 0 ({unit})")
