"""The incident wave alone at r = 1, per unit pulse: its modal pressure, and its slope, minus the source of the rigidly scattered wave."""

from __future__ import annotations

from coaxshell.acoustics.incident import IncidentWave, SphericalGeometry
from coaxshell.acoustics.operators import RadialFunctions
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid


def incident_parts(
    wave: IncidentWave, grid: LaplaceGrid, orders: FloatArray, surface: RadialFunctions
) -> tuple[ComplexArray, ComplexArray]:
    """Return the modal pressure P0 and slope dp0/dr at r = 1 of a unit pulse at all nodes of a grid, each (orders, nodes).

    A wave regular inside r = 1 has P0 = D dp0/dr with D = I_m/(s I_m') at s, and its load is L = P0 - E dp0/dr with
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
        pressure, acceleration = wave.projections(grid, orders)
        return pressure, -acceleration
    slope = wave.prepare(grid, orders)(surface, slice(0, grid.nodes.size)) / (surface.disc - surface.exterior)
    return surface.disc * slope, slope
