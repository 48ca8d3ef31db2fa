"""A true two-dimensional line source, exact in space and time.

With R the distance from it, S = R0 - b, b the radius on which the head point lies, and x = t - (R - S) the time since the front,

    p = sqrt(S/R) [f + q_0],        v = sqrt(S/R) [f + q_1] away from the source,

q_n the wake, q_n^ = f^ [sqrt(R/S) K_n(sR) e^{sR}/(K_0(sS) e^{sS}) - 1], continuous at the front.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from coaxshell.acoustics.basis import Modes, RadialBasis
from coaxshell.acoustics.rays import path_to
from coaxshell.acoustics.sources.source import NEAREST, SurfaceLoad, TimeFunction, UniformField, incident_of_regular, rays
from coaxshell.numerics import bessel_ratios as br
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.bessel_ratios import kve
from coaxshell.numerics.laplace_grid import LaplaceGrid, Nodes
from coaxshell.numerics.radial_functions import RadialFunctions

_WAKE_STEP = 1e-3
_WAKE_RADII = 24


@dataclass(frozen=True)
class LineGeometry:
    """True two-dimensional line source at distance R0, K_0(kappa R)/K_0(kappa S): an exact solution of the wave equation.

    Attributes
    ----------
    distance, head : float
        R0 and b, in units of a.
    reference : float or None
        S, the distance at which the pressure is the pulse and its clock starts: the head's, R0 - b, for None. An image has its source's.
    """

    distance: float
    head: float = 1.0
    reference: float | None = None
    along_rays = False

    @property
    def start(self) -> float:
        """S."""
        return self.distance - self.head if self.reference is None else self.reference

    def prepare(self, grid: Nodes, modes: Modes) -> SurfaceLoad:
        """Return L_m = -eps_m K_m(kappa R0)/(K_0(kappa S) kappa b K_m'(kappa b)), from Graf's addition theorem (DLMF 10.44.3)."""

        def load(basis: RadialBasis, nodes: slice) -> ComplexArray:
            surface = basis(1.0, self.head)
            return -modes.neumann / self.head * self._across(surface) * surface.exterior

        return load

    def _across(self, surface: RadialFunctions) -> ComplexArray:
        """Return K_m(kappa R0)/(K_m(kappa b) K_0(kappa S)), shape (orders, nodes); exponentials cancel but for e^{-kappa (R0 - b - S)}."""
        far = RadialFunctions(surface.kappa, self.distance, surface.orders, surface.sparse)
        to_head = br.kve(0, surface.kappa * self.start)
        if self.reference is not None:
            to_head = to_head * np.exp(surface.kappa * (self.distance - self.head - self.reference))
        if surface.sparse:
            return far.k_sample.over(surface.k_sample) / to_head
        order_zero = br.kve(0, far.argument) / (br.kve(0, surface.argument) * to_head)
        return surface.keep(br.running_product(order_zero, far.k_ratios / surface.k_ratios))

    def incident(self, grid: Nodes, basis: RadialBasis) -> tuple[ComplexArray, ComplexArray]:
        """Return the modal pressure and slope at r = b of a unit pulse."""
        return incident_of_regular(self, grid, basis)

    def free_spectrum(self, s: ComplexArray, x: FloatArray, y: FloatArray) -> ComplexArray:
        """Return K_0(sR)/K_0(sS) at points, shape (points, nodes)."""
        range_, _ = rays(self.distance, x, y)
        path = np.exp(-np.multiply.outer(path_to(self.distance, x, y, NEAREST, self.head) + (self.distance - self.head - self.start), s))
        return np.asarray(kve(0, np.multiply.outer(range_, s)) / kve(0, s * self.start) * path)

    def free_field(self, pulse: TimeFunction, x: FloatArray, y: FloatArray, latest: float) -> LineField:
        """Return the wave at points up to an instant."""
        return LineField(pulse, self.distance, x, y, latest, self.head, self.reference)

    def spatial_field(self, pulse: TimeFunction, x: FloatArray, y: FloatArray, z: FloatArray, latest: float) -> UniformField:
        """Return the wave at points in space, alike at all z."""
        x, y, _ = np.broadcast_arrays(x, y, z)
        return UniformField(LineField(pulse, self.distance, x, y, latest, self.head, self.reference))


class LineField:
    """A true two-dimensional line source: the pulse itself with its front, plus a tabulated wake."""

    def __init__(
        self,
        pulse: TimeFunction,
        distance: float,
        x: FloatArray,
        y: FloatArray,
        latest: float,
        head: float = 1.0,
        reference: float | None = None,
    ) -> None:
        self._pulse, self._start = pulse, distance - head if reference is None else reference
        self._range, self._ray = rays(distance, x, y)
        self._path, self._spread = path_to(distance, x, y, NEAREST, head), np.sqrt(self._start / self._range)
        if reference is not None:
            self._path = self._path + (distance - head - reference)
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
