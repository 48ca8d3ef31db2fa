"""All stresses at many depths of an elastic wall at stations along the axis: the waves of a finished run, solved once more.

Wave by wave the loads on the faces of the wall give its stresses at all depths, which add up at the stations; the shapes of a wave are
dropped when it has been added.
"""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.blas_threads import one_blas_thread
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.modes import Modes
from coaxshell.numerics.threads import WORKERS
from coaxshell.solver.axial.belts import driven_sets
from coaxshell.solver.axial.blocks import node_blocks
from coaxshell.solver.axial.faced import make_shapes
from coaxshell.solver.axial.faced_motion import closed_motions, wave_at
from coaxshell.solver.axial.families import Family, WaveSet
from coaxshell.solver.axial.forces import WallForces
from coaxshell.solver.axial.sampling import AxialSampling
from coaxshell.solver.axial.solution import SpatialSolution
from coaxshell.solver.axial.solve import forces_of, laplace_grid
from coaxshell.solver.axial.sums import TOGETHER, of_odd
from coaxshell.solver.axial.tied_wave import motion_parities
from coaxshell.solver.scaling import Problem
from coaxshell.solver.solid_spectra import band
from coaxshell.structure.elastic_wall import Asked, ElasticWall
from coaxshell.structure.layered_wall import SPARED_ALONG


def searched_depths(solution: SpatialSolution, shell: int) -> list[FloatArray]:
    """Return depths of each layer of an elastic wall (a), from the inside out, through which a polynomial holds its stresses."""
    wall = solution.problem.resolving(band(laplace_grid(solution.settings))).shells[shell]
    assert isinstance(wall, ElasticWall)
    return list(wall.points(solution.sampling.max_order, solution.sampling.highest, SPARED_ALONG))


def stresses_through(solution: SpatialSolution, shell: int, asked: Sequence[Asked], stations: Sequence[int]) -> FloatArray:
    """Return modal histories of stresses at depths of an elastic wall, Pa, shape (stresses, stations, parities, M + 1, T).

    Parameters
    ----------
    solution : SpatialSolution
    shell : int
    asked : sequence of Asked
        Depths in a.
    stations : sequence of int
        By number.

    Raises
    ------
    InputError
        If instants of the run are missing.
    """
    solution.at(0).need_every_instant("the largest stress through an elastic wall")
    settings, grid = solution.settings, laplace_grid(solution.settings)
    problem = solution.problem.resolving(band(grid))
    wall = problem.shells[shell]
    assert isinstance(wall, ElasticWall)
    kept = tuple(replace(wall, keeps_shapes=True) if one is wall else one for one in problem.shells)
    z = solution.stations[list(stations)] / problem.scales.length
    spectra = _Pass(replace(problem, shells=kept), grid, solution.sampling, shell, tuple(asked), forces_of(solution)).at(z)
    every = slice(None, None, settings.refinement)
    return np.stack([grid.invert(one)[..., every] * problem.scales.pressure for one in spectra])


@dataclass(frozen=True)
class _Pass:
    """One pass through all waves of a run, for some stresses in one wall."""

    problem: Problem
    grid: LaplaceGrid
    sampling: AxialSampling
    shell: int
    asked: tuple[Asked, ...]
    forces: WallForces | None = None

    def at(self, stations: FloatArray) -> ComplexArray:
        """Return the transforms at stations (z in a), shape (stresses, stations, parities, M + 1, nodes)."""
        blocks, parities, forces = node_blocks(self.grid), motion_parities(self.problem), self.forces
        parities = parities if forces is None else max(parities, forces.parities)
        per_block = [
            driven_sets(self.problem, self.sampling, stations, self.grid, block, None if forces is None else forces.at(block))
            for block in blocks
        ]
        shape = (len(self.asked), stations.size, parities, self.sampling.max_order + 1)
        found = np.zeros((*shape, self.grid.nodes.size), np.complex128)
        with one_blas_thread(), ThreadPoolExecutor(WORKERS) as pool:
            for number, waves in enumerate(per_block[0]):
                for first in range(0, len(waves.modes), TOGETHER):
                    some = waves.order[first : first + TOGETHER]
                    modes = [Modes(waves.modes[j].orders, waves.modes[j].wavenumber) for j in some]  # whose shapes end with them
                    make_shapes(self.problem, modes)
                    pairs = zip(per_block, blocks, strict=True)
                    tasks = [pool.submit(self._add, found, sets[number], some, modes, block) for sets, block in pairs]
                    for task in tasks:
                        task.result()
        return found

    def _add(self, found: ComplexArray, waves: WaveSet, some: list[int], modes: list[Modes], block: slice) -> None:
        """Add some waves at a block of nodes."""
        wall, nodes = self.problem.shells[self.shell], self.grid.nodes[block]
        assert isinstance(wall, ElasticWall)
        shape = (len(self.asked), len(some), found.shape[2], found.shape[3], nodes.size)
        amplitudes = [np.zeros(shape, np.complex128) for _ in waves.families]
        if np.ndim(modes[0].wavenumber):  # an inclined wave, of one k for each node of the block
            modes = [waves.modes[j] for j in some]
        for place, (j, one) in enumerate(zip(some, modes, strict=True)):
            wave = wave_at(self.problem, waves, j, self.grid, block, reads=False, modes=one)
            opened = wall.gains is not None and (waves.limited or wall.closed_by_solver)
            per_load, per_volt = wall.transfer(one, nodes, self.asked, fed_back=not opened), None
            if opened:
                per_volt = wall.under_voltage(one, nodes, self.asked).shown
            for (all_faces, voltage), amplitude in zip(closed_motions(wave, waves, j, self.grid, block), amplitudes, strict=True):
                for parity, faces in enumerate(all_faces):
                    there = amplitude[:, place, parity, : one.count]
                    np.multiply(per_load[:, 0], faces[self.shell].load_inner, out=there)
                    there += per_load[:, 1] * faces[self.shell].load_outer
                    if per_volt is not None:
                        there += per_volt * voltage[self.shell, parity]
        for family, amplitude in zip(waves.families, amplitudes, strict=True):
            self._share(found, family, some, amplitude, block)

    def _share(self, found: ComplexArray, family: Family, some: list[int], amplitude: ComplexArray, block: slice) -> None:
        """Add the amplitudes of some waves of a family at the stations."""
        for row, (one, of) in enumerate(zip(self.asked, amplitude, strict=True)):
            share = (family.odd if of_odd(one.what) else family.even)[:, some]
            if share.ndim == 3:
                found[row, ..., block] += share[:, 0, None, None] * of[0]
            elif np.any(share):
                columns = of.reshape(len(some), -1).view(np.float64)
                found[row, ..., block] += (share @ columns).view(np.complex128).reshape(found.shape[1], *of.shape[1:])
