"""What a user asks of a field, checked: where, when, which part, how smooth, within how much memory; and the region that it lies in."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple, TypedDict

import numpy as np
import numpy.typing as npt

from coaxshell.errors import InputError
from coaxshell.model.places import region_number
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.cost import Cost
from coaxshell.numerics.progress import Progress, ShareDone
from coaxshell.numerics.scalars import plain
from coaxshell.response import arguments
from coaxshell.solver.scaling import FluidRegion, Problem, Scales

Tell = ShareDone

PARTS = ("total", "incident", "diffracted", "radiated", "scattered")
FILTERS = ("lanczos", "exponential")
FRONTS = ("sharp", "matched")
LEAST_MEMORY = 64e6
RESOLUTION = 5e-3
"""Default time resolution of large grids in transits, unless the run is coarser."""


def axis(name: str, values: object, *, least: float | None = None, unit: str = "a") -> FloatArray:
    """Return a coordinate axis as a one-dimensional array; InputError naming it if it is not one of finite real numbers."""
    array = np.asarray(values)
    if array.dtype.kind not in "iuf":
        raise InputError(name, f"{array.dtype} is not real", f"give real numbers in {unit}")
    array = np.atleast_1d(array.astype(np.float64))
    if array.ndim != 1 or array.size == 0:
        raise InputError(name, f"an array of shape {array.shape} is not allowed", f"give one number or a list of them, in {unit}")
    if not np.all(np.isfinite(array)):
        raise InputError(name, f"{array[~np.isfinite(array)][0]} is not finite", f"give finite numbers in {unit}")
    if least is not None and np.any(array < least):
        raise InputError(name, f"{array.min():g} is not allowed", f"give numbers of at least {least:g} in {unit}")
    return array


def instants(time: object, last: float) -> FloatArray:
    """Return the instants asked for, in transits, shape () or (T,); InputError if any lies outside the run."""
    array = np.asarray(time)
    if array.dtype.kind not in "iuf" or array.ndim > 1 or array.size == 0:
        raise InputError("time", f"{time!r} is not a number or a list of numbers", "give transits a/c_e")
    array = array.astype(np.float64)
    slack = 1e-9 * last
    bad = ~((array >= -slack) & (array <= last + slack))
    if np.any(bad):
        raise InputError("time", f"{array[bad].flat[0]:g} lies outside the run", f"give times from 0 to {last:g} transits")
    return np.asarray(np.clip(array, 0.0, last), dtype=np.float64)


def when_of(time: npt.ArrayLike | None, last: float, scales: Scales) -> FloatArray:
    """Return the instants asked for, in transits, shape () or (T,); InputError if there are none or some lie after the *last*.

    NumPy's durations (timedelta64) are real time.
    """
    if time is None:
        raise InputError("time", "is missing", f"give one time or a list of them, from 0 to {last:g} transits")
    given = np.asarray(time)
    if given.dtype.kind == "m":  # durations carry their unit
        time = np.where(np.isnat(given), np.nan, given / np.timedelta64(1, "s")) / scales.time
    return instants(time, last)


_HELD = {1: 1.0, 2: 4.0, 3: 6.0, 4: 9.0}
"""Arrays of the result's size that stand side by side, by the number of quantities that it is made of."""


def require_room(name: str, place: Sequence[object], when: FloatArray, quantities: int = 1) -> None:
    """Raise InputError, before anything of its size is made, if a field at so many points and instants does not fit into memory.

    Parameters
    ----------
    name : str
        Of the field.
    place : sequence
        The axes asked for, None for those left out.
    when : ndarray
        Instants.
    quantities : int
        From which it is made: 1 for the pressure, 2 for the velocity, 3 for the intensity; one more of the latter two in space.
    """
    sizes: list[int] = [np.asarray(axis).size for axis in place if axis is not None]
    points = math.prod(sizes)
    cost = Cost(8.0 * _HELD[quantities] * points * when.size + 150.0 * points)
    if not cost.fits:
        what = f"the {name} at {points:,} points and {when.size:,} instants"
        cost.require(what, "ask for fewer points, or for some instants at a time")


