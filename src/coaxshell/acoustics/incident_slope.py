"""The modal radial slope dp/dr of an incident wave at r = 1, per unit pulse: minus the source of the rigidly scattered wave."""

from __future__ import annotations

from coaxshell.acoustics.bessel_ratios import ComplexArray
from coaxshell.acoustics.incident import IncidentWave, SphericalGeometry
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
        return -wave.projections(grid, orders)[1]
    load = wave.prepare(grid, orders)(surface, slice(0, grid.nodes.size))
    return load / (surface.disc - surface.exterior)
