"""The march of saturating actuators beside absorbers: history sums by blocks of steps, each step by its few unknowns.

Within a step let p be modal pressures, of actuators F g and of links P f, g = u + l the voltages given in units of the limits, T_v and
T_u the first weights of the velocities' and voltages' kernels, one a mode, E values at the points of the links, and C = (1 - T_u F)^-1:

    u = C [u_k + T_u F l + T_u P f],        v = v_k + E T_v F C (u_k + l) + (E T_v P + E T_v F C T_u P) f,

u_k and v_k known before the step. The links answer v by their trapezoidal rule
(:mod:`coaxshell.solver.interface.block_response`, a block of one step with the last matrix for its kernel); the lack l and the cubic
springs are left to :class:`coaxshell.solver.interface.held_step.HeldStep`. Where that does not end, or most points are held, the march
of any interface (:mod:`coaxshell.solver.interface.march`) does it all.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.convolution import History, HistorySum, KernelTable
from coaxshell.numerics.progress import Progress
from coaxshell.solver.interface.absorbers import AbsorberSet, InterfacePoints, PointsAlone
from coaxshell.solver.interface.block_response import LinkConstants, block_response
from coaxshell.solver.interface.held_step import Held, HeldStep, Linear
from coaxshell.solver.interface.laws import CubicSprings
from coaxshell.solver.interface.plan import Actuators, actuators_of, answer_of, motion_without
from coaxshell.solver.interface.saturation import CircleSums
from coaxshell.solver.interface.state import LinkState
from coaxshell.solver.structure_spectra import StructureSpectra

_LENGTH = 8
"""Steps of a block."""


class BesideHistories(NamedTuple):
    """Histories of the march, as :class:`coaxshell.solver.interface.march.MarchResult` has them.

    Attributes
    ----------
    force, mass_displacement : ndarray, shapes (T, 2, N) and (T, N)
    given : ndarray, shape (T, controlled * K)
        Voltages, in units of the limits.
    saturated : bool
    iterations : int
    """

    force: FloatArray
    mass_displacement: FloatArray
    given: FloatArray
    saturated: bool
    iterations: int


@dataclass(frozen=True, eq=False)
class BesidePlan:
    """Constants of such a march.

    Attributes
    ----------
    points : InterfacePoints or PointsAlone
    actuators : Actuators
    links : LinkConstants
    kernels : HistorySum
        Velocities, then voltages, of the modal pressures so far.
    recent : ndarray, shape (M + 1, surfaces + controlled, surfaces * (L - 1))
        Of the pressures of the last steps of a block of L, the oldest first; voltages in units of the limits.
    closed : ndarray, shape (M + 1, controlled, controlled)
        C: voltages asked for, over what they were if no actuator acted within the step.
    felt : ndarray, shape (2N, controlled * K)
        Velocities of the points per voltage given within the step.
    of_force : ndarray, shape (2N, 2N)
        The same per force of the links.
    linear : Linear
        What is linear within a step.
    law, mass_velocity : ndarray, shapes (2N, 2N) and (N, 2N)
        Forces of the links and velocities of the masses per input b.
    step : HeldStep
    """

    points: InterfacePoints | PointsAlone
    actuators: Actuators
    links: LinkConstants
    kernels: HistorySum
    recent: FloatArray
    closed: FloatArray
    felt: FloatArray
    of_force: FloatArray
    linear: Linear
    law: FloatArray
    mass_velocity: FloatArray
    step: HeldStep

    @classmethod
    def of(cls, structure: StructureSpectra, absorbers: AbsorberSet) -> BesidePlan | None:
        """Return the plan; None where springs are loose, which Newton's method of all unknowns is left to tell."""
        points, table = structure.points(absorbers), structure.kernels_with_voltage
        actuators, surfaces = actuators_of(structure, points, structure.controlled), points.surfaces
        of_velocity, of_voltage = table.present[:surfaces], table.present[surfaces:] / actuators.limits[:, None, None]
        own = of_voltage[:, actuators.controlled] * actuators.full_pressure[:, None]
        closed = np.asarray(np.linalg.inv(np.eye(len(own)) - own.transpose(2, 0, 1)), dtype=np.float64)
        shape = len(own), points.parities, points.modes
        given = actuators.pressure(np.eye(actuators.amplitudes))
        felt = points.evaluate(answer_of(of_velocity, given))
        asked = answer_of(of_voltage, points.project(np.eye(points.count)))
        asked = np.einsum("mij,jhma->ihma", closed, asked).reshape(-1, points.count)
        felt_closed = np.einsum("aihm,mij->ajhm", felt.reshape(-1, *shape), closed).reshape(felt.shape)
        of_force = points.immediate(of_velocity)
        kernel = of_force + felt @ asked
        links = LinkConstants.of(absorbers, np.diag(kernel), structure.grid.time_step)
        if links.auxiliary_stiffness.any():
            return None
        response = block_response(links, kernel[None], np.zeros((1, points.count, 0)))
        law, half = response.force[0], links.half_step
        answered = np.tile((closed @ own.transpose(2, 0, 1)).transpose(1, 2, 0), (1, 1, points.parities))
        linear = Linear(answered, felt_closed, links.damping + half * links.stiffness, half, response.stretch[0], asked @ law)
        springs = CubicSprings(np.tile(absorbers.cubic, 2), np.zeros(points.count))
        return cls(
            points=points,
            actuators=actuators,
            links=links,
            kernels=HistorySum(table, points.parities),
            recent=_recent(table, surfaces, actuators.limits),
            closed=closed,
            felt=felt,
            of_force=of_force,
            linear=linear,
            law=law,
            mass_velocity=response.mass_velocity[0],
            step=HeldStep(linear, springs, CircleSums(points.modes, points.parities), shape),
        )


