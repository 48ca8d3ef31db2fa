"""Response functions of closed fluid regions: the sum over their resonances, with what lies above it by contour.

The undamped resonances of cavities with rigid walls are the zeros of J_m'(x r1) and of J_m'(x ra) Y_m'(x rb) - Y_m'(x ra) J_m'(x rb).
With the phase phi of H_m' both are the points where phi(x rb) - phi(x ra) = k pi (phi(x ra) = pi/2 without a hole). The
lowest has k = 0 for m >= 1; for m = 0 it would be the uniform state at x = 0, which is treated apart.

Their weights: f(t) = sum_k g u_k(wall) u_k(r)/(N_k x_k) sin(x_k t), g = rb at the outer, -ra at the inner wall,
N = int u^2 r dr = [(r^2 - m^2/x^2) u^2]/2 between the walls, where u' = 0. By the Wronskian the mode shape is 2/(pi x r |H_m'|) at
either wall, with the sign (-1)^k between them; elsewhere it is J_m(xr) sin(phi) - Y_m(xr) cos(phi), phi the phase of H_m' at a wall.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.special import jv, yv

from coaxshell.acoustics.response_functions.echoes import CavityResponse
from coaxshell.acoustics.response_functions.hankel import Phase, derivative_phase, expand, reach, rough_phase
from coaxshell.acoustics.response_functions.sums import cheap_together, is_uniform, legs, levels, sines, snapped
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.threads import map_on_threads


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


def expansion(modes: Resonances, response: CavityResponse) -> FloatArray:
    """Return the weight of sin(x_k t) for every resonance."""
    x, square = modes.wavenumbers, (modes.order / modes.wavenumbers) ** 2
    at_outer = np.ones_like(x)
    at_inner = np.zeros_like(x)
    norm = 0.5 * (response.outer**2 - square)
    if response.inner > 0.0:
        sign = 1.0 - 2.0 * (modes.count % 2)
        at_inner = sign * (modes.outer.modulus / modes.inner.modulus) * (response.outer / response.inner)
        norm -= 0.5 * (response.inner**2 - square) * at_inner**2
    drive = -response.inner * at_inner if response.driven_inside else response.outer * at_outer
    if response.at == response.outer:
        here = at_outer
    elif response.at == response.inner > 0.0:
        here = at_inner
    else:
        here = _within(modes, response)
    return np.asarray(drive * here / (norm * x), dtype=np.float64)


def _within(modes: Resonances, response: CavityResponse) -> FloatArray:
    """Return u(r)/u(rb) between the walls.

    With the outer wall's phase u(r) = (J(xr) sin(phi_b) - Y(xr) cos(phi_b)) / (2/(pi x rb |H'(x rb)|)).
    """
    order, z, angle = modes.order, modes.wavenumbers * response.at, modes.outer.angle
    scale = 0.5 * np.pi * modes.wavenumbers * response.outer * modes.outer.modulus
    if response.at == 0.0:
        return np.asarray(scale * (order == 0.0) * np.sin(angle), dtype=np.float64)
    j, y = np.empty_like(z), np.zeros_like(z)
    far = z >= reach(order)
    wave = expand(order[far], z[far].astype(np.complex128), 1).value * np.exp(1j * z[far])
    j[far], y[far] = wave.real, wave.imag
    j[~far] = jv(order[~far], z[~far])
    if response.inner > 0.0:
        y[~far] = yv(order[~far], z[~far])
    else:
        y[:] = 0.0
    return np.asarray(scale * (j * np.sin(angle) - y * np.cos(angle)), dtype=np.float64)


_BLOCK = 24


def cavity(orders: npt.NDArray[np.int64], times: FloatArray, responses: Sequence[CavityResponse]) -> FloatArray:
    """Return the responses of one cavity at times >= 0 in units of the fluid's own sound speed, shape (responses, orders, times).

    Accurate to about 1e-11 of the largest value. Right-hand limits at jumps; large where a front has passed the centre an
    odd number of times, which makes it a logarithm.
    """
    for response in responses:
        times = snapped(times, response)
    result = np.empty((len(responses), orders.size, times.size))
    ranked = np.argsort(orders, kind="stable")
    blocks = [ranked[start : start + _BLOCK] for start in range(0, orders.size, _BLOCK)]
    for block, values in zip(blocks, map_on_threads(lambda block: _block(orders[block], times, responses), blocks), strict=True):
        result[:, block] = values
    for row, response in zip(result, responses, strict=True):
        drive = -response.inner if response.driven_inside else response.outer
        row[orders == 0] += 2.0 * drive * times / (response.outer**2 - response.inner**2)
        if response.at == 0.0:
            row[orders > 0] = 0.0
    return result


def _block(orders: npt.NDArray[np.int64], times: FloatArray, responses: Sequence[CavityResponse]) -> FloatArray:
    result = np.empty((len(responses), orders.size, times.size))
    ladder = list(levels(int(orders[-1]), times, responses))
    found = resonances(orders, responses[0].inner, responses[0].outer, ladder[-1][0])
    weights = np.array([expansion(found, response) for response in responses])
    even = is_uniform(times)
    for kappa, chosen in ladder:
        wholly = even and 12 * chosen.size > times.size and cheap_together(kappa, times)
        kappas = np.empty(orders.size)
        for order, row in enumerate(found.rows):
            gaps = found.gaps[row]
            end = int(np.searchsorted(gaps, kappa))
            kappas[order] = gaps[end]
            used = slice(row.start, row.start + end + 1)
            values = sines(found.wavenumbers[used], weights[:, used], times if wholly else times[chosen])
            result[:, order, chosen] = values[:, chosen] if wholly else values
        result[:, :, chosen] += legs(orders, kappas, times[chosen], responses)
    return result
