"""The incident waves of a three-dimensional run at points in space, exact."""

from __future__ import annotations

from typing import cast

import numpy as np

from coaxshell.acoustics.sources import SpatialField, SpatialGeometry
from coaxshell.model.sources import Source
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.response.fields.incident import time_function
from coaxshell.solver.axial.families import axial_position
from coaxshell.solver.scaling import Problem


class SpatialIncident:
    """All incident waves at points (x, y, z), in units of a; pressures in rho_e c_e^2, velocities in c_e.

    Parameters
    ----------
    problem : Problem
        Of three dimensions.
    x, y, z : ndarray, shape (points,)
    latest : float
        The last instant that will be asked for.
    smooth : LaplaceGrid, optional
        The band of a scattered field whose fronts those of the pressure are to match; sharp if None.
    """

    def __init__(
        self, problem: Problem, x: FloatArray, y: FloatArray, z: FloatArray, latest: float, smooth: LaplaceGrid | None = None
    ) -> None:
        self._size = x.size
        self._waves = [self._wave(problem, i, source, (x, y, z), latest, smooth) for i, source in enumerate(problem.emitters) if x.size]

    @staticmethod
    def _wave(
        problem: Problem,
        number: int,
        source: Source,
        place: tuple[FloatArray, FloatArray, FloatArray],
        latest: float,
        smooth: LaplaceGrid | None,
    ) -> tuple[SpatialField, tuple[float, float], float]:
        x, y, z = place
        cos, sin = float(np.cos(np.radians(source.angle))), float(np.sin(np.radians(source.angle)))
        geometry = cast("SpatialGeometry", problem.sources[number])  # all of three dimensions are
        from_source = z - axial_position(source) / problem.scales.length
        pulse = time_function(problem, source, smooth)
        field = geometry.spatial_field(pulse, cos * x + sin * y, cos * y - sin * x, from_source, latest)
        return field, (cos, sin), source.delay / problem.scales.time

    def pressure(self, time: float) -> FloatArray:
        """Return the pressure at an instant, shape (points,)."""
        total = np.zeros(self._size)
        for field, _, delay in self._waves:
            total += field.pressure(time - delay)
        return total

    def velocity(self, time: float) -> FloatArray:
        """Return the particle velocity along x, y and z at an instant, shape (3, points)."""
        total = np.zeros((3, self._size))
        for field, (cos, sin), delay in self._waves:
            along, across, axial = field.velocity(time - delay)
            total[0] += cos * along - sin * across
            total[1] += sin * along + cos * across
            total[2] += axial
        return total
