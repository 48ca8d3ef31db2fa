"""How a number changes with structures some of whose walls have two faces: the ports of the walls are differenced, not the run.

What marched forces changed beside them is in two more motions: that of the surfaces under the sources alone, and those under a unit load on
each surface at the nodes of the trapezoidal rule, of which the step weights are made (:mod:`coaxshell.solver.faced_forces`). A wall is held
on the mesh that it has, whose number of points jumps with its thickness.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property

import numpy as np

from coaxshell.acoustics.basis import Modes, RadialBasis
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.blas_threads import one_blas_thread
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.adjoint.answer import Backwards
from coaxshell.solver.adjoint.faces import FaceBars, Moving, Rows, answers_of
from coaxshell.solver.adjoint.fluid_slopes import FluidSlopes
from coaxshell.solver.adjoint.structure import summed, weights_of
from coaxshell.solver.excitation import SurfaceLoads
from coaxshell.solver.faced_forces import PARTS, trapezoidal_nodes
from coaxshell.solver.scaling import Problem
from coaxshell.solver.solid_spectra import FacedSystem, SolidSpectra, band, make_shapes
from coaxshell.solver.solved_spectra import SolvedSpectra
from coaxshell.solver.spectral import map_node_blocks, node_blocks
from coaxshell.structure.elastic_wall import ElasticWall


class FacedSensitivity:
    """What a number changes by with the structure of a run some of whose walls have two faces.

    Parameters
    ----------
    solved : SolvedSpectra
    back : Backwards
    """

    def __init__(self, solved: SolvedSpectra, back: Backwards) -> None:
        self._solved, self._back = solved, back
        self._grid, self._modes, self._problem = solved.grid, solved.modes, solved.structure.problem

    def change(self, before: Problem, after: Problem) -> float:
        """Return what the number changes by to first order from one problem near that of the run to another, absorbers left as they are."""
        old, new = (_held(problem, self._problem, band(self._grid)) for problem in (before, after))
        total = _of_walls(self._bars, old, new, self._modes, self._grid.nodes) + self._fluids.change(old, new)
        loads = [self._load(problem) for problem in (old, new)] if self._loaded_differently(old, new) else []
        if loads:
            total += summed(self._bars.load[: loads[0].shape[0]], loads[1] - loads[0])
        if self._back.felt is not None:
            fine, s = trapezoidal_nodes(self._grid)
            old, new = (_held(problem, self._problem, band(fine)) for problem in (before, after))
            total += _of_walls(self._kernel_bars, old, new, self._modes, s, shown=False) + self._fluids_of_kernels.change(old, new)
        radii = [np.array([surface.radius for surface in problem.surfaces]) for problem in (old, new)]
        return total + float(self._back.tighter @ np.log(radii[0] / radii[1]))

    def _loaded_differently(self, old: Problem, new: Problem) -> bool:
        same = old.sources == new.sources and old.scales == new.scales and old.system.sources == new.system.sources
        return not same or old.head != new.head or old.fluids[-1] != new.fluids[-1]

    def _load(self, problem: Problem) -> ComplexArray:
        """Return the pressure of the sources on the surface that the exterior fluid wets, (parities, M + 1, nodes)."""
        radial = RadialBasis(self._modes, self._grid.nodes)
        loads = SurfaceLoads(problem, self._grid, self._modes)(radial, slice(0, self._grid.nodes.size))
        return np.stack(loads)

    @cached_property
    def _fluids(self) -> FluidSlopes:
        return FluidSlopes(self._problem, self._bars.fluids, self._modes, self._grid.nodes)

    @cached_property
    def _fluids_of_kernels(self) -> FluidSlopes:
        return FluidSlopes(self._problem, self._kernel_bars.fluids, self._modes, trapezoidal_nodes(self._grid)[1])

    @cached_property
    def _bars(self) -> FaceBars:
        """What the number changes by through all that is solved at the nodes of the grid."""
        solved, back, grid, modes = self._solved, self._back, self._grid, self._modes
        assert solved.solid is not None
        motions = [_whole(solved.solid, back.pressure, back.reading.rows, back.moved)]
        if back.felt is not None:
            source = solved.structure.solid
            assert source is not None
            felt = grid.invert_transposed(back.felt.displacement) + grid.nodes * grid.invert_transposed(back.felt.velocity)
            motions.append(_whole(source, None, {}, felt))
        parities = max(motion.faces.shape[2] for motion in motions)
        bars = FaceBars.none(self._problem, modes, grid.nodes.size, parities)
        make_shapes(self._problem, modes, grid.nodes)

        def work(block: slice) -> None:
            system = FacedSystem(self._problem, grid.nodes[block], modes)
            units = [system.under_force(place, 1.0) for place in bars.places]
            for motion in motions:
                bars.add(self._problem, system, units, _at(motion, block), block)

        with one_blas_thread():
            map_node_blocks(node_blocks(grid, modes.max_order), work, None, "walls backwards")
        return bars

    @cached_property
    def _kernel_bars(self) -> FaceBars:
        """What the number changes by through the step weights of the march, at their own nodes."""
        assert self._back.felt is not None
        grid, modes = self._grid, self._modes
        fine, s = trapezoidal_nodes(grid)
        problem = self._problem.resolving(band(fine))
        per_compliance = _of_step_weights(weights_of(self._back.felt), grid, fine) * s
        bars = FaceBars.none(problem, modes, s.size, 1)
        make_shapes(problem, modes, s)

        def work(block: slice) -> None:
            system = FacedSystem(problem, s[block], modes)
            units = [system.under_force(place, 1.0) for place in bars.places]
            for j, surface in enumerate(problem.surfaces):
                answers = units[bars.places.index(surface)]
                faces = np.stack([[answer.faces[side] for answer in answers] for side in range(4)])[:, :, None]
                pressure = np.zeros((len(problem.surfaces), 1, *faces.shape[3:]), np.complex128)
                pressure[j] = 1.0
                moving = Moving(faces[:2], faces[2:], pressure, {}, per_compliance[:, j, None][..., block])
                bars.add(problem, system, units, moving, block)

        with one_blas_thread():
            map_node_blocks(node_blocks(fine, modes.max_order), work, None, "kernels backwards")
        return bars


def _whole(solid: SolidSpectra, pressure: ComplexArray | None, rows: Rows, moved: ComplexArray | None) -> Moving:
    return Moving(solid.faces, solid.loads, pressure, rows, moved)


def _at(motion: Moving, block: slice) -> Moving:
    """Return a motion at a block of the nodes."""
    pressure, moved = (None if x is None else x[..., block] for x in (motion.pressure, motion.moved))
    rows = {key: x[..., block] for key, x in motion.rows.items()}
    return Moving(motion.faces[..., block], motion.loads[..., block], pressure, rows, moved)


def _held(problem: Problem, base: Problem, frequency: float) -> Problem:
    """Return a problem near another one that resolves waves up to a frequency, on the other's meshes."""
    found = problem.resolving(frequency)
    pairs = zip(found.shells, base.shells, strict=True)
    shells = tuple(
        replace(wall, meshed_as=held.layers) if isinstance(wall, ElasticWall) and isinstance(held, ElasticWall) else wall
        for wall, held in pairs
    )
    return replace(found, shells=shells)


