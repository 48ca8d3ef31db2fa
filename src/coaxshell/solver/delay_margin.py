"""How much delay a loop of feedback stands: what a run without any leaves out, and what decides whether its controller can be built.

Amplifiers and converters answer late, H(s) e^{-s tau}. What derivative feedback brakes at a frequency omega it drives where omega tau >
pi/2. A wall with little feedback vibrates up to its membrane frequency, and one with much of it is fed back up to |k_d| |P||S|/M: the
larger of the two decides, at the highest order.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.modes import Modes
from coaxshell.solver.margins import common_loop, margins_of
from coaxshell.solver.scaling import Problem

_LAST = 1e-4
"""Delay above which the margin is not told, seconds."""
_SAMPLE = 3


class DelayMargin(NamedTuple):
    """The largest delay (s) of all loops with which no order grows by a factor e within the run, and the order that does beyond."""

    delay: float
    order: int


def delay_margin(problem: Problem, max_order: int, duration: float) -> DelayMargin | None:
    """Return how much delay the feedback of a stable problem stands; None if a tenth of a millisecond, or if nothing is fed back.

    Of the highest order and two below it: where others stand less it is more than the margin. All loops are late by as much.
    """
    if all(wall.gains is None or wall.gains.zero for wall in problem.shells):
        return None
    orders = sample(max_order)
    modes = Modes(orders, sparse=True)
    margins = np.min([margins_of(orders, *loop).delay for loop in common_loop(problem, modes, 1.0 / duration)], axis=0)
    place = int(margins.argmin())
    delay = float(margins[place]) * problem.scales.time
    return None if delay > _LAST else DelayMargin(delay, int(orders[place]))


def sample(max_order: int) -> FloatArray:
    """Return the highest order and some below it, ascending."""
    return np.unique(np.rint(np.geomspace(min(1.0, max_order), max_order, _SAMPLE))) if max_order > 0 else np.zeros(1)
