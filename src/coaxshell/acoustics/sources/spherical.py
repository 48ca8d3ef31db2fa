"""The paper's wave, a slice through a spherical one (Eq. 2).

With R the distance from the source, S = R0 - b, b the radius on which the head point lies, x = t - (R - S) the time since the front and F
the integral of the pulse f,

    p = (S/R) f(x),        v = (S/R) [f(x) + F(x)/R] away from the source (afterflow).

It solves no two-dimensional wave equation, so it is projected on the orders rather than expanded, and has no axial wavenumber.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coaxshell.acoustics.basis import Modes, RadialBasis
from coaxshell.acoustics.rays import path_to, surface_rays
from coaxshell.acoustics.sources.source import NEAREST, SurfaceLoad, TimeFunction, rays
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.fourier_sums import exponential_sums
from coaxshell.numerics.laplace_grid import Nodes


@dataclass(frozen=True)
class SphericalGeometry:
    """A slice through a spherical wave, (S/R) e^{-s(R - S)} with R the distance from the source."""

    distance: float
    head: float = 1.0
    along_rays = True

    def prepare(self, grid: Nodes, modes: Modes) -> SurfaceLoad:
        """Return the modal pressure plus rigid scattering of the modal velocity, from :meth:`projections`."""
        pressure, acceleration = self.projections(grid, modes)

        def load(basis: RadialBasis, nodes: slice) -> ComplexArray:
            return pressure[:, nodes] + acceleration[:, nodes] * basis(1.0, self.head).exterior

        return load

    def incident(self, grid: Nodes, basis: RadialBasis) -> tuple[ComplexArray, ComplexArray]:
        """Return the modal pressure and slope at r = b of a unit pulse."""
        pressure, acceleration = self.projections(grid, basis.modes)
        return pressure, -acceleration

    def free_spectrum(self, s: ComplexArray, x: FloatArray, y: FloatArray) -> ComplexArray:
        """Return (S/R) e^{-s(R - S)} at points, shape (points, nodes)."""
        range_, _ = rays(self.distance, x, y)
        spread = (self.distance - self.head) / range_
        return np.asarray(spread[:, None] * np.exp(-np.multiply.outer(path_to(self.distance, x, y, NEAREST, self.head), s)))

    def free_field(self, pulse: TimeFunction, x: FloatArray, y: FloatArray, latest: float) -> SphericalField:
        """Return the wave at points."""
        return SphericalField(pulse, self.distance, x, y, self.head)

    def projections(self, grid: Nodes, modes: Modes) -> tuple[ComplexArray, ComplexArray]:
        """Return the modal pressure and radial acceleration s v0 at r = b of a unit pulse, each (orders, nodes).

        v0 = (S/R) dR/dr [1 + 1/(sR)] e^{-s(R - S)}, of which the second term is the afterflow. The projections
        (1/(beta pi)) * integral of (...) cos(m theta) are taken by the trapezoidal rule in theta, exact to rounding once it
        resolves the highest frequency because the integrand is periodic and band limited: its bandwidth is
        |s| max|dR/dtheta| + m = |s| b + M.
        """
        points = int(1.05 * (grid.nyquist * self.head + float(modes.max_order))) + 64
        theta = np.pi * (np.arange(points) + 0.5) / points
        rays = surface_rays(theta, self.distance, self.head)
        amplitude = rays.spread / points
        cosines = np.cos(theta[:, None] * modes.orders) * modes.neumann.T
        shapes = np.stack([amplitude, amplitude * rays.slope, amplitude * rays.slope * rays.curvature], axis=1)
        weights = (shapes[:, :, None] * cosines[:, None, :]).reshape(points, -1)
        sums = exponential_sums(rays.path, weights, grid)
        pressure, front, afterflow = sums.reshape(3, modes.count, -1)
        return pressure, self.acceleration(front, afterflow, grid.nodes)

    def acceleration(self, front: ComplexArray, afterflow: ComplexArray, s: ComplexArray) -> ComplexArray:
        """Return s v0 from the projections of (S/R) dR/dr e^{-s(R - S)} and of the same over R."""
        return front * s + afterflow


class SphericalField:
    """The paper's wave, a slice through a spherical one (Eq. 2)."""

    def __init__(self, pulse: TimeFunction, distance: float, x: FloatArray, y: FloatArray, head: float = 1.0) -> None:
        self._pulse = pulse
        self._range, self._ray = rays(distance, x, y)
        self._path, self._spread = path_to(distance, x, y, NEAREST, head), (distance - head) / self._range

    def pressure(self, time: float) -> FloatArray:
        """Return (S/R) f(x)."""
        return self._spread * self._pulse.history(time - self._path)

    def velocity(self, time: float) -> tuple[FloatArray, FloatArray]:
        """Return (S/R) [f(x) + F(x)/R] along the ray from the source."""
        since = time - self._path
        speed = self._spread * (self._pulse.history(since) + self._pulse.impulse(since) / self._range)
        return speed * self._ray[0], speed * self._ray[1]
