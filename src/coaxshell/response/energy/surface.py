"""The pressure on the outermost surface, taken apart: incident, rigidly scattered and radiated, at all orders and Laplace nodes."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from coaxshell.acoustics.bessel_ratios import ComplexArray
from coaxshell.acoustics.laplace_grid import LaplaceGrid
from coaxshell.acoustics.operators import RadialFunctions, all_orders
from coaxshell.solver.excitation import SurfaceLoads, needs_sine_half
from coaxshell.solver.recompute import SolvedSpectra
from coaxshell.solver.scaling import Problem


class SurfacePressures(NamedTuple):
    """Transforms of the modal pressures on the outermost surface; incident and scattered may lack a sine half that is zero.

    Attributes
    ----------
    incident, scattered : ndarray, shape (1 or 2, M + 1, nodes)
        Of the undisturbed wave, and of the wave that a rigid cylinder would add.
    radiated : ndarray, shape (halves, M + 1, nodes)
        Of the surface's own motion.
    """

    incident: ComplexArray
    scattered: ComplexArray
    radiated: ComplexArray


def surface_pressures(spectra: SolvedSpectra) -> SurfacePressures:
    """Return the three parts of the pressure on the outermost surface of a finished run."""
    orders, s = all_orders(spectra.max_order), spectra.grid.nodes
    surface = RadialFunctions(s, 1.0, orders)
    incident, scattered = source_pressures(spectra.problem, spectra.grid, surface)
    return SurfacePressures(incident, scattered, surface.exterior * s**2 * spectra.normal[-1])


class _Silent(RadialFunctions):
    """A surface whose exterior fluid bears no pressure."""

    @cached_property
    def exterior(self) -> ComplexArray:
        """Zero."""
        return np.zeros((self.orders.size, self.kappa.size), np.complex128)


def source_pressures(problem: Problem, grid: LaplaceGrid, surface: RadialFunctions) -> tuple[ComplexArray, ComplexArray]:
    """Return the transforms of the sources' own and of their rigidly scattered pressure at r = 1, each (1 or 2, M + 1, nodes).

    With E = K_m/(k K_m') and D = I_m/(k I_m') at r = 1 and g the incident wave's slope dp/dr there, the load is p_0 - E g. Plane and
    line waves solve the wave equation and are regular within r = 1, so p_0 = D g: the load's share D/(D - E). The spherical
    wave does not; its load is p_0 where the exterior bears no pressure, E = 0.
    """
    sources, everywhere = problem.system.sources, slice(None)
    halves = 2 if needs_sine_half(sources) else 1
    incident, scattered = np.zeros((2, halves, surface.orders.size, surface.kappa.size), np.complex128)
    share = surface.disc / (surface.disc - surface.exterior)
    silent = _Silent(surface.kappa, surface.radius, surface.orders)
    for spherical in (True, False):
        group = tuple(source for source in sources if (source.geometry == "spherical") is spherical)
        if not group:
            continue
        waves = SurfaceLoads(replace(problem, system=problem.system.replace(source=group)), grid, surface.orders)
        own = waves(silent, everywhere) if spherical else None
        for half, load in enumerate(waves(surface, everywhere)):
            free = own[half] if own is not None else load * share
            incident[half] += free
            scattered[half] += load - free
    return incident, scattered
