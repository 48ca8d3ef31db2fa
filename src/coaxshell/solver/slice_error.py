"""How far the slice through a spherical front, which two dimensions solve, is from the sphere.

A spherical source of two dimensions has the sphere's pressure in the plane of the source, S/R f(t - (R - S)), but walls and fluids that
answer alike along the axis: what spreads along it in three dimensions stays. The map beside this file holds, for the paper's bare
shells, the difference between both answers by the source's distance, the pulse's decay and the duration of the run; the ranges of
other systems' differences over it are what is told as its spread. ``python -m coaxshell.apps.paper.sphere map`` makes it again.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any

import numpy as np

from coaxshell.model.pulses import Exponential, Gaussian, Pulse, Sampled
from coaxshell.model.shells import Shell
from coaxshell.numerics.arrays import FloatArray
from coaxshell.solver.scaling import Problem

DATA = "slice_error.json"
AXES = ("distance", "decay", "duration")
ARRAYS = ("error", "at_points", "peaks", "line", "plane")


@dataclass(frozen=True)
class SliceMap:
    """Hold the differences of the hoop stress at head and tail of both shells, the slice's from the sphere's.

    Attributes
    ----------
    distance, decay, duration : ndarray
        Of the source from the axis in outer radii, of the pulse and of the run in transits; each rises.
    error : ndarray, shape (distances, decays, durations)
        ||slice - sphere||/||sphere|| over time and the four points together.
    at_points : ndarray, shape (distances, decays, durations, 4)
        That at each of the points alone; NaN where nothing has arrived.
    peaks : ndarray, shape (distances, decays, durations, 4)
        Largest magnitude of the slice over the sphere's; NaN where nothing has arrived.
    line, plane : ndarray, shape (distances, decays, durations)
        The error of a line source at the same distance, and of a plane wave, with the same pressure at the head point.
    spread : ndarray, shape (durations, 2)
        Smallest and largest of other systems' errors over the map's.
    """

    distance: FloatArray
    decay: FloatArray
    duration: FloatArray
    error: FloatArray
    at_points: FloatArray
    peaks: FloatArray
    line: FloatArray
    plane: FloatArray
    spread: FloatArray

    def estimate(self, distance: float, decay: float, duration: float) -> float:
        """Return the error by linear interpolation of logarithms.

        It goes on beyond the map as it does near its edges: as 1/distance far away and with the duration in short runs; nearer,
        longer, and for other decays the edge's value stands.

        Parameters
        ----------
        distance : float
            Of the source from the axis, outer radii.
        decay, duration : float
            Transits.
        """
        values = np.log(self.error)
        for axis, asked in zip((self.distance, self.decay, self.duration), (distance, decay, duration), strict=True):
            values = between(np.log(axis), values, float(np.log(np.clip(asked, axis[0], axis[-1]))))
        beyond = min(1.0, self.distance[-1] / distance) * min(1.0, duration / self.duration[0])
        return float(np.exp(values) * beyond)

    def range(self, duration: float) -> tuple[float, float]:
        """Return by what factors other systems' errors lay below and above the map's, in runs of *duration* transits."""
        low, high = (float(np.interp(np.log(duration), np.log(self.duration), side)) for side in self.spread.T)
        return low, high


def between(axis: FloatArray, values: FloatArray, asked: float) -> FloatArray:
    """Return what lies between the values at the nodes of their first axis, linearly."""
    after = int(np.clip(np.searchsorted(axis, asked), 1, axis.size - 1))
    share = (asked - axis[after - 1]) / (axis[after] - axis[after - 1])
    return np.asarray((1.0 - share) * values[after - 1] + share * values[after])


def slice_map() -> SliceMap:
    """Return the map that is part of the package."""
    return _stored()


@cache
def _stored() -> SliceMap:
    return from_table(json.loads(files("coaxshell.solver").joinpath(DATA).read_text(encoding="utf-8")))


def from_table(table: dict[str, Any]) -> SliceMap:
    """Return the map that a table of lists holds; null is NaN."""
    axes = [np.array(table[name], dtype=np.float64) for name in AXES]
    arrays = [np.array(table[name], dtype=np.float64) for name in (*ARRAYS, "spread")]
    return SliceMap(*axes, *arrays)


@dataclass(frozen=True)
class SliceError:
    """Hold the estimated error of the stress in a run of two dimensions, relative (L2), and the range of it as systems differ."""

    value: float
    low: float
    high: float


def slice_error(problem: Problem, duration: float) -> SliceError:
    """Return the estimated error of a run in two dimensions, by the spherical source that is worst.

    0 in three dimensions, without spherical sources, and where no wall is elastic.

    Parameters
    ----------
    problem : Problem
    duration : float
        Transits.
    """
    system, worst = problem.system, SliceError(0.0, 0.0, 0.0)
    if problem.dimensions == 3 or not any(isinstance(shell, Shell) for shell in system.shells):
        return worst
    for source in system.sources:
        lasting = duration - source.delay / problem.scales.time
        distance = system.source_distance(source)
        if source.geometry != "spherical" or distance is None or lasting <= 0.0:
            continue
        value = slice_map().estimate(distance / system.reference_radius, equivalent_decay(source.pulse) / problem.scales.time, lasting)
        if value > worst.value:
            low, high = slice_map().range(lasting)
            worst = SliceError(value, low * value, high * value)
    return worst


def equivalent_decay(pulse: Pulse) -> float:
    """Return the decay time (s) of the exponential with a pulse's peak and energy, 2 int p^2 dt/peak^2; infinite for a step."""
    match pulse:
        case Exponential():
            return pulse.decay_time
        case Gaussian():
            return 2.0 * float(np.sqrt(np.pi)) * pulse.width
        case Sampled():
            times, values = pulse.curve
            return 2.0 * float(np.trapezoid(values**2, times)) / pulse.peak**2 if pulse.peak > 0 else float("inf")
        case _:
            return float("inf")
