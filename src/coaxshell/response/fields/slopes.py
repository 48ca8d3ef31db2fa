"""What drives the field of a region: the transforms of the modal slope dp/dr at its walls.

A wall that moves inward by w makes (rho/rho_e) s^2 W; the rigidly scattered wave makes minus the slope of the incident one at the
outermost shell. Everything else about a region is its transfer.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coaxshell.acoustics.laplace_grid import LaplaceGrid
from coaxshell.acoustics.operators import RadialFunctions, all_orders
from coaxshell.numerics.arrays import ComplexArray
from coaxshell.response.fields.regions import Region
from coaxshell.solver.excitation import incident_on_surface
from coaxshell.solver.recompute import SolvedSpectra

SCATTERED = {"radiated": ("radiated",), "diffracted": ("diffracted",), "scattered": ("radiated", "diffracted")}
SCATTERED["total"] = SCATTERED["scattered"]


@dataclass(frozen=True)
class WallSlopes:
    """Modal slopes at the inner and the outer wall of a region, each (halves, M + 1, nodes) or None where nothing drives it."""

    inner: ComplexArray | None
    outer: ComplexArray | None


def wall_slopes(spectra: SolvedSpectra, grid: LaplaceGrid, region: Region, part: str) -> WallSlopes | None:
    """Return the slopes that make a part of the scattered field in a region; None if that part vanishes there."""
    parts = SCATTERED.get(part, ())
    if region.fluid is None or not parts or (parts == ("diffracted",) and not region.exterior):
        return None
    nodes = grid.nodes
    problem, orders = spectra.problem, all_orders(spectra.max_order)
    acceleration = region.fluid.density * nodes * nodes

    def radial(slowness: float, radius: float) -> RadialFunctions:
        return RadialFunctions(slowness * nodes, radius, orders)

    def radiated(shell: int) -> ComplexArray:
        motion = spectra.normal[shell, ..., : nodes.size] * acceleration
        return np.asarray(motion * problem.ingredients.felt_motion(problem, region.index, shell, radial))

    inner: ComplexArray | None = None
    outer: ComplexArray | None = None
    if "radiated" in parts:
        if region.index > 0:
            inner = radiated(region.index - 1)
        if not region.exterior:
            outer = radiated(region.index)
    if "diffracted" in parts and region.exterior:
        rigid = -incident_on_surface(problem, grid, radial(1.0, 1.0))[1]
        inner = rigid if inner is None else _sum_of_halves(inner, rigid)
    return WallSlopes(inner, outer)


def _sum_of_halves(one: ComplexArray, other: ComplexArray) -> ComplexArray:
    """Return the sum of two modal arrays of which either may lack the sine half."""
    large, small = (one, other) if one.shape[0] >= other.shape[0] else (other, one)
    result = large.copy()
    result[: small.shape[0]] += small
    return result
