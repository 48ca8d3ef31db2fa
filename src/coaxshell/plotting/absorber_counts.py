"""Peak and RMS stress against the number of absorbers (the paper's Figure 9)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.plotting.scales import round_up
from coaxshell.plotting.style import COLOURS, PAGE_WIDTH, new_figure, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_STEPS = 6

_LOOKS: dict[str, dict[str, Any]] = {
    "anywhere": {"color": COLOURS["sky"], "linewidth": 2.6, "marker": "none", "label": "peak anywhere"},
    "head": {"color": COLOURS["green"], "linestyle": (0, (4, 1.2)), "marker": "^", "label": "peak at head"},
    "tail": {"color": COLOURS["blue"], "marker": "s", "label": "peak at tail"},
    "rms": {
        "color": COLOURS["orange"],
        "linestyle": (0, (5, 1.2, 1.2, 1.2)),
        "marker": "o",
        "label": "RMS over surface and time (right scale)",
    },
}


@dataclass(frozen=True)
class StressByCount:
    """Stress of one shell by the number of absorbers, MPa, each of the shape of *counts*.

    Attributes
    ----------
    counts : ndarray
    head, tail, anywhere : ndarray
        Largest magnitudes over time.
    rms : ndarray
        Root mean square over the surface and time.
    """

    counts: FloatArray
    head: FloatArray
    tail: FloatArray
    anywhere: FloatArray
    rms: FloatArray


def figure_absorber_counts(panels: Sequence[tuple[str, StressByCount]]) -> Figure:
    """Draw panels, two in a row, of peaks (left scale) and RMS (right scale) against the number of absorbers.

    Parameters
    ----------
    panels : sequence of (str, StressByCount)
        With their titles.

    Returns
    -------
    Figure
    """
    rows = -(-len(panels) // 2)
    with style():
        figure = new_figure(PAGE_WIDTH, 2.5 * rows + 0.6)
        axes = figure.subplots(rows, 2, squeeze=False)
        for index, (ax, (title, stress)) in enumerate(zip(axes.flat, panels, strict=True)):
            row = [beside for _, beside in panels[index - index % 2 :][:2]]
            peaks = np.concatenate([values for one in row for values in (one.head, one.tail, one.anywhere)])
            right = _panel(ax, stress, _limits(peaks), _limits(np.concatenate([one.rms for one in row])))
            ax.set_title(f"{'abcdef'[index]}  {title}", loc="left", fontweight="bold")
            if index % 2 == 0:
                ax.set_ylabel("peak hoop stress (MPa)")
                right.tick_params(labelright=False)
            else:
                right.set_ylabel("RMS hoop stress (MPa)", color=COLOURS["orange"])
                ax.tick_params(labelleft=False)
            if index // 2 == rows - 1:
                ax.set_xlabel("number of absorbers $N$")
        lines = [*axes.flat[0].lines[:3], right.lines[0]]
        figure.legend(handles=lines, loc="outside lower center", ncols=4, columnspacing=1.2)
    return figure


def _panel(ax: Axes, stress: StressByCount, peaks: tuple[float, float], rms: tuple[float, float]) -> Axes:
    right: Axes = ax.twinx()
    right.grid(visible=False)
    for name, looks in _LOOKS.items():
        axis = right if name == "rms" else ax
        axis.plot(stress.counts, getattr(stress, name), **{"markersize": 2.6, "linewidth": 1.0, **looks})
    for axis, limits in ((ax, peaks), (right, rms)):
        axis.set_ylim(*limits)
        axis.set_yticks(np.linspace(*limits, _STEPS + 1))
    right.tick_params(axis="y", colors=COLOURS["orange"])
    first, last = float(stress.counts[0]), float(stress.counts[-1])
    ax.set_xlim(first - 0.015 * (last - first), last + 0.015 * (last - first))
    return right


def _limits(values: FloatArray) -> tuple[float, float]:
    """Return the ends of a scale of _STEPS round steps that holds all values, and need not begin at zero."""
    margin = 0.03 * float(np.ptp(values))
    low, high = float(values.min()) - margin, float(values.max()) + margin
    step = round_up((high - low) / _STEPS or high / _STEPS)
    while (start := math.floor(low / step + 1e-9) * step) + _STEPS * step < high:
        step = round_up(1.01 * step)
    return start, start + _STEPS * step
