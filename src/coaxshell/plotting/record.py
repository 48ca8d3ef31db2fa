"""A measured record drawn: what was read beside what is solved, and the spectrum of its energy."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from coaxshell.model.prefixes import PREFIXES, exponent_of
from coaxshell.model.records.measures import Measures
from coaxshell.plotting.style import COLOURS, PAGE_WIDTH, literal, new_figure, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from coaxshell.model.pulses import Sampled

_POINTS = 20_000
"""Points of a curve at most: beyond them its largest and smallest values in each piece."""


def figure_record(record: Sampled, title: str = "") -> Figure:
    """Return a figure of a record: its history on the left, its spectrum on the right.

    Parameters
    ----------
    record : Sampled
    title : str
    """
    with style():
        figure = new_figure(PAGE_WIDTH, 2.9)
        left, right = figure.subplots(1, 2, width_ratios=(1.5, 1.0))
        found = record.measures
        plot_record(record, left, found)
        plot_spectrum(record, right, found)
        if title:
            figure.suptitle(literal(title), fontsize=9)
        return figure


def plot_record(record: Sampled, ax: Axes, found: Measures | None = None) -> Axes:
    """Draw the samples that were read, where they differ, and the history that is solved, with its peak; return *ax*."""
    found = found or record.measures
    time, pressure = record.curve
    t, p = exponent_of(max(float(np.abs(time).max()), 1e-12)), exponent_of(abs(found.peak) or 1.0)
    read = np.asarray(record.time), np.asarray(record.pressure)
    if not (len(read[0]) == len(time) and np.array_equal(read[0], time) and np.array_equal(read[1], pressure)):
        ax.plot(*_drawn(read[0] / 10.0**t, read[1] / 10.0**p), color=COLOURS["grey"], linewidth=0.7, label="as recorded")
    # Zero before the first sample and after the last, as it is solved.
    closed = np.concatenate([time[:1], time, time[-1:]]), np.concatenate([[0.0], pressure, [0.0]])
    ax.plot(*_drawn(closed[0] / 10.0**t, closed[1] / 10.0**p), color=COLOURS["blue"], label="as solved")
    ax.plot([found.peak_time / 10.0**t], [found.peak / 10.0**p], "o", color=COLOURS["orange"], markersize=4, label="peak")
    ax.set_xlabel(f"time ({PREFIXES[t]}s)")
    ax.set_ylabel(f"pressure ({PREFIXES[p]}Pa)")
    ax.legend(loc="best")
    return ax


def plot_spectrum(record: Sampled, ax: Axes, found: Measures | None = None) -> Axes:
    """Draw the magnitude of the history's transform against frequency, and the band that 99 % of its energy lies in; return *ax*."""
    from matplotlib.ticker import LogFormatter

    found = found or record.measures
    frequency, density = record.spectrum
    kept = (frequency > 0) & (frequency <= found.nyquist)
    f = exponent_of(found.band or found.nyquist)
    bins = np.unique(np.geomspace(1, max(2, kept.sum()), 600).astype(int)) - 1
    x = np.array([piece.mean() for piece in np.split(frequency[kept], bins[1:]) if piece.size])
    y = np.sqrt([piece.mean() for piece in np.split(density[kept], bins[1:]) if piece.size])
    ax.loglog(x / 10.0**f, y, color=COLOURS["blue"])
    top = float(y.max(initial=0.0)) or 1.0
    ax.set_ylim(max(top * 1e-6, float(y.min(initial=top)) / 2 or top * 1e-6), 2 * top)
    if found.band > 0:
        ax.axvline(found.band / 10.0**f, color=COLOURS["orange"], linewidth=0.9, linestyle="dashed", label="99 % of the energy below")
        ax.legend(loc="lower left")
    ax.xaxis.set_major_formatter("{x:g}")  # 0.1, 1, 10 kHz: powers of ten beside a prefix have to be multiplied
    if ax.get_ylim()[1] < 100 * ax.get_ylim()[0]:  # marks between the powers of ten are numbered too: 20, not 2 x 10^1
        ax.yaxis.set_major_formatter("{x:g}")
        ax.yaxis.set_minor_formatter(LogFormatter(minor_thresholds=(2.0, 0.5)))
    ax.set_xlabel(f"frequency ({PREFIXES[f]}Hz)")
    ax.set_ylabel("|P(f)| (Pa s)")
    return ax


def _drawn(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return what a figure can show of a long curve: the first, largest and smallest values of pieces, in their order."""
    if len(x) <= _POINTS:
        return x, y
    size = -(-len(x) // (_POINTS // 4))
    starts = np.arange(0, len(x) - size, size)
    pieces = y[: starts.size * size].reshape(-1, size)
    kept = np.unique(np.concatenate([starts, starts + pieces.argmax(1), starts + pieces.argmin(1), np.arange(starts.size * size, len(x))]))
    return x[kept], y[kept]
