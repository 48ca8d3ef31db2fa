"""A true spherical wave at one axial wavenumber: modal pressure and radial velocity on the outer surface, by quadrature alone.

R3 the distance from the source, D its part in the plane, S = R0 - 1 and x = t - (R3 - S) the time since the front:

    p = (S/R3) f(x),        v = (S/R3) [f(x) + F(x)/R3] away from the source,        F the integral of f.

What is taken is the integral of p cos kz over z > 0, half of that over the whole axis. With z = D sinh q it is

    S integral of f(t + S - D cosh q) cos(k D sinh q) dq,

by Gauss's rule in q before and within the pulse, and on the orders by the trapezoidal rule in theta.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.polynomial import legendre

from coaxshell.apps.verification.independent.incident import pulse_and_integral
from coaxshell.model.pulses import Gaussian, Pulse
from coaxshell.numerics.arrays import FloatArray

_LASTING = 9.0
"""Widths after its centre at which a Gaussian pulse is over."""
_ANGLES_PER_RADIAN = 3.0
"""Angles on the half circle per radian that the highest frequency of a pulse and the highest order turn."""


def incident_sphere(
    pulse: Pulse, distance: float, wavenumber: float, orders: Sequence[int], time: FloatArray, transit: float, pressure: float
) -> tuple[FloatArray, FloatArray]:
    """Return modal pressure and radial velocity at r = 1 about the source's own axis, each of shape (orders, T), in units of a.

    Parameters
    ----------
    pulse : Pulse
        Smooth: the trapezoidal rule in theta does not see fronts.
    distance, wavenumber : float
        R0 in a, k in 1/a.
    orders : sequence of int
    time : ndarray, shape (T,)
        In transits.
    transit, pressure : float
        a/c_e in s and rho_e c_e^2 in Pa.
    """
    if not isinstance(pulse, Gaussian):
        raise NotImplementedError("the independent solver knows the true spherical wave of a Gaussian pulse only")
    count = 48 + int(_ANGLES_PER_RADIAN * (8.0 * transit / pulse.width + max(orders)))
    theta = np.pi * (np.arange(count) + 0.5) / count
    clock = np.asarray(time) + distance - 1.0
    longest = np.sqrt(max(float(clock.max()) ** 2 - (distance - 1.0) ** 2, 0.0))
    rule = legendre.leggauss(64 + int(np.ceil(0.6 * wavenumber * longest)))
    p, v = np.zeros((2, len(orders), clock.size))
    for angle in theta:
        plane = np.sqrt(1 + distance**2 - 2 * distance * np.cos(angle))
        here = (distance - 1.0) * along_axis(pulse, plane, wavenumber, clock, rule, transit, pressure)
        here[1] *= (1 - distance * np.cos(angle)) / plane
        shares = np.array([(1 if m == 0 else 2) / count * np.cos(m * angle) for m in orders])
        p += np.outer(shares, here[0])
        v += np.outer(shares, here[1])
    return p, v


def along_axis(
    pulse: Gaussian, plane: float, k: float, clock: FloatArray, rule: tuple[FloatArray, FloatArray], transit: float, pressure: float
) -> FloatArray:
    """Return the integrals over z > 0 of f/R3 cos kz and of (f/R3 + F/R3^2) D/R3 cos kz, shape (2, T), f and F at ``clock`` - R3.

    ``plane`` is D, the distance in the plane; ``rule`` nodes and weights of Gauss's rule on [-1, 1].
    """
    over = (pulse.centre + _LASTING * pulse.width) / transit
    inner, outer = (np.arccosh(np.maximum(x / plane, 1.0)) for x in (clock - over, clock))
    total = np.zeros((2, clock.size))
    started = outer > 0
    for start, end in ((0 * inner, inner), (inner, outer)):
        half = (end - start)[started, None] / 2
        q = start[started, None] + half * (1 + rule[0])
        far = plane * np.cosh(q)
        f, integral = pulse_and_integral(pulse, np.maximum(clock[started, None] - far, 0.0), transit, pressure)
        waves = np.cos(k * plane * np.sinh(q)) * half * rule[1]
        total[0, started] += (f * waves).sum(1)
        total[1, started] += ((f + integral / far) * plane / far * waves).sum(1)
    return total
