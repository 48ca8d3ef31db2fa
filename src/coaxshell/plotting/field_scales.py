"""Colours of pressure and stress: two diverging maps, white at zero, with limits that are symmetric and round.

The front is tens of times louder than what the shells radiate. Colours of the pressure are in proportion up to a tenth of their limit and
follow the logarithm beyond (arsinh), so that the front is shown as strong as it is and a hundredth of it is still seen; those of the
stress are in proportion.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from coaxshell.errors import InputError
from coaxshell.plotting.frames import Frames
from coaxshell.plotting.scales import round_up

if TYPE_CHECKING:
    from matplotlib.cm import ScalarMappable

    from coaxshell.response import Response

PRESSURE_COLOURS = "RdBu_r"
"""Matplotlib's map of the pressure: red above the ambient pressure, blue below."""
STRESS_COLOURS = "PRGn"
"""Matplotlib's map of the stress: green in tension, violet in compression."""

PRESSURE_UNITS = ("auto", "Pa", "kPa", "MPa", "relative")
"""Units of pressure that a field can be drawn in; "relative" is p/(rho_e c_e^2)."""

_PREFIXES = {"Pa": 1.0, "kPa": 1e-3, "MPa": 1e-6}

_PRESSURE_SHARE = 0.9995
_STRESS_SHARE = 0.999
LINEAR = 0.1
"""Share of the limit up to which colours of the pressure are about in proportion."""
_SHARES = (-1.0, -0.4, -0.1, 0.0, 0.1, 0.4, 1.0)
"""Where the pressure's colour bar is marked: at about 0.7 and 0.3 of the way to its ends."""


@dataclass(frozen=True)
class FieldScales:
    """Largest magnitudes on the two colour scales.

    Attributes
    ----------
    pressure, stress : float
        Pa; a scale runs from minus to plus its limit.
    """

    pressure: float
    stress: float

    def __post_init__(self) -> None:
        for name, value in (("pressure_limit", self.pressure), ("stress_limit", self.stress)):
            if not (math.isfinite(value) and value > 0):
                raise InputError(name, f"{value!r} is not allowed", "give a positive number, in Pa")


@dataclass(frozen=True)
class DrawnUnit:
    """A unit on a colour bar: its label, and how many of it are one pascal."""

    label: str
    per_pascal: float


def field_scales(frames: Iterable[Frames], pressure: float | None = None, stress: float | None = None) -> FieldScales:
    """Return round limits that almost all of the pressure and the stress of the frames stays within.

    Parameters
    ----------
    frames : iterable of Frames
        All that share the scales.
    pressure, stress : float, optional
        Limits in Pa that are already decided.
    """
    every = list(frames)
    if pressure is None:
        values = [np.abs(part.pressure).ravel()[:: 1 + part.pressure.size // 2_000_000] for part in every]
        pressure = round_up(_share(values, _PRESSURE_SHARE))
    if stress is None:
        stresses = [np.abs(around).ravel() for part in every for around in part.stress if around is not None]
        stress = round_up(_share(stresses, _STRESS_SHARE))
    return FieldScales(pressure, stress)


def _share(values: list[Any], share: float) -> float:
    """Return the magnitude that the given share of all that is not quiet stays within; 0 where all is quiet."""
    if not values:
        return 0.0
    joined = np.concatenate(values)
    largest = float(joined.max(initial=0.0))
    loud = joined[joined > 1e-3 * largest]  # water that the wave has not reached would otherwise decide
    return float(np.quantile(loud, share)) if loud.size else 0.0


def check_units(name: str) -> None:
    """Raise InputError if a unit of pressure is unknown."""
    if name not in PRESSURE_UNITS:
        raise InputError("units", f"{name!r} is unknown", f"allowed: {', '.join(PRESSURE_UNITS)}")


def pressure_unit(response: Response, name: str, limit: float) -> DrawnUnit:
    """Return the unit of the pressure's colour bar; InputError for an unknown name.

    Parameters
    ----------
    response : Response
        Its exterior fluid scales the relative pressure.
    name : str
        One of :data:`PRESSURE_UNITS`; "auto" chooses among Pa, kPa and MPa by the limit.
    limit : float
        Limit of the scale, Pa.
    """
    check_units(name)
    if name == "relative":
        fluid = response.system.exterior
        whole = fluid.density * fluid.sound_speed**2
        power = math.floor(math.log10(limit / whole))
        return DrawnUnit(rf"pressure $p/\rho_e c_e^2$ ($10^{{{power}}}$)", 10.0**-power / whole)
    if name == "auto":
        name = "MPa" if limit >= 1e6 else "kPa" if limit >= 1e3 else "Pa"
    return DrawnUnit(f"pressure ({name})", _PREFIXES[name])


def stress_unit(limit: float) -> DrawnUnit:
    """Return the unit of the stress's colour bar, MPa or, below a hundredth of it, kPa."""
    name = "MPa" if limit >= 1e4 else "kPa"
    return DrawnUnit(f"hoop stress ({name})", _PREFIXES[name])


def compressed(values: Any) -> Any:
    """Return arsinh(x/LINEAR)/arsinh(1/LINEAR): the place of a pressure on its colour scale, both relative to their limits."""
    return np.arcsinh(values / LINEAR) / np.arcsinh(1.0 / LINEAR)


def mappable(limit: float, colours: str) -> ScalarMappable:
    """Return matplotlib's mapping from minus to plus a limit onto a colour map: compressed for a pressure, else in proportion."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import AsinhNorm, Normalize

    if colours == PRESSURE_COLOURS:
        return ScalarMappable(norm=AsinhNorm(LINEAR * limit, vmin=-limit, vmax=limit), cmap=colours)
    return ScalarMappable(norm=Normalize(-limit, limit), cmap=colours)


def _short(value: float) -> float:
    """Return a mark of a colour bar that can be read: the value where two digits write it, else the next below that one digit does."""
    if not value or math.isclose(float(f"{value:.1e}"), value, rel_tol=1e-9):
        return value
    step = 10.0 ** math.floor(math.log10(value))
    return math.floor(value / step) * step


def add_colour_bar(ax: Any, limit: float, unit: DrawnUnit, colours: str, *, orientation: str = "vertical") -> Any:
    """Fill axes with a colour bar, in the drawn unit, with arrows where values may lie beyond, and return it."""
    from matplotlib.ticker import FixedLocator, FuncFormatter, MaxNLocator

    bar = ax.figure.colorbar(mappable(limit * unit.per_pascal, colours), cax=ax, orientation=orientation, extend="both")
    bar.set_label(unit.label)
    bar.outline.set_linewidth(0.5)
    if colours == PRESSURE_COLOURS:
        bar.locator = FixedLocator([math.copysign(_short(abs(share) * limit * unit.per_pascal), share) for share in _SHARES])
        bar.formatter = FuncFormatter(lambda value, _: f"{value:g}".replace("-", "\N{MINUS SIGN}"))
    else:
        bar.locator = MaxNLocator(nbins=5, steps=[1, 2, 2.5, 5, 10], symmetric=True)
    bar.update_ticks()
    bar.ax.grid(visible=False)
    bar.ax.minorticks_off()
    return bar
