"""Inclined plane waves: whether feedback moves the walls ahead of the front.

Feedback of a rate of stretching makes a wall viscous along the axis: in the simplest case, of a membrane with mass I,

    I s^2 = (d11 + G s) (-k^2) = (d11 + G s) s^2 sin^2 alpha,        s_0 = (I - d11 sin^2 alpha)/(G sin^2 alpha).

What is viscous has no fastest wave: the wall is stretched ahead of the front, by e^{s_0 t} before it comes. That is a pole on the real
axis, right of the contour, and the inverse transform takes it for what it is as long as the contour runs well to its left: what was before
t = 0 returns around the period P as e^{s_0 (t - P)} e^{sigma P}. The determinants of an order with feedback and without tell where
it is: real on the real axis, where k = -i s sin alpha is imaginary, their ratio changes sign there. Fluids are counted in.

Walls stretch around less the higher the order, so that the lowest ones that are fed back have the least s_0 (6, 11, 18, 25, 32 per transit
of orders 0 to 4 of the preset "electrodes" at four times its gain under 8 degrees): two are looked at. Where feedback ties orders or walls
it is that of patterns, of as many orders as tell them. Beside elastic walls, which are tied at real wavenumbers alone, each has the loop of
its own whole electrodes here: the stretching of order 0 is the same under segments side by side (5.99 per transit, whole or in six).
"""

from __future__ import annotations

import math
from dataclasses import fields, replace

import numpy as np

from coaxshell.acoustics.sources import PlaneGeometry
from coaxshell.errors import InputError
from coaxshell.model.gains import segments_of
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.modes import Modes
from coaxshell.solver.axial.causality import rounded_up
from coaxshell.solver.contour import fed_orders
from coaxshell.solver.scaling import Problem
from coaxshell.solver.stability import determinant_ratio
from coaxshell.solver.tied_stability import determinants
from coaxshell.structure.elastic_wall import ElasticWall
from coaxshell.structure.electroded_wall import ElectrodedWall, LossyElectrodedWall
from coaxshell.structure.shell_model import ShellModel
from coaxshell.structure.tied_wall import TiedWall

_LOWEST = 2
"""Orders that are looked at: those that bend least are stretched furthest ahead."""
_SAMPLES, _ROUNDS = 40, 2
_LEFT = 1e-2
"""What may return around the period, of the motion as the front comes."""


def require_fronts_before_feedback(problem: Problem, grid: LaplaceGrid, max_order: int) -> None:
    """Refuse plane waves so inclined that feedback moves the walls ahead of them so slowly that the run takes it for growth.

    Raises
    ------
    InputError
        It names the source's inclination.
    """
    for where, degrees, rate in _ahead(problem, grid, max_order):
        needed = math.log(1.0 / (grid.wrap_around * _LEFT)) / rate  # e^{s_0 (T - P)} of t = 0, with e^{sigma P}
        if grid.period - grid.time[-1] < needed:
            raise InputError(
                where,
                f"{degrees:g} degrees: feedback damps the walls along the axis, which stretches them {_told(problem, rate)} and more "
                "before the front comes: a run of this length cannot tell that from growth",
                f"use duration = {rounded_up(needed):g} or more, less inclination, or lower derivative gains",
            )


def moved_ahead(problem: Problem, grid: LaplaceGrid, max_order: int) -> list[str]:
    """Return the warning that feedback moves the walls ahead of an inclined front, as long as the time step resolves it."""
    return [
        f"{where}: feedback damps the walls along the axis, which stretches them ahead of the front, inclined by {degrees:g} degrees, "
        f"{_told(problem, rate)} before it comes; what is before t = 0 is not shown: use less inclination, or lower derivative gains"
        for where, degrees, rate in _ahead(problem, grid, max_order)
    ]


def _told(problem: Problem, rate: float) -> str:
    return f"{1e6 * problem.scales.time / rate:.3g} microseconds"


def _ahead(problem: Problem, grid: LaplaceGrid, max_order: int) -> list[tuple[str, float, float]]:
    """Return path and inclination of each source ahead of which feedback moves the walls, and the least s_0 that is resolved."""
    if all(wall.gains is None for wall in problem.shells):
        return []
    found = []
    for number, geometry in enumerate(problem.sources):
        if isinstance(geometry, PlaneGeometry) and geometry.inclination:
            rate = least_rate(problem, geometry.trace_slowness, grid.nyquist, max_order)
            if rate is not None:
                where = f"source[{number}].inclination" if isinstance(problem.system.source, tuple) else "source.inclination"
                found.append((where, geometry.inclination, rate))
    return found


def least_rate(problem: Problem, trace_slowness: float, highest: float, max_order: int) -> float | None:
    """Return the least s_0 of any order or pattern up to a highest rate, in c_e/a; None without any."""
    low, high, found = 1e-2, highest, None
    problem = _with_own_loops(problem) if problem.two_faced else problem
    ties, orders = problem.tied and not problem.two_faced, _orders(problem, max_order)
    if not orders.size:
        return None
    for _ in range(_ROUNDS):
        s = np.geomspace(low, high, 4 * _SAMPLES if ties else _SAMPLES)  # of all patterns together where segments are dead
        nodes = s.astype(np.complex128)
        modes = Modes(orders, -1j * trace_slowness * nodes)
        if ties:
            ratio = determinants(problem, problem.open_loop, modes, nodes).real
        else:
            ratio = determinant_ratio(problem, problem.open_loop, nodes, modes).real
        turns = np.flatnonzero(np.any(np.signbit(ratio[:, 1:]) != np.signbit(ratio[:, :-1]), axis=0))
        if turns.size == 0:
            break
        low, high = float(s[turns[0]]), float(s[turns[0] + 1])
        found = math.sqrt(low * high)
    return found


def _with_own_loops(problem: Problem) -> Problem:
    """Return the problem whose walls are fed back what they read themselves, around as a whole."""
    return replace(problem, shells=tuple(map(_by_itself, problem.shells)))


def _by_itself(wall: ShellModel) -> ShellModel:
    if isinstance(wall, ElasticWall):
        return replace(wall, segments=None, tied_as=None)
    if not isinstance(wall, TiedWall):
        return wall
    kind = LossyElectrodedWall if isinstance(wall, LossyElectrodedWall) else ElectrodedWall
    return kind(**{one.name: getattr(wall, one.name) for one in fields(kind)})


def _orders(problem: Problem, max_order: int) -> FloatArray:
    """Return the lowest orders that are fed back, or as many as tell the patterns of segments."""
    segments = segments_of(problem.system)
    if segments is not None and not problem.two_faced:
        return np.arange(min(max_order, 2 * segments) + 1.0)
    return fed_orders(problem, Modes.up_to(max_order))[:_LOWEST]
