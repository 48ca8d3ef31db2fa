"""Point absorbers in three dimensions: their points march alone, or are solved exactly at each Laplace node where they are linear."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import TypeVar

import numpy as np

from coaxshell.errors import InputError
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.convolution import KernelTable, summed_weights
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.modes import Modes
from coaxshell.numerics.progress import Progress, of_stage
from coaxshell.solver.axial.blocks import BlockMap, node_blocks
from coaxshell.solver.axial.point_forces import PointForces
from coaxshell.solver.axial.points import PairClasses, PointLayout, class_shares, pair_classes, point_receptance, point_sums
from coaxshell.solver.axial.sampling import AxialSampling
from coaxshell.solver.faced_forces import step_weights, trapezoidal_nodes
from coaxshell.solver.interface.absorbers import AbsorberSet, PointsAlone, point_law, side_admittance
from coaxshell.solver.interface.link_motion import LinkMotion, exact_motion, marched_motion, motion_of_laws
from coaxshell.solver.kernels import exponential_weights, initial_decay
from coaxshell.solver.links.any_law import march_interface
from coaxshell.solver.links.histories import LawHistories, middles_transform
from coaxshell.solver.scaling import Problem
from coaxshell.solver.solid_spectra import band
from coaxshell.solver.step_error import SHARES
from coaxshell.solver.structure_spectra import StructureSpectra

Numbers = TypeVar("Numbers", FloatArray, ComplexArray)


@dataclass(frozen=True)
class PointSolution:
    """What the absorbers of a run did.

    Attributes
    ----------
    forces : PointForces
        At all points.
    force : ndarray, shape (N, 2, T)
        On the inner and the outer shell, positive inward, for every absorber of the description.
    displacement : ndarray, shape (N, T)
        q of every absorber.
    structure : PointStructure
    carried : ndarray, shape (2N, nodes)
        Transforms of the forces of the absorbers carried.
    exact : ndarray or None
        Those of q of the absorbers carried, (N, nodes), where they are linear.
    marched : ndarray or None
        Histories of the forces of the absorbers carried, (2N, T), where they were marched.
    laws : LawHistories or None
        What links of any law did, where there are such.
    """

    forces: PointForces
    force: FloatArray
    displacement: FloatArray
    structure: PointStructure
    carried: ComplexArray
    exact: ComplexArray | None = None
    marched: FloatArray | None = None
    laws: LawHistories | None = None

    @cached_property
    def error(self) -> float:
        """Relative error of the forces by the steps of the march, 0 where nothing was marched: it takes about as long as they did."""
        return 0.0 if self.marched is None else _march_error(self.structure, self.marched)

    @property
    def links(self) -> LinkMotion:
        """Forces, motion and rates of every absorber of the description."""
        absorbers, grid = self.structure.layout.absorbers, self.structure.grid
        if self.exact is not None:
            return exact_motion(absorbers, grid, self.carried, self.exact)
        if self.laws is not None:
            return motion_of_laws(absorbers, self.laws, self.force, self.displacement)
        return marched_motion(absorbers, grid.time_step, self.force, self.displacement)


class PointStructure(StructureSpectra):
    """A structure seen at points alone: kernels between them, and their motion under the sources.

    Parameters
    ----------
    problem : Problem
    grid : LaplaceGrid
    layout : PointLayout
    motion : ndarray, shape (carried points, nodes)
        w under the sources.
    receptance : ndarray, shape (carried points, carried points, nodes)
        w of a point per force at another and at all its images.
    immediate : ndarray, shape (carried points, carried points)
        What of it answers at once: the sum of the orders' shares, between points of one surface.
    weights : ndarray, shape (carried points, carried points, T), or None
        Step weights of a march, where walls have faces that move differently (:mod:`coaxshell.solver.faced_forces`).
    """

    def __init__(
        self,
        problem: Problem,
        grid: LaplaceGrid,
        layout: PointLayout,
        motion: ComplexArray,
        receptance: ComplexArray,
        immediate: FloatArray,
        weights: FloatArray | None = None,
    ) -> None:
        super().__init__(problem, grid, Modes.up_to(0))
        self.layout, self.motion, self.receptance, self.immediate = layout, motion, receptance, immediate
        if weights is not None:
            self.units.kernels = KernelTable(weights[:, :, None])

    @property
    def linear_displacement(self) -> FloatArray:
        """W of the points without absorbers, shape (points, 1, 1, T)."""
        return self.grid.invert(self.motion)[:, None, None]

    @property
    def linear_velocity(self) -> FloatArray:
        """Velocity dW/dt of the points without absorbers, shape (points, 1, 1, T)."""
        return self.grid.invert(self.motion * self.grid.nodes)[:, None, None]

    def points(self, absorbers: AbsorberSet) -> PointsAlone:
        """Return the points, which march alone."""
        return PointsAlone(absorbers)

    @property
    def kernels(self) -> KernelTable:
        """Step weights of forces in the velocities of the points; see :mod:`coaxshell.solver.kernels`.

        Points of one thin shell answer at once by its mass: (immediate/M)/(s + b) is inverted in closed form.
        """
        if self.units.kernels is None:
            grid, shell = self.grid, self.layout.carried.surface
            hat, weights = grid.hat * grid.time_step, np.empty((shell.size, shell.size, 1, grid.time.size))
            for a, i in enumerate(shell):
                mass = self.problem.shells[i].leading(self.modes).mass
                decay = initial_decay(self.problem, int(i), self.modes)
                at_once = self.immediate[a][:, None] / mass
                rest = self.receptance[a] * grid.nodes - at_once / (grid.nodes + decay)
                weights[a, :, 0] = grid.invert(rest * hat) + at_once * exponential_weights(decay, grid)
            self.units.kernels = KernelTable(weights)
        return self.units.kernels


def point_structure(
    problem: Problem,
    grid: LaplaceGrid,
    sampling: AxialSampling,
    layout: PointLayout,
    blocks: list[slice],
    on: BlockMap,
    progress: Progress | None = None,
) -> PointStructure:
    """Return the structure at the points of some absorbers, from blocks of nodes in turn."""
    classes = pair_classes(layout, cut=problem.cut)
    motion = np.empty((layout.carried.count, grid.nodes.size), np.complex128)
    by_class = np.empty((classes.moved.size, grid.nodes.size), np.complex128)
    work = partial(point_sums, problem, grid, sampling, layout, classes)
    for block, part in zip(blocks, on(work, blocks, of_stage(progress, "points of the absorbers")), strict=True):
        motion[:, block], by_class[:, block] = part["motion"], part["receptance"]
    at_once = np.zeros(classes.moved.size)
    for (i, j), share in class_shares(problem, layout, classes, sampling.max_order).items():
        if i == j:
            at_once[share.numbers] = sum(share.at(modes, sampling, wave).sum(axis=1) for wave, modes in enumerate(sampling.modes))
    receptance, immediate = _over_images(layout, classes, by_class), _over_images(layout, classes, at_once)
    weights = None
    if problem.two_faced and not layout.absorbers.is_linear:
        weights = _over_images(layout, classes, _march_weights(problem, grid, sampling, layout, classes, on, progress))
    if layout.absorbers.elements is not None:  # what a core holds does not move, and nobody feels the force on it
        held = layout.absorbers.held.ravel()
        motion, immediate = motion * held[:, None], held[:, None] * immediate * held
        receptance = held[:, None, None] * receptance * held[:, None]
        weights = None if weights is None else held[:, None, None] * weights * held[:, None]
    return PointStructure(problem, grid, layout, motion, receptance, immediate, weights)


def _march_weights(
    problem: Problem,
    grid: LaplaceGrid,
    sampling: AxialSampling,
    layout: PointLayout,
    classes: PairClasses,
    on: BlockMap,
    progress: Progress | None,
) -> FloatArray:
    """Return the step weights of forces in velocities by class, (classes, T), of walls whose faces move differently."""
    fine, s = trapezoidal_nodes(grid)
    resolving, waves = problem.resolving(band(fine)), replace(sampling)  # its modes keep these walls' shapes, as long as this takes
    found, blocks = np.empty((classes.moved.size, s.size), np.complex128), node_blocks(fine)
    work = partial(point_receptance, resolving, s, waves, layout, classes)
    for block, part in zip(blocks, on(work, blocks, of_stage(progress, "step weights of the absorbers")), strict=True):
        found[:, block] = part["receptance"]
    return step_weights(found, fine, s, grid)


def _over_images(layout: PointLayout, classes: PairClasses, values: Numbers) -> Numbers:
    """Return what forces at a carried point and all its images do, (carried points, carried points, ...), from values by class."""
    pairs = [(side * layout.member_count + members) for side in (0, 1) for members in layout.images]
    return np.stack([values[classes.number[:, images]].sum(axis=1) for images in pairs], axis=1)


def solve_points(structure: PointStructure, progress: Progress | None = None) -> PointSolution:
    """Return what the absorbers do: exact where all are linear, by the march otherwise.

    Raises
    ------
    InputError
        If a step does not converge.
    """
    layout, grid = structure.layout, structure.grid
    absorbers, displacement, marched = layout.absorbers, None, None
    laws: LawHistories | None = None
    if absorbers.is_linear:
        carried, displacement = _exact(structure)
        histories, moved = grid.invert(carried), grid.invert(displacement)
    else:
        result = march_interface(structure, absorbers, progress=progress)
        histories = marched = result.force
        moved, laws = result.mass_displacement, result.laws
        carried = grid.transform_linear(histories) if laws is None else middles_transform(grid, laws.force)
    every = layout.of_every(histories)
    sides = every.reshape(2, layout.member_count, -1).swapaxes(0, 1)
    felt = carried if absorbers.elements is None else carried * absorbers.held.reshape(-1, 1)
    forces = PointForces(layout.points, layout.of_every(felt), layout.parities)
    return PointSolution(forces, sides, moved[absorbers.member], structure, carried, displacement, marched, laws)


def _exact(structure: PointStructure) -> tuple[ComplexArray, ComplexArray]:
    """Return the transforms of the forces (2N, nodes) and of the masses' displacements (N, nodes) of linear absorbers."""
    absorbers, nodes = structure.layout.absorbers, structure.grid.nodes
    count, sides, law = absorbers.count, side_admittance(absorbers, nodes), point_law(absorbers, nodes)
    receptance = np.ascontiguousarray(np.moveaxis(structure.receptance, -1, 0))
    moved = np.linalg.solve(np.eye(2 * count) + receptance @ law, structure.motion.T[:, :, None])
    force = -(law @ moved)[:, :, 0].T
    walls = moved[:, :, 0].T
    return force, sides.mass_displacement(walls[:count].T, walls[count:].T).T


