"""Modulus and phase of H_m'(x): J_m' = N cos(phi), Y_m' = N sin(phi), the phase unwrapped (DLMF 10.18)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.special import jv, yv

from coaxshell.acoustics.response_functions.debye import expand_slope, reach
from coaxshell.numerics.arrays import FloatArray

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
