"""The march of links of any law: the interface march in the means over the steps, which keeps the energy of every law.

With x~_n = (x_n + x_{n-1})/2, what is linear in the march of :mod:`coaxshell.solver.interface.march` holds between the means as it does
between the instants: kernels f~ -> v~, the trapezoidal rule, masses and dampers. There D~_n - D~_{n-1} = (r~_n + r~_{n-1}) dt/2 follows
from r~_n = (D_n - D_{n-1})/dt, so that a force f~_n over a step does the work f~_n (D_n - D_{n-1}), and the laws' own forces over a step
(:mod:`coaxshell.solver.links.law`) lose no energy that they do not tell. f~_n is the force of the middle of the step.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from coaxshell.errors import InputError
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.convolution import History
from coaxshell.numerics.progress import Progress
from coaxshell.solver.interface.absorbers import AbsorberSet
from coaxshell.solver.interface.march import MarchResult
from coaxshell.solver.interface.newton import ConvergenceError
from coaxshell.solver.interface.plan import MarchPlan, MotionWithout, march_plan, motion_without
from coaxshell.solver.interface.state import LinkState
from coaxshell.solver.links.described import assembled
from coaxshell.solver.links.histories import LawHistories, at_instants, best_springs
from coaxshell.solver.links.laws import LawState, LinkLaws
from coaxshell.solver.links.step import LawSolver, compliance
from coaxshell.solver.structure_spectra import StructureSpectra


@dataclass(frozen=True)
class _Plan:
    """Constants: those of the linear parts, the laws, the solver of a step, and the laws that are linear."""

    linear: MarchPlan
    laws: LinkLaws
    solver: LawSolver


class _State(NamedTuple):
    """What a march of links has become by some step."""

    links: LinkState
    history: History
    laws: LawState
    added: FloatArray


class _Block(NamedTuple):
    """Means over the steps of a block, forces (steps, 2N), u (steps, N) and pressure; D and stored energy (steps, 2N) at the instants."""

    force: FloatArray
    added: FloatArray
    velocity: FloatArray
    pressure: FloatArray
    stretch: FloatArray
    stored: FloatArray
    iterations: int
    stiffest: float


def march_links(
    structure: StructureSpectra, absorbers: AbsorberSet, *, saturate: bool = False, progress: Progress | None = None
) -> MarchResult:
    """March absorbers of any law over all times of the linear response.

    Raises
    ------
    InputError
        If actuators are to saturate, or a step does not converge.
    """
    if saturate:
        problem = "true is not marched beside absorbers whose links have laws"
        raise InputError("control.saturation", problem, "use saturation = false, or cubic springs alone")
    assert absorbers.elements is not None
    linear = march_plan(structure, absorbers)
    step, n = linear.time_step, linear.count
    response, cubic = linear.rows[: 2 * n, : 2 * n], np.tile(absorbers.cubic, 2) * absorbers.elements.present
    laws = assembled(absorbers.elements.elements, step, cubic, compliance(response))
    plan = _Plan(linear, laws, LawSolver(response, laws, np.tile(linear.links.auxiliary_stiffness, 2)))
    motion = _means(motion_without(structure, absorbers, linear.points, linear.actuators), step)
    force, added, stretch, stored = np.zeros((4, motion.steps, 2 * n))
    velocity = np.zeros((motion.steps, n))
    pressure = np.zeros((linear.points.surfaces, linear.points.parities, linear.points.modes, motion.steps))
    state = _State(LinkState(*np.zeros((3, 2, n)), *np.zeros((2, n))), History(), laws.at_rest(), np.zeros(2 * n))
    iterations, stiffest = 0, 0.0
    for first in range(1, motion.steps, linear.length):
        block = slice(first, min(first + linear.length, motion.steps))
        state, found = _march_block(plan, state, motion[block])
        force[block], added[block], velocity[block], pressure[..., block], stretch[block], stored[block] = found[:6]
        iterations, stiffest = iterations + found.iterations, max(stiffest, found.stiffest)
        if progress is not None:
            progress(block.stop / motion.steps, "march of the absorbers")
    histories = _histories(plan, absorbers, force, added, velocity, stretch, stored, 2.0 * np.sqrt(stiffest))
    displacement = np.cumsum(velocity, axis=0) * step
    return MarchResult(at_instants(force.T), displacement.T, pressure, None, False, iterations, histories)


def _means(motion: MotionWithout, step: float) -> MotionWithout:
    """Return the means of the displacement over the steps before the instants, and of the velocity, whose integral it is.

    At t = 0 all is at rest, as the links are: the little that the band limit leaves of w there would go on in their stretches,
    D_n = 2 D~_n - D_{n-1}, with a sign that changes at every step.
    """
    w = motion.displacement.copy()
    w[0] = 0.0
    before = np.concatenate([np.zeros_like(w[:1]), w[:-1]])
    return MotionWithout(0.5 * (w + before), (w - before) / step, motion.demanded_voltage)


def _march_block(plan: _Plan, state: _State, motion: MotionWithout) -> tuple[_State, _Block]:
    """Solve one block of steps, in the means; the linear parts as in :func:`coaxshell.solver.interface.march.march_block`."""
    linear, before = plan.linear, state.links
    n, links, count, half = linear.count, linear.links, motion.steps, linear.links.half_step
    integral = linear.integral[:count, :count]
    excited = linear.points.evaluate(linear.kernels.forcing(state.history, count)[: linear.points.surfaces]).T
    free_w = (integral @ excited).reshape(count, 2, n) + (before.displacement + half * before.velocity)
    excited = excited.reshape(count, 2, n)
    free_u = before.mass_velocity - links.mobility * before.force.sum(axis=0)
    free_q = before.mass_displacement + half * before.mass_velocity + integral.sum(axis=1)[:, None] * free_u
    free_stretch = free_q[:, None] - motion.displacement - free_w
    parting = free_u - motion.velocity - excited
    drive = (links.damping.reshape(2, n) * parting + links.stiffness.reshape(2, n) * free_stretch).reshape(count, -1)
    size = 2 * n
    known = free_stretch.reshape(count, -1) + (linear.rows[: drive.size, : drive.size] @ drive.ravel()).reshape(count, -1)
    added, stretch, stored = np.zeros((3, count, size))
    flat, laws, guess, iterations, stiffest = added.ravel(), state.laws, state.added, 0, 0.0
    for step in range(count):
        earlier = linear.earlier[step]
        mean = known[step] + earlier @ flat[: earlier.shape[1]] if step else known[step]
        try:
            solved = plan.solver.solve(mean, guess, laws)
        except ConvergenceError:
            raise _did_not_converge(linear.time_step) from None
        added[step], stretch[step], guess, laws = solved.added, solved.state.stretch, solved.added, solved.state
        stored[step] = plan.laws.stored(laws)
        iterations, stiffest = iterations + solved.iterations, max(stiffest, solved.stiffest)
    inputs = (added + drive).ravel()
    force = (linear.force_of_input[: 2 * n * count, : inputs.size] @ inputs).reshape(count, 2, n)
    u = (linear.mass_velocity_of_input[: n * count, : inputs.size] @ inputs).reshape(count, n)
    mass = free_q + integral @ u
    pressure = linear.points.project(force.reshape(count, -1).T)
    history, own = linear.kernels.push(state.history, pressure)
    moved = linear.points.evaluate(own[: linear.points.surfaces]).T.reshape(count, 2, n)
    after = LinkState(force[-1], free_w[-1], excited[-1], mass[-1], free_u + u[-1]).moved(moved, linear.integral[count - 1, :count])
    block = _Block(force.reshape(count, -1), added, free_u + u, pressure, stretch, stored, iterations, stiffest)
    return _State(after, history, laws, guess), block


def _histories(
    plan: _Plan,
    absorbers: AbsorberSet,
    force: FloatArray,
    added: FloatArray,
    velocity: FloatArray,
    stretch: FloatArray,
    stored: FloatArray,
    angle: float,
) -> LawHistories:
    """Return the histories of a march from those of its blocks, (steps, 2N) each, velocities (steps, N)."""
    links, step = plan.linear.links, plan.linear.time_step
    lent = np.tile(links.auxiliary_stiffness, 2)
    before = np.concatenate([np.zeros_like(stretch[:1]), stretch[:-1]])
    change, middle = stretch - before, 0.5 * (stretch + before)
    by_laws = added + lent * middle
    damped = np.cumsum(links.damping * change**2 / step, axis=0)
    lost = np.cumsum(by_laws * change, axis=0) - stored
    stored = stored + 0.5 * (links.stiffness - lent) * stretch**2
    of_masses = np.zeros_like(velocity)
    for n in range(1, len(velocity)):
        of_masses[n] = 2.0 * velocity[n] - of_masses[n - 1]
    linear = best_springs(absorbers, middle.T, change.T / step, by_laws.T)
    return LawHistories(force.T, stretch.T, of_masses.T, stored.T, damped.T, lost.T, linear, angle)


def _did_not_converge(step: float) -> InputError:
    coarse = f"steps of {step:g} (time_step/refinement) are too coarse for the laws of the absorbers: their forces did not converge"
    return InputError("time_step", coarse, "use a quarter of time_step, or four times the refinement")
