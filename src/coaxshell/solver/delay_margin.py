"""How much delay a loop of feedback stands: what a run without any leaves out, and what decides whether its controller can be built.

Amplifiers and converters answer late, H(s) e^{-s tau}. What derivative feedback brakes at a frequency omega it drives where omega tau >
pi/2. A wall with little feedback vibrates up to its membrane frequency, and one with much of it is fed back up to |k_d| |P||S|/M: the
larger of the two decides, at the highest order.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.modes import Modes
from coaxshell.solver.scaling import Problem
from coaxshell.solver.stability import poles_beyond

_FIRST, _LAST = 1e-9, 1e-4
"""Delays between which the margin is looked for, seconds."""
_ROUGHLY = 1.2
_SAMPLE = 3


class DelayMargin(NamedTuple):
    """The largest delay (s), roughly, with which no order grows by a factor e within the run, and the highest order that does beyond."""

    delay: float
    order: int


def delay_margin(problem: Problem, max_order: int, duration: float) -> DelayMargin | None:
    """Return how much delay the feedback of a problem stands; None if a tenth of a millisecond, or if nothing is fed back.

    Of the highest order and two below it: where others stand less it is more than the margin.
    """
    if all(wall.gains is None or wall.gains.zero for wall in problem.shells):
        return None
    orders = sample(max_order)
    low, high = _FIRST, _FIRST
    while not (found := _unstable(problem, orders, high, duration)).size:
        low, high = high, 4.0 * high
        if low > _LAST:
            return None
    while high > _ROUGHLY * low:
        middle = float(np.sqrt(low * high))
        beyond = _unstable(problem, orders, middle, duration)
        low, high, found = (low, middle, beyond) if beyond.size else (middle, high, found)
    return DelayMargin(low, int(found[-1]))


def sample(max_order: int) -> FloatArray:
    """Return the highest order and some below it, ascending."""
    return np.unique(np.rint(np.geomspace(min(1.0, max_order), max_order, _SAMPLE))) if max_order > 0 else np.zeros(1)


def _unstable(problem: Problem, orders: FloatArray, delay: float, duration: float) -> FloatArray:
    late = delay / problem.scales.time
    walls = tuple(wall.with_gains(None if wall.gains is None else wall.gains.late(late)) for wall in problem.shells)
    return poles_beyond(replace(problem, shells=walls), Modes(orders, sparse=True), 1.0 / duration).orders
