"""Magnified views inside a panel, put where they cover the curves least."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.plotting.histories import History

if TYPE_CHECKING:
    from matplotlib.axes import Axes


WIDTH, HEIGHT = 0.42, 0.32
"""Size of an inset, shares of the panel."""

_SIDES = (0.10, 0.20, 0.30, 0.42, 0.55)
_ABOVE, _BELOW = 0.655, 0.08
_MARGIN = 0.03
_COVERING, _HIDING, _DISTANCE = 10.0, 10.0, 0.2


@dataclass(frozen=True)
class Window:
    """A part of a panel: first and last time, lowest and highest value, in drawn units."""

    start: float
    end: float
    low: float
    high: float


def window_around(curves: Sequence[History], time: float, half_width: float) -> Window:
    """Return the part of a panel within *half_width* transits of a time that holds the extrema of all curves there.

    Its height is three times the spread of the extrema, but at least a tenth and at most half of the largest magnitude.
    """
    parts = [curve.values[np.abs(curve.time - time) <= half_width] for curve in curves]
    values = np.concatenate(parts)
    largest = float(values[np.abs(values).argmax()])
    sign = -1.0 if largest < 0 else 1.0
    extrema = [float((sign * part).max()) for part in parts]
    top = max(extrema) or 1.0
    depth = min(max(3.0 * (top - min(extrema)), 0.1 * top), 0.5 * top)
    low, high = sorted((sign * (top - depth), sign * (top + 0.12 * depth)))
    return Window(max(0.0, time - half_width), time + half_width, low, high)


def add_inset(ax: Axes, curves: Sequence[History], window: Window) -> Axes:
    """Add and return an empty inset for a window of the panel, limits set: above the curves for an extremum above zero, else below.

    Parameters
    ----------
    ax : Axes
        Its limits must be final.
    curves : sequence of History
        What is drawn in the panel.
    window : Window
    """
    left, bottom = _place(ax, curves, window)
    inset: Axes = ax.inset_axes((left, bottom, WIDTH, HEIGHT), zorder=6)
    inset.set_xlim(window.start, window.end)
    inset.set_ylim(window.low, window.high)
    inset.tick_params(labelsize=6, length=2, pad=1.5)
    inset.locator_params(nbins=4)
    return inset


def _place(ax: Axes, curves: Sequence[History], window: Window) -> tuple[float, float]:
    """Return the lower left corner, in shares of the panel, with the fewest samples and the least of the window below it."""
    (start, end), (low, high) = ax.get_xlim(), ax.get_ylim()
    x = np.concatenate([(curve.time - start) / (end - start) for curve in curves])
    y = np.concatenate([(curve.values - low) / (high - low) for curve in curves])
    box = (
        (window.start - start) / (end - start),
        (window.end - start) / (end - start),
        (window.low - low) / (high - low),
        (window.high - low) / (high - low),
    )
    level = _ABOVE if window.high > 0 else _BELOW
    return min(((side, level) for side in _SIDES), key=lambda corner: _cost(corner, x, y, box))


def _cost(corner: tuple[float, float], x: FloatArray, y: FloatArray, box: tuple[float, float, float, float]) -> float:
    left, bottom = corner
    inside_x = (x > left - 3 * _MARGIN) & (x < left + WIDTH + _MARGIN)
    covered = float(np.mean(inside_x & (y > bottom - _MARGIN) & (y < bottom + HEIGHT + _MARGIN)))
    apart = box[1] < left - _MARGIN or box[0] > left + WIDTH + _MARGIN or box[3] < bottom - _MARGIN or box[2] > bottom + HEIGHT + _MARGIN
    distance = abs(0.5 * (box[0] + box[1]) - left - 0.5 * WIDTH) + abs(0.5 * (box[2] + box[3]) - bottom - 0.5 * HEIGHT)
    return _COVERING * covered + (0.0 if apart else _HIDING) + _DISTANCE * distance
