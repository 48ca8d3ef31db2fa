"""Incident waves in free field, exact in space and time: pressure and particle velocity at any points and instants.

The partner of ``incident``: there a wave is projected on circumferential orders at r = 1, here it is evaluated where it is. With
f the pulse, F its integral, R the distance from the source and x = t - (R - S) the time since the front (all dimensionless),

    plane       p = f(x),                 v = f(x) along the direction of travel, x = t - (1 - r cos theta),
    spherical   p = (S/R) f(x),           v = (S/R) [f(x) + F(x)/R] away from the source (afterflow),
    line        p = sqrt(S/R) [f + q_0],  v = sqrt(S/R) [f + q_1] away from the source,

where q_n is the wake of a line source, q_n^ = f^ [sqrt(R/S) K_n(sR) e^{sR}/(K_0(sS) e^{sS}) - 1], continuous at the front.
Velocities are in units of c_e, pressures in rho_e c_e^2.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from coaxshell.acoustics.rays import path_to
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.bessel_ratios import kve
from coaxshell.numerics.laplace_grid import LaplaceGrid

NEAREST = 1e-3
"""Least distance from a source at which it is evaluated; nearer points get the value there: fields stay finite."""

_WAKE_STEP = 1e-3
_WAKE_RADII = 24


@dataclass(frozen=True, eq=False)
class TimeFunction:
    """A pulse in dimensionless form: its history, its integral from 0, both zero before 0, and its transform."""

    history: Callable[[FloatArray], FloatArray]
    impulse: Callable[[FloatArray], FloatArray]
    transform: Callable[[ComplexArray], ComplexArray]


class FreeField(Protocol):
    """An incident wave at points: the source lies on the positive x axis, its front reaches x = 1, y = 0 at t = 0."""

    def pressure(self, time: float) -> FloatArray:
        """Return the pressure at all points at an instant."""
        ...

    def velocity(self, time: float) -> tuple[FloatArray, FloatArray]:
        """Return the particle velocity along x and y at all points at an instant."""
        ...


class PlaneField:
    """A plane wave travelling towards -x."""

    def __init__(self, pulse: TimeFunction, x: FloatArray, y: FloatArray) -> None:
        self._pulse, self._path = pulse, 1.0 - x

    def pressure(self, time: float) -> FloatArray:
        """Return f(t - (1 - x))."""
        return self._pulse.history(time - self._path)

    def velocity(self, time: float) -> tuple[FloatArray, FloatArray]:
        """Return -f(t - (1 - x)) and 0."""
        along = self.pressure(time)
        return -along, np.zeros_like(along)


class SphericalField:
    """The paper's wave, a slice through a spherical one (Eq. 2)."""

    def __init__(self, pulse: TimeFunction, distance: float, x: FloatArray, y: FloatArray) -> None:
        self._pulse = pulse
        self._range, self._ray = _rays(distance, x, y)
        self._path, self._spread = path_to(distance, x, y, NEAREST), (distance - 1.0) / self._range

    def pressure(self, time: float) -> FloatArray:
        """Return (S/R) f(x)."""
        return self._spread * self._pulse.history(time - self._path)

    def velocity(self, time: float) -> tuple[FloatArray, FloatArray]:
        """Return (S/R) [f(x) + F(x)/R] along the ray from the source."""
        since = time - self._path
        speed = self._spread * (self._pulse.history(since) + self._pulse.impulse(since) / self._range)
        return speed * self._ray[0], speed * self._ray[1]


class LineField:
    """A true two-dimensional line source: the pulse itself with its front, plus a tabulated wake."""

    def __init__(self, pulse: TimeFunction, distance: float, x: FloatArray, y: FloatArray, latest: float) -> None:
        self._pulse, self._start = pulse, distance - 1.0
        self._range, self._ray = _rays(distance, x, y)
        self._path, self._spread = path_to(distance, x, y, NEAREST), np.sqrt(self._start / self._range)
        self._wakes: dict[int, Callable[[float, FloatArray], FloatArray]] = {}
        self._latest = latest

    def pressure(self, time: float) -> FloatArray:
        """Return sqrt(S/R) [f(x) + q_0(R, x)]."""
        return self._field(0, time)

    def velocity(self, time: float) -> tuple[FloatArray, FloatArray]:
        """Return sqrt(S/R) [f(x) + q_1(R, x)] along the ray from the source."""
        speed = self._field(1, time)
        return speed * self._ray[0], speed * self._ray[1]

    def _field(self, order: int, time: float) -> FloatArray:
        if order not in self._wakes:
            self._wakes[order] = self._tabulate(order)
        since = time - self._path
        wake = self._wakes[order](time, since)
        return self._spread * (self._pulse.history(since) + np.where(since > 0.0, wake, 0.0))

    def _tabulate(self, order: int) -> Callable[[float, FloatArray], FloatArray]:
        """Return q_n(R, x) as a function of the instant and x, R = S + t - x: at one instant a function of x alone.

        It is smooth in log R (Chebyshev points) and in x behind the front (a uniform table of its inverse transform).
        """
        near, far = float(self._range.min()), float(self._range.max()) * (1 + 1e-9)
        longest = max(self._latest - float(self._path.min()), 8 * _WAKE_STEP)
        grid = LaplaceGrid(_WAKE_STEP, int(np.ceil(longest / _WAKE_STEP)) + 8)
        phase = np.pi * (np.arange(_WAKE_RADII) + 0.5) / _WAKE_RADII
        points, weights = np.cos(phase), np.sin(phase) * (-1.0) ** np.arange(_WAKE_RADII)
        middle, half = 0.5 * np.log(near * far), max(0.5 * np.log(far / near), 1e-9)
        radii = np.exp(middle + half * points)
        spectrum = self._pulse.transform(grid.nodes)
        s, base = grid.nodes, kve(0, grid.nodes * self._start)
        wakes = np.stack([grid.invert(spectrum * (np.sqrt(r / self._start) * kve(order, s * r) / base - 1.0)) for r in radii])
        wakes[:, 0] = 0.0

        def wake(time: float, since: FloatArray) -> FloatArray:
            reached = np.clip(self._start + time - grid.time, near, far)
            offset = (np.log(reached) - middle)[None, :] / half - points[:, None]
            terms = weights[:, None] / np.where(np.abs(offset) < 1e-13, 1e-13, offset)
            profile = (terms * wakes).sum(axis=0) / terms.sum(axis=0)
            return np.asarray(np.interp(since, grid.time, profile), dtype=np.float64)

        return wake


def _rays(distance: float, x: FloatArray, y: FloatArray) -> tuple[FloatArray, tuple[FloatArray, FloatArray]]:
    """Return the distance of points from a source at (distance, 0) and the unit vector from the source to them."""
    along, across = x - distance, y
    range_ = np.hypot(along, across)
    clear = np.maximum(range_, NEAREST)
    return clear, (along / clear, across / clear)
