"""Response functions of the fluid outside a wall: at the wall by sums of exponentials where they are tabulated, else by contour.

At the wall: poles of a rational approximation (AAA) of K_m/K_m' + 1. On the imaginary axis K_m(s)/K_m'(s) + 1 is smooth, bounded and
real in the sense F(conj s) = conj F(s); AAA on logarithmically spaced points meets it to 1e-12 with 15 to 35 poles, all in the left half
plane. Then K_m/(s K_m') <-> -1 + sum_j w_j (e^{p_j t} - 1). The fits of the orders 0..300 are stored beside this file, because a fit
takes a second and more.

Away from the wall: a contour up the imaginary axis, turned to the left above i kappa. With F(s) = K_m(rs)/(s K_m'(s)) and
theta = t - (r - 1) the time since the front,

    f = (1/pi) Re int_0^kappa F(i w) e^{i w t} dw - (1/pi) Im int_0^inf F(i kappa - u) e^{(i kappa - u) t} du.

On the imaginary axis F is smooth except for a logarithm at s = 0. A sum of exponentials, good at the wall, is not here: the wave
of order m is delayed by up to 1 more than its front, which takes hundreds of poles.
"""

from __future__ import annotations

from functools import cache
from importlib.resources import files
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from coaxshell.acoustics.radial_fields import exterior_field as laplace_field
from coaxshell.acoustics.response_functions.echoes import waves
from coaxshell.acoustics.response_functions.sums import ladder, leg_nodes, lowest, needed, product, sines
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.bessel_ratios import k_ratios
from coaxshell.numerics.radial_functions import RadialFunctions

TABLE = "exterior_poles.npz"
_TOLERANCE = 1e-12
_DECADES = (-4.0, 5.0)
_POINTS = 160
_NEAR = 160  # around s = i m, where the response changes within m^(1/3)


class Poles(NamedTuple):
    """f(t) = -1 + Re sum_j w_j (e^{p_j t} - 1), the real part taken."""

    poles: ComplexArray
    weights: ComplexArray


def fit(order: int) -> Poles:
    """Return a fresh fit of one order, accurate to about 1e-11 for t >= 0 (up to 1e3 for m = 0)."""
    from scipy.interpolate import AAA

    s = 1j * np.concatenate([np.logspace(*_DECADES, _POINTS), np.linspace(0.3, 2.5, _NEAR)]) * max(order, 1)
    values = 1.0 + 1.0 / (order / s - k_ratios(order, s + 1e-14 * abs(s))[order])
    rational = AAA(np.concatenate([s, s.conj()]), np.concatenate([values, values.conj()]), rtol=_TOLERANCE, clean_up=False)
    poles = np.asarray(rational.poles(), dtype=np.complex128)
    if np.any(poles.real >= 0.0):
        raise ArithmeticError(f"order {order}: the rational approximation has a pole in the right half plane")
    return Poles(poles, _weights(s, values, poles))


def _weights(s: ComplexArray, values: ComplexArray, poles: ComplexArray) -> ComplexArray:
    """Return residue/pole by least squares on the imaginary axis, every pole with its conjugate at half the weight.

    AAA does not know that the function is real and finds conjugate pairs only roughly; sharing the weights makes it so.
    """
    one, other = 0.5 * poles / (s[:, None] - poles), 0.5 * poles.conj() / (s[:, None] - poles.conj())
    matrix = np.concatenate([one + other, 1j * (one - other)], axis=1)
    stacked = np.concatenate([matrix.real, matrix.imag]), np.concatenate([values.real, values.imag])
    scale = np.linalg.norm(stacked[0], axis=0)
    found = np.linalg.lstsq(stacked[0] / scale, stacked[1], rcond=1e-14)[0] / scale
    return np.asarray(found[: poles.size] + 1j * found[poles.size :], dtype=np.complex128)


@cache
def tabulated() -> list[Poles]:
    """Return the stored fits of the orders 0, 1, 2, ..."""
    source = files("coaxshell.acoustics.response_functions") / TABLE
    with source.open("rb") as stream, np.load(stream) as stored:
        ends = np.cumsum(stored["counts"])[:-1]
        return [Poles(p, w) for p, w in zip(np.split(stored["poles"], ends), np.split(stored["weights"], ends), strict=True)]