def _of_walls(bars: FaceBars, old: Problem, new: Problem, modes: Modes, s: ComplexArray, *, shown: bool = True) -> float:
    """Return what the number changes by with the walls from one problem to another."""
    total, own = 0.0, [Modes(modes.orders, sparse=modes.sparse) for _ in range(2)]
    for i, (first, second) in enumerate(zip(old.shells, new.shells, strict=True)):
        if first != second and second.moves:
            ends = [answers_of(wall, at, s, shown=shown) for wall, at in zip((first, second), own, strict=True)]
            total += summed(bars.walls[i], ends[1][0] - ends[0][0])
            if shown:
                total += summed(bars.shown[i], ends[1][1] - ends[0][1])
    return total


def _of_step_weights(weights: FloatArray, grid: LaplaceGrid, fine: LaplaceGrid) -> ComplexArray:
    """Return what the number changes by per unit of the spectra of step weights at a part of the step, transposed (..., nodes)."""
    falling = 1.0 - np.arange(PARTS) / PARTS
    spread = np.zeros((*weights.shape[:-1], fine.time.size))
    parts = weights[..., :-1, None] * falling + weights[..., 1:, None] * (1.0 - falling)
    spread[..., : PARTS * grid.steps] = parts.reshape(*weights.shape[:-1], -1)
    spread[..., PARTS * grid.steps] = weights[..., -1]
    return fine.invert_transposed(spread * fine.time_step, np.ones(fine.nodes.size))
