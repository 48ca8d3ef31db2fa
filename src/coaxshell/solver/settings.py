"""What the user asks of a run beside the system itself: one holder for calls, study files, commands and the studio."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields, replace
from typing import Any, Literal, TypedDict

from coaxshell.errors import InputError
from coaxshell.model.base import shown
from coaxshell.model.durations import transits
from coaxshell.model.naming import suggestion
from coaxshell.model.paths import joined, within
from coaxshell.model.system import System
from coaxshell.numerics.scalars import plain

MAX_MODES = 2000
MAX_REFINEMENT = 64
MAX_STEPS = 2_000_000
ENGINES = ("spectral", "direct")


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
        """Return them by name: keyword arguments of :func:`coaxshell.simulate`, and the table of a study file."""
        return asdict(self)

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
    settings: Settings | Mapping[str, Any] | None


NAMES = tuple(field.name for field in fields(Settings))
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
