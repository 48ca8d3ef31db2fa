"""The surfaces of walls on which links act, in one wave along the axis: what sources and forces move there.

Thin walls answer at their reference surface, walls of elastic solids at the faces that look at a gap
(:attr:`coaxshell.solver.scaling.Problem.surfaces`).
"""

from __future__ import annotations

import numpy as np

from coaxshell.numerics.arrays import ComplexArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.modes import Modes
from coaxshell.solver.axial.faced import FacedWave
from coaxshell.solver.axial.families import Family
from coaxshell.solver.axial.sums import normals_of
from coaxshell.solver.cascade import FaceMotion
from coaxshell.solver.coupling import ModalSystem
from coaxshell.solver.scaling import Problem
from coaxshell.solver.shared_parts import SharedParts


class SurfaceWave:
    """All walls and fluids at some modes and Laplace nodes, read at the surfaces on which links act.

    Parameters
    ----------
    problem : Problem
    s : ndarray, shape (nodes,)
    modes : Modes
    fluids : SharedParts, optional
        Where the added masses of the fluids beside thin walls are found, or left for the next run.
    """

    def __init__(self, problem: Problem, s: ComplexArray, modes: Modes, fluids: SharedParts | None = None) -> None:
        self._problem, self.modes = problem, modes
        self._system = FacedWave(problem, s, modes, reads=False) if problem.two_faced else ModalSystem(problem, s, modes, shared=fluids)

    def under(self, family: Family, grid: LaplaceGrid, block: slice) -> list[list[ComplexArray]]:
        """Return the displacement of every surface, (orders, nodes), under the loads of a family, for each parity around."""
        if isinstance(self._system, FacedWave):
            return [self._read(faces) for faces in self._system.faces(family, grid, block)]
        return normals_of(self._problem, self._system, family, grid, block)

    def under_pressure(self, surface: int) -> list[ComplexArray]:
        """Return the displacement of every surface, (orders, nodes), per modal pressure on one of them, by its number."""
        if isinstance(self._system, FacedWave):
            return self._read(self._system.under_pressure(surface, 1.0))
        return self._system.solve(surface, 1.0)

    @property
    def compliance(self) -> ComplexArray:
        """C_ij, displacement of surface i per modal pressure on surface j, shape (surfaces, surfaces, orders, nodes)."""
        return np.stack([np.stack(self.under_pressure(j)) for j in range(len(self._problem.surfaces))], axis=1)

    def _read(self, faces: list[FaceMotion]) -> list[ComplexArray]:
        return [faces[one.shell].inner if one.side == 0 else faces[one.shell].outer for one in self._problem.surfaces]
