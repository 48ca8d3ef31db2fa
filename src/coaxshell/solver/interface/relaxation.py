"""A few steps of the interface at once, z = z_known + R n(z), by fixed-point iteration over all of them (waveform relaxation).

R, the answer within those steps, is lower triangular in time and small where springs are soft on the scale of a step. Then this takes a
product or two more than Newton's method at each step, and none of its work a step; where it does not converge at once it says so.

E. Lelarasmee, A. E. Ruehli, A. L. Sangiovanni-Vincentelli, The waveform relaxation method, IEEE Trans. CAD 1 (1982) 131-145.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.solver.interface.laws import CubicSprings

UNKNOWNS = 224
"""Most unknowns of the steps taken at once: above, the product with R costs more than the work a step that it saves."""
_MOST_ITERATIONS = 10
_SLOWEST = 0.05
"""The change of an iteration over that of the one before it, at most."""


class Relaxed(NamedTuple):
    """Some steps solved at once: z and n(z), both of shape (steps, size), and the iterations, each counted once for every step."""

    z: FloatArray
    nonlinear_part: FloatArray
    iterations: int


class Relaxation:
    """Fixed-point iteration over a few steps; constants only.

    Parameters
    ----------
    rows : ndarray, shape (steps * size, steps * size)
        Answers of z within a block to n at all its steps.
    size : int
        Unknowns of one step.
    springs : CubicSprings

    Attributes
    ----------
    steps : int
        How many are taken at once.
    """

    def __init__(self, rows: FloatArray, size: int, springs: CubicSprings) -> None:
        self.steps = max(1, min(UNKNOWNS // max(size, 1), rows.shape[0] // max(size, 1)))
        self._springs = springs
        self._rows = [np.ascontiguousarray(rows[: count * size, : count * size]) for count in range(self.steps + 1)]

    def solve(self, known: FloatArray) -> Relaxed | None:
        """Return z of some steps from z_known, shape (steps, size), or None if the iteration converges too slowly for it to pay."""
        springs, rows = self._springs, self._rows[len(known)]
        z, last = known, 0.0
        for iteration in range(1, _MOST_ITERATIONS + 1):
            new = known + (rows @ springs.nonlinear_part(z).ravel()).reshape(known.shape)
            size = springs.relative((new - z).ravel(), new.ravel())
            z, left = new, size
            if size > springs.tolerance and last > 0.0:
                rate = size / last
                if rate > _SLOWEST:
                    return None
                left = size * rate  # what the next one would change
            if left <= springs.tolerance:
                return Relaxed(z, springs.nonlinear_part(z), iteration * len(z))
            last = size
        return None
