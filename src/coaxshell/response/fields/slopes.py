"""What drives the field of a region: the transforms of the modal slope dp/dr at its walls.

A wall that moves inward by w makes (rho/rho_e) s^2 W; the rigidly scattered wave makes minus the slope of the incident one at the
outermost shell. Everything else about a region is its transfer.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coaxshell.acoustics.bessel_ratios import ComplexArray
from coaxshell.acoustics.incident import IncidentWave
from coaxshell.acoustics.incident_slope import incident_slope
from coaxshell.acoustics.laplace_grid import LaplaceGrid
from coaxshell.acoustics.operators import RadialFunctions, all_orders
from coaxshell.model.sources import Source
from coaxshell.response.fields.regions import Region
from coaxshell.solver.excitation import incident_wave, needs_sine_half, projection, source_spectrum
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
        rigid = -incident_slopes(spectra, grid)
        inner = rigid if inner is None else _sum_of_halves(inner, rigid)
    return WallSlopes(inner, outer)


def incident_slopes(spectra: SolvedSpectra, grid: LaplaceGrid) -> ComplexArray:
    """Return the modal slope of all incident waves at r = 1, shape (halves, M + 1, nodes)."""
    problem, orders = spectra.problem, all_orders(spectra.max_order)
    surface = RadialFunctions(grid.nodes, 1.0, orders)
    groups: dict[IncidentWave, list[Source]] = {}
    for source in problem.system.sources:
        groups.setdefault(incident_wave(problem, source), []).append(source)
    halves = 2 if needs_sine_half(problem.system.sources) else 1
    total = np.zeros((halves, orders.size, grid.nodes.size), np.complex128)
    for wave, sources in groups.items():
        unit = incident_slope(wave, grid, orders, surface)
        for source in sources:
            history = source_spectrum(problem, source, grid.nodes)
            for half in range(halves):
                total[half] += unit * (projection(orders, source.angle, half) * history)
    return total


def _sum_of_halves(one: ComplexArray, other: ComplexArray) -> ComplexArray:
    """Return the sum of two modal arrays of which either may lack the sine half."""
    large, small = (one, other) if one.shape[0] >= other.shape[0] else (other, one)
    result = large.copy()
    result[: small.shape[0]] += small
    return result
