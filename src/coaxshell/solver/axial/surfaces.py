"""The surfaces of walls on which links act, in one wave along the axis: what sources and forces move there.

Thin walls answer at their reference surface, walls of elastic solids at the faces that look at a gap
(:attr:`coaxshell.solver.scaling.Problem.surfaces`).
"""

from __future__ import annotations

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.modes import Modes
from coaxshell.solver.axial.faced import FacedWave
from coaxshell.solver.axial.families import Family
from coaxshell.solver.axial.normals import normals_of
from coaxshell.solver.axial.tied_faces import TiedFaces
from coaxshell.solver.axial.tied_wave import TiedWave, motion_parities
from coaxshell.solver.cascade import FaceMotion
from coaxshell.solver.coupling import ModalSystem
from coaxshell.solver.scaling import Problem
from coaxshell.solver.shared_parts import SharedParts


class SurfaceWave:
    """All walls and fluids at some modes and Laplace nodes, read at the surfaces on which links act, with all feedback.

    Parameters
    ----------
    problem : Problem
    s : ndarray, shape (nodes,)
    modes : Modes
    fluids : SharedParts, optional
        Where the added masses of the fluids beside thin walls are found, or left for the next run.
    parities : int
        How many forces may have around the circle, at most, where electrodes are cut.
    """

    def __init__(self, problem: Problem, s: ComplexArray, modes: Modes, fluids: SharedParts | None = None, parities: int = 1) -> None:
        self._problem, self.modes = problem, modes
        parities = max(parities, motion_parities(problem))
        self._loops: TiedWave | TiedFaces | None = None
        self._unit_faces: dict[int, list[FaceMotion]] = {}
        self._units: dict[int, list[ComplexArray]] = {}
        if problem.two_faced:
            self._system: FacedWave | ModalSystem = FacedWave(problem, s, modes, reads=False)
            if problem.tied:
                self._loops = TiedFaces(self._system, parities)
        elif problem.tied:
            self._loops = TiedWave(problem, s, modes, parities)
            self._system = self._loops.bare
        else:
            self._system = ModalSystem(problem, s, modes, shared=fluids)

    def under(self, family: Family, grid: LaplaceGrid, block: slice) -> list[list[ComplexArray]]:
        """Return the displacement of every surface, (orders, nodes), under the loads of a family, for each parity around."""
        if isinstance(self._system, FacedWave):
            return [self._read(faces) for faces in self._closed_faces(self._system.faces(family, grid, block))]
        return self._closed(normals_of(self._problem, self._system, family, grid, block))

    def under_pressure(self, surface: int) -> list[ComplexArray]:
        """Return the displacement of every surface, (orders, nodes), per modal pressure on one of them, by its number.

        Where electrodes are cut orders move each other, and no order has such an answer of its own.
        """
        if isinstance(self._system, FacedWave):
            return self._read(self._closed_faces([self._system.under_pressure(surface, 1.0)])[0])
        return self._closed([self._system.solve(surface, 1.0)])[0]

    def under_forces(self, surface: int, pressures: FloatArray) -> list[list[ComplexArray]]:
        """Return the displacement of every surface, (orders, nodes), for each parity around, under pressures on one of them.

        ``pressures`` are those of all orders together, the same at all nodes, (parities, orders): what one force is in orders.
        """
        columns = pressures[:, :, None]
        if isinstance(self._system, FacedWave):
            if surface not in self._unit_faces:
                self._unit_faces[surface] = self._system.under_pressure(surface, 1.0)
            unit = self._unit_faces[surface]
            free = [[FaceMotion(*(each * x for x in moving)) for moving in unit] for each in columns]
            return [self._read(faces) for faces in self._closed_faces(free)]
        if surface not in self._units:
            self._units[surface] = self._system.solve(surface, 1.0)
        return self._closed([[each * w for w in self._units[surface]] for each in columns])

    @property
    def compliance(self) -> ComplexArray:
        """C_ij, displacement of surface i per modal pressure on surface j, shape (surfaces, surfaces, orders, nodes)."""
        return np.stack([np.stack(self.under_pressure(j)) for j in range(len(self._problem.surfaces))], axis=1)

    def _closed(self, normal: list[list[ComplexArray]]) -> list[list[ComplexArray]]:
        """Return W of all shells with feedback that ties walls or orders, for each parity around."""
        if not isinstance(self._loops, TiedWave):
            return normal
        moved = self._loops.driven(np.stack([np.stack(each) for each in normal], axis=1)).normal
        return [list(each) for each in np.moveaxis(moved, 1, 0)]

    def _closed_faces(self, free: list[list[FaceMotion]]) -> list[list[FaceMotion]]:
        return self._loops.closed(free).faces if isinstance(self._loops, TiedFaces) else free

    def _read(self, faces: list[FaceMotion]) -> list[ComplexArray]:
        return [faces[one.shell].inner if one.side == 0 else faces[one.shell].outer for one in self._problem.surfaces]
