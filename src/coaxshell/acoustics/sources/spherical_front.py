"""The true spherical source of three-dimensional runs, exact in space and time: one amplitude for each axial wavenumber k.

With R the distance from it, S = R0 - b, b the radius of the surface on which the head point lies, and x = t - (R - S) the time since the
front, p = (S/R) f(x). Along z, D the distance in the
plane of the cross-section, it is made of

    integral of (e^{-sR}/R) e^{-ikz} dz = 2 K_0(kappa D),        K_0(kappa D) = sum_m eps_m I_m(kappa r) K_m(kappa R0) cos m theta,  r < R0.

Amplitudes F(k) here leave the 2 out: what a wave of wavenumbers k_j = 2 pi j/L gives at z is

    (2/L) [F(k_0) + 2 sum_{j>=1} F(k_j) cos k_j z].
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coaxshell.acoustics.basis import RadialBasis
from coaxshell.acoustics.sources.source import SurfaceLoad, TimeFunction, incident_of_regular
from coaxshell.acoustics.sources.spherical import SphericalField
from coaxshell.numerics import bessel_ratios as br
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import Nodes
from coaxshell.numerics.modes import Modes
from coaxshell.numerics.radial_functions import RadialFunctions


@dataclass(frozen=True)
class SphericalFrontGeometry:
    """A point source at distance R0 from the axis in the plane z = 0: an exact solution of the three-dimensional wave equation.

    Attributes
    ----------
    distance : float
        R0 > b, in units of a.
    head : float
        b, in units of a.
    """

    distance: float
    head: float = 1.0
    along_rays = False

    def prepare(self, grid: Nodes, modes: Modes) -> SurfaceLoad:
        """Return the amplitude of incident and rigidly scattered pressure at r = b, in units of a, per unit pressure at the head:

            P_m = S e^{sS} eps_m K_m(kappa R0)/(kappa b K_{m+1}(kappa b) - m K_m(kappa b)),

        from the addition theorem (DLMF 10.44.3) and the Wronskian I_m K_m' - I_m' K_m = -1/(kappa b).

        Re kappa >= Re s, so that e^{(s - kappa) S} and with it P_m are bounded for all s, k and m.
        """

        def load(basis: RadialBasis, nodes: slice) -> ComplexArray:
            surface, source = basis(1.0, self.head), basis.passing(1.0, self.distance)
            across = surface.keep(self._across(basis, surface, source))
            return -modes.neumann / self.head * across * surface.exterior

        return load

    def incident(self, grid: Nodes, basis: RadialBasis) -> tuple[ComplexArray, ComplexArray]:
        """Return the amplitudes at r = b of the pressure S e^{sS} eps_m I_m(kappa b) K_m(kappa R0) and of its slope, without scattering."""
        return incident_of_regular(self, grid, basis)

    def free_field(self, pulse: TimeFunction, x: FloatArray, y: FloatArray, latest: float) -> SphericalField:
        """Return the wave at points of the source's own plane z = 0."""
        return SphericalField(pulse, self.distance, x, y, self.head)

    def spatial_field(self, pulse: TimeFunction, x: FloatArray, y: FloatArray, z: FloatArray, latest: float) -> SpatialSphericalField:
        """Return the wave at points in space."""
        return SpatialSphericalField(pulse, self.distance, x, y, z, self.head)

    def _across(self, basis: RadialBasis, surface: RadialFunctions, source: RadialFunctions) -> ComplexArray:
        """Return S e^{sS} K_m(kappa R0)/K_m(kappa b) of all orders: e^{(s - kappa) S} of order 0, and ratios between orders.

        s - kappa = -k^2/(kappa + s), without the cancellation that a distant source would show.
        """
        start, ahead = self.distance - self.head, -(basis.modes.wavenumber**2) / (surface.kappa + basis.s)
        order_zero = br.kve(0, source.argument) / br.kve(0, surface.argument) * (start * np.exp(ahead * start))
        return br.running_product(order_zero, source.k_ratios / surface.k_ratios)


class SpatialSphericalField:
    """A spherical wave in space, alike in every plane through the x axis, on which its source lies.

    p = (S/R) f(x),        v = (S/R) [f(x) + F(x)/R] away from the source, F the integral of f.
    """

    def __init__(self, pulse: TimeFunction, distance: float, x: FloatArray, y: FloatArray, z: FloatArray, head: float = 1.0) -> None:
        off_axis = np.hypot(y, z)
        clear = np.where(off_axis > 0.0, off_axis, 1.0)
        self._plane, self._turn = SphericalField(pulse, distance, x, off_axis, head), (y / clear, z / clear)

    def pressure(self, time: float) -> FloatArray:
        """Return (S/R) f(x)."""
        return self._plane.pressure(time)

    def velocity(self, time: float) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return (S/R) [f(x) + F(x)/R] along the ray from the source."""
        along, off_axis = self._plane.velocity(time)
        return along, off_axis * self._turn[0], off_axis * self._turn[1]
