"""A plane wave travelling towards theta = 180 degrees, or inclined to the cross-section by alpha towards +z:

    p = f(x),    v = f(x) along the direction of travel,    x = t - [(b - r cos theta) cos alpha + z sin alpha],

b the radius of the surface on which the head point lies.

Its trace runs along z at 1/sin alpha. In the Laplace domain everything goes with e^{-s z sin alpha}, an axial wavenumber for each node,

    k = -i s sin alpha,        kappa = s cos alpha.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from coaxshell.acoustics.basis import Modes, RadialBasis
from coaxshell.acoustics.sources.source import SurfaceLoad, TimeFunction, incident_of_regular
from coaxshell.numerics import bessel_ratios as br
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import Nodes
from coaxshell.numerics.radial_functions import RadialFunctions


@dataclass(frozen=True)
class PlaneGeometry:
    """Plane wave, e^{-kappa(b - r cos theta)} in the plane z = 0.

    Attributes
    ----------
    inclination : float
        alpha, degrees by which its direction of travel leaves the cross-section towards +z, between -90 and 90. Its modes are then those
        of the wavenumber -i s sin alpha.
    head : float
        b, in units of a.
    """

    inclination: float = 0.0
    head: float = 1.0
    distance = None
    along_rays = True

    @property
    def trace_slowness(self) -> float:
        """Sin alpha, what its trace along z takes for a unit of length; negative towards -z."""
        return math.sin(math.radians(self.inclination))

    def prepare(self, grid: Nodes, modes: Modes) -> SurfaceLoad:
        """Return L_m = -eps_m e^{-kappa b}/(kappa b K_m'(kappa b)), from the Wronskian I_m K_m' - I_m' K_m = -1/(kappa b)."""

        def load(basis: RadialBasis, nodes: slice) -> ComplexArray:
            surface = basis(1.0, self.head)
            return -modes.neumann / self.head * _inverse_k(surface) * surface.exterior

        return load

    def incident(self, grid: Nodes, basis: RadialBasis) -> tuple[ComplexArray, ComplexArray]:
        """Return the modal pressure and slope at r = b of a unit pulse."""
        return incident_of_regular(self, grid, basis)

    def free_spectrum(self, s: ComplexArray, x: FloatArray, y: FloatArray) -> ComplexArray:
        """Return e^{-s (b - x) cos alpha} at points, shape (points, nodes)."""
        return np.exp(-np.multiply.outer((self.head - x) * math.cos(math.radians(self.inclination)), s))

    def free_field(self, pulse: TimeFunction, x: FloatArray, y: FloatArray, latest: float) -> PlaneField:
        """Return the wave at points of the plane z = 0."""
        return PlaneField(pulse, x, y, self.inclination, self.head)

    def spatial_field(self, pulse: TimeFunction, x: FloatArray, y: FloatArray, z: FloatArray, latest: float) -> SpatialPlaneField:
        """Return the wave at points in space."""
        return SpatialPlaneField(pulse, x, y, z, self.inclination, self.head)


def _inverse_k(surface: RadialFunctions) -> ComplexArray:
    """Return e^{-kappa b}/K_m(kappa b), shape (orders, nodes)."""
    if surface.sparse:
        return np.asarray(np.exp(-surface.k_sample.exponent) / surface.k_sample.mantissa, dtype=np.complex128)
    return surface.keep(br.running_product(1.0 / br.kve(0, surface.argument), 1.0 / surface.k_ratios))


class PlaneField:
    """A plane wave travelling towards -x, in the plane z = 0."""

    def __init__(self, pulse: TimeFunction, x: FloatArray, y: FloatArray, inclination: float = 0.0, head: float = 1.0) -> None:
        self._pulse, self._across = pulse, math.cos(math.radians(inclination))
        self._path = (head - x) * self._across

    def pressure(self, time: float) -> FloatArray:
        """Return f(t - (b - x) cos alpha)."""
        return self._pulse.history(time - self._path)

    def velocity(self, time: float) -> tuple[FloatArray, FloatArray]:
        """Return -cos alpha f(t - (b - x) cos alpha) and 0."""
        along = self._across * self.pressure(time)
        return -along, np.zeros_like(along)


class SpatialPlaneField:
    """A plane wave in space, which travels along (-cos alpha, 0, sin alpha)."""

    def __init__(
        self, pulse: TimeFunction, x: FloatArray, y: FloatArray, z: FloatArray, inclination: float = 0.0, head: float = 1.0
    ) -> None:
        self._pulse, self._ray = pulse, (-math.cos(math.radians(inclination)), math.sin(math.radians(inclination)))
        self._path = (head - x) * -self._ray[0] + z * self._ray[1] + 0.0 * y

    def pressure(self, time: float) -> FloatArray:
        """Return f(t - (b - x) cos alpha - z sin alpha)."""
        return self._pulse.history(time - self._path)

    def velocity(self, time: float) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return the pressure along the direction of travel."""
        along = self.pressure(time)
        return self._ray[0] * along, np.zeros_like(along), self._ray[1] * along