class FieldOptions(TypedDict, total=False):
    """Keyword arguments of any field beside x and y; see :func:`coaxshell.response.fields.evaluate.pressure`."""

    radius: npt.ArrayLike | None
    angle: npt.ArrayLike | None
    time: npt.ArrayLike | None
    filter: str | None
    time_resolution: float | None
    memory: float
    progress: Progress | None


class PartOptions(FieldOptions, total=False):
    """Keyword arguments of a particle velocity: those of any field, and which part of it."""

    part: str


class PressureOptions(PartOptions, total=False):
    """Keyword arguments of a pressure: those of a velocity, and how sharp the incident front is."""

    front: str


class RmsOptions(TypedDict, total=False):
    """Keyword arguments of a mean over a region."""

    time: npt.ArrayLike | None
    part: str
    filter: str | None
    time_resolution: float | None
    memory: float
    progress: Progress | None


@dataclass(frozen=True)
class FieldRequest:
    """Options common to all fields; ``resolution_given`` tells whether the time resolution is the user's or only a proposal."""

    part: str
    filter: str | None
    resolution: float
    resolution_given: bool
    memory: float
    progress: Progress | None
    front: str = "sharp"


def request(
    *,
    part: str,
    filter: str | None,
    time_resolution: float | None,
    memory: float,
    progress: Progress | None,
    step: float,
    front: str = "sharp",
) -> FieldRequest:
    """Return the options, checked; InputError naming the one that is wrong."""
    arguments.one_of("part", part, PARTS)
    arguments.one_of("front", front, FRONTS)
    if filter is not None:
        arguments.one_of("filter", filter, FILTERS)
    resolution = max(RESOLUTION, step) if time_resolution is None else positive("time_resolution", time_resolution, "transits a/c_e")
    memory = positive("memory", memory, "bytes")
    if memory < LEAST_MEMORY:
        raise InputError("memory", f"{memory:g} bytes are too few", f"give at least {LEAST_MEMORY:g}")
    return FieldRequest(part, filter, max(resolution, step), time_resolution is not None, memory, progress, front)


def positive(name: str, value: object, unit: str) -> float:
    """Return a finite number greater than 0; InputError otherwise."""
    value = plain(value)
    if isinstance(value, bool) or not isinstance(value, (int, float, np.integer, np.floating)) or not 0 < float(value) < np.inf:
        raise InputError(name, f"{value!r} is not allowed", f"give a finite number greater than 0 ({unit})")
    return float(value)


def mode_filter(name: str | None, max_order: int) -> FloatArray:
    """Return the weight of every order: 1; sinc(m/(M + 1)) for "lanczos"; exp(-36 (m/(M + 1))^6) for "exponential"."""
    return filter_weight(name, np.arange(max_order + 1) / (max_order + 1.0))


def filter_weight(name: str | None, ratio: FloatArray) -> FloatArray:
    """Return 1, sinc(x) or exp(-36 x^6) of ratios x to the first order left out."""
    match name:
        case "lanczos":
            return np.asarray(np.sinc(ratio), dtype=np.float64)
        case "exponential":
            return np.exp(-36.0 * ratio**6)
    return np.ones_like(ratio)


SMEAR = 20
"""Resolutions by which the band limit smears a front, to about 1e-4."""


@dataclass(frozen=True)
class Region:
    """One fluid between the surfaces of walls that it wets.

    Attributes
    ----------
    index : int
        Counted from the inside; the exterior is the last.
    inner, outer : float
        Radii of its walls in units of a: 0 inside a disc, infinity outside.
    fluid : FluidRegion or None
        None is a vacuum.
    exterior : bool
    """

    index: int
    inner: float
    outer: float
    fluid: FluidRegion | None
    exterior: bool

    @property
    def spacing(self) -> float:
        """Radial distance per time that a wave needs at least to be resolved alike: 1 in the exterior, less in slower fluids."""
        return 1.0 if self.fluid is None else 1.0 / max(1.0, self.fluid.slowness)


class Members(NamedTuple):
    """A region and the positions of the radii that lie in it."""

    region: Region
    at: npt.NDArray[np.int64]


