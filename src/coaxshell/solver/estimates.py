"""How far the answer can be trusted: what the orders above M would add, and what the finite time window costs.

The orders above M are not extrapolated: a sample of them is solved, on a sample of the Laplace nodes. That matters because
modal stress need not decay steadily: near the order R sqrt(a22/d22), where a shell's membrane and bending frequencies
cross (m = 284 for the paper's shells), it rises again before it falls.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from coaxshell.acoustics.bessel_ratios import ComplexArray
from coaxshell.acoustics.laplace_grid import LaplaceGrid
from coaxshell.solver.coupling import ModalSystem
from coaxshell.solver.excitation import SurfaceLoads
from coaxshell.solver.scaling import Problem
from coaxshell.solver.settings import MAX_MODES, Settings
from coaxshell.solver.workshop import Workshop

FloatArray = npt.NDArray[np.float64]

_SAMPLED_ORDERS = 28
# Poles are at least sigma from the contour, so sums over nodes 2 sigma apart are good to a few per cent.
_NODE_STRIDE = 8


def crossing_order(problem: Problem) -> float:
    """Return the largest order R sqrt(a22/d22) at which a shell's membrane and bending frequencies cross."""
    sections = [shell.section for shell in problem.shells if shell.section is not None]
    return max((s.radius * float(np.sqrt(s.membrane / s.bending)) for s in sections if s.bending > 0), default=0.0)


def sampled_orders(problem: Problem, first: int) -> FloatArray:
    """Return about 28 orders from ``first`` to well above four times it and the crossing order, geometrically spaced."""
    top = min(2 * MAX_MODES, int(max(4 * first, 2.2 * crossing_order(problem), first + 32)))
    return np.unique(np.geomspace(first, top, _SAMPLED_ORDERS).round())


def modal_norms(problem: Problem, grid: LaplaceGrid, orders: FloatArray, workshop: Workshop | None = None) -> tuple[FloatArray, FloatArray]:
    """Return the squared norms of the displacement W and of the strain m V - W of each order, shape (shells, orders).

    The norm is the integral of |X|^2 along the contour, that is of x(t)^2 e^{-2 sigma t} in time (Parseval).
    """
    nodes = slice(0, None, _NODE_STRIDE)
    modal = ModalSystem(problem, grid.nodes[nodes], orders, workshop=workshop)
    displacement = np.zeros((len(problem.shells), orders.size))
    strain = np.zeros_like(displacement)
    for load in SurfaceLoads(problem, grid, orders, workshop)(modal.surface, nodes):
        normal = modal.solve(len(problem.shells) - 1, load)
        for i, (w, v) in enumerate(zip(normal, modal.tangential(normal), strict=True)):
            displacement[i] += np.sum(np.abs(w) ** 2, axis=-1)
            strain[i] += np.sum(np.abs(orders[:, None] * v - w) ** 2, axis=-1)
    return displacement, strain


def computed_norms(normal: npt.NDArray[np.complex128], tangential: npt.NDArray[np.complex128]) -> tuple[FloatArray, FloatArray]:
    """Return the same norms of the orders that were computed, from their transforms (shells, halves, M + 1, nodes)."""
    w, v = normal[..., ::_NODE_STRIDE], tangential[..., ::_NODE_STRIDE]
    m = np.arange(w.shape[2])[:, None]
    return np.sum(np.abs(w) ** 2, axis=(1, 3)), np.sum(np.abs(m * v - w) ** 2, axis=(1, 3))


def surface_total(norms: FloatArray) -> FloatArray:
    """Return the mean square over the surface, order 0 plus half the sum of the others (Parseval in theta)."""
    total: FloatArray = norms[:, 0] + 0.5 * norms[:, 1:].sum(axis=1)
    return total


