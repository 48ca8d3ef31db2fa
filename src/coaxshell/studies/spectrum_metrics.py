"""Metrics of shock spectra, as "outer.pseudo_velocity@500 Hz": the largest answer of light equipment of that natural frequency."""

from __future__ import annotations

from typing import Literal, NamedTuple, Self, cast

import numpy as np

from coaxshell.errors import InputError
from coaxshell.model.units import DIMENSIONS, to_si
from coaxshell.numerics.oscillators import Kind
from coaxshell.response.shock_spectrum import UNITS, shock_spectrum
from coaxshell.response.wall_motion import WallMotion

QUALITY_FACTOR = 10.0
"""Of the equipment: a damping of 5 %."""
STEP = 5.0
"""Between the angles that are searched all around, degrees."""

_TURNS = {"_head": 0.0, "_tail": 180.0}
NAMES = tuple(kind.replace("-", "_") + where for kind in UNITS for where in ("", *_TURNS))
"""Kinds of spectrum, all around the shell or at its head or tail."""


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
    where: Literal["", "_head", "_tail"]
    frequency: float

    @classmethod
    def of(cls, name: str, frequency: str, where: str) -> Self | None:
        """Return the metric of one of :data:`NAMES` and a text such as "500 Hz", None if it is none; InputError if the text is none."""
        if name not in NAMES:
            return None
        place = next((place for place in _TURNS if name.endswith(place)), "")
        try:
            hertz = to_si(frequency.strip(), DIMENSIONS["frequency"])
        except InputError as error:
            raise InputError(where, error.problem, error.remedy) from None
        if hertz <= 0.0:
            raise InputError(where, f"{hertz:g} Hz is not allowed", "give a frequency above 0, such as outer.pseudo_velocity@500 Hz")
        return cls(cast(Kind, name.removesuffix(place).replace("_", "-")), cast(Literal["", "_head", "_tail"], place), hertz)

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
        angles = np.array([head + _TURNS[self.where]]) if self.where else head + np.arange(0.0, 360.0, STEP)
        found = shock_spectrum(motion, shell, angles, [self.frequency], quality_factor=QUALITY_FACTOR, kind=self.kind)
        return float(found.max())
