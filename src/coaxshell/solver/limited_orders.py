"""Orders left out where actuators stop at their limit: what they are given, and what they change in the orders kept.

With a the pressure that the law asks for in the run, in units of the limit, and da what the orders above M ask for beside it, normally
distributed on the circle, in time like a:

- The mean <clip(a + da)> has harmonics in the orders above M, forces that the run leaves out; in the orders kept it differs from clip(a).
- Of their own feedback the orders above M get the share <clip(a + da)(a + da)>/<(a + da)^2>.
- What is left, of mean square var clip(a + da) - (P da)^2, P the part of the circle that is not held, spreads over all orders.

The mean gain is that of statistical linearisation: J. B. Roberts, P. D. Spanos, Random Vibration and Statistical Linearization (1990).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy import special

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.interface.saturation import circle, voltage_limit
from coaxshell.solver.sampled_orders import NODES, SampledOrders
from coaxshell.solver.scaling import Problem
from coaxshell.solver.structure_spectra import StructureSpectra
from coaxshell.structure.control_law import ControlGains

_INSTANTS = 256
_UNLIKELY = 4.0
"""Standard deviations that nothing exceeds."""
_TABLE, _NORMAL = 257, 161
"""Pressures for which means are tabulated, and points of the normal distribution."""
_LEVEL = 1.5
"""Ratio of the deviations that a table stands for."""


def limited_means(largest: float, deviation: float) -> FloatArray:
    """Return a and, for x = a + da with da of a standard deviation, <clip(x)>, <clip(x) x> and var clip(x) - (P da)^2: (4, table)."""
    a = np.linspace(0.0, max(largest, 1e-9), _TABLE)
    normal = np.linspace(-_UNLIKELY, _UNLIKELY, _NORMAL)
    weight = np.exp(-0.5 * normal**2)
    weight /= weight.sum()
    x = a[:, None] + deviation * normal
    cut = np.clip(x, -1.0, 1.0)
    width = max(deviation, 1e-9)
    free = special.ndtr((1.0 - a) / width) - special.ndtr((-1.0 - a) / width)
    mean = cut @ weight
    spread = np.maximum((cut**2) @ weight - mean**2 - (free * deviation) ** 2, 0.0)
    return np.stack([a, mean, (cut * x) @ weight, spread])


@dataclass(frozen=True)
class LimitedActuator:
    """One actuator on the circle; pressures are its own, not in units of the limit.

    Attributes
    ----------
    shell : int
    gain : float
        Share of its feedback that the orders above M get.
    above : ndarray, shape (parities, orders, instants)
        Mean pressure given in the orders of the sample above M.
    kept : ndarray, shape (parities, M + 1, instants)
        Mean pressure given in the orders kept, less that of the run.
    spread : ndarray, shape (instants,)
        Mean square over the circle of what spreads over all orders.
    """

    shell: int
    gain: float
    above: FloatArray
    kept: FloatArray
    spread: FloatArray

    @classmethod
    def of(cls, shell: int, limit: float, asked: FloatArray, orders: FloatArray, deviation: float) -> LimitedActuator:
        """Cut what the law asks for, shape (parities, M + 1, instants), with da of a standard deviation over circle and time beside it."""
        parities, modes, instants = asked.shape
        evaluate, back = circle(modes, parities)
        points = len(evaluate)
        theta = (np.pi if parities == 1 else 2.0 * np.pi) * (np.arange(points) + 0.5) / points
        resolved = np.where(orders < points // parities, 2.0 / points, 0.0)
        project = np.concatenate([resolved * wave(theta[:, None] * orders) for wave in (np.cos, np.sin)[:parities]], axis=1)
        rows = np.ascontiguousarray(asked.reshape(parities * modes, instants).T) / limit
        envelope = np.sqrt((rows**2).sum(axis=1))
        deviations = deviation / limit * envelope / max(float(np.sqrt((envelope**2).mean())), 1e-300)
        levels = np.rint(np.log(np.maximum(deviations, 1e-3)) / np.log(_LEVEL))
        above, kept, spread = np.zeros((instants, project.shape[1])), np.zeros((instants, parities * modes)), np.zeros(instants)
        square = work = 0.0
        for level in np.unique(levels):
            members = np.flatnonzero(levels == level)
            largest = float(np.abs(rows[members]).sum(axis=1).max())
            if largest + _UNLIKELY * _LEVEL**level <= 1.0:
                square += points * float((0.5 * envelope[members] ** 2 + deviations[members] ** 2).sum())
                work = work + points * float((0.5 * envelope[members] ** 2 + deviations[members] ** 2).sum())
                continue
            table = limited_means(largest, _LEVEL**level)
            for start in range(0, members.size, _INSTANTS):
                block = members[start : start + _INSTANTS]
                a = rows[block] @ evaluate.T
                size = np.abs(a)
                mean = np.copysign(np.interp(size, table[0], table[1]), a)
                above[block], kept[block] = mean @ project, (mean - np.clip(a, -1.0, 1.0)) @ back.T
                square += float((a * a).sum()) + a.size * _LEVEL ** (2 * level)
                work += float(np.interp(size, table[0], table[2]).sum())
                spread[block] = np.interp(size, table[0], table[3]).mean(axis=1)
        return cls(
            shell,
            work / square if square > 0 else 1.0,
            limit * above.T.reshape(parities, -1, instants),
            limit * kept.T.reshape(parities, -1, instants),
            limit**2 * spread,
        )


def pressure_limits(problem: Problem) -> dict[int, float]:
    """Return the largest pressure of each actuator, by shell."""
    return {i: abs(wall.actuator_pressure) * voltage_limit(problem, i) for i, wall in enumerate(problem.shells) if wall.gains is not None}


def asked_above(problem: Problem, above: SampledOrders, squares: FloatArray) -> dict[int, FloatArray]:
    """Return the mean squares over the circle of what the law asks for in the orders above M, at the sampled nodes, by shell.

    ``squares`` are their |W|^2, shape (shells, orders, nodes).
    """
    found = {}
    for i in pressure_limits(problem):
        wall = problem.shells[i]
        assert wall.gains is not None
        assert above.modal is not None
        law = wall.gains.at(above.nodes, above.modal.modes) * wall.fed_back(above.modal.modes, above.modal.shells[i])
        found[i] = 0.5 * (above.weight @ (np.abs(law) ** 2 * squares[i]))
    return found


def softened(problem: Problem, actuators: list[LimitedActuator]) -> Problem:
    """Return the problem with the share of the gains that the orders above M get."""
    shells = list(problem.shells)
    for one in actuators:
        wall = shells[one.shell]
        assert isinstance(wall.gains, ControlGains)  # no other law saturates
        shells[one.shell] = wall.with_gains(wall.gains.scaled(one.gain, one.gain))
    return replace(problem, shells=tuple(shells))


def transformed(grid: LaplaceGrid, histories: FloatArray) -> ComplexArray:
    """Return the transforms at the sampled nodes of histories that are given at every so many steps of the grid."""
    every = grid.steps // (histories.shape[-1] - 1)
    if every > 1:
        left, part = np.divmod(np.arange(grid.steps + 1) / every, 1.0)
        left, part = np.minimum(left.astype(int), histories.shape[-1] - 2), part + (left == histories.shape[-1] - 1)
        histories = histories[..., left] * (1.0 - part) + histories[..., left + 1] * part
    return grid.transform_linear(histories)[..., NODES]


def moved_above(above: SampledOrders, grid: LaplaceGrid, actuators: list[LimitedActuator]) -> FloatArray:
    """Return |W|^2 of the orders above M under what actuators give them, shape (shells, orders, nodes)."""
    pressure = np.stack([transformed(grid, one.above) for one in actuators])
    found = np.einsum("ijmk,jhmk->ihmk", above.compliance[:, [one.shell for one in actuators]], pressure)
    return np.asarray((np.abs(found) ** 2).sum(axis=1))


def actuators_of(
    problem: Problem, asked: FloatArray, above: SampledOrders, further: dict[int, FloatArray], lasting: FloatArray
) -> list[LimitedActuator]:
    """Return the actuators with what the orders above M ask for beside the run; none if no limit is reached.

    Parameters
    ----------
    problem : Problem
        With its feedback.
    asked : ndarray, shape (shells, parities, M + 1, instants)
        Modal pressures that the law asked for in the run.
    above : SampledOrders
    further : dict of int to ndarray
        Those of :func:`asked_above`.
    lasting : ndarray, shape (shells,)
        Means over all times per sum over the sampled nodes, of squares.
    """
    found = [
        LimitedActuator.of(i, limit, asked[i], above.orders, float(np.sqrt(further[i].sum() * lasting[i])))
        for i, limit in pressure_limits(problem).items()
    ]
    return found if any(one.spread.any() or one.above.any() for one in found) else []


def moved_below(structure: StructureSpectra, asked: dict[int, FloatArray], actuators: list[LimitedActuator]) -> FloatArray:
    """Return the norms (shells, 2, M + 1) of what the orders above M change in the orders kept through the actuators.

    ``asked`` is that of :func:`asked_above`: what spreads has its spectrum.
    """
    m = np.arange(structure.modes.count)
    compliance, ratio = structure.compliance[..., NODES], structure.tangential_ratio[..., NODES]
    pressure = np.stack([transformed(structure.grid, one.kept) for one in actuators])
    chosen = [one.shell for one in actuators]
    squares = (np.abs(np.einsum("ijmk,jhmk->ihmk", compliance[:, chosen], pressure)) ** 2).sum(axis=1)
    for one in actuators:
        total = float(asked[one.shell].mean())
        if total > 0:  # half of it above M; the mean square of a cosine is a half
            time = np.linspace(0.0, structure.grid.time[-1], one.spread.size)
            energy = float(np.trapezoid(one.spread * np.exp(-2.0 * structure.grid.shift * time), time))
            energy *= np.pi / (NODES.step * structure.grid.frequency_step * asked[one.shell].size)
            squares = squares + np.abs(compliance[:, one.shell]) ** 2 * (asked[one.shell] / total * energy / m.size)
    share = np.where(m == 0, 1.0, 0.5)
    strain = np.abs(m[:, None] * ratio - 1.0) ** 2
    return np.stack([squares.sum(axis=-1), (squares * strain).sum(axis=-1)], axis=1) * share
