"""The fixed point of voltages that stop at a limit, u = known + Z clip(u), of many instants at once.

With clip(u) = u + l(u), the lack l(u) is there at held points alone, and with clip(u) = sigma u + r(u), r(u) = (1 - sigma) u + l(u),

    u <- (1 - sigma Z)^-1 [known + Z r(u)]

(:mod:`coaxshell.solver.interface.actuator_march`). Once u has come closer to its end, only points near the limit can be held: what all
iterations since the last look at all points have moved together, |du(theta)| <= sum_m |du_m|, tells beyond doubt which cannot, and only the
others are summed over.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.solver.interface.saturation import CircleSums

SHARE = 0.55
"""sigma: 1/2 contracts most where all is held, 1 where nothing is."""
_TOLERANCE = 1e-10
"""Error of the voltages, in units of the limits, or of the largest of them."""
_MOST_ITERATIONS = 1000
_NEAR = 0.5
"""Of the limit: voltages closer to it are near, at most."""
_WHOLE = 3
"""Where more than one of so many points is near, sums by symmetries over all are faster."""
_AHEAD = 2.0
"""By how much more than the last iteration all to come are taken to move, at first."""


class Settled(NamedTuple):
    """Voltages asked for and given, (..., parities, M + 1), and the iterations."""

    asked: FloatArray
    given: FloatArray
    iterations: int


class _Lack:
    """l(u) = clip(u) - u by modes, of voltages that settle."""

    def __init__(self, circle: CircleSums) -> None:
        self._circle = circle
        self._some: tuple[FloatArray, FloatArray] | None = None
        self._left = 0.0

    def of(self, asked: FloatArray, moved: float) -> FloatArray:
        """Return l(u) of voltages (..., parities, M + 1), none of which has moved by more than ``moved`` since the last ones."""
        self._left -= moved
        if self._some is not None and self._left >= 0.0:
            around, back = self._some
            volts = asked.reshape(-1, around.shape[0]) @ around
            return np.asarray((_beyond(volts) @ back).reshape(asked.shape))
        volts = self._circle.at_points(asked)
        self._look(volts, _AHEAD * moved)
        return self._circle.amplitudes(_beyond(volts))

    def _look(self, volts: FloatArray, margin: float) -> None:
        """Find the points that may be held while nothing moves by more than a margin."""
        self._some, self._left = None, margin
        if margin > _NEAR:
            return
        rows = volts.reshape(-1, volts.shape[-1])
        near = np.flatnonzero(np.maximum(rows.max(axis=0), -rows.min(axis=0)) > 1.0 - margin)
        if _WHOLE * near.size <= volts.shape[-1]:
            self._some = self._circle.some(near)


def _beyond(volts: FloatArray) -> FloatArray:
    return np.clip(volts, -1.0, 1.0) - volts


def settle(circle: CircleSums, answer: Callable[[FloatArray], FloatArray], asked: FloatArray) -> Settled:
    """Return the fixed point of voltages that stop at their limits.

    Parameters
    ----------
    circle : CircleSums
    answer : callable
        From r(u), (..., parities, M + 1), to the next u.
    asked : ndarray, same shape
        Where it begins.
    """
    lack, moved = _Lack(circle), np.inf
    for iteration in range(1, _MOST_ITERATIONS + 1):  # noqa: B007 - how many there were is told
        rest = lack.of(asked, moved)
        rest += (1.0 - SHARE) * asked
        after = answer(rest)
        step = np.abs(after - asked)
        asked, moved, change = after, float(step.sum(axis=(-2, -1)).max()), float(step.max())
        if change <= _TOLERANCE * max(1.0, float(np.abs(asked).max())):
            break
    return Settled(asked, asked + lack.of(asked, moved), iteration)
