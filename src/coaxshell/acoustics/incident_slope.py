"""The modal radial slope dp/dr of an incident wave at r = 1, per unit pulse: minus the source of the rigidly scattered wave."""

from __future__ import annotations

import numpy as np

from coaxshell.acoustics.bessel_ratios import ComplexArray
from coaxshell.acoustics.fourier_sums import exponential_sums
from coaxshell.acoustics.incident import IncidentWave, SphericalGeometry, neumann
from coaxshell.acoustics.laplace_grid import LaplaceGrid
from coaxshell.acoustics.operators import FloatArray, RadialFunctions


def incident_slope(wave: IncidentWave, grid: LaplaceGrid, orders: FloatArray, surface: RadialFunctions) -> ComplexArray:
    """Return the modal slope dp0/dr at r = 1 of a unit pulse at all nodes of a grid, shape (orders, nodes).

    A wave regular inside r = 1 has dp0/dr = P0/D with D = I_m/(s I_m') at s, and its load is L = P0 - E dp0/dr with
    E = K_m/(s K_m'), so dp0/dr = L/(D - E). The paper's spherical wave solves no two-dimensional wave equation and is projected.

    Parameters
    ----------
    wave : IncidentWave
    grid : LaplaceGrid
    orders : ndarray, shape (M,)
        All orders from 0.
    surface : RadialFunctions
        The exterior fluid's at r = 1 and the nodes of the grid.
    """
    if isinstance(wave, SphericalGeometry):
        return _spherical_slope(wave, grid, orders)
    load = wave.prepare(grid, orders)(surface, slice(0, grid.nodes.size))
    return load / (surface.disc - surface.exterior)


def _spherical_slope(wave: SphericalGeometry, grid: LaplaceGrid, orders: FloatArray) -> ComplexArray:
    """Project -s v0 = -(S/R) dR/dr [s + 1/R] e^{-s(R - S)} on cos(m theta) by the trapezoidal rule (see SphericalGeometry)."""
    points = int(1.05 * (grid.nyquist + float(orders[-1]))) + 64
    theta = np.pi * (np.arange(points) + 0.5) / points
    range_ = np.sqrt(1.0 + wave.distance**2 - 2.0 * wave.distance * np.cos(theta))
    amplitude = (wave.distance - 1.0) / range_ * (1.0 - wave.distance * np.cos(theta)) / range_ / points
    cosines = np.cos(theta[:, None] * orders) * neumann(orders).T
    weights = np.concatenate([amplitude[:, None] * cosines, (amplitude / range_)[:, None] * cosines], axis=1)
    front, afterflow = exponential_sums(range_ - (wave.distance - 1.0), weights, grid).reshape(2, orders.size, -1)
    return -(front * grid.nodes + afterflow)
