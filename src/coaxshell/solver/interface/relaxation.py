"""A few steps of the interface at once, z = z_known + R n(z), by fixed-point iteration over all of them (waveform relaxation).

R, the answer within those steps, is lower triangular in time and small where springs are soft on the scale of a step. Then this takes a
product or two more than Newton's method at each step, and none of its work a step; where it does not converge at once it says so.

E. Lelarasmee, A. E. Ruehli, A. L. Sangiovanni-Vincentelli, The waveform relaxation method, IEEE Trans. CAD 1 (1982) 131-145.
"""

from __future__ import annotations

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.solver.interface.laws import CubicSprings

UNKNOWNS = 224
"""Of the steps taken at once: above, the product with R costs more than the work a step that it saves."""
_MOST_ITERATIONS = 10
_SLOWEST = 0.05
"""The change of an iteration over that of the one before it, at most."""


class Relaxation:
    """Fixed-point iteration over a few steps.

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
    last : ndarray, shape (steps, size)
        z of the steps last solved.
    iterations : int
        In all, each counted once for every step.
    """

    def __init__(self, rows: FloatArray, size: int, springs: CubicSprings) -> None:
        self.steps = max(1, min(UNKNOWNS // max(size, 1), rows.shape[0] // max(size, 1)))
        self._springs = springs
        self._rows = [np.ascontiguousarray(rows[: count * size, : count * size]) for count in range(self.steps + 1)]
        self.last = np.empty((0, size))
        self.iterations = 0

    def solve(self, known: FloatArray) -> FloatArray | None:
        """Return n(z) at some steps, shape (steps, size), from z_known, or None if the iteration converges too slowly for it to pay."""
        springs, rows = self._springs, self._rows[len(known)]
        z, last = known, 0.0
        for iteration in range(1, _MOST_ITERATIONS + 1):
            new = known + (rows @ springs.nonlinear_part(z).ravel()).reshape(known.shape)
            size = springs.relative((new - z).ravel(), new.ravel())
            z = new
            if size > springs.tolerance and last > 0.0:
                rate = size / last
                if rate > _SLOWEST:
                    return None
                size *= rate  # what the next one would change
            if size <= springs.tolerance:
                self.last = z
                self.iterations += iteration * len(z)
                return springs.nonlinear_part(z)
            last = size
        return None
