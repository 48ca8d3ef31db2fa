"""The incident wave on the outer surface: modal pressure and radial velocity by Gauss quadrature over the wetted arc."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.polynomial import legendre
from scipy.special import erf

from coaxshell.model.pulses import Exponential, Gaussian, Pulse, Step
from coaxshell.numerics.arrays import FloatArray

POINTS = 80


def pulse_and_integral(pulse: Pulse, x: FloatArray, transit: float, pressure: float) -> tuple[FloatArray, FloatArray]:
    """Return f and its integral since the front, dimensionless, x in transits behind the front (x >= 0)."""
    match pulse:
        case Exponential():
            decay, peak = pulse.decay_time / transit, pulse.peak_pressure / pressure
            return peak * np.exp(-x / decay), peak * decay * (1 - np.exp(-x / decay))
        case Gaussian():
            width, centre, peak = pulse.width / transit, pulse.centre / transit, pulse.peak_pressure / pressure
            f = peak * np.exp(-(((x - centre) / width) ** 2) / 2)
            root = np.sqrt(2) * width
            return f, peak * width * np.sqrt(np.pi / 2) * (erf((x - centre) / root) + erf(centre / root))
        case Step(rise_time=0.0):
            height = pulse.pressure / pressure
            return np.full_like(x, height), height * x
    raise NotImplementedError(f"the independent solver knows no {pulse.type} pulse")


def incident(
    pulse: Pulse, distance: float | None, orders: Sequence[int], time: FloatArray, transit: float, pressure: float
) -> tuple[FloatArray, FloatArray]:
    """Return modal pressure and radial velocity at r = 1 about the source's own axis, each of shape (orders, T).

    ``distance`` is R0 in units of a, or None for a plane wave; both waves are those of Eq. 2, the spherical one with its afterflow.
    """
    x, weight = legendre.leggauss(POINTS)
    t = np.asarray(time)[:, None]
    reach = np.maximum(t, 0.0)  # path beyond the head
    spread: FloatArray | float
    curvature: FloatArray | float
    if distance is None:
        theta, shares = _arc(1 - reach, x, weight)
        range_, spread, slope, curvature = 1 - np.cos(theta), 1.0, -np.cos(theta), 0.0
    else:
        theta, shares = _arc((1 + distance**2 - (distance - 1 + reach) ** 2) / (2 * distance), x, weight)
        far = np.sqrt(1 + distance**2 - 2 * distance * np.cos(theta))
        range_, spread, slope, curvature = far - (distance - 1), (distance - 1) / far, (1 - distance * np.cos(theta)) / far, 1 / far
    f, integral = pulse_and_integral(pulse, t - range_, transit, pressure)
    p, v = spread * f, spread * slope * (f + curvature * integral)

    def project(g: FloatArray) -> FloatArray:
        return np.array([2 * (g * np.cos(m * theta) * shares).sum(1) / (np.pi * (2 if m == 0 else 1)) for m in orders])

    return project(p), project(v)


def _arc(front: FloatArray, x: FloatArray, weight: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return angles and quadrature weights on the arc that a front at this cosine has wetted."""
    arc = np.arccos(np.clip(front, -1, 1))
    return arc * (x + 1) / 2, arc * weight / 2
