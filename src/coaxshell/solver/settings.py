"""What the user asks of a run beside the system itself: one holder for calls, study files, commands and the studio."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any, Literal, TypedDict

from coaxshell.errors import InputError
from coaxshell.model.base import shown
from coaxshell.model.durations import transits
from coaxshell.model.naming import suggestion
from coaxshell.model.paths import joined, within
from coaxshell.model.system import System
from coaxshell.numerics.scalars import plain
from coaxshell.solver.stations import axial_length, stations_of

MAX_MODES = 2000
MAX_REFINEMENT = 64
MAX_STEPS = 2_000_000
ENGINES = ("spectral", "direct")
AXIAL = ("stations", "axial_modes", "axial_period")
"""What three dimensions alone have."""


@dataclass(frozen=True)
class Settings:
    """Settings of a run; what no run accepts is refused as soon as it is written, wherever it comes from.

    A text that holds a number, as from a file or a command line, counts as the number. Times as text, "3 ms", need a system:
    :meth:`of`.

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
    dimensions : int
        2, all alike along the axis, or 3.
    stations : tuple of float
        Axial positions z (m) at which a run in three dimensions answers, at most 200; also one position, or texts such as "70 cm".
    axial_modes : float or None
        Largest axial wavenumber, as k a; None for as much as the highest order, k a = M.
    axial_period : float or None
        Distance L (m) after which the answer repeats along the axis; None for what causality asks.

    Raises
    ------
    InputError
        A setting is not allowed; it names the setting.
    """

    duration: float = 5.0
    time_step: float = 1e-3
    modes: int | Literal["auto"] = 150
    engine: str = "spectral"
    tolerance: float = 1e-3
    refinement: int = 1
    dimensions: int = 2
    stations: tuple[float, ...] = (0.0,)
    axial_modes: float | None = None
    axial_period: float | None = None

    def __post_init__(self) -> None:
        for name, unit in (("duration", _TRANSITS), ("time_step", _TRANSITS), ("tolerance", "relative error")):
            object.__setattr__(self, name, _positive(name, getattr(self, name), unit))
        if not isinstance(self.modes, str) or self.modes.strip().lower() != "auto":
            object.__setattr__(self, "modes", whole("modes", self.modes, MAX_MODES, ' or "auto"'))
        else:
            object.__setattr__(self, "modes", "auto")
        object.__setattr__(self, "refinement", whole("refinement", self.refinement, MAX_REFINEMENT))
        if self.engine not in ENGINES:
            raise InputError("engine", f"{shown(self.engine)} is unknown", f"allowed: {', '.join(ENGINES)}")
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
        self._settle_dimensions()

    def _settle_dimensions(self) -> None:
        """Check what three dimensions need, and that two have none of it."""
        number = plain(self.dimensions)
        found = _number(number, int)
        if found not in (2, 3) or (isinstance(number, float) and found != number):
            raise InputError("dimensions", f"{shown(number)} is not allowed", "give 2 or 3")
        object.__setattr__(self, "dimensions", found)
        object.__setattr__(self, "stations", stations_of(self.stations))
        if self.axial_modes is not None:
            object.__setattr__(self, "axial_modes", _positive("axial_modes", self.axial_modes, "axial wavenumber times a"))
        if self.axial_period is not None:
            object.__setattr__(self, "axial_period", axial_length("axial_period", self.axial_period))
        if self.axial_modes is not None and self.axial_modes > MAX_MODES:
            raise InputError("axial_modes", f"{self.axial_modes:g} is not allowed", f"at most {MAX_MODES} (axial wavenumber times a)")
        if found == 2:
            for name in AXIAL:
                if name in self.arguments():
                    raise InputError(name, "has no effect in two dimensions", "use dimensions=3, or leave it out")
        elif self.engine != "spectral":
            raise InputError("engine", f"{shown(self.engine)} solves two dimensions only", 'use engine="spectral", or dimensions=2')

    @classmethod
    def of(cls, system: System | None, given: Any = None, *, base: Settings | None = None, where: str = "") -> Settings:
        """Return the settings of runs of a system that somebody gave, in whatever form.

        Parameters
        ----------
        system : System or None
            Times as text, "3 ms", become its transits; there are none without one.
        given : Settings or mapping, optional
            A table of some of them, as in a study file, changes those of *base*.
        base : Settings, optional
            The defaults unless given.
        where : str
            Dotted path that errors begin with, such as "resolution".

        Raises
        ------
        InputError
            An entry is unknown, or no run accepts it.
        """
        if isinstance(given, Settings):
            return given
        if given is not None and not isinstance(given, Mapping):
            raise InputError(where, f"{shown(given)} is not a resolution", f"give a table with {', '.join(NAMES)}")
        table = dict(given or {})
        for name in table:
            if name not in NAMES:
                raise InputError(joined(where, str(name)), "is not an entry of a resolution", suggestion(str(name), NAMES))
        try:
            for name in ("duration", "time_step"):
                if name in table:
                    table[name] = transits(table[name], system, name)
            return replace(base or cls(), **table)
        except InputError as error:
            raise within(where, error) from None

    @classmethod
    def asked(cls, system: System, keywords: Mapping[str, Any]) -> Settings:
        """Return what the keywords of a call ask for, see :class:`SettingsKeywords`.

        Raises
        ------
        InputError
            As :meth:`of`.
        TypeError
            A keyword that there is not.
        """
        changes = dict(keywords)
        base = cls.of(system, changes.pop("settings", None), where="settings")
        unknown = next((name for name in changes if name not in NAMES), None)
        if unknown is not None:
            raise TypeError(f"unexpected keyword argument {unknown!r}; {suggestion(unknown, NAMES)}")
        return cls.of(system, changes, base=base)

    def up_to(self, duration: float) -> Settings:
        """Return the settings of a run that is no longer than *duration* transits."""
        return replace(self, duration=min(self.duration, duration))

    def arguments(self) -> dict[str, Any]:
        """Return them by name: keyword arguments of :func:`coaxshell.simulate`, and the table of a study file or a saved run.

        What three dimensions brought is left out where it is as in two: such runs are told as they were before.
        """
        table = {name: getattr(self, name) for name in NAMES}
        return {
            name: list(value) if name == "stations" else value
            for name, value in table.items()
            if name not in _LATER or value != _LATER[name]
        }

    @property
    def steps(self) -> int:
        """Number of time steps: the last instant is steps * time_step, within rounding of the duration or just below it."""
        return math.floor(self.duration / self.time_step * (1 + 1e-12) + 1e-9)


class SettingsKeywords(TypedDict, total=False):
    """The keywords of every call that runs: single settings, and *settings* that they change, whole or as the table of a study file."""

    duration: float | str
    time_step: float | str
    modes: int | Literal["auto"]
    engine: str
    tolerance: float
    refinement: int
    dimensions: int
    stations: float | str | Sequence[float | str]
    axial_modes: float | str | None
    axial_period: float | str | None
    settings: Settings | Mapping[str, Any] | None


NAMES = tuple(field.name for field in fields(Settings))
_LATER = {field.name: field.default for field in fields(Settings) if field.name in ("dimensions", *AXIAL)}
_TRANSITS = "acoustic transit times a/c_e"


def _positive(name: str, value: Any, unit: str) -> float:
    """Return a finite number above zero; 1 and 1.0 are one setting, also to a hash of its text."""
    number = plain(transits(value, None, name) if unit == _TRANSITS else value)
    found = _number(number, float)
    if found is None or not 0.0 < found < math.inf:
        raise InputError(name, f"{shown(number)} is not allowed", f"give a finite number greater than 0 ({unit})")
    return float(found)


def whole(name: str, value: Any, most: int, more: str = "") -> int:
    """Return a whole number from 1 to *most*."""
    number = plain(value)
    found = _number(number, int)
    if found is None or not 1 <= found <= most or (isinstance(number, float) and found != number):
        raise InputError(name, f"{shown(number)} is not allowed", f"give a whole number from 1 to {most}{more}")
    return int(found)


def _number(value: Any, kind: type[int] | type[float]) -> float | None:
    """Return a number, or the one that a text holds; None if there is none."""
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        return None
    try:
        return kind(value)
    except (ValueError, OverflowError):
        return None
