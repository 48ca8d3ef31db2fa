"""How far a stable loop is from growing: gain, phase and delay margins of the feedback of each shell, by order.

Where walls answer each other the loop of one is all that its amplifier drives, of the same determinants.

With the loops of all other shells closed, that of one is 1 - L = D_m/D_m', D_m' without its feedback. On Re s = sigma_0, the least growth
that counts, it would vanish if the gain were 1/L where L is real and positive, if the phase turned by arg L where |L| = 1, and if the
answer came later by (arg L)/omega there. Between nodes log L is taken as linear.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.modes import Modes
from coaxshell.numerics.progress import ShareDone
from coaxshell.numerics.winding import turning
from coaxshell.solver.contour import SPACING, Contour, along_alone, fed_orders, few_of
from coaxshell.solver.electrode_loops import ElectrodeLoops, determinant_of
from coaxshell.solver.electrode_patterns import OrderPatterns
from coaxshell.solver.scaling import Problem
from coaxshell.solver.stability import opened
from coaxshell.solver.tied_stability import Tied
from coaxshell.solver.voltage_response import controlled

_BLOCK = 512
FURTHER = 10.0
"""How far beyond where feedback fades to half of the inertia a loop is followed: to gain margins of about as much."""


@dataclass(frozen=True)
class LoopMargins:
    """Margins of the loop of one shell, each of an order; infinite where no change of that kind makes it grow.

    Attributes
    ----------
    orders : ndarray, shape (orders,)
    gain : ndarray
        Least factor above 1.
    lesser_gain : ndarray
        Largest factor below 1, 0 where there is none.
    phase : ndarray
        Radians.
    delay : ndarray
        Transits, beyond the delay that the law has.
    gain_frequency, phase_frequency, delay_frequency : ndarray
        Where, radians per transit; NaN where a margin is infinite.
    """

    orders: FloatArray
    gain: FloatArray
    lesser_gain: FloatArray
    phase: FloatArray
    delay: FloatArray
    gain_frequency: FloatArray
    phase_frequency: FloatArray
    delay_frequency: FloatArray


class Loop(NamedTuple):
    """L of a shell's loop: nodes on Re s = sigma_0, ascending, and L of each order there, shape (orders, nodes)."""

    nodes: ComplexArray
    values: ComplexArray


class Loops(NamedTuple):
    """The loops of all shells at the same nodes.

    Attributes
    ----------
    each : dict of int to Loop
        Of each shell that feeds anything back, by its number.
    ratio : ndarray, shape (orders, nodes)
        D_m/D0_m of the orders that are fed back.
    even : int
        How many nodes stand at an even step, as far as any order resonates.
    """

    each: dict[int, Loop]
    ratio: ComplexArray
    even: int

    @property
    def surely_stable(self) -> bool:
        """Whether D_m/D0_m turns by nothing, and nowhere beyond the resonances so fast that nodes would have to lie closer."""
        turns = turning(self.ratio) + np.angle(1.0 / self.ratio[:, -1])
        beyond = self.ratio[:, self.even - 1 :]
        slow = np.abs(np.angle(beyond[:, 1:] / beyond[:, :-1])).max() <= SPACING
        return bool(slow and (np.rint(-turns / np.pi) <= 0.0).all())


def loops(problem: Problem, tied: Tied, least: float, told: ShareDone = lambda _: None) -> Loops:
    """Return L of the loop of each shell that feeds anything back on Re s = *least* or a little more, 0 of orders that no law weighs.

    Of one wave, or of all that electrodes tie to it along the axis. *told* hears the share of the nodes that are done, and may
    end it by an exception.
    """
    modes = tied.modes
    fed = fed_orders(problem, modes)
    some = few_of(modes, fed if fed.size else modes.orders[:1]) if tied.alone else modes
    contour, rows = Contour.of(problem, modes, least), np.searchsorted(modes.orders, some.orders)
    nodes = contour._replace(fades=FURTHER * contour.fades).nodes
    problem = along_alone(problem, some)
    if problem.tied:
        ratio, found = _tied(problem, Tied(some) if tied.alone else tied, nodes, told)
    else:
        ratio, found = _alone(problem, some, nodes, told)
    each = {}
    for shell, values in found.items():
        whole = np.zeros((modes.count, nodes.size), np.complex128)
        whole[rows] = values
        each[shell] = Loop(nodes, whole)
    return Loops(each, ratio, contour.even.size)


