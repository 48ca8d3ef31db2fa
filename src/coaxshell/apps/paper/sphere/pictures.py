"""The pictures of the report: histories under the four sources, and the map of the slice's error."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from coaxshell.apps.paper.point_histories import figure_points
from coaxshell.apps.paper.sphere.compared import SPHERE, Compared
from coaxshell.plotting.style import COLOURS, PAGE_WIDTH, new_figure, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from coaxshell.solver.slice_error import SliceMap

_DRAWN = {
    SPHERE: ("sphere, three dimensions", "black", "solid", 1.5),
    "slice": ("slice (the paper's)", COLOURS["orange"], "solid", 2.6),
    "line": ("line source", COLOURS["blue"], (0, (4.5, 1.5)), 1.0),
    "plane": ("plane wave", COLOURS["green"], (0, (1.2, 1.2)), 1.1),
}
_LEVELS = (0.02, 0.05, 0.1, 0.2, 0.5, 1.0)
_SHOWN_DURATIONS = (1.0, 4.0)


def figure_histories(found: Compared) -> Figure:
    """Draw the hoop stress at head and tail of each shell under every source, a panel a point."""
    return figure_points(found.points, lambda point, ax: plot_histories(found, point, ax), len(_DRAWN))


def plot_histories(found: Compared, point: int, ax: Axes) -> Axes:
    """Draw the hoop stress at one point, by its number, under every source, and return the axes."""
    ax.axhline(0.0, color=COLOURS["grey"], linewidth=0.6, zorder=1)
    for kind, (label, colour, dash, width) in _DRAWN.items():
        if kind in found.stress:
            ax.plot(found.time, found.stress[kind][point] / 1e6, color=colour, linestyle=dash, linewidth=width, label=label)
    ax.set_xlim(float(found.time[0]), float(found.time[-1]))
    return ax


def figure_error_map(known: SliceMap) -> Figure:
    """Draw the slice's error over distance and decay for two durations, and beside it that of line and plane over the distance."""
    with style():
        figure = new_figure(PAGE_WIDTH, 2.9)
        axes = figure.subplots(1, 3, width_ratios=(1.0, 1.0, 1.05))
        for ax, duration in zip(axes, _SHOWN_DURATIONS, strict=False):
            plot_error_map(known, duration, ax).set_title(f"slice, error (%) to $t$ = {duration:g}")
        axes[1].set_ylabel("")
        plot_errors(known, ax=axes[2])
    return figure


def plot_error_map(known: SliceMap, duration: float, ax: Axes) -> Axes:
    """Draw the slice's error to an instant as contours over distance and decay, and return the axes."""
    from matplotlib.colors import LogNorm

    distances, decays = (np.geomspace(axis[0], axis[-1], 80) for axis in (known.distance, known.decay))
    values = np.array([[known.estimate(distance, decay, duration) for distance in distances] for decay in decays])
    ax.grid(visible=False)
    _distance_axis(ax)
    ax.set_yscale("log")
    ax.set_yticks([0.05, 0.2, 1.0, 5.0, 20.0], ["0.05", "0.2", "1", "5", "20"])
    norm = LogNorm(_LEVELS[0], 2.0)
    ax.contourf(distances, decays, values, np.geomspace(1e-3, 2.0, 60), norm=norm, cmap="cividis", extend="both")
    lines = ax.contour(distances, decays, values, _LEVELS, colors="white", linewidths=0.9)
    ax.clabel(lines, fmt=lambda level: f"{100 * level:g}", fontsize=8, inline_spacing=3)
    ax.minorticks_off()
    ax.set_ylabel("decay of the pulse (transits)")
    return ax


def plot_errors(known: SliceMap, ax: Axes) -> Axes:
    """Draw the error of slice, line and plane wave to the report's instant over the distance, and return the axes."""
    from coaxshell.apps.paper.sphere.texts import SHOWN_DECAY, SHOWN_DURATION

    j, k = list(known.decay).index(SHOWN_DECAY), list(known.duration).index(SHOWN_DURATION)
    for kind, table in (("slice", known.error), ("line", known.line), ("plane", known.plane)):
        label, colour, dash, width = _DRAWN[kind]
        ax.plot(known.distance, 100 * table[:, j, k], color=colour, linestyle=dash, linewidth=width, label=label.split(" (")[0])
    _distance_axis(ax)
    ax.set_yscale("log")
    ax.set_yticks([5, 10, 20, 50, 100, 200], ["5", "10", "20", "50", "100", "200"])
    ax.minorticks_off()
    ax.set_title(f"decay {SHOWN_DECAY:g}, to $t$ = {SHOWN_DURATION:g}")
    ax.set_ylabel("error (%)")
    ax.legend(loc="lower left")
    return ax


def _distance_axis(ax: Axes) -> None:
    ax.set_xscale("log")
    ax.set_xticks([2, 5, 10, 20, 50, 100], ["2", "5", "10", "20", "50", "100"])
    ax.set_xlabel("distance (outer radii)")
