"""The march of a ring of many absorbers, alike in all that is linear: class by class, and in the angle for the springs alone.

On the N places of a ring everything linear is circulant: it acts on cos l theta_n and sin l theta_n, l = 0..N/2, each by itself, as two
links do on two surfaces. What a block of steps answers (:mod:`coaxshell.solver.interface.block_response`) are then matrices of two unknowns
a step for each class l instead of one matrix of all 2 N. The cubic springs act in theta, where the stretches are

    D(theta_n) = sum_l Phi_nl D_l,        n_l = sum_n (Phi^-1)_ln k_nl D(theta_n)^3,

and all steps of a block, or of a part of it, are solved at once by fixed-point iteration, z = z_known + R n(z). Springs too stiff for that
at a single step are left to the march of all points.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.convolution import History, HistorySum
from coaxshell.numerics.progress import Progress
from coaxshell.solver.interface.absorbers import AbsorberSet, InterfacePoints, PointsAlone
from coaxshell.solver.interface.block_response import LinkConstants, block_response
from coaxshell.solver.interface.laws import CubicSprings, relative_size
from coaxshell.solver.structure_spectra import StructureSpectra

LINKS = 10
"""Links 2N from which on a ring is marched so: fewer take less by one matrix."""
_BLOCK_NUMBERS = 2048
"""Classes times steps of a block at most: above, what a class answers leaves the processor's cache."""
_STEPS = 32
"""Of a block, at most."""
_MOST_ITERATIONS = 30
_SLOWEST = 0.15
"""The change of an iteration over that of the one before it, at most, where fewer steps could be taken at once."""
_SLOWEST_ALONE = 0.4
"""The same of a single step."""


class TooStiffError(Exception):
    """Raised where the iteration of a single step converges too slowly."""


class RingHistories(NamedTuple):
    """Forces (2N, T), displacements of the masses (N, T), and the iterations of all steps."""

    force: FloatArray
    mass_displacement: FloatArray
    iterations: int


