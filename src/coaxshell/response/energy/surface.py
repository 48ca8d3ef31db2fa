"""The pressure on the outermost surface, taken apart: incident, rigidly scattered and radiated, at all orders and Laplace nodes."""

from __future__ import annotations

from typing import NamedTuple

from coaxshell.acoustics.operators import RadialFunctions, all_orders
from coaxshell.numerics.arrays import ComplexArray
from coaxshell.solver.excitation import incident_on_surface
from coaxshell.solver.recompute import SolvedSpectra


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
    incident, slope = incident_on_surface(spectra.problem, spectra.grid, surface)
    return SurfacePressures(incident, -surface.exterior * slope, surface.exterior * s**2 * spectra.normal[-1])
