"""Inclined plane waves: whether feedback moves the walls ahead of the front.

Feedback of a rate of stretching makes a wall viscous along the axis: in the simplest case, of a membrane with mass I,

    I s^2 = (d11 + G s) (-k^2) = (d11 + G s) s^2 sin^2 alpha,        s_0 = (I - d11 sin^2 alpha)/(G sin^2 alpha).

What is viscous has no fastest wave: the wall is stretched ahead of the front, by e^{s_0 t} before it comes. That is a pole on the real
axis, right of the contour, and the inverse transform takes it for what it is as long as the contour runs well to its left: what was before
t = 0 returns around the period P as e^{s_0 (t - P)} e^{sigma P}. The determinants of an order with feedback and without tell where
it is: real on the real axis, where k = -i s sin alpha is imaginary, their ratio changes sign there. Fluids are counted in.
"""

from __future__ import annotations

import math

import numpy as np

from coaxshell.acoustics.sources import PlaneGeometry
from coaxshell.errors import InputError
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.modes import Modes
from coaxshell.solver.axial.causality import rounded_up
from coaxshell.solver.scaling import Problem
from coaxshell.solver.stability import determinant_ratio

_ORDERS = np.arange(2.0)
"""Those that bend least are stretched furthest ahead."""
_SAMPLES, _ROUNDS = 40, 2
_LEFT = 1e-2
"""What may return around the period, of the motion as the front comes."""


def require_fronts_before_feedback(problem: Problem, grid: LaplaceGrid) -> None:
    """Refuse plane waves so inclined that feedback moves the walls ahead of them so slowly that the run takes it for growth.

    Raises
    ------
    InputError
        It names the source's inclination.
    """
    for where, degrees, rate in _ahead(problem, grid):
        needed = math.log(1.0 / (grid.wrap_around * _LEFT)) / rate  # e^{s_0 (T - P)} of t = 0, with e^{sigma P}
        if grid.period - grid.time[-1] < needed:
            raise InputError(
                where,
                f"{degrees:g} degrees: feedback damps the walls along the axis, which stretches them {_told(problem, rate)} and more "
                "before the front comes: a run of this length cannot tell that from growth",
                f"use duration = {rounded_up(needed):g} or more, less inclination, or lower derivative gains",
            )


def moved_ahead(problem: Problem, grid: LaplaceGrid) -> list[str]:
    """Return the warning that feedback moves the walls ahead of an inclined front, as long as the time step resolves it."""
    return [
        f"{where}: feedback damps the walls along the axis, which stretches them ahead of the front, inclined by {degrees:g} degrees, "
        f"{_told(problem, rate)} before it comes; what is before t = 0 is not shown: use less inclination, or lower derivative gains"
        for where, degrees, rate in _ahead(problem, grid)
    ]


def _told(problem: Problem, rate: float) -> str:
    return f"{1e6 * problem.scales.time / rate:.3g} microseconds"


def _ahead(problem: Problem, grid: LaplaceGrid) -> list[tuple[str, float, float]]:
    """Return path and inclination of each source ahead of which feedback moves the walls, and the least s_0 that is resolved."""
    if all(wall.gains is None for wall in problem.shells):
        return []
    found = []
    for number, geometry in enumerate(problem.sources):
        if isinstance(geometry, PlaneGeometry) and geometry.inclination:
            rate = least_rate(problem, geometry.trace_slowness, grid.nyquist)
            if rate is not None:
                where = f"source[{number}].inclination" if isinstance(problem.system.source, tuple) else "source.inclination"
                found.append((where, geometry.inclination, rate))
    return found


def least_rate(problem: Problem, trace_slowness: float, highest: float) -> float | None:
    """Return the least s_0 of any order up to a highest rate, in c_e/a; None without any.

    Loops that tie orders or walls to each other are not looked at.
    """
    low, high, found = 1e-2, highest, None
    for _ in range(_ROUNDS):
        s = np.geomspace(low, high, _SAMPLES)
        nodes = s.astype(np.complex128)
        ratio = determinant_ratio(problem, problem.open_loop, nodes, Modes(_ORDERS, -1j * trace_slowness * nodes)).real
        turns = np.flatnonzero(np.any(np.signbit(ratio[:, 1:]) != np.signbit(ratio[:, :-1]), axis=0))
        if turns.size == 0:
            break
        low, high = float(s[turns[0]]), float(s[turns[0] + 1])
        found = math.sqrt(low * high)
    return found