def _recent(table: KernelTable, surfaces: int, limits: FloatArray) -> FloatArray:
    """Return the weights of the last steps of a block, as :class:`BesidePlan` has them."""
    weights = np.zeros((*table.shape, _LENGTH))
    few = table.kernels[..., :_LENGTH]
    weights[..., : few.shape[-1]] = few
    weights[surfaces:] /= limits[:, None, None, None]
    ordered = weights[..., :0:-1].transpose(2, 0, 3, 1)
    return np.ascontiguousarray(ordered).reshape(table.shape[2], table.shape[0], -1)


def march_beside(structure: StructureSpectra, absorbers: AbsorberSet, progress: Progress | None = None) -> BesideHistories | None:
    """March saturating actuators beside absorbers over all times of the linear response; None where springs are loose.

    Raises
    ------
    NotSettledError
        If a step does not end.
    """
    plan = BesidePlan.of(structure, absorbers)
    if plan is None:
        return None
    motion = motion_without(structure, absorbers, plan.points, plan.actuators)
    steps, n, parities, modes = motion.steps, absorbers.count, plan.points.parities, plan.points.modes
    force, mass, given = np.zeros((steps, 2, n)), np.zeros((steps, n)), np.zeros((steps, plan.actuators.amplitudes))
    state, held, saturated, iterations = LinkState(*np.zeros((3, 2, n)), *np.zeros((2, n))), plan.step.at_rest(), False, 0
    history = History()
    for first in range(1, steps, _LENGTH):  # at rest at t = 0
        block = slice(first, min(first + _LENGTH, steps))
        forcing = plan.kernels.forcing(history, block.stop - first)
        excited = plan.points.evaluate(forcing[: plan.points.surfaces]).T
        asked = motion.demanded_voltage[block] + plan.actuators.of_limits(forcing[plan.points.surfaces :]).reshape(-1, len(excited)).T
        pressure = np.zeros((modes, plan.points.surfaces * len(excited), parities))
        for n_step, step in enumerate(range(block.start, block.stop)):
            known = _Known(excited[n_step], asked[n_step], motion.displacement[step], motion.velocity[step])
            state, held, given[step] = _march_step(plan, state, held, known, pressure, n_step)
            force[step], mass[step] = state.force, state.mass_displacement
            saturated, iterations = saturated or bool(held.sides.any()), iterations + held.iterations
        ordered = pressure.reshape(modes, len(excited), -1, parities).transpose(2, 3, 0, 1)
        history, _ = plan.kernels.push(history, np.ascontiguousarray(ordered))
        if progress is not None:
            progress(block.stop / steps, "interface march")
    return BesideHistories(force, mass, given, saturated, iterations)


class _Known(NamedTuple):
    """What is known of a step: velocities (2N,) and voltages asked for (controlled * K,) by steps before its block; motion without all."""

    excited: FloatArray
    asked: FloatArray
    displacement: FloatArray
    velocity: FloatArray


def _march_step(
    plan: BesidePlan, before: LinkState, held: Held, known: _Known, pressure: FloatArray, done: int
) -> tuple[LinkState, Held, FloatArray]:
    """Solve one step; ``pressure``, (M + 1, surfaces * steps, parities), holds those of the ``done`` steps of the block, and then its own.

    Returns the links and the actuators after it, and the voltages given.
    """
    points, links, linear, surfaces = plan.points, plan.links, plan.linear, plan.points.surfaces
    half, n, walls = links.half_step, links.count, len(plan.actuators.controlled)
    excited, asked = known.excited, known.asked
    if done:
        lately = plan.recent[:, :, -surfaces * done :] @ pressure[:, : surfaces * done]
        lately = lately.transpose(1, 2, 0)
        excited = excited + points.evaluate(lately[:surfaces])
        asked = asked + lately[surfaces:].ravel()
    closed = (plan.closed @ asked.reshape(walls, -1, points.modes).transpose(2, 0, 1)).transpose(1, 2, 0).reshape(walls, -1)
    felt = excited.reshape(2, n)
    free_w = half * felt + (before.displacement + half * before.velocity)
    free_u = before.mass_velocity - links.mobility * before.force.sum(axis=0)
    free_q = before.mass_displacement + half * before.mass_velocity + half * free_u
    free_stretch = (free_q - known.displacement - free_w).ravel()
    drive = links.damping * (free_u - known.velocity - felt).ravel() + links.stiffness * free_stretch
    moved = linear.felt @ asked
    inputs = drive - linear.tangent * moved
    held = plan.step.solve(
        closed + (linear.asked @ inputs).reshape(walls, -1),
        free_stretch - half * moved + linear.stretch @ inputs,
        float(np.abs(inputs).max()),
        held,
    )
    given = (held.asked + held.lack).ravel()
    inputs += held.nonlinear - linear.tangent * (linear.felt @ held.lack.ravel())
    force, u = plan.law @ inputs, plan.mass_velocity @ inputs
    pushed = points.project(force) + plan.actuators.pressure(given)
    pressure[:, surfaces * done : surfaces * (done + 1)] = pushed.transpose(2, 0, 1)
    own = (plan.felt @ given + plan.of_force @ force).reshape(2, n)
    after = LinkState(force.reshape(2, n), free_w + half * own, felt + own, free_q + half * u, free_u + u)
    return after, held, given
