"""Metrics at given frequencies, as "system.target_strength@500 Hz" or "inner.stress@100..1000 Hz": what needs no time step.

Of one frequency it is the magnitude of an amplitude, or a level; of a band the root of the mean square over frequencies of equal spacing,
of levels that of the power that they stand for, so that no resonance can be dodged by a shift.
"""

from __future__ import annotations

from typing import Any, Literal, NamedTuple, Self, cast

import numpy as np

from coaxshell.errors import InputError
from coaxshell.model.system import System
from coaxshell.numerics.arrays import FloatArray
from coaxshell.response.frequency.answer import frequency_response
from coaxshell.response.frequency.request import STEADY
from coaxshell.studies.spectrum_metrics import STEP, TURNS, Where, frequency_of

OF_BAND = 201
"""Frequencies that stand for a band."""
OF_SHELLS = ("displacement", "shell_velocity", "shell_acceleration", "stress", "sensor_voltage", "actuator_voltage")
OF_SYSTEMS = ("target_strength", "transmission_loss", "scattering_width", "extinction_width", "absorption_width")
OF_FLUIDS = ("transmission_loss",)
NAMES = (*(name + where for name in OF_SHELLS for where in ("", *TURNS)), "mobility_head", "mobility_tail", *OF_SYSTEMS)
"""Of a shell all around it or at its head or tail, of the system, of a fluid within."""
_BETWEEN = ".."


class SteadyMetric(NamedTuple):
    """The value of an answer at a frequency, or over a band.

    Attributes
    ----------
    name : str
        Of :func:`coaxshell.frequency_response`.
    where : str
        Of a shell, "_head" or "_tail"; "" for the largest of all angles, 5 degrees apart.
    lowest, highest : float
        Hz; the same of a single frequency.
    """

    name: str
    where: Where
    lowest: float
    highest: float

    @classmethod
    def of(cls, name: str, text: str, where: str) -> Self | None:
        """Return the metric of one of :data:`NAMES` and "500 Hz" or "100..1000 Hz", None if it is none; InputError if the text is none."""
        if name not in NAMES:
            return None
        place = next((place for place in TURNS if name.endswith(place)), "")
        first, between, last = text.partition(_BETWEEN)
        highest = frequency_of(last if between else first, where)
        lowest = frequency_of(_with_unit(first, last), where) if between else highest
        if between and not lowest < highest:
            raise InputError(where, f"a band from {lowest:g} to {highest:g} Hz is empty", "give the lower frequency first")
        return cls(name.removesuffix(place), cast(Where, place), lowest, highest)

    @classmethod
    def read(cls, quantity: str) -> Self | None:
        """Return the metric that :attr:`quantity` names, None if it names none."""
        name, at, text = quantity.partition("@")
        return cls.of(name, text, quantity) if at else None

    @property
    def quantity(self) -> str:
        """Name of the quantity, with the frequencies in Hz."""
        band = f"{self.lowest!r}{_BETWEEN}" if self.lowest < self.highest else ""
        return f"{self.name}{self.where}@{band}{self.highest!r}"

    @property
    def units(self) -> str:
        """SI unit of its value, per pressure of the source at the head."""
        entry = STEADY[self.name]
        if entry.name == "target_strength":
            return "dB re 1 m"
        return entry.unit if entry.kind != "shell" else "1" if entry.unit == "Pa" else f"{entry.unit}/Pa"

    @property
    def long_name(self) -> str:
        """What it is, in words."""
        at = f"{self.highest:g} Hz" if self.lowest == self.highest else f"{self.lowest:g} to {self.highest:g} Hz"
        on_shell = STEADY[self.name].kind in ("shell", "point")
        place = (f", at the {self.where[1:]}" if self.where else ", anywhere") if on_shell else ""
        return f"{STEADY[self.name].long_name} at {at}{place}"

    def value(self, system: System, place: str | int) -> float:
        """Return its value, SI; *place* is a shell or a fluid by number, or "system"."""
        entry, options = STEADY[self.name], dict[str, Any]()
        if entry.kind in ("shell", "point"):
            head = system.sources[0].angle
            options["shell"] = place
            options["angle"] = head + TURNS[self.where] if self.where else head + np.arange(0.0, 360.0, STEP)
        elif isinstance(place, int):
            options["region"] = place
        single = self.lowest == self.highest
        hertz = np.array([self.highest]) if single else np.linspace(self.lowest, self.highest, OF_BAND)
        found = frequency_response(system, hertz, self.name, **options).to_numpy()
        return _mean(found if found.ndim == 1 else np.abs(found).max(axis=1), entry.unit, entry.name)


def _mean(values: FloatArray, unit: str, name: str) -> float:
    """Return the mean over a band: of powers behind levels, of widths, of squares of amplitudes."""
    if unit == "dB":
        sign = -1.0 if name == "transmission_loss" else 1.0
        return float(sign * 10.0 * np.log10(np.mean(10.0 ** (0.1 * sign * values))))
    if name.endswith("_width"):
        return float(np.mean(values))
    return float(np.sqrt(np.mean(np.abs(values) ** 2)))


def _with_unit(first: str, last: str) -> str:
    """Return the lower end of a band with the unit of the upper one if it has none itself: "100..1000 Hz"."""
    try:
        float(first)
    except ValueError:
        return first
    return f"{first.strip()} {last.strip().lstrip('0123456789.eE+-').strip()}".strip()


Places = Literal["shell", "system", "fluid"]


def places_of(metric: SteadyMetric) -> tuple[Places, ...]:
    """Return what a metric may be read of."""
    if STEADY[metric.name].kind in ("shell", "point"):
        return ("shell",)
    return ("system", "fluid") if metric.name in OF_FLUIDS else ("system",)
