"""A plane wave travelling towards theta = 180 degrees: p = f(x), v = f(x) along the direction of travel, x = t - (1 - r cos theta)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coaxshell.acoustics.basis import Modes, RadialBasis
from coaxshell.acoustics.sources.source import SurfaceLoad, TimeFunction, incident_of_regular
from coaxshell.numerics import bessel_ratios as br
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid


@dataclass(frozen=True)
class PlaneGeometry:
    """Plane wave, e^{-kappa(1 - r cos theta)}."""

    distance = None
    along_rays = True

    def prepare(self, grid: LaplaceGrid, modes: Modes) -> SurfaceLoad:
        """Return L_m = -eps_m e^{-kappa}/(kappa K_m'(kappa)), from the Wronskian I_m K_m' - I_m' K_m = -1/kappa."""

        def load(basis: RadialBasis, nodes: slice) -> ComplexArray:
            surface = basis.surface
            inverse_k = br.running_product(1.0 / br.kve(0, surface.kappa), 1.0 / surface.k_ratios)  # e^{-kappa}/K_m(kappa)
            return -modes.neumann * surface.keep(inverse_k) * surface.exterior

        return load

    def incident(self, grid: LaplaceGrid, basis: RadialBasis) -> tuple[ComplexArray, ComplexArray]:
        """Return the modal pressure and slope at r = 1 of a unit pulse."""
        return incident_of_regular(self, grid, basis)

    def free_field(self, pulse: TimeFunction, x: FloatArray, y: FloatArray, latest: float) -> PlaneField:
        """Return the wave at points."""
        return PlaneField(pulse, x, y)


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
