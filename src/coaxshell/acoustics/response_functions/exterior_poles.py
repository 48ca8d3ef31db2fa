"""The exterior response at the wall as a sum of exponentials: poles of a rational approximation (AAA) of K_m/K_m' + 1.

On the imaginary axis K_m(s)/K_m'(s) + 1 is smooth, bounded and real in the sense F(conj s) = conj F(s); AAA on logarithmically
spaced points meets it to 1e-12 with 15 to 35 poles, all in the left half plane. Then K_m/(s K_m') <-> -1 + sum_j w_j (e^{p_j t} - 1).
The fits of the orders 0..300 are stored beside this file, because a fit takes a second and more.
"""

from __future__ import annotations

from functools import cache
from importlib.resources import files
from typing import NamedTuple

import numpy as np

from coaxshell.acoustics.bessel_ratios import k_ratios
from coaxshell.numerics.arrays import ComplexArray

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
