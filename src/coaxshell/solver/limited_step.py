"""One step of voltages that stop at a limit: a = b + K_0 delta(a), delta = clip(a) - a, of each wall.

With E the values at the points (of a circle, or segments) of patterns, P the patterns of values there, and h the points that are held at
their limit on the side sigma, y = -delta = P_h d the excess cut off there, d = E_h a - sigma V,

    a = b + kappa y,      (1 - G kappa) y = G b - P_h sigma V,      G = P_h E_h,      kappa = -K_0,

or, where fewer points are held than there are patterns, (1 - E_h kappa P_h) d = E_h b - sigma V. The set of points is corrected until it
reproduces itself (a semi-smooth Newton method), starting from that of the step before.

Where it turns in circles, only a part of each correction is taken: with g the sums of squares of patterns the equation is that of the least

    Phi(a) = (1/2) sum of (g/kappa) (a - b)^2 - (1/2) sum over points of the squares of what exceeds the limit,

strongly convex because 0 < kappa < 1 and patterns are orthogonal, and each correction leads down.

Where even that fails, as of feedback that does not damp, the step is solved by an iteration that always converges: with
delta = -a/2 + r(a), r = clip - a/2 of slope 1/2 or -1/2,

    a <- (1 - kappa/2)^-1 [b - kappa r(a)],

which shortens the way left by |kappa/(2 - kappa)| < 1 at each turn: patterns are orthogonal, and feedback that damps has 0 < kappa < 1,
kappa = k/(1 + k) with k what an open loop of any strength gives back within the step.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from coaxshell.errors import InputError
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.late import linalg
from coaxshell.solver.electrode_patterns import Patterns

_MAX_SETS = 30
_WHOLE = 8
"""Sets that are corrected in one go, before only a part of each correction is taken."""
_SHORTEST = 1e-6
_TOLERANCE = 1e-10
"""Of the voltages, in units of the limit."""
_MOST_ITERATIONS = 100_000

Places = npt.NDArray[np.intp]


class LimitedStep:
    """The steps of a march, one after another; it remembers which points were held.

    Parameters
    ----------
    patterns : Patterns
    limits : ndarray, shape (walls, points)
        V.
    present : ndarray, shape (walls, walls, patterns)
        K_0.
    """

    def __init__(self, patterns: Patterns, limits: FloatArray, present: FloatArray) -> None:
        self._evaluate, self._project = np.ascontiguousarray(patterns.evaluate), np.ascontiguousarray(patterns.project)
        self._limits, self._present = limits, present
        self._size = float(limits.max())
        self._squares = (self._evaluate**2).sum(axis=0)
        walls = len(limits)
        self._kappa = -np.stack([present[i, i] for i in range(walls)])
        others = present.copy()
        others[np.arange(walls), np.arange(walls)] = 0.0
        self._others = others if np.abs(others).max(initial=0.0) > _TOLERANCE else None
        self._sides = np.zeros(limits.shape)

    def solve(self, known: FloatArray) -> tuple[FloatArray, int]:
        """Return delta, (walls, patterns), from b, and the iterations it took; 0 where no limit is reached.

        Raises
        ------
        InputError
            If walls that answer each other within a step do so too strongly to be solved in turn.
        """
        at = known @ self._evaluate.T
        if (np.abs(at) <= self._limits).all():
            self._sides[:] = 0.0
            return np.zeros_like(known), 0
        delta, taken = np.zeros_like(known), 0
        for _ in range(_MAX_SETS):
            before = delta.copy()
            beside = known if self._others is None else known + np.einsum("ijq,jq->iq", self._others, delta)
            for wall, b in enumerate(beside):
                delta[wall], more = self._of_wall(wall, b)
                taken += more
            if self._others is None or np.abs(delta - before).max() <= _TOLERANCE * max(self._size, float(np.abs(known).max())):
                return delta, taken
        raise InputError(
            "time_step",
            "is too long for limits of shells that answer each other so strongly: what they give does not settle within a step",
            "use a quarter of it, or four times the refinement, or lower gains across shells (control.matrix)",
        )

    def _of_wall(self, wall: int, b: FloatArray) -> tuple[FloatArray, int]:
        """Return delta of one wall and the iterations it took."""
        evaluate, kappa, limit, sides = self._evaluate, self._kappa[wall], self._limits[wall], self._sides[wall]
        free = evaluate @ b
        asked = b
        for taken in range(1, _MAX_SETS):
            held = np.flatnonzero(sides)
            y = self._excess(b, free[held], kappa, sides[held] * limit[held], held) if held.size else np.zeros_like(b)
            found, part = b + kappa * y, 1.0
            if taken > _WHOLE:
                part = self._part(asked, found - asked, b, kappa, limit)
            asked = asked + part * (found - asked) if part < 1.0 else found
            volts = evaluate @ asked if held.size else free
            beyond = np.where(np.abs(volts) > limit, np.sign(volts), 0.0)
            if part == 1.0 and np.array_equal(beyond, sides):
                self._sides[wall] = sides
                return -y, taken
            sides = beyond
        self._sides[wall] = sides
        return self._safely(b, kappa, limit)

    def _part(self, a: FloatArray, way: FloatArray, b: FloatArray, kappa: FloatArray, limit: FloatArray) -> float:
        """Return the part of a correction that brings Phi down, all of it if it can."""
        at, along = self._evaluate @ a, self._evaluate @ way
        weight = self._squares / np.maximum(kappa, 1e-12)

        def phi(part: float) -> float:
            beyond = np.maximum(np.abs(at + part * along) - limit, 0.0)
            return float(weight @ (a + part * way - b) ** 2 - beyond @ beyond)

        part, start = 1.0, phi(0.0)
        while part > _SHORTEST and phi(part) > start:
            part *= 0.5
        return part

    def _excess(self, b: FloatArray, free: FloatArray, kappa: FloatArray, target: FloatArray, held: Places) -> FloatArray:
        """Return y where some points are held at a target each, sigma V; ``free`` is E_h b."""
        rows, columns = self._evaluate[held], self._project[:, held]
        if held.size < b.size:
            matrix = -(rows * kappa) @ columns
            matrix[np.diag_indices(held.size)] += 1.0
            return np.asarray(columns @ linalg.solve(matrix, free - target, check_finite=False, overwrite_a=True))
        whole = columns @ rows
        matrix = np.eye(b.size) - whole * kappa
        return np.asarray(linalg.solve(matrix, whole @ b - columns @ target, check_finite=False, overwrite_a=True))

    def _safely(self, b: FloatArray, kappa: FloatArray, limit: FloatArray) -> tuple[FloatArray, int]:
        """Return delta by the iteration that always converges."""
        ahead, a = 1.0 / (1.0 - 0.5 * kappa), b
        for taken in range(1, _MOST_ITERATIONS):  # noqa: B007 - how many there were is told
            given = self._project @ np.clip(self._evaluate @ a, -limit, limit)
            after = ahead * (b - kappa * (given - 0.5 * a))
            change, a = np.abs(after - a).max(), after
            if change < _TOLERANCE * self._size:
                break
        volts = self._evaluate @ a
        return self._project @ (np.clip(volts, -limit, limit) - volts), taken
