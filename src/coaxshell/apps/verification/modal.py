"""The package's answer mode by mode, at one axial wavenumber, under a true spherical wave: what is added up in three dimensions."""

from __future__ import annotations

import numpy as np

from coaxshell.acoustics.sources import SphericalFrontGeometry
from coaxshell.model.system import System
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.modes import Modes
from coaxshell.solver.coupling import ModalSystem
from coaxshell.solver.excitation import source_spectrum
from coaxshell.solver.scaling import dimensionless


def modal_spectra(system: System, grid: LaplaceGrid, modes: Modes) -> ComplexArray:
    """Return W, V and U of every shell at the nodes of a grid, shape (3, shells, orders, nodes), dimensionless.

    Parameters
    ----------
    system : System
        Under one point source on the axis theta = 0 in the plane z = 0.
    grid : LaplaceGrid
    modes : Modes
    """
    (source,), problem = system.sources, dimensionless(system)
    distance = system.source_distance(source)
    assert distance is not None
    modal = ModalSystem(problem, grid.nodes, modes)
    geometry = SphericalFrontGeometry(distance / problem.scales.length, problem.head)
    unit = geometry.prepare(grid, modes)(modal.radial, slice(0, grid.nodes.size))
    normal = modal.solve_outside(unit * source_spectrum(problem, source, grid.nodes))
    axial = [wall.axial * w if wall.axial is not None else 0 * w for wall, w in zip(modal.shells, normal, strict=True)]
    return np.array([normal, modal.tangential(normal), axial])


def modal_histories(system: System, grid: LaplaceGrid, modes: Modes) -> FloatArray:
    """Return W, V and U of every shell over time, shape (3, shells, orders, T), dimensionless; see :func:`modal_spectra`."""
    return grid.invert(modal_spectra(system, grid, modes))
