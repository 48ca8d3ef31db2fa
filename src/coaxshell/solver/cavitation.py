"""At what pressures water cavitates: where, and below which pressure of the shock.

Water at rest stands under p_rest = p_atm + rho g (d - h), h the height above the axis; what a run computes is added to it. Below the
pressure of its vapour it cavitates: where p < p_vapour - p_rest. A description without a sea has no depth, and is taken to lie at its
surface; so is what shells enclose, which may be sealed.
"""

from __future__ import annotations

import numpy as np

from coaxshell.model.sea import VAPOUR_PRESSURE
from coaxshell.numerics.arrays import FloatArray
from coaxshell.solver.scaling import Problem

AMBIENT = 0.1e6
"""Pressure at the surface of the sea, Pa, of systems without one."""


def least_pressure(problem: Problem, x: FloatArray, y: FloatArray, vapour_pressure: float = VAPOUR_PRESSURE) -> FloatArray:
    """Return the acoustic pressure below which the water outside cavitates at points (in a), Pa, negative; the system needs a sea."""
    system, a = problem.system, problem.scales.length
    sea = system.sea
    assert sea is not None
    turn = np.radians(sea.up)
    height = a * (np.cos(turn) * x + np.sin(turn) * y)
    return np.asarray(vapour_pressure - sea.at_rest(height, system.exterior.density), dtype=np.float64)


def least_on_wall(problem: Problem, region: int, angles: FloatArray) -> FloatArray:
    """Return the acoustic pressure below which the fluid on a wetted surface cavitates, Pa, at angles in degrees."""
    if region < len(problem.shells) or problem.system.sea is None:
        return np.full(angles.shape, -AMBIENT)
    turn = np.radians(angles)
    return least_pressure(problem, problem.head * np.cos(turn), problem.head * np.sin(turn))
