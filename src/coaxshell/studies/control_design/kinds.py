"""The kinds of control law that a design chooses from, each a rational H(s) of few numbers in units of the plant.

With g the gain that turns as much voltage as the sensors read at rest per volt (|G H| = 1), in the sign that stiffens, and omega_0 the
ring frequency, k and all ratios of frequencies being numbers about 1:

    rate               H = g k s/omega_0
    pd                 H = g (k_p + k_d s/omega_0)
    lead-lag           H = g k (1 + s/z)/(1 + s/p)
    resonant           H = g k omega s/(s^2 + 2 zeta omega s + omega^2)
    positive-position  H = -g k omega^2/(s^2 + 2 zeta omega s + omega^2)
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import FloatArray

Polynomials = tuple[tuple[float, ...], tuple[float, ...]]
"""Numerator and denominator, highest power of s first."""


class Reference(NamedTuple):
    """Gain g, V/V and signed, and frequency omega_0, radians per transit."""

    gain: float
    frequency: float


class Kind(NamedTuple):
    """One kind of law.

    Attributes
    ----------
    name, words : str
    bounds : tuple of (float, float)
        Between which each number is looked for, on a logarithmic scale.
    made : callable
        From the numbers and the reference to the polynomials in s, transits.
    """

    name: str
    words: str
    bounds: tuple[tuple[float, float], ...]
    made: Callable[[FloatArray, Reference], Polynomials]


_GAIN, _FREQUENCY, _DAMPING = (1e-2, 1e2), (0.1, 10.0), (0.05, 3.0)


def _rate(x: FloatArray, by: Reference) -> Polynomials:
    return (by.gain * x[0] / by.frequency, 0.0), (1.0,)


def _pd(x: FloatArray, by: Reference) -> Polynomials:
    return (by.gain * x[1] / by.frequency, by.gain * x[0]), (1.0,)


def _lead_lag(x: FloatArray, by: Reference) -> Polynomials:
    gain, zero, pole = by.gain * x[0], by.frequency * x[1], by.frequency * x[2]
    return (gain / zero, gain), (1.0 / pole, 1.0)


def _second_order(x: FloatArray, by: Reference) -> tuple[float, float, tuple[float, ...]]:
    omega = by.frequency * x[1]
    return by.gain * x[0], omega, (1.0, 2.0 * x[2] * omega, omega**2)


def _resonant(x: FloatArray, by: Reference) -> Polynomials:
    gain, omega, denominator = _second_order(x, by)
    return (gain * omega, 0.0), denominator


def _positive_position(x: FloatArray, by: Reference) -> Polynomials:
    gain, omega, denominator = _second_order(x, by)
    return (-gain * omega**2,), denominator


KINDS = {
    kind.name: kind
    for kind in (
        Kind("rate", "rate feedback", (_GAIN,), _rate),
        Kind("pd", "proportional-derivative feedback", (_GAIN, _GAIN), _pd),
        Kind("lead-lag", "lead-lag feedback", (_GAIN, _FREQUENCY, (0.1, 100.0)), _lead_lag),
        Kind("resonant", "resonant feedback", (_GAIN, _FREQUENCY, _DAMPING), _resonant),
        Kind("positive-position", "positive position feedback", (_GAIN, _FREQUENCY, _DAMPING), _positive_position),
    )
}


def with_corner(polynomials: Polynomials, corner: float | None) -> Polynomials:
    """Return the polynomials with a corner, radians per transit, of first order in the denominator."""
    if corner is None:
        return polynomials
    top, bottom = polynomials
    return top, tuple(float(x) for x in np.polymul(bottom, (1.0 / corner, 1.0)))