def regions(problem: Problem) -> tuple[Region, ...]:
    """Return the fluid regions from the inside out."""
    inner = [0.0, *(shell.wetted[1] for shell in problem.shells)]
    outer = [*(shell.wetted[0] for shell in problem.shells), np.inf]
    last = len(problem.fluids) - 1
    return tuple(Region(i, inner[i], outer[i], fluid, i == last) for i, fluid in enumerate(problem.fluids))


def split(problem: Problem, radius: FloatArray) -> list[Members]:
    """Return the regions that hold some of the radii.

    A wall wetted at its mid-surface has no thickness, and a radius on it lies outside of it; what lies between wetted faces is in no fluid.
    """
    found = []
    for region in regions(problem):
        wall_follows = region.index < len(problem.shells) and len(set(problem.shells[region.index].wetted)) == 2
        within = (radius >= region.inner) & ((radius <= region.outer) if wall_follows else (radius < region.outer))
        if within.any():
            found.append(Members(region, np.flatnonzero(within)))
    return found


def reach(problem: Problem, times: FloatArray, resolution: float) -> float:
    """Return the radius beyond which there is no scattered wave yet at any of the times: t beyond the head, and the first front's smear."""
    first = min(source.delay for source in problem.system.sources) / problem.scales.time
    return float(problem.head + times.max() - first + SMEAR * resolution)


EXTERIOR_RADIUS = 3.0
"""Default outer radius of the exterior, in a."""

INSTANTS = 500
"""Intervals between the default instants, at most twice as many."""


@dataclass(frozen=True)
class Domain:
    """An annulus (or disc) of one fluid."""

    region: Region
    outer: float

    def rule(self, resolution: float) -> tuple[FloatArray, FloatArray]:
        """Return Gauss radii and weights of the mean over the area, enough for squares of waves resolved in time by *resolution*."""
        inner, width = self.region.inner, self.outer - self.region.inner
        count = int(0.5 * np.pi / (resolution * self.region.spacing) * width) + 24
        x, w = np.polynomial.legendre.leggauss(count)
        radii = inner + 0.5 * width * (1.0 + x)
        return radii, w * radii / (self.outer + inner)


def domain_of(problem: Problem, name: str | int, radius: float | None) -> Domain:
    """Return the domain of a region named by a user, the exterior up to *radius*; InputError if either is not allowed."""
    region = _region(problem, name)
    if not region.exterior:
        if radius is not None:
            raise InputError("radius", f"{radius!r} is not allowed for the region {name!r}", "only the exterior has a radius to choose")
        return Domain(region, region.outer)
    nearest = np.inf if problem.planes is None else problem.planes.nearest
    outer = min(EXTERIOR_RADIUS, nearest) if radius is None else positive("radius", radius, "a")
    if outer > nearest:
        raise InputError("radius", f"{outer:g} reaches beyond the surface or the bottom of the sea", f"give at most {nearest:g}")
    if outer <= region.inner:
        raise InputError("radius", f"{outer:g} is not outside the outermost shell", f"give more than {region.inner:g}")
    return Domain(region, outer)


def _region(problem: Problem, name: str | int) -> Region:
    known = regions(problem)
    gaps = known[1:-1]
    number = region_number(name, len(problem.shells)) if isinstance(name, str) else name
    if isinstance(number, int) and not isinstance(number, bool) and 0 <= number < len(known):
        return known[number]
    if name == "gap":
        remedy = f"name the fluid by its number, 1 to {len(gaps)} from the inside" if gaps else 'use "interior" or "exterior"'
        raise InputError("region", f"{len(gaps) or 'no'} gaps lie between {len(problem.shells)} shells", remedy)
    raise InputError("region", f"{name!r} is unknown", f'allowed: "interior", "gap", "exterior" or a number from 0 to {len(known) - 1}')


def default_instants(time: FloatArray) -> FloatArray:
    """Return every k-th instant of a run, k the largest number that leaves at least 500 intervals."""
    return time[:: max(1, (time.size - 1) // INSTANTS)]
