"""What an answer at given frequencies says of itself: units, words, and warnings where it cannot be trusted."""

from __future__ import annotations

import math

import numpy as np

from coaxshell.model.gains import saturates
from coaxshell.model.places import shell_phrase
from coaxshell.model.prefixes import engineering
from coaxshell.response.frequency.request import Asked
from coaxshell.solver.scaling import Problem
from coaxshell.structure.thin_wall import ThinWall

LEFT_OUT = 1e-3
"""Share of the top fifth of the orders above which the rest may matter."""
TOO_FAST = 0.05
"""Error of the frequency of a bending wave that is told."""
_SHEAR = 0.18
"""Shear and rotary inertia of a plate lower the frequency of a bending wave by this times (k h)^2, at nu = 0.3 (theory manual)."""


def unit_of(what: Asked) -> str:
    """Return the unit, with what it is per."""
    unit = what.quantity.unit
    if what.quantity.name == "target_strength":
        return "dB re 1 m" if what.length is None else "dB re 1 m^2"
    if what.quantity.kind in ("target", "through", "point"):
        return unit
    if what.force is not None:
        return f"{unit}/(N/m)"
    if what.per == "absolute":
        return f"{unit}/Hz"
    return "1" if unit == "Pa" else f"{unit}/Pa"


def words_of(what: Asked) -> str:
    """Return what an axis says."""
    name = what.quantity.long_name
    if what.quantity.name == "stress":
        name = f"{what.component.replace('_', ' ')} stress"
    if what.quantity.kind in ("target", "through", "point"):
        return name
    if what.quantity.kind == "field" and what.part != "total":
        name = f"{what.part} {name}"
    if what.force is not None:
        return f"{name} per line force"
    return f"{name}, spectrum" if what.per == "absolute" else f"{name} per incident pressure"


def remarks(problem: Problem, highest: float, share: float, orders: int, what: Asked) -> list[str]:
    """Return warnings, each with its numbers and what to do.

    Parameters
    ----------
    problem : Problem
    highest : float
        Highest frequency, radians per transit.
    share : float
        Of the top fifth of the orders in the largest value.
    orders : int
    what : Asked
    """
    return [*_cubic(problem), *_saturating(problem), *_left_out(problem, share, orders, what), *_bending(problem, highest)]


def _cubic(problem: Problem) -> list[str]:
    cubic = [one for one in problem.system.absorber_list if one.cubic_stiffness]
    if not cubic:
        return []
    stretch = min(math.sqrt(one.linear_stiffness / one.cubic_stiffness) for one in cubic)
    reach = f"below a stretch of {engineering(stretch, 'm')}, where it equals the linear one" if stretch else "at no amplitude: k_l = 0"
    return [
        f"absorbers: {len(cubic)} of {len(problem.system.absorber_list)} have a cubic stiffness, which is left out: the answer holds well "
        f"{reach}; simulate tells what they do at theirs"
    ]


def _saturating(problem: Problem) -> list[str]:
    if not saturates(problem.system):
        return []
    return ["control.saturation: the linear law is taken, whatever the voltage; simulate cuts it at the limit"]


def _left_out(problem: Problem, share: float, orders: int, what: Asked) -> list[str]:
    if share <= LEFT_OUT:
        return []
    if what.force is not None and not problem.shells[what.force.shell].faces_move_alike:
        advice = "a line force on a solid has no finite displacement where it acts; read it elsewhere"
    else:
        advice = f"use modes={2 * orders} and compare"
    return [f"modes: the top fifth of the orders up to {orders} makes {100.0 * share:.2g} % of the largest value; {advice}"]


def _bending(problem: Problem, highest: float) -> list[str]:
    """Return a warning for each thin wall whose bending waves are too short for its theory at the highest frequency."""
    found = []
    for number, wall in enumerate(problem.shells):
        if not isinstance(wall, ThinWall) or wall.section.bending <= 0.0:
            continue
        thickness = wall.faces[1] - wall.faces[0]
        k = math.sqrt(highest * math.sqrt(wall.mass / wall.section.bending))
        error = _SHEAR * (k * thickness) ** 2
        if error > TOO_FAST:
            least = highest * TOO_FAST / error / (2.0 * np.pi * problem.scales.time)
            found.append(
                f"{shell_phrase(number, len(problem.shells))}: at the highest frequency a thin wall's bending waves are about "
                f"{100.0 * error:.2g} % too fast, as it has no shear across it; stay below {engineering(least, 'Hz')} for "
                f'{100.0 * TOO_FAST:g} %, or use theory = "elastic"'
            )
    return found
