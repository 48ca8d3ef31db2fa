"""Round scales for two quantities on one panel, so that their zero lines and their grids coincide."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

_STEPS = (1.0, 2.0, 2.5, 4.0, 5.0, 8.0, 10.0)


@dataclass(frozen=True)
class Scale:
    """A round scale: ``below`` steps under zero and ``above`` steps over it."""

    step: float
    below: int
    above: int

    @property
    def limits(self) -> tuple[float, float]:
        """Lowest and highest value of the scale."""
        return -self.below * self.step, self.above * self.step

    @property
    def ticks(self) -> list[float]:
        """Values of the ticks."""
        return [i * self.step for i in range(-self.below, self.above + 1)]


def round_up(value: float) -> float:
    """Return the smallest round number that is not less than *value*."""
    if not value > 0:
        return 1.0
    power = 10.0 ** math.floor(math.log10(value))
    return next(step * power for step in _STEPS if step * power >= value * (1 - 1e-9))


def common_scales(ranges: Sequence[tuple[float, float]], intervals: Sequence[int] = (5, 6, 7, 8), margin: float = 0.06) -> list[Scale]:
    """Return one scale for each (lowest, highest) range, all with the same numbers of steps below and above zero.

    Parameters
    ----------
    ranges : sequence of (float, float)
        Lowest and highest value of each quantity.
    intervals : sequence of int
        Total numbers of steps to choose from; the choice leaves the least empty space.
    margin : float
        Room kept beyond the extremes, relative to them.
    """
    wanted = [(max(0.0, -low) * (1 + margin), max(0.0, high) * (1 + margin)) for low, high in ranges]
    candidates = []
    for total in intervals:
        for below in range(total + 1):
            above = total - below
            if any((low > 0 and below == 0) or (high > 0 and above == 0) for low, high in wanted):
                continue
            scales = [Scale(_step(low, high, below, above), below, above) for low, high in wanted]
            waste = sum(scale.step * total / ((low + high) or 1.0) for scale, (low, high) in zip(scales, wanted, strict=True))
            candidates.append((waste, total, scales))
    return min(candidates, key=lambda candidate: candidate[:2])[2]


def _step(low: float, high: float, below: int, above: int) -> float:
    return round_up(max(low / below if below else 0.0, high / above if above else 0.0))
