"""How far a spherical shock is felt along the axis, and when: by whichever wave gets there first.

A front from a point at the distance S from the head, fired at t = -S, runs along the head line of the wall to z at
t = sqrt(S^2 + z^2) - S. A wave of speed c > 1 (in c_e), in another fluid or in a wall, leaves it behind: from

    z_0 = S/sqrt(c^2 - 1)    on it arrives at z at    t = (z + S sqrt(c^2 - 1))/c - S,

as a head wave does. Nothing is felt earlier anywhere else on the walls, nor scattered from them.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import NamedTuple


def reach(time: float, start: float, speed: float) -> float:
    """Return how far along the axis a shock is felt by a time after its front reached the head.

    c (T + S) - S sqrt(c^2 - 1) where c > 1 and S/sqrt(c^2 - 1) <= sqrt(T^2 + 2 S T), else sqrt(T^2 + 2 S T).

    Parameters
    ----------
    time : float
        T, in a/c_e; before 0 there is nothing.
    start : float
        S, distance of the source from the head, in a.
    speed : float
        c, of the fastest wave, in c_e.
    """
    time = max(time, 0.0)
    front = math.sqrt(time) * math.sqrt(time + 2.0 * start)
    if speed <= 1.0 or _departure(start, speed) > front:
        return front
    return speed * time + start / (speed + _faster(speed))  # c - sqrt(c^2 - 1), without its cancellation


def first_arrival(z: float, start: float, speed: float) -> float:
    """Return when a shock is first felt at an axial distance: the time T at which its :func:`reach` is |z|.

    Parameters
    ----------
    z : float
        From the source's plane, in a.
    start, speed : float
        S in a and c in c_e, see :func:`reach`.
    """
    z = abs(z)
    if speed <= 1.0 or z <= _departure(start, speed):
        return z * (z / (math.hypot(start, z) + start)) if z else 0.0
    return (z - start / (speed + _faster(speed))) / speed


class Front(NamedTuple):
    """A spherical front: axial position and distance S from the head of its source, in a, and when it reaches the head, in a/c_e."""

    z: float
    start: float
    delay: float = 0.0


def felt_length(duration: float, fronts: Iterable[Front], speed: float) -> float:
    """Return the length of the stretch of the axis along which shocks are felt within a run; 0 for no fronts.

    max (z_source + reach) - min (z_source - reach): from this axial period on nothing of the sources meets anything of their images, and
    integrals along the whole axis, energies for instance, are those of the sources alone. For one source it is 2 reach.

    Parameters
    ----------
    duration, fronts, speed
        As for :func:`least_period`.
    """
    ends = [(front.z, reach(duration - front.delay, front.start, speed)) for front in fronts]
    return max((z + r for z, r in ends), default=0.0) - min((z - r for z, r in ends), default=0.0)


def least_period(duration: float, places: Iterable[float], fronts: Iterable[Front], speed: float) -> float:
    """Return the axial period L from which on images of the sources, at z + nL, are not felt at some places within a run; 0 for no fronts.

    L = max (|z - z_source| + reach(T - delay)), over places and sources.

    Integrals along the whole axis are then those of the row of sources; those of the sources alone need :func:`felt_length`.

    Parameters
    ----------
    duration : float
        T, in a/c_e.
    places : iterable of float
        z of stations, and of whatever breaks the uniformity of the walls along the axis, in a.
    fronts : iterable of Front
    speed : float
        Of the fastest wave, in c_e.
    """
    places = list(places)
    return max((abs(z - front.z) + reach(duration - front.delay, front.start, speed) for front in fronts for z in places), default=0.0)


def rounded_up(value: float) -> float:
    """Return a number of four digits that is no less, for a message that tells what is enough."""
    digits = 3 - math.floor(math.log10(value))
    return math.ceil(value * 10.0**digits) / 10.0**digits


def _faster(speed: float) -> float:
    """Return sqrt(c^2 - 1)."""
    return math.sqrt((speed - 1.0) * (speed + 1.0))


def _departure(start: float, speed: float) -> float:
    """Return z_0 = S/sqrt(c^2 - 1), from which on a wave of speed c > 1 runs ahead of the front."""
    return start / _faster(speed)
