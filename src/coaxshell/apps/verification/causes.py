"""Why another code's history differs from ours, where one of the usual slips explains it: sign, unit, time zero, head and tail.

Each slip, and each combination of them, is undone and the rest measured; one is named only where that brings the deviation down a lot.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.optimize import minimize_scalar
from scipy.signal import correlate

from coaxshell.numerics.arrays import FloatArray

IntArray = npt.NDArray[np.int_]

MUCH = 0.3
"""Share of the deviation that may be left for a slip to explain it, and of what fewer slips leave for one more to be named."""
ENOUGH = 0.01
"""Relative deviation that needs no further explanation."""
LEAST_LEFT = 0.5
"""Share of the norm of either history that must overlap after a shift."""
POWERS = (0, -9, -6, -3, -2, 2, 3, 6, 9)
"""Powers of ten between units that are mistaken for each other: m, mm and um, Pa, kPa and MPa, per cent."""


@dataclass(frozen=True)
class Cause:
    """Slips that explain a deviation.

    Attributes
    ----------
    lag : float
        By how much their history comes later than ours, in transits.
    factor : float
        Power of ten by which theirs is too large; negative with the sign reversed.
    exchanged : bool
        Whether theirs is ours of the opposite side.
    left : float
        Relative L2 deviation once all is undone.
    """

    lag: float
    factor: float
    exchanged: bool
    left: float

    @property
    def slips(self) -> int:
        """Return how many slips these are."""
        return (self.lag != 0) + (self.factor < 0) + (abs(self.factor) != 1) + self.exchanged

    def text(self, transit: float) -> str:
        """Return the slips in words; *transit* is a/c_e in seconds."""
        named = ["head and tail exchanged"] if self.exchanged else []
        named += ["the sign reversed"] if self.factor < 0 else []
        size = abs(self.factor)
        if size != 1:
            named.append(f"{max(size, 1 / size):,.0f} times too {'large' if size > 1 else 'small'} (its unit?)")
        if self.lag:
            late = "late" if self.lag > 0 else "early"
            named.append(f"{abs(self.lag) * transit * 1e3:.3g} ms ({abs(self.lag):.3g} transits) too {late}")
        return " and ".join(named)


def likely_cause(time: FloatArray, theirs: FloatArray, step: float, ours: FloatArray, opposite: FloatArray, error: float) -> Cause | None:
    """Return the fewest slips that explain a deviation, or None.

    Parameters
    ----------
    time, theirs : ndarray, shape (K,)
        Their instants in transits, and values.
    step : float
        Interval of our histories, which begin at t = 0, in transits.
    ours, opposite : ndarray, shape (T,)
        Our history at the place, and that of the opposite side.
    error : float
        Relative L2 deviation as the file is.
    """
    first, last = int(np.ceil(time[0] / step - 1e-9)), int(time[-1] / step + 1e-9)
    grid = np.arange(first, min(last, len(ours) - 1) + 1)
    values = np.interp(grid * step, time, theirs)
    found: Cause | None = None
    for cause in sorted(_candidates(grid, values, step, ours, opposite), key=lambda one: (one.slips, one.left)):
        before = error if found is None else found.left
        if before > ENOUGH and cause.left <= MUCH * min(before, 1.0):
            found = cause
    return found


def _candidates(grid: IntArray, values: FloatArray, step: float, ours: FloatArray, opposite: FloatArray) -> Iterator[Cause]:
    if len(grid) < 2 or not values.any():
        return
    for exchanged, mine in ((False, ours), (True, opposite)):
        near = _best_lag(grid, values, mine)
        fine = minimize_scalar(lambda lag, mine=mine: _undone(grid, values, mine, lag)[1], bounds=(near - 2, near + 2), method="bounded")
        for lag in (0.0, float(fine.x)):
            factor, left = _undone(grid, values, mine, lag)
            cause = Cause(lag * step, factor, exchanged, left)
            if cause.slips:
                yield cause


def _undone(grid: IntArray, values: FloatArray, mine: FloatArray, lag: float) -> tuple[float, float]:
    """Return the power of ten, with its sign, by which theirs is too large after a shift, and the relative deviation left without both."""
    place = grid - lag
    within = place <= len(mine) - 1
    expected = np.interp(place[within], np.arange(len(mine)), mine, left=0.0)
    given = values[within]
    norm = float(np.linalg.norm(expected))
    if not norm:
        return 1.0, math.inf
    gain = float(given @ expected) / norm**2
    power = min(POWERS, key=lambda one: abs(one - math.log10(abs(gain) or 1.0)))
    factor = math.copysign(10.0**power, gain)
    return factor, float(np.linalg.norm(given / factor - expected)) / norm


def _best_lag(grid: IntArray, values: FloatArray, mine: FloatArray) -> int:
    """Return the lag in steps at which the histories resemble each other most: the largest |r(k)|.

    r(k) = sum_i v_i o_(i-k) / sqrt(sum_i v_i^2 sum_i o_(i-k)^2)

    over the instants that both have. Ours is zero before t = 0.
    """
    count = len(grid)
    end = grid[0] + count
    part = mine[:end]
    lags = np.arange(-(end - 1), count)
    product = correlate(values, part, method="fft")
    shifts = lags + grid[0]
    own = np.concatenate([[0.0], np.cumsum(values**2)])
    square = np.concatenate([[0.0], np.cumsum(part**2)])
    # Of v the instants count at which ours is known, of ours those that meet them; before t = 0 ours is zero.
    upper = np.clip(end + shifts - grid[0], 0, count)
    energy = own[upper]
    low, high = np.clip(grid[0] - shifts, 0, end), np.clip(grid[0] + upper - shifts, 0, end)
    reference = square[high] - square[low]
    allowed = (energy >= LEAST_LEFT**2 * own[-1]) & (reference >= LEAST_LEFT**2 * square[-1]) & (energy > 0) & (reference > 0)
    if not allowed.any():
        return 0
    resemblance = np.where(allowed, np.abs(product) / np.sqrt(np.where(allowed, energy * reference, 1.0)), 0.0)
    return int(shifts[resemblance.argmax()])
