"""Ratios of modified Bessel functions for all orders 0..M at once, without overflow at any order or argument (Re z > 0).

I_m and K_m alone overflow or underflow long before the acoustics becomes extreme (K_150(0.5) > 1e308), while every
quantity of the radial problem is a ratio of them. Two families suffice:

    R_m(z) = I_{m+1}(z) / I_m(z)     downward recurrence  R_{m-1} = 1 / (2m/z + R_m)       (DLMF 10.29.1)
    S_m(z) = K_{m+1}(z) / K_m(z)     upward recurrence    S_m = 2m/z + 1/S_{m-1}           (DLMF 10.29.1)
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
from scipy import special
from scipy.special import ive

from coaxshell.numerics.arrays import ComplexArray

# Below this |z|/m the asymptotic ratio is forgotten quickly enough by the downward recurrence (each step shrinks its
# error by |R|^2 <= 0.21 here) and I_m itself would begin to underflow; above it the start has to be exact.
_ASYMPTOTIC_LIMIT = 0.75
_FORGETTING_STEPS = 24
_NEUTRAL = 3.0
"""m^2 |Re 1/z| up to which, for |z| >= m, the upward recurrence from R_0 spoils no more than a digit: K_m/I_m grows by its exponential."""


def as_complex(z: npt.ArrayLike, *, left: bool = False) -> ComplexArray:
    """Return arguments as a complex array of one dimension; ValueError if any Re z <= 0, unless ``left`` allows that."""
    argument = np.atleast_1d(np.asarray(z, dtype=np.complex128))
    if argument.ndim != 1:
        raise ValueError(f"z: an array of shape {argument.shape}; a scalar or one-dimensional array is allowed")
    if not left and not np.all(argument.real > 0):
        raise ValueError("z: the recurrences are stable only for Re z > 0; shift the Laplace contour to the right")
    return argument


def starting_ratio(order: int, z: ComplexArray) -> ComplexArray:
    """Return R_order(z), the start of the downward recurrence.

    Near the imaginary axis with |z| > m the recurrence does not forget its start, so the start must be exact there. There I and K are
    of one size, and R_0 is carried upward, R_m = 1/R_{m-1} - 2m/z, at a seventh of the cost of I_m and I_{m+1} themselves.
    """
    size = np.abs(z)
    upward = (size >= order) & (np.abs(z.real) * order**2 <= _NEUTRAL * size**2)
    ratio = np.empty_like(z)
    ratio[upward] = _carried_up(order, z[upward])
    far = np.flatnonzero(~upward & (size > _ASYMPTOTIC_LIMIT * order))
    above = ive(order + 1, z[far])
    usable = above != 0  # ive underflows where Re z is large and |z| not much above m; there the start is forgotten quickly
    far, above = far[usable], above[usable]
    ratio[far] = above / ive(order, z[far])
    rest = ~upward
    rest[far] = False
    near = z[rest]
    top = order + _FORGETTING_STEPS
    r = near / (top + 0.5 + np.sqrt((top + 1.5) ** 2 + near**2))  # DLMF 10.41 leading ratio (Amos's bound)
    for m in range(top, order, -1):
        r = 1.0 / (2 * m / near + r)
    ratio[rest] = r
    return ratio


def _carried_up(order: int, z: ComplexArray) -> ComplexArray:
    """Return R_order from R_0 = I_1/I_0 by the upward recurrence."""
    ratio, two_over_z = ive(1, z) / ive(0, z), 2.0 / z
    work = np.empty_like(z)
    for m in range(1, order + 1):
        np.reciprocal(ratio, out=ratio)
        np.multiply(two_over_z, m, out=work)
        np.subtract(ratio, work, out=ratio)
    return np.asarray(ratio)


def i_ratios(max_order: int, z: npt.ArrayLike, *, left: bool = False) -> ComplexArray:
    """Return R_m = I_{m+1}/I_m for m = 0..max_order.

    Parameters
    ----------
    max_order : int
        Highest order M.
    z : array_like, shape (n,)
        Complex arguments with Re z > 0.
    left : bool
        Whether they may lie to the left of the imaginary axis too, not far: an error of rounding grows there by exp(2 |Re z|).

    Returns
    -------
    ndarray, shape (M + 1, n)

    Raises
    ------
    ValueError
        If any Re z <= 0 and that is not allowed.
    """
    z = as_complex(z, left=left)
    ratios = np.empty((max_order + 1, z.size), dtype=np.complex128)
    ratios[max_order] = starting_ratio(max_order, z)
    two_over_z = 2.0 / z
    work = np.empty_like(z)
    for m in range(max_order, 0, -1):
        np.multiply(two_over_z, m, out=work)
        np.add(work, ratios[m], out=work)
        np.reciprocal(work, out=ratios[m - 1])
    return ratios


_ASYMPTOTIC = 1e4
"""|z| above which four terms of K_0's and K_1's asymptotic series are exact to rounding; SciPy's kve ends at about 2^30."""


