"""The incident waves of a system at points of its own frame, summed over its sources, their fronts as steep as the scattered ones."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from coaxshell.acoustics.pulse_histories import pulse_history, pulse_impulse
from coaxshell.acoustics.pulse_transforms import pulse_transform
from coaxshell.acoustics.sources import FreeField, SourceGeometry, TimeFunction
from coaxshell.model.sources import Source
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.response.fields.inversion import window
from coaxshell.solver.scaling import Problem

_REACH = 12
"""Time steps of the band on either side of a front within which its window is felt."""
_FINER = 32
"""Points of the table per time step of the band."""
_PERIOD = 64
"""Reaches in the table's period: so many that its contour lies as close to the imaginary axis as the field's own."""


def banded(pulse: TimeFunction, band: LaplaceGrid) -> Callable[[FloatArray], FloatArray]:
    """Return the pulse under the band's window near its front, tabulated; elsewhere as it is, where the window changes nothing.

    The transform of the pulse, delayed by the reach so that what rises before the front is kept, is inverted on a grid 32 times finer.
    """
    reach = _REACH * band.time_step
    fine = LaplaceGrid(band.time_step / _FINER, _PERIOD * _REACH * _FINER, 1e-8)
    cut = np.interp(fine.nodes.imag, band.nodes.imag, window(band), right=0.0)
    table = fine.invert(pulse.transform(fine.nodes) * np.exp(-fine.nodes * reach), cut)

    def history(t: FloatArray) -> FloatArray:
        result = pulse.history(t)
        near = np.abs(t) < reach
        result[near] = np.interp(t[near] + reach, fine.time, table)
        return result

    return history


class Incident:
    """All incident waves at points (x, y), in units of a; pressures in rho_e c_e^2, velocities in c_e.

    ``smooth`` is the band of a scattered field whose fronts those of the pressure are to match; sharp if None.
    """

    def __init__(self, problem: Problem, x: FloatArray, y: FloatArray, latest: float, smooth: LaplaceGrid | None = None) -> None:
        self._size = x.size
        sources = zip(problem.emitters, problem.sources, strict=True)
        self._waves = [_wave(problem, source, geometry, x, y, latest, smooth) for source, geometry in sources] if x.size else []

    def pressure(self, time: float) -> FloatArray:
        """Return the pressure at an instant, shape (points,)."""
        total = np.zeros(self._size)
        for field, _, delay in self._waves:
            total += field.pressure(time - delay)
        return total

    def velocity(self, time: float) -> FloatArray:
        """Return the particle velocity along x and y at an instant, shape (2, points)."""
        total = np.zeros((2, self._size))
        for field, (cos, sin), delay in self._waves:
            along, across = field.velocity(time - delay)
            total[0] += cos * along - sin * across
            total[1] += sin * along + cos * across
        return total


def _wave(
    problem: Problem, source: Source, geometry: SourceGeometry, x: FloatArray, y: FloatArray, latest: float, smooth: LaplaceGrid | None
) -> tuple[FreeField, tuple[float, float], float]:
    angle = np.radians(source.angle)
    cos, sin = float(np.cos(angle)), float(np.sin(angle))
    along, across = cos * x + sin * y, cos * y - sin * x
    wave = geometry.free_field(time_function(problem, source, smooth), along, across, latest)
    return wave, (cos, sin), source.delay / problem.scales.time


def time_function(problem: Problem, source: Source, smooth: LaplaceGrid | None) -> TimeFunction:
    """Return the pulse of a source in dimensionless form, under the window of a band near its front if one is given."""
    scales, pulse = problem.scales, source.pulse
    history = TimeFunction(
        lambda t: pulse_history(pulse, t, scales.time, scales.pressure),
        lambda t: pulse_impulse(pulse, t, scales.time, scales.pressure),
        lambda s: pulse_transform(pulse, s, scales.time, scales.pressure),
    )
    return history if smooth is None else replace(history, history=banded(history, smooth))
