"""Metrics of shock spectra: what equipment of a natural frequency feels, "outer.pseudo_velocity@500 Hz" of light equipment.

Of equipment that the shell feels, "outer.mounted_pseudo_velocity_head@500 Hz, 50 kg/m": a run of its own for each value.
"""

from __future__ import annotations

from typing import Literal, NamedTuple, Self, cast

import numpy as np

from coaxshell.errors import InputError
from coaxshell.model.units import DIMENSIONS, to_si
from coaxshell.numerics.oscillators import Kind
from coaxshell.response import Response
from coaxshell.response.equipment import largest_of_mounted
from coaxshell.response.shock_spectrum import UNITS, shock_spectrum
from coaxshell.response.wall_motion import WallMotion

QUALITY_FACTOR = 10.0
"""Of the equipment: a damping of 5 %."""
STEP = 5.0
"""Between the angles that are searched all around, degrees."""

Where = Literal["", "_head", "_tail"]
TURNS = {"_head": 0.0, "_tail": 180.0}
NAMES = tuple(kind.replace("-", "_") + where for kind in UNITS for where in ("", *TURNS))
"""Kinds of spectrum, all around the shell or at its head or tail."""
_MOUNTED = "mounted_"
MOUNTED_NAMES = tuple(_MOUNTED + kind.replace("-", "_") + where for kind in UNITS for where in TURNS)
"""Of equipment that the shell feels, which is mounted at one place."""


def frequency_of(text: str, where: str) -> float:
    """Return a frequency in Hz; InputError if a text is none, or not above 0."""
    try:
        hertz = to_si(text.strip(), DIMENSIONS["frequency"])
    except InputError as error:
        raise InputError(where, error.problem, error.remedy) from None
    if hertz <= 0.0:
        raise InputError(where, f"{hertz:g} Hz is not allowed", "give a frequency above 0, such as outer.pseudo_velocity@500 Hz")
    return hertz


def _kind_of(name: str) -> tuple[Kind, Where]:
    place = next((place for place in TURNS if name.endswith(place)), "")
    return cast(Kind, name.removesuffix(place).replace("_", "-")), cast(Where, place)


class SpectrumMetric(NamedTuple):
    """The value of a shock spectrum at a natural frequency.

    Attributes
    ----------
    kind : str
        Of the spectrum: "pseudo-velocity", "absolute-acceleration" or "relative-displacement".
    where : str
        "_head" or "_tail"; "" for the largest of all angles, 5 degrees apart.
    frequency : float
        Hz.
    """

    kind: Kind
    where: Where
    frequency: float

    @classmethod
    def of(cls, name: str, frequency: str, where: str) -> Self | None:
        """Return the metric of one of :data:`NAMES` and a text such as "500 Hz", None if it is none; InputError if the text is none."""
        return cls(*_kind_of(name), frequency_of(frequency, where)) if name in NAMES else None

    @classmethod
    def read(cls, quantity: str) -> Self | None:
        """Return the metric that :attr:`quantity` names, None if it names no spectrum."""
        name, at, frequency = quantity.partition("@")
        return cls.of(name, frequency, quantity) if at else None

    @property
    def quantity(self) -> str:
        """Name of the quantity, with the frequency in Hz."""
        return f"{self.kind.replace('-', '_')}{self.where}@{self.frequency!r}"

    @property
    def units(self) -> str:
        """SI unit of its value."""
        return UNITS[self.kind]

    @property
    def long_name(self) -> str:
        """What it is, in words."""
        place = f"at the {self.where[1:]}" if self.where else "anywhere"
        return f"{self.kind} of the shock spectrum at {self.frequency:g} Hz, Q = {QUALITY_FACTOR:g}, {place}"

    def largest(self, motion: WallMotion, shell: int, head: float) -> float:
        """Return its value of a run (at a station), SI; *head* is the direction of the source in degrees."""
        angles = np.array([head + TURNS[self.where]]) if self.where else head + np.arange(0.0, 360.0, STEP)
        found = shock_spectrum(motion, shell, angles, [self.frequency], quality_factor=QUALITY_FACTOR, kind=self.kind)
        return float(found.max())


class MountedMetric(NamedTuple):
    """What equipment that the shell feels suffers at the head or the tail.

    Attributes
    ----------
    kind : str
        "pseudo-velocity", "absolute-acceleration" or "relative-displacement".
    where : str
        "_head" or "_tail".
    frequency, mass : float
        Hz, on a base at rest, and kg/m.
    """

    kind: Kind
    where: Where
    frequency: float
    mass: float

    @classmethod
    def of(cls, name: str, text: str, where: str) -> Self | None:
        """Return the metric of one of :data:`MOUNTED_NAMES` and "500 Hz, 50 kg/m", None if it is none; InputError if the text is none."""
        if name not in MOUNTED_NAMES:
            return None
        frequency, comma, mass = text.partition(",")
        if not comma:
            raise InputError(where, f"{text.strip()!r} has no mass", "give both, as in outer.mounted_pseudo_velocity_head@500 Hz, 50 kg/m")
        try:
            value = to_si(mass.strip(), DIMENSIONS["line mass"])
        except InputError as error:
            raise InputError(where, error.problem, error.remedy) from None
        if value <= 0.0:
            raise InputError(
                where, f"{value:g} kg/m is not allowed", "give a mass above 0; equipment without mass is outer.pseudo_velocity@500 Hz"
            )
        return cls(*_kind_of(name.removeprefix(_MOUNTED)), frequency_of(frequency, where), value)

    @classmethod
    def read(cls, quantity: str) -> Self | None:
        """Return the metric that :attr:`quantity` names, None if it names none."""
        name, at, text = quantity.partition("@")
        return cls.of(name, text, quantity) if at else None

    @property
    def quantity(self) -> str:
        """Name of the quantity, with frequency and mass in SI."""
        return f"{_MOUNTED}{self.kind.replace('-', '_')}{self.where}@{self.frequency!r}, {self.mass!r}"

    @property
    def units(self) -> str:
        """SI unit of its value."""
        return UNITS[self.kind]

    @property
    def long_name(self) -> str:
        """What it is, in words."""
        return f"{self.kind} of {self.mass:g} kg/m mounted at the {self.where[1:]}, {self.frequency:g} Hz, Q = {QUALITY_FACTOR:g}"

    def value(self, response: Response, shell: int) -> float:
        """Return its value in the system and at the settings of a run, SI."""
        angle = response.system.sources[0].angle + TURNS[self.where]
        return largest_of_mounted(response, shell, self.frequency, self.mass, angle, QUALITY_FACTOR, self.kind)
