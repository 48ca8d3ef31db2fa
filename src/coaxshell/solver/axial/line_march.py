"""The march of line absorbers in three dimensions: the interface march of two (:mod:`coaxshell.solver.interface.march`) at every axial
wavenumber, coupled by the cubes of the stretches alone.

What is linear within a block of steps is found for each wavenumber by itself. There remains, for the stretches D of all links,

    D = D_known + R n(D),        n(D) = k_nl D^3 at every z (less the stiffness that was lent to the linear problem),

R diagonal in the wavenumbers, n in the points of the period (:mod:`coaxshell.solver.axial.series`). Links of any other law are marched
in the means over the steps (:mod:`coaxshell.solver.axial.line_laws`), between which all that is linear holds as between the instants.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from coaxshell.errors import InputError
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.convolution import History, HistorySum, KernelTable
from coaxshell.numerics.progress import Progress
from coaxshell.solver.axial.line_laws import LawSeed, LineLawHistories, LineLaws, means_of, of_means
from coaxshell.solver.axial.line_newton import LineSolver, Seed
from coaxshell.solver.axial.lines import LineLayout
from coaxshell.solver.interface.block_response import LinkConstants, block_response, block_toeplitz
from coaxshell.solver.interface.newton import ConvergenceError
from coaxshell.solver.links.histories import at_instants

_LONGEST_BLOCK = 32
_BLOCK_UNKNOWNS = 128
"""Unknowns of a block at a wavenumber: above, the matrices of all wavenumbers take longer to read than the steps that they spare."""


@dataclass(frozen=True)
class LineMotion:
    """Histories along the lines, as sums along the axis.

    Attributes
    ----------
    displacement, velocity : ndarray, shape (waves, 2N, axial parities, T)
        Of the walls without absorbers.
    weights : ndarray, shape (shells, shells, waves, classes, T)
    time_step : float
    """

    displacement: FloatArray
    velocity: FloatArray
    weights: FloatArray
    time_step: float

    @property
    def steps(self) -> int:
        """T."""
        return int(self.displacement.shape[-1])


@dataclass(frozen=True)
class LineMarch:
    """What a march found, as sums along the axis.

    Attributes
    ----------
    force : ndarray, shape (waves, 2N, axial parities, T)
        Positive inward.
    displacement : ndarray, shape (waves, N, axial parities, T)
        Of the masses.
    moved : ndarray, shape (waves, 2N, axial parities, T)
        Displacement that the forces give to the walls at the lines.
    laws : LineLawHistories or None
        What links of any law did.
    """

    force: FloatArray
    displacement: FloatArray
    moved: FloatArray
    laws: LineLawHistories | None = None


@dataclass(frozen=True)
class _Plan:
    """Constants of a march; matrices of a block at every wavenumber, in steps times points."""

    layout: LineLayout
    links: LinkConstants
    history: HistorySum
    length: int
    rows: FloatArray
    force_of_input: FloatArray
    mass_velocity_of_input: FloatArray
    integral: FloatArray
    solver: LineSolver | LineLaws


@dataclass(frozen=True)
class _State:
    """Forces, forced displacement and velocity at the lines (waves, 2N, parities); the masses' displacement and velocity."""

    force: FloatArray
    displacement: FloatArray
    velocity: FloatArray
    mass_displacement: FloatArray
    mass_velocity: FloatArray
    history: History
    seed: Seed | LawSeed


