"""The exterior response away from the wall: a contour up the imaginary axis, turned to the left above i kappa.

With F(s) = K_m(rs)/(s K_m'(s)) and theta = t - (r - 1) the time since the front,

    f = (1/pi) Re int_0^kappa F(i w) e^{i w t} dw - (1/pi) Im int_0^inf F(i kappa - u) e^{(i kappa - u) t} du.

On the imaginary axis F is smooth except for a logarithm at s = 0. A sum of exponentials, good at the wall, is not here: the wave
of order m is delayed by up to 1 more than its front, which takes hundreds of poles.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from coaxshell.acoustics.operators import RadialFunctions
from coaxshell.acoustics.radial_fields import exterior_field as laplace_field
from coaxshell.acoustics.response_functions.echoes import waves
from coaxshell.acoustics.response_functions.legs import leg_nodes
from coaxshell.acoustics.response_functions.levels import ladder, lowest, needed
from coaxshell.acoustics.response_functions.products import product
from coaxshell.acoustics.response_functions.sums import sines
from coaxshell.numerics.arrays import ComplexArray, FloatArray

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
