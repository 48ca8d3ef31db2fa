"""Walls whose faces move differently, in one wave along the axis: the cascade (:mod:`coaxshell.solver.cascade`) at a wavenumber.

Every wall is read where stations read it, its amplitudes in the order of :data:`READ`: W, V and U, and of an elastic wall the stresses at
its design depth, 0 of others, whose stresses are made of the motion and its derivatives along the axis.
"""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from coaxshell.acoustics.basis import Modes
from coaxshell.numerics.arrays import ComplexArray
from coaxshell.numerics.blas_threads import one_blas_thread
from coaxshell.numerics.laplace_grid import WORKERS, LaplaceGrid
from coaxshell.solver.axial.families import Family, WaveSet, outside_loads
from coaxshell.solver.cascade import CascadeSystem, FaceMotion
from coaxshell.solver.scaling import Problem
from coaxshell.structure.elastic_wall import ElasticWall
from coaxshell.structure.shell_model import SOLID_STRESSES, FaceReceptance, ShellModel, WallOperator

READ = ("w", "v", "u", *SOLID_STRESSES)
"""What a wall is read for, before the potentials of its piezoelectric layers."""


class FacedWave:
    """All walls and fluids at some modes and a block of Laplace nodes.

    Parameters
    ----------
    problem : Problem
    s : ndarray, shape (nodes,)
    modes : Modes
        Of a real wavenumber.
    reads : bool
        Whether elastic walls are read, or their faces alone.
    """

    def __init__(self, problem: Problem, s: ComplexArray, modes: Modes, *, reads: bool = True) -> None:
        self.problem, self.modes, self.s = problem, modes, s
        self._readings: list[ComplexArray | WallOperator] = []
        receptances = []
        for wall in problem.shells:
            if isinstance(wall, ElasticWall):
                receptance, reading = wall.station_port(modes, s, reads=reads)
                self._readings.append(reading)
            else:
                operator = wall.operator(modes, s)
                self._readings.append(operator)
                receptance = _alike(wall, operator) if wall.moves else wall.receptance(modes, s)
            receptances.append(receptance)
        self.cascade = CascadeSystem(problem, s, modes, walls=receptances)

    def faces(self, family: Family, grid: LaplaceGrid, block: slice) -> list[list[FaceMotion]]:
        """Return what the faces of all walls do under the sources or the forces of a family, for each parity around."""
        on_outermost = outside_loads(family, self.cascade.radial, grid, block)
        forces = {} if family.forces is None else family.forces.loads(self.problem, self.modes, odd=family.odd_forces)
        found = []
        for parity in range(family.parities):
            each = [self.cascade.solve_outside(on_outermost[parity])] if on_outermost else []
            each += [self.under_pressure(surface, pressures[parity]) for surface, pressures in forces.items()]
            found.append(each[0] if len(each) == 1 else [_together(moving) for moving in zip(*each, strict=True)])
        return found

    def under_pressure(self, surface: int, load: ComplexArray | float) -> list[FaceMotion]:
        """Return what the faces of all walls do under an inward pressure on one of the surfaces on which links act, by its number."""
        shell, side, _ = self.problem.surfaces[surface]
        return self.cascade.solve(shell, load, side)

    def read(self, faces: list[FaceMotion], layers: int) -> ComplexArray:
        """Return what all walls are read for, (9 + layers, shells, orders, nodes), from the motion of their faces and the loads on them."""
        found = np.zeros((len(READ) + layers, len(faces), *faces[0].outer.shape), np.complex128)
        for i, (reading, moving) in enumerate(zip(self._readings, faces, strict=True)):
            if isinstance(reading, WallOperator):
                self._read_thin(found[:, i], self.problem.shells[i], reading, moving.outer)
            else:
                count = min(len(reading), len(found))
                np.multiply(reading[:count, 0], moving.load_inner, out=found[:count, i])
                found[:count, i] += reading[:count, 1] * moving.load_outer
        return found

    def _read_thin(self, found: ComplexArray, wall: ShellModel, operator: WallOperator, w: ComplexArray) -> None:
        v = operator.tangential * w
        u = np.zeros_like(w) if operator.axial is None else operator.axial * w
        found[:3] = w, v, u
        for number, per in enumerate(wall.shown_voltages(self.modes, self.s)[: len(found) - len(READ)]):
            found[len(READ) + number] = per.v * v + per.w * w + (0.0 if per.u is None else per.u * u)


def _together(moving: tuple[FaceMotion, ...]) -> FaceMotion:
    """Return the sum of several motions of one wall."""
    return FaceMotion(*(np.sum(parts, axis=0) for parts in zip(*moving, strict=True)))


def _alike(wall: ShellModel, operator: WallOperator) -> FaceReceptance:
    """Return the receptance of a wall with one W."""
    both = np.reciprocal(wall.radius * operator.impedance)
    return FaceReceptance(both, both, both, operator.impedance)


def faced_amplitudes(problem: Problem, waves: WaveSet, j: int, grid: LaplaceGrid, block: slice, layers: int) -> list[ComplexArray]:
    """Return what walls are read for in wave j under each family's loads, (9 + layers, shells, parities, orders, nodes)."""
    wave = FacedWave(problem, grid.nodes[block], waves.modes[j])
    return [np.stack([wave.read(faces, layers) for faces in wave.faces(family, grid, block)], axis=2) for family in waves.families]


def motions_and_faces(problem: Problem, waves: WaveSet, j: int, grid: LaplaceGrid, block: slice) -> list[ComplexArray]:
    """Return W, V, U and what :func:`faces_of` gives, (7, shells, parities, orders, nodes) of each family."""
    wave, found = FacedWave(problem, grid.nodes[block], waves.modes[j]), []
    for family in waves.families:
        each = [
            np.concatenate([wave.read(faces, 0)[:3], np.stack([np.stack(moving) for moving in faces], axis=1)])
            for faces in wave.faces(family, grid, block)
        ]
        found.append(np.stack(each, axis=2))
    return found


def faces_of(problem: Problem, waves: WaveSet, j: int, grid: LaplaceGrid, block: slice) -> list[ComplexArray]:
    """Return what the faces of all walls do in wave j under each family's loads, (4, shells, parities, orders, nodes).

    Displacements of the inner and of the outer faces and the loads on them, all positive inward; nothing within elastic walls is read.
    """
    wave, found = FacedWave(problem, grid.nodes[block], waves.modes[j], reads=False), []
    for family in waves.families:
        each = [np.stack([np.stack(moving) for moving in faces], axis=1) for faces in wave.faces(family, grid, block)]
        found.append(np.stack(each, axis=2))
    return found


def make_shapes(problem: Problem, modes: Sequence[Modes]) -> None:
    """Make what all blocks of nodes share of elastic walls, on all threads: once, as long as these modes are in use."""
    solids = [wall for wall in problem.shells if isinstance(wall, ElasticWall)]
    pairs = [(wall, one) for one in modes for wall in solids]
    if pairs:
        with one_blas_thread(), ThreadPoolExecutor(WORKERS) as pool:  # many small matrices
            list(pool.map(lambda pair: pair[0].prepare_stations(pair[1]), pairs))
