"""Hankel functions H_m of real and complex argument at any order from 0, with no loss for large ones.

Debye's expansions of H_m and H_m' for |z| well above m, real or complex (DLMF 10.19(iii), 10.41.10): with w = sqrt(z^2 - m^2),
c = m^2/w^2 and the phase xi = w - m arccos(m/z) - pi/4,

    H1_m  = sqrt(2/(pi w)) e^{i xi} sum_k (-i/w)^k U_k(-c),      H1_m' = i sqrt(2 w/pi)/z e^{i xi} sum_k (-i/w)^k V_k(-c),

U_k and V_k the polynomials of DLMF 10.41(ii) without their lowest power; H2 is the same with -i for i.

Modulus and phase of H_m'(x) for real x: J_m' = N cos(phi), Y_m' = N sin(phi), the phase unwrapped (DLMF 10.18).
"""

from __future__ import annotations

from fractions import Fraction
from functools import cache
from typing import NamedTuple

import numpy as np
from scipy.special import jv, yv

from coaxshell.numerics.arrays import ComplexArray, FloatArray

_TERMS = 16
_BANDS = ((0.0, 100.0, 16), (100.0, 300.0, 10), (300.0, 2e3, 7), (2e3, 3e4, 5), (3e4, 1e7, 3), (1e7, np.inf, 2))
_Polynomial = dict[int, Fraction]


class Expansion(NamedTuple):
    """Value and slope of H1_m (without e^{iz}) or H2_m (without e^{-iz})."""

    value: ComplexArray
    slope: ComplexArray


def expand(order: FloatArray | float, z: ComplexArray, kind: int) -> Expansion:
    """Return H_m and H_m' of the first or second kind without their exponential, to rounding where |z| >= :func:`reach`."""
    turn, root = _turn(kind), _root(order, z)
    carrier = _carrier(order, z, root, turn)
    value, slope = (_series(table, order, root, turn) for table in _tables())
    return Expansion(carrier * value, turn * carrier * root / z * slope)


def expand_slope(order: FloatArray | float, z: ComplexArray, kind: int) -> ComplexArray:
    """Return H_m' alone, as :func:`expand` does."""
    turn, root = _turn(kind), _root(order, z)
    return np.asarray(turn * _carrier(order, z, root, turn) * root / z * _series(_tables()[1], order, root, turn), dtype=np.complex128)


def reach(order: FloatArray | float) -> FloatArray:
    """Return the |z| from which the expansions are good to rounding."""
    return np.asarray(1.3 * np.asarray(order, dtype=np.float64) + 24.0, dtype=np.float64)


def _turn(kind: int) -> complex:
    return 1j if kind == 1 else -1j


def _root(order: FloatArray | float, z: ComplexArray) -> ComplexArray:
    return np.asarray(np.sqrt(z - order) * np.sqrt(z + order), dtype=np.complex128)


def _carrier(order: FloatArray | float, z: ComplexArray, root: ComplexArray, turn: complex) -> ComplexArray:
    phase = -(np.square(order)) / (root + z) - order * (0.5 * np.pi - np.arcsin(order / z)) - 0.25 * np.pi
    return np.asarray(np.exp(turn * phase) * np.sqrt(2.0 / (np.pi * root)), dtype=np.complex128)


def _series(table: tuple[tuple[float, ...], ...], order: FloatArray | float, root: ComplexArray, turn: complex) -> ComplexArray:
    """Return the sum over k, with as many terms as |w| asks for."""
    size = np.abs(root)
    inverse, ratio = -turn / root, -np.square(order / root)
    total = np.ones_like(root)
    for low, high, terms in _BANDS:
        band = (size >= low) & (size < high)
        if np.any(band):
            total[band] = _partial(table[: terms + 1], inverse[band], ratio[band])
    return total


def _partial(rows: tuple[tuple[float, ...], ...], inverse: ComplexArray, ratio: ComplexArray) -> ComplexArray:
    total = np.zeros_like(inverse)
    for row in rows[:0:-1]:
        inner = np.full_like(inverse, row[-1])
        for coefficient in row[-2::-1]:
            inner *= ratio
            inner += coefficient
        total += inner
        total *= inverse
    return total + 1.0


