"""The interface march: absorbers with any force law and saturating actuators, one small implicit solve a step.

Unknown are only the stretches D of the links and, where actuators saturate, the voltages asked for, together z. The shells and fluids
enter through their velocity kernels,

    dw/dt = (dw/dt)_linear + k * p,

summed by product integration; springs and masses are stepped by the trapezoidal rule. The step weights keep the positive real
part of the kernel and the trapezoidal rule keeps energy, so no step is unstable, however stiff or damped the absorbers. Where
actuators saturate the kernels are those without feedback, and the voltages given, clip(u), are forces like those of the links: a
law between 0 and 1 times that of the linear feedback, on a passive structure.

Time is worked through in blocks of a few steps. What came before a block, and what is linear in it, is summed for all its steps at
once; step by step remains z_n = z_known + sum_l Z_l n(z_{n-l}), n(z) what the nonlinear laws add to the linear ones. Where springs are
soft on the scale of a step, several steps are solved together instead.

A block is a function of the plan, the state before it and the motion without the interface: :func:`march_block`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from coaxshell.errors import InputError
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.progress import Progress
from coaxshell.solver.interface.absorbers import AbsorberSet
from coaxshell.solver.interface.actuator_march import march_actuators
from coaxshell.solver.interface.actuators_beside import march_beside
from coaxshell.solver.interface.held_step import NotSettledError
from coaxshell.solver.interface.newton import ConvergenceError, NewtonState
from coaxshell.solver.interface.plan import MarchPlan, MotionWithout, actuators_of, march_plan, motion_without
from coaxshell.solver.interface.ring_march import RingPlan, TooStiffError, march_ring
from coaxshell.solver.interface.state import LinkState, MarchState
from coaxshell.solver.links.histories import LawHistories
from coaxshell.solver.structure_spectra import StructureSpectra


@dataclass(frozen=True)
class MarchResult:
    """Histories of one march, dimensionless.

    Attributes
    ----------
    force : ndarray, shape (2N, T)
        Line forces at the interface points, positive inward.
    mass_displacement : ndarray, shape (N, T)
        Displacements q of the masses, positive inward.
    modal_pressure : ndarray, shape (surfaces, parities, M + 1, T)
        Pressure of links and saturating actuators together on every shell.
    actuation : ndarray, same shape, or None
        The actuators' share in that pressure, where they saturate.
    saturated : bool
        Whether any actuator reached its limit.
    iterations : int
        Iterations of all steps together.
    laws : LawHistories or None
        What links of any law did, where there are such: then ``modal_pressure`` is that of the middles of the steps.
    """

    force: FloatArray
    mass_displacement: FloatArray
    modal_pressure: FloatArray
    actuation: FloatArray | None
    saturated: bool
    iterations: int
    laws: LawHistories | None = None


class BlockOutput(NamedTuple):
    """What a block of steps adds to the histories.

    Attributes
    ----------
    force : ndarray, shape (steps, 2, N)
    mass_displacement : ndarray, shape (steps, N)
    volts : ndarray, shape (steps, amplitudes)
        Voltages given, in units of the limits.
    modal_pressure : ndarray, shape (surfaces, parities, M + 1, steps)
    """

    force: FloatArray
    mass_displacement: FloatArray
    volts: FloatArray
    modal_pressure: FloatArray


def march(structure: StructureSpectra, absorbers: AbsorberSet, *, saturate: bool = False, progress: Progress | None = None) -> MarchResult:
    """March the interface over all times of the linear response.

    Parameters
    ----------
    structure : StructureSpectra
    absorbers : AbsorberSet
        May be empty.
    saturate : bool
        Whether actuators stop at their field limit. The motion that the forces are added to is then that without feedback.
    progress : callable, optional

    Raises
    ------
    InputError
        If a step does not converge.
    """
    without_newton = _as_ring if not saturate else _actuators_beside if absorbers.count else _actuators_alone
    if (found_so := without_newton(structure, absorbers, progress)) is not None:
        return found_so
    plan = march_plan(structure, absorbers, saturate=saturate)
    motion = motion_without(structure, absorbers, plan.points, plan.actuators)
    steps, n = motion.steps, plan.count
    force, mass, volts = np.zeros((steps, 2, n)), np.zeros((steps, n)), np.zeros((steps, plan.actuators.amplitudes))
    pressure = np.zeros((plan.points.surfaces, plan.points.parities, plan.points.modes, steps))
    state = MarchState.at_rest(plan)
    while state.step < steps:
        block = slice(state.step, min(state.step + plan.length, steps))
        state, found = march_block(plan, state, motion[block])
        force[block], mass[block], volts[block], pressure[..., block] = found
        if progress is not None:
            progress(block.stop / steps, "interface march")
    actuation = plan.actuators.pressure(volts.T) if saturate and plan.actuators.controlled else None
    return MarchResult(force.reshape(steps, -1).T, mass.T, pressure, actuation, state.saturated, state.iterations)


def _as_ring(structure: StructureSpectra, absorbers: AbsorberSet, progress: Progress | None) -> MarchResult | None:
    """Return the march of a ring by the classes of its orders, None if the absorbers make none or are too stiff for it."""
    plan = RingPlan.of(structure, absorbers)
    if plan is None:
        return None
    points = structure.points(absorbers)
    displacement, velocity = (np.ascontiguousarray(x.T).reshape(-1, 2, absorbers.count) for x in structure.motion_at(points))
    try:
        found = march_ring(plan, displacement, velocity, points.surfaces, progress)
    except TooStiffError:
        return None
    return MarchResult(found.force, found.mass_displacement, points.project(found.force), None, False, found.iterations)


def _actuators_alone(structure: StructureSpectra, absorbers: AbsorberSet, progress: Progress | None) -> MarchResult | None:
    """Return the march of saturating actuators without absorbers, None if they return too much within a step for it."""
    found = march_actuators(structure, absorbers, progress)
    if found is None:
        return None
    steps = structure.grid.time.size
    actuators = actuators_of(structure, structure.points(absorbers), structure.controlled)
    pressure, none = actuators.pressure(found.given.reshape(-1, steps)), np.zeros((0, steps))
    return MarchResult(none, none, pressure, pressure, found.saturated, found.iterations)


def _actuators_beside(structure: StructureSpectra, absorbers: AbsorberSet, progress: Progress | None) -> MarchResult | None:
    """Return the march of saturating actuators beside absorbers by blocks, None if that does not converge."""
    try:
        found = march_beside(structure, absorbers, progress)
    except NotSettledError:
        return None
    if found is None:
        return None
    steps, points = structure.grid.time.size, structure.points(absorbers)
    force = found.force.reshape(steps, -1).T
    actuation = actuators_of(structure, points, structure.controlled).pressure(found.given.T)
    return MarchResult(force, found.mass_displacement.T, points.project(force) + actuation, actuation, found.saturated, found.iterations)


def march_block(plan: MarchPlan, state: MarchState, motion: MotionWithout) -> tuple[MarchState, BlockOutput]:
    """Solve one block of steps.

    Parameters
    ----------
    plan : MarchPlan
    state : MarchState
        Before the block; it stays as it is.
    motion : MotionWithout
        At the block's steps, at most ``plan.length``; fewer only in the last one.

    Returns
    -------
    MarchState
        After it.
    BlockOutput

    Raises
    ------
    InputError
        If a step does not converge.
    """
    n, links, count = plan.count, plan.links, motion.steps
    before, half = state.links, links.half_step
    integral = plan.integral[:count, :count]
    history_forcing = plan.kernels.forcing(state.history, count)
    excited = plan.points.evaluate(history_forcing[: plan.points.surfaces]).T
    free_w = integral @ excited
    excited, free_w = excited.reshape(count, 2, n), free_w.reshape(count, 2, n) + (before.displacement + half * before.velocity)
    free_u = before.mass_velocity - links.mobility * before.force.sum(axis=0)
    free_q = before.mass_displacement + half * before.mass_velocity + integral.sum(axis=1)[:, None] * free_u
    free_stretch = free_q[:, None] - motion.displacement - free_w
    parting = free_u - motion.velocity - excited
    drive = (links.damping.reshape(2, n) * parting + links.stiffness.reshape(2, n) * free_stretch).reshape(count, -1)
    demanded = motion.demanded_voltage
    if plan.actuators.controlled:
        demanded = demanded + plan.actuators.of_limits(history_forcing[plan.points.surfaces :]).reshape(-1, count).T
    solved = _nonlinear_parts(plan, state, np.concatenate([free_stretch.reshape(count, -1), demanded], axis=1), drive)
    inputs = solved.nonlinear_part
    inputs[:, : 2 * n] += drive
    flat = inputs.ravel()
    force = (plan.force_of_input[: 2 * n * count, : flat.size] @ flat).reshape(count, 2, n)
    u = (plan.mass_velocity_of_input[: n * count, : flat.size] @ flat).reshape(count, n)
    mass = free_q + integral @ u
    volts = inputs[:, 2 * n :]
    pressure = plan.points.project(force.reshape(count, -1).T)
    if plan.actuators.controlled:
        pressure = pressure + plan.actuators.pressure(volts.T)
    history, own = plan.kernels.push(state.history, pressure)
    moved = plan.points.evaluate(own[: plan.points.surfaces]).T.reshape(count, 2, n)
    after = LinkState(force[-1], free_w[-1], excited[-1], mass[-1], free_u + u[-1]).moved(moved, plan.integral[count - 1, :count])
    iterations, saturated = state.iterations + solved.iterations, state.saturated or solved.saturated
    left = MarchState(state.step + count, after, history, solved.newton, solved.relaxed, iterations, saturated)
    return left, BlockOutput(force, mass, volts, pressure)


class _BlockSolution(NamedTuple):
    nonlinear_part: FloatArray
    newton: NewtonState
    relaxed: FloatArray | None
    iterations: int
    saturated: bool


def _nonlinear_parts(plan: MarchPlan, state: MarchState, known: FloatArray, drive: FloatArray) -> _BlockSolution:
    """Return n(z) at the steps of a block, shape (steps, unknowns), from z_known without inputs and the inputs of the links."""
    count, links = len(known), drive.shape[1]
    found = np.zeros_like(known)
    found[:, :links] = drive
    known = known + (plan.rows[: known.size, : known.size] @ found.ravel()).reshape(known.shape)
    newton, relaxed, iterations, done = _relax_steps(plan, state, known, found)
    flat, demanded = found.ravel(), []
    solve, nonlinear_part = plan.newton.solve, plan.law.nonlinear_part
    try:
        for step in range(done, count):
            earlier = plan.earlier[step]
            z, taken, newton = solve(newton, known[step] + earlier @ flat[: earlier.shape[1]] if step else known[step])
            iterations += taken
            found[step] = nonlinear_part(z)
            demanded.append(z[links:])
    except ConvergenceError:
        raise _did_not_converge(plan) from None
    saturated = bool(plan.actuators.controlled) and plan.voltages.saturates(np.array(demanded))
    return _BlockSolution(found, newton, relaxed, iterations, saturated)


def _relax_steps(
    plan: MarchPlan, state: MarchState, known: FloatArray, found: FloatArray
) -> tuple[NewtonState, FloatArray | None, int, int]:
    """Fill in n(z) of the first steps, several at once, as long as that pays.

    Returns Newton's state for the steps after them, z of the steps last solved so (None once it does not pay), iterations, and how many.
    """
    flat, unknowns, done, iterations = found.ravel(), known.shape[1], 0, 0
    newton, relaxed = state.newton, state.relaxed
    while relaxed is not None and done < len(known):
        end = min(done + plan.relaxation.steps, len(known))
        part, before = slice(done * unknowns, end * unknowns), slice(0, done * unknowns)
        solved = plan.relaxation.solve(known[done:end] + (plan.rows[part, before] @ flat[before]).reshape(-1, unknowns))
        if solved is None:
            newton, relaxed = newton.seeded(relaxed), None
        else:
            found[done:end], relaxed, done = solved.nonlinear_part, solved.z, end
            iterations += solved.iterations
    return newton, relaxed, iterations, done


def _did_not_converge(plan: MarchPlan) -> InputError:
    if plan.links.auxiliary_stiffness.any():  # no step helps: the tangent is singular wherever both springs pass through rest
        remedy = "give them a linear stiffness, however small, such as 1 kN/m^2, or a mass"
        loose = "without mass, cubic springs alone leave them loose at rest, and their forces did not converge"
        return InputError("absorbers", loose, remedy)
    guilty = [name for name, there in (("absorbers", plan.count), ("saturating actuators", plan.actuators.controlled)) if there]
    coarse = f"steps of {plan.time_step:g} (time_step/refinement) are too coarse for the {' and '.join(guilty)}"
    remedy = "use a quarter of time_step, or four times the refinement"
    return InputError("time_step", f"{coarse}: their forces did not converge", remedy)