@dataclass(frozen=True)
class RingPlan:
    """Constants of the march of a ring.

    Attributes
    ----------
    shapes, inverse : ndarray, shapes (N, classes) and (classes, N)
        Phi, cos l theta_n and sin l theta_n as far as they do not vanish, and its inverse.
    evaluate, project : list of ndarray, shapes (classes, modes) and (modes, classes)
        For both sides, from modes of its surface to classes and from line forces of classes to modes; parities follow each other.
    surfaces : tuple of int
        Those that they hold.
    kernels : HistorySum
    links : LinkConstants
        Of one absorber.
    stretch, force : ndarray, shape (classes, 2 steps, 2 steps)
        D and f at the steps of a block per input there; at every step both sides.
    mass_velocity : ndarray, shape (classes, steps, 2 steps)
    springs : CubicSprings
        Of all links, (N, 1): both sides are alike.
    parities : int
    """

    shapes: FloatArray
    inverse: FloatArray
    evaluate: list[FloatArray]
    project: list[FloatArray]
    surfaces: tuple[int, ...]
    kernels: HistorySum
    links: LinkConstants
    stretch: FloatArray
    force: FloatArray
    mass_velocity: FloatArray
    springs: CubicSprings
    parities: int

    @classmethod
    def of(cls, structure: StructureSpectra, absorbers: AbsorberSet) -> RingPlan | None:
        """Return the plan where the absorbers are many and make a ring, else None."""
        points = structure.points(absorbers)
        if 2 * absorbers.count < LINKS or isinstance(points, PointsAlone) or not _make_ring(absorbers):
            return None
        shapes = _independent(absorbers)
        if shapes.shape[0] != shapes.shape[1]:
            return None
        inverse, table = np.asarray(np.linalg.inv(shapes), dtype=np.float64), structure.kernels
        surfaces = tuple(int(x) for x in absorbers.surfaces[:, 0])
        maps = [points.maps_of(i) for i in surfaces]
        rows = [points.on_surface(i) for i in surfaces]
        evaluate = [inverse @ one[: absorbers.count] for one, _ in maps]
        project = [one[: absorbers.count].T @ shapes for _, one in maps]
        if any(one.size != absorbers.count for one in rows):
            return None
        steps = min(_STEPS if len(shapes) * _STEPS <= _BLOCK_NUMBERS else _STEPS // 2, table.steps)
        own = _of_classes(points, table.kernels[..., :steps], evaluate, project, surfaces)
        every = LinkConstants.of(absorbers, np.zeros(2 * absorbers.count) + own[:, [0, 1], [0, 1], 0].max(), structure.grid.time_step)
        if every.auxiliary_stiffness.any():
            return None
        links = _of_one(every)
        answer = block_response(links, np.ascontiguousarray(np.moveaxis(own, -1, 0)), np.zeros((steps, len(own), 2, 0)))
        stretch, force, mass_velocity = (_blocks(one) for one in (answer.stretch, answer.force, answer.mass_velocity))
        springs = CubicSprings(absorbers.cubic[:, None], np.zeros((absorbers.count, 1)))
        sums = HistorySum(table, points.parities)
        return cls(shapes, inverse, evaluate, project, surfaces, sums, links, stretch, force, mass_velocity, springs, points.parities)

    @property
    def classes(self) -> int:
        """Cosines and sines together."""
        return int(self.shapes.shape[1])

    @property
    def steps(self) -> int:
        """Number of steps of a block."""
        return int(self.mass_velocity.shape[1])

    def excited(self, modal: FloatArray) -> FloatArray:
        """Return velocities of the classes, (steps, 2, classes), of those of modes, (surfaces, parities, M + 1, steps)."""
        parts = [one @ modal[i].reshape(-1, modal.shape[-1]) for one, i in zip(self.evaluate, self.surfaces, strict=True)]
        return np.ascontiguousarray(np.stack(parts).transpose(2, 0, 1))

    def pressure(self, force: FloatArray, surfaces: int) -> FloatArray:
        """Return modal pressures (surfaces, parities, M + 1, steps) of line forces of the classes, (steps, 2, classes)."""
        found = np.zeros((surfaces, self.parities, self.project[0].shape[0] // self.parities, len(force)))
        for side, i in enumerate(self.surfaces):
            found[i] += (self.project[side] @ force[:, side].T).reshape(found.shape[1:])
        return found


def _make_ring(absorbers: AbsorberSet) -> bool:
    """Return whether absorbers are equal, but for their cubic springs, and stand at equal spacing."""
    if absorbers.elements is not None:
        return False
    held = () if absorbers.footprint is None else tuple(absorbers.footprint)
    if any(np.ptp(x) > 0 for x in (absorbers.mass, absorbers.damping, absorbers.linear, *absorbers.surfaces, *held)):
        return False
    angles = np.sort(absorbers.every_angle % 360.0)
    gaps = np.diff(np.append(angles, angles[0] + 360.0))
    return bool(np.all(np.abs(gaps - 360.0 / angles.size) <= 1e-9))


def _independent(absorbers: AbsorberSet) -> FloatArray:
    """Return cos l theta_n and, with two parities, sin l theta_n at the absorbers, (N, classes), without those that follow from others.

    Some vanish, and of an even number N the cosine and the sine of l = N/2 are the same but for a factor: the larger one stays.
    """
    count = absorbers.every_angle.size
    phase = np.radians(absorbers.angle)[:, None] * np.arange(count // 2 + 1)
    found = np.stack([np.cos(phase), np.sin(phase)][: absorbers.parities])
    largest = np.abs(found).max(axis=1)
    kept = largest > 1e-6
    if count % 2 == 0:
        kept[:, -1] = np.arange(len(found)) == largest[:, -1].argmax()
        kept[:, -1] &= largest[:, -1] > 1e-6
    return np.ascontiguousarray(found.transpose(1, 0, 2).reshape(absorbers.count, -1)[:, kept.ravel()])


def _of_classes(
    points: InterfacePoints, kernels: FloatArray, evaluate: list[FloatArray], project: list[FloatArray], surfaces: tuple[int, ...]
) -> FloatArray:
    """Return the velocities of each class per force of its own, at some lags: shape (classes, 2, 2, lags)."""
    found = np.empty((evaluate[0].shape[0], 2, 2, kernels.shape[-1]))
    for i, a in enumerate(surfaces):
        for j, b in enumerate(surfaces):
            found[:, i, j] = (evaluate[i] * project[j].T) @ np.tile(kernels[a, b], (points.parities, 1))
    return found


def _of_one(links: LinkConstants) -> LinkConstants:
    """Return the constants of one absorber of a ring."""
    both, n = slice(None, None, links.count), slice(0, 1)
    return LinkConstants(
        links.damping[both], links.stiffness[both], links.auxiliary_stiffness[n], links.inertia[n], links.mobility[n], links.half_step
    )


def _blocks(kernels: FloatArray) -> FloatArray:
    """Return the matrices (classes, lags * rows, lags * columns) that convolve a block with kernels (lags, classes, rows, columns)."""
    lags, classes, rows, columns = kernels.shape
    matrix = np.zeros((classes, lags, rows, lags, columns))
    for start in range(lags):
        matrix[:, start:, :, start] = kernels[: lags - start].swapaxes(0, 1)
    return matrix.reshape(classes, lags * rows, lags * columns)


def _by_class(matrix: FloatArray, values: FloatArray) -> FloatArray:
    """Return matrices (classes, rows, columns) times values (classes, columns)."""
    return np.asarray((matrix @ values[:, :, None])[:, :, 0])


class RingState(NamedTuple):
    """The state between two blocks, as :class:`coaxshell.solver.interface.state.MarchState`: with the plan it decides all after it.

    Attributes
    ----------
    force, displacement, velocity : ndarray, shape (2, classes)
    mass_displacement, mass_velocity : ndarray, shape (classes,)
        As :class:`coaxshell.solver.interface.state.LinkState`, of the classes.
    history : History
        Modal pressures so far.
    together : int
        Steps last solved together.
    """

    force: FloatArray
    displacement: FloatArray
    velocity: FloatArray
    mass_displacement: FloatArray
    mass_velocity: FloatArray
    history: History
    together: int

    @classmethod
    def at_rest(cls, plan: RingPlan) -> RingState:
        """Return the state before the first block."""
        forced, resting = np.zeros((3, 2, plan.classes)), np.zeros((2, plan.classes))
        return cls(forced[0], forced[1], forced[2], resting[0], resting[1], History(), plan.steps)


def march_ring(
    plan: RingPlan, displacement: FloatArray, velocity: FloatArray, surfaces: int, progress: Progress | None = None
) -> RingHistories:
    """March a ring over all times of the linear response.

    Parameters
    ----------
    plan : RingPlan
    displacement, velocity : ndarray, shape (T, 2, N)
        Of the points without absorbers.
    surfaces : int
        Of the structure.
    progress : callable, optional

    Raises
    ------
    TooStiffError
        If the iteration does not converge at single steps.
    """
    steps, c = len(displacement), plan.classes
    displacement, velocity = ((x.reshape(2 * steps, -1) @ plan.inverse.T).reshape(steps, 2, c) for x in (displacement, velocity))
    force, mass, iterations = np.zeros((steps, 2, c)), np.zeros((steps, c)), 0
    state = RingState.at_rest(plan)
    for first in range(1, steps, plan.steps):
        block = slice(first, min(first + plan.steps, steps))
        state, force[block], mass[block], taken = march_ring_block(plan, state, displacement[block], velocity[block], surfaces)
        iterations += taken
        if progress is not None:
            progress(block.stop / steps, "interface march")
    at_points = np.concatenate([plan.shapes @ np.ascontiguousarray(force[:, side].T) for side in (0, 1)])
    return RingHistories(at_points, plan.shapes @ np.ascontiguousarray(mass.T), iterations)


def march_ring_block(
    plan: RingPlan, state: RingState, displacement: FloatArray, velocity: FloatArray, surfaces: int
) -> tuple[RingState, FloatArray, FloatArray, int]:
    """Solve one block of steps, as :func:`coaxshell.solver.interface.march.march_block` does for all points.

    Parameters
    ----------
    plan : RingPlan
    state : RingState
        Stays as it is.
    displacement, velocity : ndarray, shape (steps, 2, classes)
        Of the block, without absorbers.
    surfaces : int
        Of the structure.

    Returns
    -------
    RingState
    ndarray, shape (steps, 2, classes)
        Forces.
    ndarray, shape (steps, classes)
        Displacements of the masses.
    int
        Iterations of all steps.

    Raises
    ------
    TooStiffError
    """
    links, count, half = plan.links, len(displacement), plan.links.half_step
    integral = half * (2.0 * np.tri(count, k=-1) + np.eye(count))
    excited = plan.excited(plan.kernels.forcing(state.history, count))
    free_w = _integrated(integral, excited) + (state.displacement + half * state.velocity)
    free_u = state.mass_velocity - links.mobility * state.force.sum(axis=0)
    free_q = state.mass_displacement + half * state.mass_velocity + integral.sum(axis=1)[:, None] * free_u
    free_stretch = free_q[:, None] - displacement - free_w
    drive = links.damping[:, None] * (free_u - velocity - excited) + links.stiffness[:, None] * free_stretch
    drive, size = _flat(drive), 2 * count
    known = _flat(free_stretch) + _by_class(plan.stretch[:, :size, :size], drive)
    inputs, together, iterations = _solve(plan, known, min(2 * state.together, plan.steps))
    inputs += drive
    force = _by_class(plan.force[:, :size, :size], inputs).reshape(-1, count, 2).transpose(1, 2, 0)
    u = _by_class(plan.mass_velocity[:, :count, :size], inputs).T
    mass = free_q + integral @ u
    history, own = plan.kernels.push(state.history, plan.pressure(force, surfaces))
    moved = plan.excited(own)
    after = RingState(
        force[-1],
        free_w[-1] + _integrated(integral[-1:], moved)[0],
        excited[-1] + moved[-1],
        mass[-1],
        free_u + u[-1],
        history,
        together,
    )
    return after, force, mass, iterations


def _integrated(rule: FloatArray, values: FloatArray) -> FloatArray:
    """Return a rule (instants, steps) of values (steps, 2, classes)."""
    return np.asarray(rule @ values.reshape(len(values), -1)).reshape(-1, *values.shape[1:])


def _flat(values: FloatArray) -> FloatArray:
    """Return values (steps, 2, classes) as (classes, 2 steps)."""
    return np.ascontiguousarray(values.transpose(2, 0, 1)).reshape(values.shape[2], -1)


def _solve(plan: RingPlan, known: FloatArray, together: int) -> tuple[FloatArray, int, int]:
    """Return n(z) of a block's steps, (classes, 2 steps), from z_known; how many steps were taken at once in the end; iterations."""
    found, done, iterations, end = np.zeros_like(known), 0, 0, known.shape[1]
    while done < end:
        part = slice(done, min(done + 2 * together, end))
        here = known[:, part]
        if done:
            here = here + _by_class(plan.stretch[:, part, :done], found[:, :done])
        solved, taken = _iterate(plan, here, _SLOWEST if together > 1 else _SLOWEST_ALONE)
        iterations += taken * (here.shape[1] // 2)
        if solved is not None:
            found[:, part], done = solved, part.stop
        elif together == 1:
            raise TooStiffError
        else:
            together //= 2
    return found, together, iterations


def _iterate(plan: RingPlan, known: FloatArray, slowest: float) -> tuple[FloatArray | None, int]:
    """Return n(z) of some steps by fixed-point iteration, None if a step of it gains too little; and its iterations."""
    size, springs = known.shape[1], plan.springs
    rows, z, last = plan.stretch[:, :size, :size], known, 0.0
    for iteration in range(1, _MOST_ITERATIONS + 1):
        nonlinear = plan.inverse @ springs.nonlinear_part(plan.shapes @ z)
        new = known + _by_class(rows, nonlinear)
        change = relative_size((new - z).ravel(), new.ravel())
        z, left = new, change
        if last > 0.0 and change > springs.tolerance:
            rate = change / last
            if not rate <= slowest:
                return None, iteration
            left = change * rate  # what the next one would change
        if left <= springs.tolerance:
            return plan.inverse @ springs.nonlinear_part(plan.shapes @ z), iteration
        last = change
    return None, _MOST_ITERATIONS