def _alone(problem: Problem, modes: Modes, nodes: ComplexArray, told: ShareDone) -> tuple[ComplexArray, dict[int, ComplexArray]]:
    """Return D/D0, and L of each shell that feeds anything back to itself, (orders, nodes)."""
    shells = [i for i, wall in enumerate(problem.shells) if wall.gains is not None and not wall.gains.zero]
    values = np.empty((len(shells), modes.count, nodes.size), dtype=np.complex128)
    ratio, passive = np.empty((modes.count, nodes.size), np.complex128), problem.open_loop
    without = [_without(problem, shell) for shell in shells]
    for start in range(0, nodes.size, _BLOCK):
        block = slice(start, start + _BLOCK)
        open_loop = opened(problem, passive, nodes[block], modes, None)
        ratio[:, block] = open_loop.closed(problem, nodes[block], modes)
        for loop, others in zip(values, without, strict=True):
            loop[:, block] = 1.0 - ratio[:, block] / open_loop.closed(others, nodes[block], modes)
        told(min(1.0, block.stop / nodes.size))
    return ratio, dict(zip(shells, values, strict=True))


def _matrices(problem: Problem, passive: Problem, tied: Tied, nodes: ComplexArray) -> Iterator[tuple[slice, ComplexArray]]:
    """Yield 1 - H K C of blocks of nodes, (orders, nodes, walls, walls), where the actuators of walls answer other walls."""
    for start in range(0, nodes.size, _BLOCK):
        block = slice(start, start + _BLOCK)
        answers = tied.response(passive, problem, nodes[block])
        yield block, ElectrodeLoops.of(problem, answers, OrderPatterns(tied.modes.orders, 1), nodes[block]).matrix


def _tied(problem: Problem, tied: Tied, nodes: ComplexArray, told: ShareDone) -> tuple[ComplexArray, dict[int, ComplexArray]]:
    """Return D/D0, and L of what the actuators of each wall answer, cut at their amplifier, (orders, nodes); none of walls without any."""
    shells = controlled(problem)
    values = np.empty((len(shells), tied.modes.count, nodes.size), dtype=np.complex128)
    ratio = np.empty((tied.modes.count, nodes.size), np.complex128)
    for block, matrix in _matrices(problem, problem.open_loop, tied, nodes):
        ratio[:, block] = determinant_of(matrix)
        for wall, loop in enumerate(values):
            others = np.delete(np.delete(matrix, wall, axis=2), wall, axis=3)
            loop[:, block] = 1.0 - ratio[:, block] / determinant_of(others)
        told(min(1.0, block.stop / nodes.size))
    return ratio, {shell: one for shell, one in zip(shells, values, strict=True) if one.any()}


def loop_margins(problem: Problem, modes: Modes, least: float) -> dict[int, LoopMargins]:
    """Return the margins of the loop of each shell that feeds anything back, by its number, in a stable system."""
    return {shell: margins_of(modes.orders, *loop) for shell, loop in loops(problem, Tied(modes), least).each.items()}


