"""Incident waves: the modal load that a unit pulse puts on the outer surface r = 1, incident plus rigidly scattered.

Each geometry is normalised so that the free-field pressure at the head (r = 1, theta = 0) is the pulse itself, whose front
arrives there at t = 0. In the Laplace domain the load of a pulse f is f(s) L_m(s); the rigid scattering cancels the
incident normal velocity, p_d = s B_m K_m(s)/(s K_m'(s)), B_m the modal radial velocity of the incident wave at r = 1.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from coaxshell.acoustics.operators import RadialFunctions
from coaxshell.acoustics.rays import surface_rays
from coaxshell.numerics import bessel_ratios as br
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.fourier_sums import exponential_sums
from coaxshell.numerics.laplace_grid import LaplaceGrid

SurfaceLoad = Callable[[RadialFunctions, slice], ComplexArray]
"""From the exterior fluid's radial functions at r = 1 and the slice of grid nodes they stand for to L_m(s), (orders, nodes)."""


class IncidentWave(Protocol):
    """A source geometry."""

    def prepare(self, grid: LaplaceGrid, orders: FloatArray) -> SurfaceLoad:
        """Return the load function for the given orders on a Laplace grid."""
        ...


@dataclass(frozen=True)
class PlaneGeometry:
    """Plane wave travelling towards theta = 180 degrees, e^{-s(1 - r cos theta)}."""

    def prepare(self, grid: LaplaceGrid, orders: FloatArray) -> SurfaceLoad:
        """Return L_m = -eps_m e^{-s}/(s K_m'(s)), from the Wronskian I_m K_m' - I_m' K_m = -1/s."""

        def load(surface: RadialFunctions, nodes: slice) -> ComplexArray:
            inverse_k = br.running_product(1.0 / br.kve(0, surface.kappa), 1.0 / surface.k_ratios)  # e^{-s}/K_m(s)
            return -neumann(orders) * surface.keep(inverse_k) * surface.exterior

        return load


@dataclass(frozen=True)
class LineGeometry:
    """True two-dimensional line source at distance R0, K_0(sR)/K_0(sS), S = R0 - 1: an exact solution of the wave equation."""

    distance: float

    def prepare(self, grid: LaplaceGrid, orders: FloatArray) -> SurfaceLoad:
        """Return L_m = -eps_m K_m(s R0)/(K_0(s S) s K_m'(s)), from Graf's addition theorem (DLMF 10.44.3)."""

        def load(surface: RadialFunctions, nodes: slice) -> ComplexArray:
            s, far = surface.kappa, surface.kappa * self.distance
            far_ratios = br.k_ratios(surface.max_order, far)
            order_zero = br.kve(0, far) / (br.kve(0, s) * br.kve(0, s * (self.distance - 1.0)))  # exponentials cancel: R0 = 1 + S
            across = br.running_product(order_zero, far_ratios / surface.k_ratios)
            return -neumann(orders) * surface.keep(across) * surface.exterior

        return load


@dataclass(frozen=True)
class SphericalGeometry:
    """The paper's wave, a slice through a spherical one: (S/R) e^{-s(R - S)} with R the distance from the source (Eq. 2)."""

    distance: float

    def prepare(self, grid: LaplaceGrid, orders: FloatArray) -> SurfaceLoad:
        """Return the modal pressure plus rigid scattering of the modal velocity, from :meth:`projections`."""
        pressure, acceleration = self.projections(grid, orders)

        def load(surface: RadialFunctions, nodes: slice) -> ComplexArray:
            return pressure[:, nodes] + acceleration[:, nodes] * surface.exterior

        return load

    def projections(self, grid: LaplaceGrid, orders: FloatArray) -> tuple[ComplexArray, ComplexArray]:
        """Return the modal pressure and radial acceleration s v0 at r = 1 of a unit pulse, each (orders, nodes).

        v0 = (S/R) dR/dr [1 + 1/(sR)] e^{-s(R - S)}, of which the second term is the afterflow. The projections
        (1/(beta pi)) * integral of (...) cos(m theta) are taken by the trapezoidal rule in theta, exact to rounding once it
        resolves the highest frequency because the integrand is periodic and band limited: its bandwidth is
        |s| max|dR/dtheta| + m = |s| + M.
        """
        points = int(1.05 * (grid.nyquist + float(orders[-1]))) + 64
        theta = np.pi * (np.arange(points) + 0.5) / points
        rays = surface_rays(theta, self.distance)
        amplitude = rays.spread / points
        cosines = np.cos(theta[:, None] * orders) * neumann(orders).T
        shapes = np.stack([amplitude, amplitude * rays.slope, amplitude * rays.slope * rays.curvature], axis=1)
        weights = (shapes[:, :, None] * cosines[:, None, :]).reshape(points, -1)
        sums = exponential_sums(rays.path, weights, grid)
        pressure, front, afterflow = sums.reshape(3, orders.size, -1)
        return pressure, self.acceleration(front, afterflow, grid.nodes)

    def acceleration(self, front: ComplexArray, afterflow: ComplexArray, s: ComplexArray) -> ComplexArray:
        """Return s v0 from the projections of (S/R) dR/dr e^{-s(R - S)} and of the same over R."""
        return front * s + afterflow


def neumann(orders: FloatArray) -> FloatArray:
    """Return Neumann's factor as a column: 1 for order 0, else 2."""
    return np.where(orders == 0, 1.0, 2.0)[:, None]
