"""The pressure of an explosion under water: the shock wave, then its bubble, which overexpands and collapses again and again.

A bubble of radius a whose volume V changes radiates p = rho V''/(4 pi R), V'' = 4 pi (2 a a'^2 + a^2 a''). Its gas follows the adiabat of
the products of TNT, p_g = 780 MPa (v/(cm^3/g))^(-5/4), v the volume per mass of charge (H. Jones and A. R. Miller, Proc. R. Soc. A 194
(1948); Cole, Underwater Explosions, ch. 8), and its largest radius is that of the similitude,

    A = K6 (W/Z)^(1/3),        Z = depth + 10 m.

Until it is that large the water is taken as incompressible (Rayleigh and Plesset): the motion is that of a collapse in reverse, without
losses, and the pulse is the shock wave's until the bubble's is the larger. Then the bubble loses energy by radiation (J. B. Keller and
M. Miksis, J. Acoust. Soc. Am. 68 (1980)),

    (1 - a'/c) a a'' + (3/2)(1 - a'/(3c)) a'^2 = (1 + a'/c)(p_g - p_0)/rho + a p_g'/(rho c),

which makes each pulse weaker than the one before. The period is then no input: that of the similitude, K5 W^(1/3)/Z^(5/6), is met within
5 % from 1 to 500 kg and 10 to 100 m (a run warns where it is not), and so is the peak of the first pulse that Cole gives of TNT,
7.1 MPa m/kg^(1/3), within 25 %. HBX-1 and PETN take the adiabat of TNT too: K6 tells what energy their bubbles have.
Migration towards the surface, and what surface, bottom and shells do to the bubble's shape, are left out.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from coaxshell.model.sea import ATMOSPHERE, GRAVITY

if TYPE_CHECKING:
    from coaxshell.numerics.arrays import FloatArray

DENSITY, SPEED = 1025.0, 1500.0
"""Sea water, in which the fits were made, kg/m^3 and m/s."""
ADIABAT, EXPONENT = 780e6, 1.25
HEAD = 10.0
"""Depth whose pressure is the atmosphere's, m."""
_SHOCK = 160
"""Samples of the shock wave."""
_FINER = 4
"""Samples to each step of the bubble's integration."""


def largest_radius(mass: float, depth: float, factor: float) -> float:
    """Return A (m) of a charge (kg) at a depth (m), *factor* its K6."""
    return float(factor * (mass / (depth + HEAD)) ** (1.0 / 3.0))


def similitude_period(mass: float, depth: float, factor: float) -> float:
    """Return the time (s) from the explosion to the first bubble pulse, *factor* its K5."""
    return float(factor * mass ** (1.0 / 3.0) / (depth + HEAD) ** (5.0 / 6.0))


@lru_cache(maxsize=64)
def oscillation(mass: float, depth: float, factor: float, pulses: int) -> tuple[FloatArray, FloatArray]:
    """Return times since the explosion (s) and rho V''/(4 pi) (Pa m) until the bubble is largest after so many pulses.

    Parameters
    ----------
    mass, depth, factor : float
        Charge (kg), depth (m) and K6.
    pulses : int
    """
    import numpy as np

    rest, largest = ATMOSPHERE + DENSITY * GRAVITY * depth, largest_radius(mass, depth, factor)
    half = _motion(mass, rest, largest, math.inf, 1)
    later = _motion(mass, rest, largest, SPEED, 2 * pulses)
    middle = half[0][-1]
    back = slice(None, 0, -1)
    time = np.concatenate([middle - half[0][back], middle + later[0]])
    strength = np.concatenate([half[1][back], later[1]])
    return time, strength


def first_pulse(mass: float, depth: float, factor: float) -> float:
    """Return the time (s) from the explosion to the first pulse as the model has it, of which the similitude knows its own."""
    time, strength = oscillation(mass, depth, factor, 1)
    late = time > 0.5 * time[-1]
    return float(time[late][strength[late].argmax()])


def _motion(mass: float, rest: float, largest: float, speed: float, turns: int) -> tuple[FloatArray, FloatArray]:
    """Return times from rest at the largest radius and rho V''/(4 pi), until the bubble has turned so many times."""
    import numpy as np
    from scipy.integrate import solve_ivp

    def gas(a: Any) -> Any:
        return ADIABAT * (1e3 * 4.0 / 3.0 * math.pi * a**3 / mass) ** -EXPONENT  # m^3/kg are 1000 cm^3/g

    def acceleration(a: Any, v: Any) -> Any:
        pressure, mach = gas(a), v / speed
        change = -3.0 * EXPONENT * pressure * v / speed  # a p_g'/c
        return ((1.0 + mach) * (pressure - rest) / DENSITY + change / DENSITY - 1.5 * (1.0 - mach / 3.0) * v * v) / ((1.0 - mach) * a)

    def turned(t: float, state: FloatArray) -> float:
        return float(state[1]) if t > 0.0 else 1.0

    turned.terminal = turns + 1  # type: ignore[attr-defined] # the start is one
    longest = 3.0 * turns * largest * math.sqrt(DENSITY / rest)
    found: Any = solve_ivp(
        lambda t, state: [state[1], acceleration(state[0], state[1])],
        (0.0, longest),
        [largest, 0.0],
        events=turned,
        rtol=1e-9,
        atol=1e-12 * largest,
        dense_output=True,
    )
    ends = found.t_events[0][found.t_events[0] > 1e-6 * longest]
    steps = found.t[found.t < ends[turns - 1]]
    time = np.append(steps, ends[turns - 1])
    time = np.interp(np.arange((time.size - 1) * _FINER + 1) / _FINER, np.arange(time.size), time)
    a, v = found.sol(time)
    return time, DENSITY * (2.0 * a * v**2 + a**2 * acceleration(a, v))


def whole_pulse(
    peak: float, decay: float, stand_off: float, mass: float, depth: float, factor: float, pulses: int
) -> tuple[FloatArray, FloatArray]:
    """Return times (s) and pressures (Pa) of shock wave and bubble at a distance (m): the shock wave until the bubble's is the larger.

    Parameters
    ----------
    peak, decay : float
        Of the shock wave there, Pa and s.
    stand_off, mass, depth, factor : float
        Distance (m), charge (kg), its depth (m) and K6.
    pulses : int
        How many bubble pulses follow.
    """
    import numpy as np

    time, strength = oscillation(mass, depth, factor, pulses)
    shock_time = np.concatenate([[0.0], decay * np.geomspace(1e-2, 12.0, _SHOCK)])
    both = np.union1d(shock_time, time)
    bubble = np.interp(both, time, strength / stand_off)
    shock = peak * np.exp(-both / decay)
    later = np.flatnonzero(bubble >= shock)
    meets = int(later[both[later] > decay][0])
    pressure = np.where(np.arange(both.size) < meets, shock, bubble)
    end = both[-1]
    return np.append(both, end * (1.0 + 1e-3)), np.append(pressure, 0.0)