def common_loop(problem: Problem, modes: Modes, least: float) -> list[Loop]:
    """Return the eigenvalues of all loops together, one Loop each: with a common factor z on all laws D_m/D0_m = prod (1 - z lambda).

    With one shell under control that is its L. D_m/D0_m is a polynomial in z, 1 at z = 0, known from as many other places as there are
    loops. Eigenvalues are followed from node to node by the permutation that moves them least.
    """
    shells = [i for i, wall in enumerate(problem.shells) if wall.gains is not None and not wall.gains.zero]
    if problem.tied:
        nodes = Contour.of(problem, modes, least).nodes
        found = [np.linalg.eigvals(np.eye(one.shape[-1]) - one) for _, one in _matrices(problem, problem.open_loop, Tied(modes), nodes)]
        return [Loop(nodes, one) for one in followed(np.moveaxis(np.concatenate(found, axis=1), -1, 0))]
    places = np.array([(-1.0) ** j * (1.0 - (j // 2) / len(shells)) for j in range(len(shells))])
    contour, problem = Contour.of(problem, modes, least), along_alone(problem, modes)
    scaled = [_times(problem, float(z)) for z in places]
    powers = np.linalg.inv(np.vander(places, len(shells) + 1, increasing=True)[:, 1:])
    nodes, passive = contour.nodes, problem.open_loop
    values = np.empty((len(shells), modes.count, nodes.size), dtype=np.complex128)
    for start in range(0, nodes.size, _BLOCK):
        block = nodes[start : start + _BLOCK]
        open_loop = opened(problem, passive, block, modes, None)
        closed = np.stack([open_loop.closed(one, block, modes) - 1.0 for one in scaled])
        values[..., start : start + _BLOCK] = _eigenvalues(np.einsum("kj,jmn->kmn", powers, closed))
    return [Loop(nodes, one) for one in followed(values)]


def _eigenvalues(coefficients: ComplexArray) -> ComplexArray:
    """Return the roots of x^n + c_1 x^(n-1) + ... + c_n, shape (n, ...) as the coefficients have."""
    count = len(coefficients)
    if count == 1:
        return -coefficients
    companion = np.zeros((*coefficients.shape[1:], count, count), dtype=np.complex128)
    companion[..., 0, :] = -np.moveaxis(coefficients, 0, -1)
    companion[..., np.arange(1, count), np.arange(count - 1)] = 1.0
    return np.asarray(np.moveaxis(np.linalg.eigvals(companion), -1, 0), dtype=np.complex128)


def followed(values: ComplexArray) -> ComplexArray:
    """Return values, (n, orders, nodes), in an order in which they move least from node to node."""
    if len(values) == 1:
        return values
    if len(values) == 2:
        one, other = values[:, :, :-1], values[:, :, 1:]
        crossed = np.abs(other[::-1] - one).sum(axis=0) < np.abs(other - one).sum(axis=0)
        turned = np.concatenate([np.zeros((len(crossed), 1), np.int64), np.cumsum(crossed, axis=1)], axis=1) % 2
        return np.where(turned == 1, values[::-1], values)
    from scipy.optimize import linear_sum_assignment

    found = values.copy()
    for order in range(values.shape[1]):
        place = np.arange(len(values))
        way = np.abs(values[:, None, order, 1:] - values[None, :, order, :-1])  # to each from each
        turns = way.argmin(axis=0)
        for node in range(way.shape[2]):
            turn = turns[:, node]
            if np.unique(turn).size < turn.size:
                turn = linear_sum_assignment(way[..., node].T)[1]
            place = turn[place]
            found[:, order, node + 1] = values[place, order, node + 1]
    return found


def _times(problem: Problem, factor: float) -> Problem:
    return replace(
        problem, shells=tuple(wall.with_gains(None if wall.gains is None else wall.gains.times(factor)) for wall in problem.shells)
    )


def _without(problem: Problem, shell: int) -> Problem:
    walls = list(problem.shells)
    walls[shell] = walls[shell].with_gains(None)
    return replace(problem, shells=tuple(walls))


def margins_of(orders: FloatArray, s: ComplexArray, loop: ComplexArray) -> LoopMargins:
    """Return the margins of a loop, shape (orders, nodes), given along a line of constant Re s."""
    size, angle, frequency = np.log(np.maximum(np.abs(loop), 1e-300)), np.unwrap(np.angle(loop), axis=1), s.imag
    real = _crossings(np.sin(angle), (np.cos(angle[:, :-1]) > 0.0) & (np.cos(angle[:, 1:]) > 0.0))
    factor = np.exp(-_between(size, real))
    at_real, where = _between(np.broadcast_to(frequency, size.shape), real), ~np.isnan(factor)
    gain, gain_at = _least(np.where(where & (factor > 1.0), factor, np.inf), at_real)
    lesser = np.where(where & (factor <= 1.0), factor, 0.0).max(axis=1, initial=0.0)
    at_rest = np.exp(-size[:, 0])  # where L is real on the whole axis
    rests = (frequency[0] == 0.0) & (loop[:, 0].real > 0.0)
    sooner = rests & (at_rest > 1.0) & (at_rest < gain)
    gain, gain_at = np.where(sooner, at_rest, gain), np.where(sooner, 0.0, gain_at)
    lesser = np.maximum(lesser, np.where(rests & (at_rest <= 1.0), at_rest, 0.0))
    alone = _crossings(size, np.ones_like(real, dtype=np.bool_))
    turned, at = _between(angle, alone), _between(np.broadcast_to(frequency, size.shape), alone)
    turned = np.mod(turned, 2.0 * np.pi)  # of s and of its conjugate: what a delay takes off, and the shorter way round
    phase, phase_at = _least(np.where(np.isnan(turned), np.inf, np.minimum(turned, 2.0 * np.pi - turned)), at)
    delay, delay_at = _least(np.where(np.isnan(turned), np.inf, turned / np.maximum(at, 1e-300)), at)
    return LoopMargins(orders, gain, lesser, phase, delay, gain_at, phase_at, delay_at)


def _crossings(values: FloatArray, allowed: npt.NDArray[np.bool_]) -> FloatArray:
    """Return where between two nodes values cross 0, 0 to 1, shape (orders, nodes - 1); NaN where they do not."""
    one, other = values[:, :-1], values[:, 1:]
    crosses = (np.signbit(one) != np.signbit(other)) & (one != other) & allowed  # zeros of either sign cross nothing
    return np.where(crosses, np.divide(one, one - other, out=np.full_like(one, np.nan), where=crosses), np.nan)


def _between(values: FloatArray, place: FloatArray) -> FloatArray:
    return values[:, :-1] + place * (values[:, 1:] - values[:, :-1])


def _least(values: FloatArray, at: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the least value of each order and where it is; NaN where it is infinite."""
    if not values.shape[1]:
        return np.full(len(values), np.inf), np.full(len(values), np.nan)
    place = values.argmin(axis=1)[:, None]
    least = np.take_along_axis(values, place, 1)[:, 0]
    return least, np.where(np.isinf(least), np.nan, np.take_along_axis(at, place, 1)[:, 0])
