"""Loops of electrodes cut into segments, for their margins: L of each pattern, or where dead segments tie the patterns its eigenvalues.

Without dead segments each pattern q is a loop of its own: that of one wall, the loops of the others closed, is 1 - L = |1 - H C_q| over
the same determinant without its feedback, as of an order. With dead ones a wall's loop has as many inputs as live segments,

    A_i = H_i (C_ii + C_io (1 - H_o C_oo)^-1 H_o C_oi),      |1 - z A_i| = product of 1 - z lambda_j,

z a factor on the gain, or the further delay, of all its segments together: each eigenvalue lambda_j is an L (a characteristic locus).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.modes import Modes
from coaxshell.numerics.progress import ShareDone
from coaxshell.solver.contour import Contour, along_alone
from coaxshell.solver.electrode_loops import ElectrodeLoops, determinant_of
from coaxshell.solver.electrode_patterns import Patterns, patterns_of, segments_of
from coaxshell.solver.margins import FURTHER, Loop, LoopMargins, followed, margins_of
from coaxshell.solver.scaling import Problem
from coaxshell.solver.tied_stability import Tied
from coaxshell.solver.voltage_response import controlled

_BLOCK = 128
_ROUNDING = 1e-9
"""Of the largest loop of a wall: what is smaller everywhere is none, as of a pattern whose orders are not there."""


class CutLoop(NamedTuple):
    """The loops of one wall's segments: each L over the nodes, what pattern each is, and their margins.

    Attributes
    ----------
    loop : Loop
        Values of shape (loops, nodes).
    patterns : ndarray, shape (loops,)
        q, where dead segments tie all patterns that which the segments follow most where the loop is critical.
    margins : LoopMargins
        By pattern, 0 to N/2, the least of all its loops.
    """

    loop: Loop
    patterns: FloatArray
    margins: LoopMargins


def segmented_loops(problem: Problem, tied: Tied, least: float, told: ShareDone = lambda _: None) -> dict[int, CutLoop]:
    """Return the loops of each wall that feeds anything back, by its number, on Re s = *least* or a little more.

    Of one wave, or of all that electrodes tie to it along the axis. *told* hears the share of the nodes that are done, and may
    end it by an exception.
    """
    modes = tied.modes
    contour, problem = Contour.of(problem, modes, least), along_alone(problem, modes)
    nodes = contour._replace(fades=FURTHER * contour.fades).nodes
    walls = controlled(problem)
    patterns = patterns_of(problem, walls, modes.orders, 1)
    shown = patterns.numbers.orders[: _count(patterns)]
    found = {}
    values = _values(problem, tied, patterns, nodes, told)
    for place, shell in enumerate(walls):
        size = np.abs(values[place]).max(axis=1, keepdims=True)
        if not size.any():
            continue
        loop = Loop(nodes, np.where(size > _ROUNDING * size.max(), values[place], 0.0))
        each = margins_of(np.arange(float(len(loop.values))), *loop)
        numbers = _resembled(problem, tied, patterns, place, loop, each) if patterns.dead else shown
        found[shell] = CutLoop(loop, numbers, _by_pattern(each, numbers, shown))
    return found


def common_patterns(problem: Problem, max_order: int, numbers: FloatArray, least: float) -> list[Loop]:
    """Return the eigenvalues of the loops of all walls together in some patterns q, one Loop each of (patterns, nodes).

    Dead segments count as if they were alive. With a common factor z on all laws the determinant of a pattern is prod (1 - z lambda), as
    of orders (:func:`coaxshell.solver.margins.common_loop`). Only the orders that are tied in these patterns are made.
    """
    walls = controlled(problem)
    count, orders = segments_of(problem, walls)[0].count, np.arange(max_order + 1.0)
    modes = Modes(orders[np.isin(np.abs(orders - count * np.rint(orders / count)), numbers)], sparse=True)
    patterns, rows = patterns_of(problem, walls, modes.orders, 1), numbers.astype(int)
    contour, problem = Contour.of(problem, modes, least), along_alone(problem, modes)
    found = []
    for start in range(0, contour.nodes.size, 4 * _BLOCK):
        matrix = _at(problem, Tied(modes), patterns, contour.nodes[start : start + 4 * _BLOCK]).matrix[rows]
        found.append(np.linalg.eigvals(np.eye(len(walls)) - matrix))
    return [Loop(contour.nodes, one) for one in followed(np.moveaxis(np.concatenate(found, axis=1), -1, 0))]


def _count(patterns: Patterns) -> int:
    """Return how many patterns are cosines."""
    return int(np.argmax(patterns.numbers.orders)) + 1


def _values(problem: Problem, tied: Tied, patterns: Patterns, nodes: ComplexArray, told: ShareDone) -> list[ComplexArray]:
    """Return L of each wall under control, (loops, nodes) each."""
    found: list[list[ComplexArray]] = []
    step = _BLOCK if patterns.dead else 4 * _BLOCK
    for start in range(0, nodes.size, step):
        loops = _at(problem, tied, patterns, nodes[start : start + step])
        walls = range(len(loops.law))
        found.append([_eigenvalues(loops, i) if patterns.dead else _alone(loops, i) for i in walls])
        told(min(1.0, (start + step) / nodes.size))
    whole = [np.concatenate(each, axis=-1) for each in zip(*found, strict=True)]
    return [followed(one[:, None])[:, 0] for one in whole] if patterns.dead else whole


def _at(problem: Problem, tied: Tied, patterns: Patterns, nodes: ComplexArray) -> ElectrodeLoops:
    return ElectrodeLoops.of(problem, tied.response(problem.open_loop, problem, nodes), patterns, nodes)


def _alone(loops: ElectrodeLoops, wall: int) -> ComplexArray:
    """Return L of a wall in each pattern, (patterns, nodes)."""
    others = np.delete(np.delete(loops.matrix, wall, axis=2), wall, axis=3)
    return np.asarray(1.0 - determinant_of(loops.matrix) / determinant_of(others))


def _eigenvalues(loops: ElectrodeLoops, wall: int) -> ComplexArray:
    """Return lambda_j of a wall, (live, nodes)."""
    return np.ascontiguousarray(np.linalg.eigvals(_live(loops, wall)).T, dtype=np.complex128)


def _live(loops: ElectrodeLoops, wall: int) -> ComplexArray:
    """Return A_i on the live segments of a wall, (nodes, live, live)."""
    patterns = loops.patterns
    live = [k for k in range(len(patterns.evaluate)) if k not in patterns.dead]
    whole = np.einsum("dq,qkij,qe->kidje", patterns.evaluate[live], loops.matrix, patterns.project[:, live], optimize=True)
    count, others = len(live), [i for i in range(whole.shape[1]) if i != wall]
    own = np.eye(count) - whole[:, wall, :, wall]
    if not others:
        return np.asarray(own)
    size = count * len(others)
    back = whole[:, others][:, :, :, wall].reshape(-1, size, count)
    between = whole[:, others][:, :, :, others].reshape(-1, size, size)
    return np.asarray(own + whole[:, wall][:, :, others].reshape(-1, count, size) @ np.linalg.solve(between, back))


def _resembled(problem: Problem, tied: Tied, patterns: Patterns, place: int, loop: Loop, margins: LoopMargins) -> FloatArray:
    """Return the pattern that the eigenvector of each loop has most of, where it stands the least delay, else where it is largest."""
    nearest = np.abs(loop.nodes.imag - np.nan_to_num(margins.delay_frequency)[:, None]).argmin(axis=1)
    nodes = np.where(np.isfinite(margins.delay), nearest, np.abs(loop.values).argmax(axis=1))
    live = [k for k in range(len(patterns.evaluate)) if k not in patterns.dead]
    asked, inverse = np.unique(nodes, return_inverse=True)
    values, vectors = np.linalg.eig(_live(_at(problem, tied, patterns, loop.nodes[asked]), place))
    found = []
    for row, (node, there) in enumerate(zip(nodes, inverse, strict=True)):
        own = vectors[there][:, np.abs(values[there] - loop.values[row, node]).argmin()]
        size = np.abs(patterns.project[:, live] @ own) ** 2 * (patterns.evaluate**2).sum(axis=0)
        found.append(patterns.numbers.orders[size.argmax()])
    return np.array(found)


def _by_pattern(margins: LoopMargins, numbers: FloatArray, shown: FloatArray) -> LoopMargins:
    """Return the least margins of the loops of each pattern; infinite of those that no loop resembles."""
    own = numbers == shown[:, None]
    found: dict[str, FloatArray] = {}
    for name in ("gain", "phase", "delay"):
        values = np.where(own, getattr(margins, name), np.inf)
        place = values.argmin(axis=1)
        found[name] = values.min(axis=1)
        found[f"{name}_frequency"] = np.where(np.isinf(found[name]), np.nan, getattr(margins, f"{name}_frequency")[place])
    return LoopMargins(shown, lesser_gain=np.where(own, margins.lesser_gain, 0.0).max(axis=1), **found)
