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
from coaxshell.solver.electrode_patterns import segments_of
from coaxshell.solver.margins import common_loop, margins_of
from coaxshell.solver.scaling import Problem
from coaxshell.solver.segmented_margins import common_patterns
from coaxshell.solver.voltage_response import controlled

_LAST = 1e-4
"""Delay above which the margin is not told, seconds."""
_SAMPLE = 3


class DelayMargin(NamedTuple):
    """The largest delay (s) of all loops with which no order grows by a factor e within the run, and the order that does beyond.

    Of electrodes in N ``segments`` the order q of a pattern, with N - q, N + q, ... tied to it.
    """

    delay: float
    order: int
    segments: int | None = None

    @property
    def grows(self) -> str:
        """What would grow, in words."""
        if self.segments is None:
            return f"order {self.order}"
        others = sorted({self.segments - self.order, self.segments + self.order} - {self.order})
        return f"order {self.order} with {', '.join(map(str, others))}, ..., which {self.segments} segments tie to it,"


def delay_margin(problem: Problem, max_order: int, duration: float) -> DelayMargin | None:
    """Return how much delay the feedback of a stable problem stands; None if a tenth of a millisecond, or if nothing is fed back.

    Of the highest order and two below it, or of as many patterns of segments, dead ones as if alive: where others stand less it is more
    than the margin. All loops are late by as much.
    """
    if all(wall.gains is None or wall.gains.zero for wall in problem.shells):
        return None
    cut = segments_of(problem, controlled(problem))
    count = cut[0].count if cut else None
    orders = sample(max_order if count is None else count // 2)
    if count is None:
        found = common_loop(problem, Modes(orders, sparse=True), 1.0 / duration)
    else:
        found = common_patterns(problem, max_order, orders, 1.0 / duration)
    margins = np.min([margins_of(orders, *loop).delay for loop in found], axis=0)
    place = int(margins.argmin())
    delay = float(margins[place]) * problem.scales.time
    return None if delay > _LAST else DelayMargin(delay, int(orders[place]), count)


def sample(max_order: int) -> FloatArray:
    """Return the highest order and some below it, ascending."""
    return np.unique(np.rint(np.geomspace(min(1.0, max_order), max_order, _SAMPLE))) if max_order > 0 else np.zeros(1)