def tail_above(order: int, orders: FloatArray, norms: FloatArray) -> FloatArray:
    """Return the mean square that all orders above ``order`` would add, interpolated between sampled ones (log-log)."""
    every = np.arange(order + 1, int(orders[-1]) + 1)
    tail = np.empty(norms.shape[0])
    for i, row in enumerate(np.log(np.maximum(norms, 1e-300))):
        tail[i] = 0.5 * np.exp(np.interp(np.log(every), np.log(orders), row)).sum() + 0.5 * norms[i, -1] * orders[-1]
    return tail


def relative(tail: FloatArray, total: FloatArray) -> FloatArray:
    """Return sqrt(tail/total), 0 where nothing moves."""
    return np.sqrt(np.divide(tail, total, out=np.zeros_like(tail), where=total > 0))


def choose_modes(problem: Problem, grid: LaplaceGrid, tolerance: float, workshop: Workshop | None = None) -> tuple[int, float]:
    """Return the smallest order M whose estimated stress truncation is within the tolerance on every shell, and that estimate.

    If even 2000 orders are not enough, 2000 and what remains.
    """
    orders = np.unique(np.concatenate([np.arange(0, 33), np.geomspace(36, 2 * MAX_MODES, 48).round()]))
    _, strain = modal_norms(problem, grid, orders, workshop)
    every = np.arange(0, int(orders[-1]) + 1)
    remaining = np.zeros(every.size)
    for row in strain:
        dense = np.exp(np.interp(np.log(every + 1.0), np.log(orders + 1.0), np.log(np.maximum(row, 1e-300))))
        total = dense[0] + 0.5 * dense[1:].sum()
        if total > 1e-290:
            above = 0.5 * (np.cumsum(dense[::-1])[::-1] - dense)
            remaining = np.maximum(remaining, np.sqrt(above / total))
    enough = np.flatnonzero(remaining <= tolerance)
    chosen = min(max(int(enough[0]) if enough.size else MAX_MODES, 8), MAX_MODES)
    return chosen, float(remaining[chosen])


def window_error(grid: LaplaceGrid, normal: npt.NDArray[np.complex128]) -> float:
    """Return the estimated relative error of the inverse transform itself.

    The largest change of the head's displacement when the roll-off is widened from a fifth to two fifths of the band,
    plus what wraps around the period, relative to the largest displacement there.
    """
    head = normal[:, 0].sum(axis=1)
    history, wider = grid.invert(head), grid.invert(head, grid.taper(0.4))
    scale = float(np.abs(history).max())
    return 0.0 if scale == 0 else float(np.abs(history - wider).max()) / scale + grid.wrap_around


def resolve_modes(problem: Problem, grid: LaplaceGrid, settings: Settings, workshop: Workshop | None = None) -> tuple[int, list[str]]:
    """Return the number of modes asked for, chosen by the tolerance if "auto", and a warning if 2000 are not enough."""
    if settings.modes != "auto":
        return settings.modes, []
    order, remaining = choose_modes(problem, grid, settings.tolerance, workshop)
    if remaining <= settings.tolerance:
        return order, []
    return order, [
        f'modes="auto": {order} orders, the most that are allowed, leave an estimated {remaining:.2g} of the stress, more than '
        f"the tolerance {settings.tolerance:g}; accept it or shorten the source's spectrum (a longer rise_time)"
    ]


def truncation(
    problem: Problem,
    grid: LaplaceGrid,
    max_order: int,
    normal: ComplexArray,
    tangential: ComplexArray,
    workshop: Workshop | None = None,
) -> tuple[FloatArray, FloatArray]:
    """Return what the orders above M would add to displacement and stress of each shell, relative to what the others give.

    ``normal`` and ``tangential`` are the transforms of W and V, shape (shells, halves, M + 1, nodes).
    """
    orders = sampled_orders(problem, max_order + 1)
    above = modal_norms(problem, grid, orders, workshop)
    below = computed_norms(normal, tangential)
    displacement, stress = (
        relative(tail_above(max_order, orders, high), surface_total(low)) for high, low in zip(above, below, strict=True)
    )
    return displacement, stress
