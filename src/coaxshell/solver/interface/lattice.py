"""Angles on a lattice, theta_0 + 360 n/N degrees: what orders are alike to whoever looks from there alone.

cos m(theta_a - theta_b) is the same for all orders m = +-l (mod N), so that N/2 + 1 classes l take the place of the orders.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.solver.interface.absorbers import AbsorberSet
from coaxshell.solver.point_forces import point_force_shares
from coaxshell.solver.scaling import Problem

_SAME = 1e-7
"""Of a lattice's spacing, within which an angle lies on it."""


def lattice_of(angles: FloatArray, max_order: int) -> int:
    """Return the fewest places at equal spacing that all angles (degrees) lie on, 0 if there are no fewer classes of them than orders."""
    turns = (angles - angles[0]) / 360.0
    for count in range(1, 2 * max_order):
        place = turns * count
        if np.all(np.abs(place - np.rint(place)) <= _SAME):
            return count
    return 0


def folding(lattice: int, max_order: int) -> FloatArray:
    """Return the share of each order in each class of a lattice, beta_l/beta_m for m = +-l (mod N), shape (classes, M + 1)."""
    orders = np.arange(max_order + 1)
    of_order = np.minimum(orders % lattice, -orders % lattice)
    beta = np.where(orders == 0, 2.0, 1.0)
    shares = np.zeros((lattice // 2 + 1, orders.size))
    shares[of_order, orders] = beta[of_order] / beta
    return shares


class Channels(NamedTuple):
    """By what a march of some absorbers sees a structure.

    Attributes
    ----------
    lattice : int
        Places of the lattice whose classes are marched, 0 if none are.
    alone : bool
        Whether each pair of points has a kernel of its own.
    kernels : int
        Kernels that are summed over the past.
    """

    lattice: int
    alone: bool
    kernels: int


def channels(problem: Problem, absorbers: AbsorberSet, max_order: int) -> Channels:
    """Return the way of the fewest kernels: of all orders, of the classes of a lattice, or of the points."""
    pairs, lattice = len(problem.surfaces) ** 2, _lattice(problem, absorbers, max_order)
    together, points = pairs * (lattice // 2 + 1 if lattice else max_order + 1), (2 * absorbers.count) ** 2
    if points <= together * absorbers.parities:
        return Channels(0, True, points)
    return Channels(lattice, False, together)


def _lattice(problem: Problem, absorbers: AbsorberSet, max_order: int) -> int:
    """Return the places of the lattice of some absorbers, 0 if it has no fewer classes than there are orders, or does not tell all."""
    if not absorbers.count or problem.point_force_shares is not point_force_shares:
        return 0
    if absorbers.footprint is not None and len(absorbers.held_alike) > 1:
        return 0
    return lattice_of(absorbers.every_angle, max_order)