def march_lines(layout: LineLayout, motion: LineMotion, progress: Progress | None = None) -> LineMarch:
    """March the line absorbers over all times.

    Raises
    ------
    InputError
        If a step does not converge.
    """
    plan, linear = _plan(layout, motion), motion
    if isinstance(plan.solver, LineLaws):
        moved_by_sources, velocity = means_of(motion.displacement, motion.time_step)
        linear = replace(motion, displacement=moved_by_sources, velocity=velocity)
    waves, n, parities, steps = len(layout.sampling.modes), layout.absorbers.count, layout.axial_parities, motion.steps
    force, mass, moved = (np.zeros((waves, points, parities, steps)) for points in (2 * n, n, 2 * n))
    walls, masses = np.zeros((3, waves, 2 * n, parities)), np.zeros((2, waves, n, parities))
    state = _State(walls[0], walls[1], walls[2], masses[0], masses[1], History(), plan.solver.at_rest())
    for first in range(1, steps, plan.length):
        block = slice(first, min(first + plan.length, steps))
        try:
            state, force[..., block], mass[..., block], moved[..., block] = _march_block(plan, state, linear, block)
        except ConvergenceError:
            raise _did_not_converge(plan, motion.time_step) from None
        if progress is not None:
            progress(block.stop / steps, "march of the line absorbers")
    if not (isinstance(state.seed, LawSeed) and isinstance(plan.solver, LineLaws)):
        return LineMarch(force, mass, moved)
    mass, moved = of_means(mass), of_means(moved)
    free = motion.displacement.copy()
    free[..., 0] = 0.0
    stretch = np.tile(mass, (1, 2, 1, 1)) - free - moved
    histories = LineLawHistories(force, stretch, 2.0 * float(np.sqrt(state.seed.stiffest)), plan.solver.compliance)
    return LineMarch(at_instants(force), mass, moved, histories)


def block_steps(count: int) -> int:
    """Return the steps of a block of the march of so many absorbers."""
    length = _LONGEST_BLOCK
    while length > 1 and length * 2 * count > _BLOCK_UNKNOWNS:
        length //= 2
    return length


def _plan(layout: LineLayout, motion: LineMotion) -> _Plan:
    absorbers = layout.absorbers
    length = min(block_steps(absorbers.count), motion.steps)
    kernels = layout.points.immediate(np.moveaxis(motion.weights[..., :length], -1, 3))
    own = np.diagonal(kernels[:, 0], axis1=1, axis2=2).max(axis=0)
    links = LinkConstants.of(absorbers, own, motion.time_step)
    nothing = np.zeros((length, 2 * absorbers.count, 0))
    answers = [block_response(links, kernel, nothing) for kernel in kernels]
    rows = np.stack([block_toeplitz(answer.stretch) for answer in answers])
    lent = np.tile(links.auxiliary_stiffness, 2)
    solver = (
        LineLaws(layout.series, rows, absorbers, lent, motion.time_step)
        if absorbers.of_any_law
        else LineSolver(layout.series, rows, np.tile(absorbers.cubic, 2), lent)
    )
    flat = motion.weights.reshape(*motion.weights.shape[:2], -1, motion.steps)
    return _Plan(
        layout,
        links,
        HistorySum(KernelTable(flat), layout.absorbers.parities * layout.axial_parities),
        length,
        rows,
        np.stack([block_toeplitz(answer.force) for answer in answers]),
        np.stack([block_toeplitz(answer.mass_velocity) for answer in answers]),
        links.half_step * (2.0 * np.tri(length, k=-1) + np.eye(length)),
        solver,
    )


def _march_block(plan: _Plan, state: _State, motion: LineMotion, block: slice) -> tuple[_State, FloatArray, FloatArray, FloatArray]:
    """Solve one block of steps; return the state after it, and at its steps what :class:`LineMarch` holds.

    Inside, arrays have the shape (waves, steps, points, axial parities).
    """
    links, count, n, half = plan.links, block.stop - block.start, plan.links.count, plan.links.half_step
    waves, parities = len(state.force), state.force.shape[-1]
    integral, over = plan.integral[:count, :count], plan.integral[:count, :count].sum(axis=1)[:, None, None]
    excited = _at_lines(plan, plan.history.forcing(state.history, count))
    free_w = _integrated(integral, excited) + (state.displacement + half * state.velocity)[:, None]
    free_u = (state.mass_velocity - links.mobility[:, None] * _both(state.force))[:, None]
    free_q = (state.mass_displacement + half * state.mass_velocity)[:, None] + over * free_u
    bare_w, bare_v = (np.moveaxis(x[..., block], -1, 1) for x in (motion.displacement, motion.velocity))
    damping, stiffness = (x[:, None] for x in (links.damping, links.stiffness))
    free_stretch = np.tile(free_q, (1, 1, 2, 1)) - bare_w - free_w
    drive = damping * (np.tile(free_u, (1, 1, 2, 1)) - bare_v - excited) + stiffness * free_stretch
    size = count * 2 * n
    inputs = drive.reshape(waves, size, parities)
    known = free_stretch.reshape(waves, size, parities) + plan.rows[:, :size, :size] @ inputs
    nonlinear_part, seed = _solved(plan.solver, known, count, state.seed)
    inputs = inputs + nonlinear_part
    force = (plan.force_of_input[:, :size, :size] @ inputs).reshape(waves, count, 2 * n, parities)
    u = (plan.mass_velocity_of_input[:, : count * n, :size] @ inputs).reshape(waves, count, n, parities)
    q = free_q + _integrated(integral, u)
    history, own = plan.history.push(state.history, _pressure(plan, force))
    own_v = _at_lines(plan, own)
    moved = free_w + _integrated(integral, own_v)
    after = _State(force[:, -1], moved[:, -1], excited[:, -1] + own_v[:, -1], q[:, -1], free_u[:, 0] + u[:, -1], history, seed)
    return after, np.moveaxis(force, 1, -1), np.moveaxis(q, 1, -1), np.moveaxis(moved, 1, -1)