def write_table(path: str, highest: int = 300) -> None:
    """Fit the orders 0..highest and store them; run once, when the fit changes."""
    fits = [fit(order) for order in range(highest + 1)]
    np.savez_compressed(
        path,
        counts=np.array([each.poles.size for each in fits]),
        poles=np.concatenate([each.poles for each in fits]),
        weights=np.concatenate([each.weights for each in fits]),
    )


_BLOCK = 32
_NODES = 20
_CHUNK = 4000


def exterior_field(orders: npt.NDArray[np.int64], late: FloatArray, radius: float) -> FloatArray:
    """Return K_m(rs)/(s K_m'(s)) at times *late* >= 0 after the front has reached r > 1, shape (orders, times)."""
    result = np.empty((orders.size, late.size))
    ranked = np.argsort(orders, kind="stable")
    for start in range(0, orders.size, _BLOCK):
        block = ranked[start : start + _BLOCK]
        highest = int(orders[block[-1]])
        spread = np.full_like(late, (highest**2 + 1.0) * (1.0 - 1.0 / radius))
        for kappa, chosen in ladder(lowest(highest), [needed(spread, late)]):
            result[np.ix_(block, chosen)] = _below(orders[block], kappa, late[chosen], radius) + _above(
                orders[block], kappa, late[chosen], radius
            )
    return result


def _below(orders: npt.NDArray[np.int64], kappa: float, late: FloatArray, radius: float) -> FloatArray:
    frequencies, weights = _axis(kappa, float(late.max()) + radius)
    total = np.zeros((orders.size, late.size))
    for start in range(0, frequencies.size, _CHUNK):
        part = slice(start, start + _CHUNK)
        spectrum = _spectrum(orders, frequencies[part], radius) * (weights[part] / np.pi)
        total += sines(frequencies[part], -spectrum.imag, late, spectrum.real)
    return total


def _spectrum(orders: npt.NDArray[np.int64], frequencies: FloatArray, radius: float) -> ComplexArray:
    """Return F on the imaginary axis without the delay r - 1."""
    s = np.asarray((1e-15 + 1j) * frequencies, dtype=np.complex128)
    every = np.unique(orders)
    wall, here = (RadialFunctions(s, at, every.astype(np.float64)) for at in (1.0, radius))
    rows: ComplexArray = laplace_field(here, wall).pressure[np.searchsorted(every, orders)]
    return np.asarray(rows * np.exp(1j * frequencies * (radius - 1.0)), dtype=np.complex128)


def _axis(kappa: float, duration: float) -> tuple[FloatArray, FloatArray]:
    """Return nodes and weights for the integral from 0 to kappa: panels of four oscillations, and ever smaller ones towards 0."""
    width = min(2.0, 8.0 * np.pi / duration)
    edges = np.linspace(0.0, kappa, int(np.ceil(kappa / width)) + 1)
    edges = np.concatenate([[0.0], edges[1] * 0.25 ** np.arange(22, 0, -1.0), edges[1:]])
    x, w = np.polynomial.legendre.leggauss(_NODES)
    half = 0.5 * np.diff(edges)[:, None]
    return (edges[:-1, None] + half * (1.0 + x)).ravel(), (half * w).ravel()


def _above(orders: npt.NDArray[np.int64], kappa: float, late: FloatArray, radius: float) -> FloatArray:
    u, weights = leg_nodes()
    at = waves(orders, np.full((orders.size, 1), kappa) - 1j * u, {1.0, radius})
    rows = at.left[radius].outward.value / (np.conj(at.x) * at.left[1.0].outward.slope) * weights
    decay = np.exp(-np.outer(late, u))
    sums = (product(decay, rows.real.T.copy()) + 1j * product(decay, rows.imag.T.copy())).T * np.exp(1j * kappa * late)
    return np.asarray(-sums.imag / np.pi, dtype=np.float64)


def exterior_at_wall(orders: npt.NDArray[np.int64], times: FloatArray) -> FloatArray:
    """Return K_m/(s K_m') at r = 1 at times >= 0, shape (orders, times)."""
    table = tabulated()
    result = np.empty((orders.size, times.size))
    for row, order in enumerate(orders):
        if order < len(table):
            result[row] = _sum(table[int(order)], times)
    high = orders >= len(table)
    if np.any(high):
        result[high] = exterior_field(orders[high], times, 1.0)
    return result


def _sum(fit: Poles, times: FloatArray) -> FloatArray:
    waves = np.einsum("tp,p->t", np.exp(np.outer(times, fit.poles)), fit.weights)
    return np.asarray(waves.real - fit.weights.real.sum() - 1.0, dtype=np.float64)