class _CoarserPoints(PointStructure):
    """Points seen at every few steps of a run: for the error of the march."""

    def __init__(self, fine: PointStructure, every: int) -> None:
        coarse = LaplaceGrid(fine.grid.time_step * every, fine.grid.steps // every)
        super().__init__(fine.problem, coarse, fine.layout, fine.motion, fine.receptance, fine.immediate)
        self._fine, self._kept = fine, slice(0, coarse.time.size * every, every)
        self.units.kernels = KernelTable(summed_weights(fine.kernels.kernels, every, coarse.time.size))

    @property
    def linear_displacement(self) -> FloatArray:
        """W of the points without absorbers at the kept instants."""
        return self._fine.linear_displacement[..., self._kept]

    @property
    def linear_velocity(self) -> FloatArray:
        """Velocity dW/dt of the points without absorbers at the kept instants."""
        return self._fine.linear_velocity[..., self._kept]


def _march_error(structure: PointStructure, force: FloatArray) -> float:
    """Return a share of what changes in the forces at steps eight times longer, or four times or twice; 1 if all of them fail."""
    found = 1.0
    for every, (share, telling) in SHARES.items():
        coarser = _CoarserPoints(structure, every)
        try:
            with np.errstate(all="ignore"):
                coarse = march_interface(coarser, structure.layout.absorbers).force
        except (InputError, np.linalg.LinAlgError, FloatingPointError):
            continue
        change, whole = force[:, ::every][:, : coarse.shape[1]] - coarse, np.linalg.norm(force[:, ::every])
        if np.isfinite(change).all() and whole > 0:
            found = min(found, share * float(np.linalg.norm(change) / whole))
        if found < telling:
            break
    return found