def kve(order: int, z: npt.ArrayLike) -> ComplexArray:
    """Return K_m(z) e^z for m = 0 or 1 and Re z > 0, however large z.

    For large z sqrt(pi/(2 z)) (1 + a_1/z + a_2/z^2 + ...), a_k = a_{k-1} (4 m^2 - (2 k - 1)^2)/(8 k) (DLMF 10.40.2).
    """
    z = np.asarray(z, dtype=np.complex128)
    large = np.abs(z) > _ASYMPTOTIC
    value = np.asarray(special.kve(order, np.where(large, _ASYMPTOTIC, z)), dtype=np.complex128)
    if large.any():
        inverse, term = 1.0 / z[large], np.ones(int(large.sum()), np.complex128)
        series = term.copy()
        for k in range(1, 5):
            term = term * inverse * ((4.0 * order**2 - (2 * k - 1) ** 2) / (8.0 * k))
            series += term
        value[large] = np.sqrt(0.5 * np.pi * inverse) * series
    return value


def k_ratios(max_order: int, z: npt.ArrayLike, *, left: bool = False) -> ComplexArray:
    """Return S_m = K_{m+1}/K_m for m = 0..max_order; parameters and errors are those of :func:`i_ratios`."""
    z = as_complex(z, left=left)
    ratios = np.empty((max_order + 1, z.size), dtype=np.complex128)
    ratios[0] = kve(1, z) / kve(0, z)
    two_over_z = 2.0 / z
    work = np.empty_like(z)
    for m in range(1, max_order + 1):
        np.reciprocal(ratios[m - 1], out=ratios[m])
        np.multiply(two_over_z, m, out=work)
        np.add(ratios[m], work, out=ratios[m])
    return ratios


def running_product(first: Any, factors: ComplexArray) -> ComplexArray:
    """Return first * prod_{j<m} factors_j for m = 0..M: a quantity of order m from its order 0 and ratios between orders.

    The last row of ``factors`` is not used. Underflow to zero is the right limit of every product formed here.
    """
    product = np.empty_like(factors)
    product[0] = first
    for m in range(1, factors.shape[0]):
        np.multiply(product[m - 1], factors[m - 1], out=product[m])
    return product


def i_across(ratios_a: ComplexArray, ratios_b: ComplexArray, za: npt.ArrayLike, zb: npt.ArrayLike, *, left: bool = False) -> ComplexArray:
    """Return I_m(za)/I_m(zb) for m = 0..M, with |za| < |zb| on one ray, from the ratios R_m at both arguments."""
    za, zb = as_complex(za, left=left), as_complex(zb, left=left)
    order_zero = ive(0, za) / ive(0, zb) * np.exp(np.abs(za.real) - np.abs(zb.real))
    return running_product(order_zero, ratios_a / ratios_b)


def k_across(ratios_a: ComplexArray, ratios_b: ComplexArray, za: npt.ArrayLike, zb: npt.ArrayLike, *, left: bool = False) -> ComplexArray:
    """Return K_m(zb)/K_m(za) for m = 0..M, with |za| < |zb| on one ray, from the ratios S_m at both arguments."""
    za, zb = as_complex(za, left=left), as_complex(zb, left=left)
    order_zero = kve(0, zb) / kve(0, za) * np.exp(za - zb)
    return running_product(order_zero, ratios_b / ratios_a)
