"""Undamped resonances of cavities with rigid walls: zeros of J_m'(x r1) and of J_m'(x ra) Y_m'(x rb) - Y_m'(x ra) J_m'(x rb).

With the phase phi of H_m' both are the points where phi(x rb) - phi(x ra) = k pi (phi(x ra) = pi/2 without a hole). The
lowest has k = 0 for m >= 1; for m = 0 it would be the uniform state at x = 0, which is treated apart.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from coaxshell.acoustics.response_functions.phases import Phase, derivative_phase, rough_phase
from coaxshell.numerics.arrays import FloatArray


@dataclass(frozen=True, eq=False)
class Resonances:
    """The resonances of several orders below some wavenumber, one order after the other.

    Attributes
    ----------
    order : ndarray, shape (K,)
    wavenumbers : ndarray, shape (K,)
        x_k, ascending within an order.
    count : ndarray, shape (K,)
        Radial phase in half-turns, k.
    inner, outer : Phase
        Of H_m' at x_k ra and x_k rb; the modulus is infinite at ra = 0.
    gaps : ndarray, shape (K,)
        gaps[i] lies between wavenumbers[i] and the next one, about half a turn of phase from both.
    rows : list of slice
        Where each of the orders lies.
    """

    order: FloatArray
    wavenumbers: FloatArray
    count: FloatArray
    inner: Phase
    outer: Phase
    gaps: FloatArray
    rows: list[slice]


def resonances(orders: npt.NDArray[np.int64], inner: float, outer: float, limit: float) -> Resonances:
    """Return all resonances below *limit* and one or two above, to rounding; a hole of radius 0 is none."""
    grids = [_coarse(int(order), inner, outer, limit) for order in orders]
    repeated = np.repeat(orders.astype(np.float64), [grid.size for grid in grids])
    ends = np.cumsum([grid.size for grid in grids])[:-1]
    turns = np.split(_rough_turns(repeated, np.concatenate(grids), inner, outer), ends)
    guesses = [_guess(int(order), grid, turn, limit) for order, grid, turn in zip(orders, grids, turns, strict=True)]
    sizes = [guess[0].size for guess in guesses]
    x, count, gaps = (np.concatenate(parts) for parts in zip(*guesses, strict=True))
    order = np.repeat(orders.astype(np.float64), sizes)
    x = _solve(order, inner, outer, x, count)
    starts = np.cumsum([0, *sizes[:-1]])
    rows = [slice(int(start), int(start) + size) for start, size in zip(starts, sizes, strict=True)]
    return Resonances(order, x, count, _phase(order, x, inner), derivative_phase(order, x * outer), gaps, rows)


def _coarse(order: int, inner: float, outer: float, limit: float) -> FloatArray:
    """Return wavenumbers a fraction of a turn apart, from below the lowest resonance to two beyond the limit."""
    lowest = max(0.98 * order / outer, 1e-3)
    highest = max(limit, 1.5 * lowest) + 3.0 * np.pi / (outer - inner)
    return np.linspace(lowest, highest, int((highest - lowest) * outer / 0.7) + 24)


def _guess(order: int, grid: FloatArray, turns: FloatArray, limit: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return wavenumbers, counts and gaps by inverse interpolation."""
    start = int(np.argmin(turns[: grid.size // 2])) if order else 0
    count = np.arange(0 if order else 1, int(np.floor(turns[-1] - 0.5)) + 1, dtype=np.float64)
    x, gaps = (np.interp(count + more, turns[start:], grid[start:]) for more in (0.0, 0.5))
    keep = slice(int(np.searchsorted(gaps, limit)) + 1)
    return x[keep], count[keep], gaps[keep]


def _solve(order: FloatArray, inner: float, outer: float, x: FloatArray, count: FloatArray) -> FloatArray:
    """Return the roots by Newton's method, each left alone once it has converged."""
    open_ = np.arange(x.size)
    for _ in range(8):
        here, m = x[open_], order[open_]
        a, b = _phase(m, here, inner), derivative_phase(m, here * outer)
        step = (b.angle - a.angle - np.pi * count[open_]) / (outer * b.slope - inner * a.slope)
        x[open_] -= step
        open_ = open_[np.abs(step) > 1e-8 * here]
        if not open_.size:
            break
    return x


def _rough_turns(order: FloatArray, x: FloatArray, inner: float, outer: float) -> FloatArray:
    within = rough_phase(order, x * inner) if inner > 0.0 else 0.5 * np.pi
    return np.asarray((rough_phase(order, x * outer) - within) / np.pi, dtype=np.float64)


def _phase(order: FloatArray, x: FloatArray, radius: float) -> Phase:
    if radius > 0.0:
        return derivative_phase(order, x * radius)
    return Phase(np.full_like(x, 0.5 * np.pi), np.zeros_like(x), np.full_like(x, np.inf))
