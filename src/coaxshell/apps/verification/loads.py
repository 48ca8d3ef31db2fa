"""The pressure on a rigid cylinder, which is the modal load on a shell: incident plus rigidly scattered."""

from __future__ import annotations

from coaxshell.acoustics.basis import Modes, RadialBasis
from coaxshell.apps.verification.systems import WATER
from coaxshell.model.fluids import VACUUM
from coaxshell.model.shells import RigidShell
from coaxshell.model.sources import Source
from coaxshell.model.system import System
from coaxshell.numerics.arrays import ComplexArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.excitation import SurfaceLoads
from coaxshell.solver.scaling import dimensionless


def surface_pressure(source: Source, grid: LaplaceGrid, modes: int, unit: float) -> ComplexArray:
    """Return the modal pressure on a rigid cylinder of 1 m in water, in units of ``unit`` (Pa), shape (modes + 1, nodes)."""
    problem = dimensionless(System(shells=[RigidShell(radius=1.0)], fluids=[VACUUM, WATER], source=source))
    basis = RadialBasis(Modes.up_to(modes), grid.nodes)
    load = SurfaceLoads(problem, grid, basis.modes)(basis, slice(None))
    return load[0] * (problem.scales.pressure / unit)