@cache
def _tables() -> tuple[tuple[tuple[float, ...], ...], tuple[tuple[float, ...], ...]]:
    """Return the coefficients of U_k and V_k in p^2, without their lowest power p^k."""
    u: list[_Polynomial] = [{0: Fraction(1)}]
    v: list[_Polynomial] = [{0: Fraction(1)}]
    for _ in range(_TERMS):
        u.append(_next_u(u[-1]))
        v.append(_next_v(u[-1], u[-2]))
    first, second = (
        tuple(tuple(float(polynomial[k + 2 * j]) for j in range(k + 1)) for k, polynomial in enumerate(family)) for family in (u, v)
    )
    return first, second


def _next_u(u: _Polynomial) -> _Polynomial:
    """u_{k+1} = p^2 (1 - p^2) u_k'/2 + (1/8) int (1 - 5 p^2) u_k dp (DLMF 10.41.9)."""
    found: _Polynomial = {}
    for power, a in u.items():
        found[power + 1] = found.get(power + 1, Fraction(0)) + a * (Fraction(power, 2) + Fraction(1, 8 * (power + 1)))
        found[power + 3] = found.get(power + 3, Fraction(0)) - a * (Fraction(power, 2) + Fraction(5, 8 * (power + 3)))
    return found


def _next_v(u: _Polynomial, before: _Polynomial) -> _Polynomial:
    """v_k = u_k + p (p^2 - 1) (u_{k-1}/2 + p u_{k-1}') (DLMF 10.41.9)."""
    found = dict(u)
    for power, a in before.items():
        term = a * (Fraction(1, 2) + power)
        found[power + 1] = found.get(power + 1, Fraction(0)) - term
        found[power + 3] = found.get(power + 3, Fraction(0)) + term
    return found


_DECAYED = 45.0
"""Where J_m has fallen to e^-45 and Y_m has risen to its inverse, the phase is pi/2 to rounding."""


class Phase(NamedTuple):
    """phi(x), its derivative and the modulus N(x), of the derivative H_m' of the Hankel function."""

    angle: FloatArray
    slope: FloatArray
    modulus: FloatArray


def derivative_phase(order: FloatArray, x: FloatArray) -> Phase:
    """Return phase and modulus of H_m'(x), x > 0; far below x = m the modulus is infinite and the phase pi/2.

    The phase starts at pi/2, falls until x = m and rises from there to x - (m/2 - 1/4) pi. Orders and x have the same shape.
    """
    angle, modulus = np.empty_like(x), np.empty_like(x)
    far = x >= reach(order)
    if np.any(far):
        outgoing = expand_slope(order[far], x[far].astype(np.complex128), 1)
        angle[far], modulus[far] = np.angle(outgoing) + x[far], np.abs(outgoing)
    near = ~far
    if np.any(near):
        j, y = _near(order[near], x[near])
        angle[near], modulus[near] = np.arctan2(y, j), np.hypot(j, y)
    angle += 2.0 * np.pi * np.round((_leading(order, x) - angle) / (2.0 * np.pi))
    return Phase(angle, 2.0 * (x * x - order * order) / (np.pi * x**3 * modulus**2), modulus)


def rough_phase(order: FloatArray, x: FloatArray) -> FloatArray:
    """Return the phase to 0.01: its leading term where that is good, itself elsewhere."""
    angle = _leading(order, x)
    near = x < reach(order)
    if np.any(near):
        angle[near] = derivative_phase(order[near], x[near]).angle
    return angle


def _near(order: FloatArray, x: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return J_m' and Y_m'."""
    j, y = np.zeros_like(x), np.full_like(x, np.inf)
    ratio = np.minimum(x / np.maximum(order, 1e-300), 1.0)
    decay = order * (np.arccosh(1.0 / ratio) - np.sqrt(1.0 - ratio**2))
    some = decay < _DECAYED
    m, z = order[some], x[some]
    j[some] = m / z * jv(m, z) - jv(m + 1.0, z)
    y[some] = m / z * yv(m, z) - yv(m + 1.0, z)
    return j, y


def _leading(order: FloatArray, x: FloatArray) -> FloatArray:
    """Debye's phase, within 0.6 of the true one everywhere: enough to unwrap it."""
    above = np.maximum(x, order)
    return np.asarray(np.sqrt(above**2 - order**2) - order * np.arccos(order / above) + 0.25 * np.pi, dtype=np.float64)