def _solved(solver: LineSolver | LineLaws, known: FloatArray, count: int, seed: Seed | LawSeed) -> tuple[FloatArray, Seed | LawSeed]:
    if isinstance(solver, LineLaws):
        assert isinstance(seed, LawSeed)
        return solver.solve(known, count, seed)
    assert isinstance(seed, Seed)
    return solver.solve(known, count, seed)


def _both(force: FloatArray) -> FloatArray:
    """Return the sum of the forces on both sides: (waves, N, ...) from (waves, 2N, ...)."""
    return np.asarray(force[:, : force.shape[1] // 2] + force[:, force.shape[1] // 2 :])


def _integrated(integral: FloatArray, velocity: FloatArray) -> FloatArray:
    """Return the integrals at the steps of a block of velocities (waves, steps, points, parities)."""
    return np.asarray(integral @ velocity.reshape(*velocity.shape[:2], -1)).reshape(velocity.shape)


def _at_lines(plan: _Plan, amplitudes: FloatArray) -> FloatArray:
    """Return the values at the lines, (waves, steps, points, axial parities), of classes (shells, parities, waves * classes, steps)."""
    shells, parities, flat, count = amplitudes.shape
    along, classes = plan.layout.axial_parities, plan.layout.classes.count
    parts = amplitudes.reshape(shells, parities // along, along, flat // classes, classes, count).transpose(0, 1, 4, 3, 5, 2)
    values = plan.layout.points.evaluate(np.ascontiguousarray(parts).reshape(shells, parities // along, classes, -1))
    return values.reshape(-1, flat // classes, count, along).transpose(1, 2, 0, 3)


def _pressure(plan: _Plan, force: FloatArray) -> FloatArray:
    """Return the pressures of the classes, (shells, parities, waves * classes, steps), of forces (waves, steps, points, axial parities)."""
    waves, count, points, along = force.shape
    modal = plan.layout.points.project(np.ascontiguousarray(force.transpose(2, 0, 1, 3)).reshape(points, -1))
    shells, parities, classes, _ = modal.shape
    parts = modal.reshape(shells, parities, classes, waves, count, along).transpose(0, 1, 5, 3, 2, 4)
    return np.ascontiguousarray(parts).reshape(shells, parities * along, waves * classes, count)


def _did_not_converge(plan: _Plan, time_step: float) -> InputError:
    if isinstance(plan.solver, LineLaws):
        found = f"steps of {time_step:g} (time_step/refinement) are too coarse for the laws of the absorbers: their forces did not converge"
        return InputError("time_step", found, "use a quarter of time_step, or four times the refinement")
    if plan.links.auxiliary_stiffness.any():
        remedy = "give them a linear stiffness, however small, such as 1 kN/m^2, or a mass"
        return InputError(
            "absorbers", "without mass, cubic springs alone leave them loose at rest, and their forces did not converge", remedy
        )
    coarse = f"steps of {time_step:g} (time_step/refinement) are too coarse for the absorbers: their forces did not converge"
    return InputError("time_step", coarse, "use a quarter of time_step, or four times the refinement")
