"""Angles on a lattice, theta_0 + 360 n/N degrees: what orders are alike to whoever looks from there alone.

cos m(theta_a - theta_b) is the same for all orders m = +-l (mod N), so that N/2 + 1 classes l take the place of the orders.
"""

from __future__ import annotations

import numpy as np

from coaxshell.numerics.arrays import FloatArray

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
