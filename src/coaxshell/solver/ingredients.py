"""The formulas that the solver puts together, in one place: a study of other formulas changes them here and nothing else.

A problem carries its ingredients (:attr:`coaxshell.solver.scaling.Problem.ingredients`); every stage that needs one asks the problem.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from coaxshell.acoustics.basis import RadialBasis
from coaxshell.acoustics.operators import all_orders
from coaxshell.numerics.arrays import ComplexArray, FloatArray

if TYPE_CHECKING:
    from coaxshell.solver.interface.absorbers import AbsorberSet
    from coaxshell.solver.scaling import Problem

Radial = RadialBasis


def wall_motion_factor(problem: Problem, region: int, wall: int, radial: Radial) -> ComplexArray | float:
    """Return 1: a fluid moves with its wall (Eq. 9)."""
    return 1.0


def point_force_shares(absorbers: AbsorberSet, max_order: int) -> FloatArray:
    """Return cos(m theta_n)/(beta pi), sin for the sines, for an absorber that stands for two twice as much: (parities, N, M + 1)."""
    beta_pi = np.pi * np.where(all_orders(max_order) == 0, 2.0, 1.0)
    shares: FloatArray = absorbers.shapes(max_order) * absorbers.multiplicity[:, None] / beta_pi
    return shares


@dataclass(frozen=True)
class Ingredients:
    """Formulas by their place in the solution; the defaults are the theory manual's.

    Attributes
    ----------
    wall_motion_factor : callable
        From problem, number of the fluid, number of the shell beside it and Bessel ratios to the factor, a number or an array
        (M + 1, nodes), with which that fluid feels the acceleration of that shell.
    point_force_shares : callable
        From absorbers and M to each order's share of a line force on a circle of radius 1, shape (parities, N, M + 1).
    """

    wall_motion_factor: Callable[[Problem, int, int, Radial], ComplexArray | float] = wall_motion_factor
    point_force_shares: Callable[[AbsorberSet, int], FloatArray] = point_force_shares


OWN = Ingredients()
"""The theory manual's formulas."""
