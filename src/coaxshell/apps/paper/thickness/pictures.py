"""The pictures of the report: histories under thin and exact walls, and the map of the thin walls' error."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from coaxshell.apps.paper.point_histories import figure_points
from coaxshell.apps.paper.thickness.compared import EXACT, Compared
from coaxshell.plotting.style import COLOURS, PAGE_WIDTH, new_figure, style
from coaxshell.solver.thin_error import WALLS, WETTED

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from coaxshell.solver.thin_error import ThinMap

_DRAWN = {
    EXACT: ("exact, elastic solids", "black", "solid", 1.6),
    "mid-surface": ("thin, wetted at mid-surfaces (the paper's)", COLOURS["orange"], "solid", 1.1),
    "faces": ("thin, wetted at faces", COLOURS["blue"], (0, (4.5, 1.5)), 1.1),
}
_TITLES = {"dry": "steel tube, dry inside", "inner": "the paper's inner wall", "outer": "the paper's outer wall"}
_LEVELS = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0)


def figure_histories(found: Compared) -> Figure:
    """Draw the hoop stress at head and tail of each wall under every theory, a panel a point."""
    return figure_points(found.points, lambda point, ax: plot_histories(found, point, ax), len(_DRAWN))


def plot_histories(found: Compared, point: int, ax: Axes) -> Axes:
    """Draw the hoop stress at one point, by its number, under every theory, and return the axes."""
    ax.axhline(0.0, color=COLOURS["grey"], linewidth=0.6, zorder=1)
    for theory, (label, colour, dash, width) in _DRAWN.items():
        values = found.histories.get((theory, "stress"))
        if values is not None:
            ax.plot(found.time, values[point] / 1e6, color=colour, linestyle=dash, linewidth=width, label=label)
    ax.set_xlim(float(found.time[0]), float(found.time[-1]))
    return ax


def figure_error_map(known: ThinMap) -> Figure:
    """Draw the error of thin walls over thickness and decay to the report's instant: a column a wall, a row what the fluids wet."""
    from coaxshell.apps.paper.thickness.texts import SHOWN_DURATION

    with style():
        figure = new_figure(PAGE_WIDTH, 4.8)
        figure.suptitle(f"Error of the hoop stress (%), histories to t = {SHOWN_DURATION:g}", fontsize=10)
        axes = figure.subplots(len(WETTED), len(WALLS), sharex="col", sharey=True)
        for row, wetted in zip(axes, WETTED, strict=True):
            for ax, wall in zip(row, WALLS, strict=True):
                plot_error_map(known, wall, wetted, SHOWN_DURATION, ax)
        for ax, wall in zip(axes[0], WALLS, strict=True):
            ax.set_title(_TITLES[wall])
        for ax in axes[-1]:
            ax.set_xlabel("thickness/radius")
        for ax, wetted in zip(axes[:, 0], WETTED, strict=True):
            ax.set_ylabel(f"wetted at {'mid-surfaces' if wetted == 'mid-surface' else wetted}\ndecay (transits)")
    return figure


def plot_error_map(known: ThinMap, wall: str, wetted: str, duration: float, ax: Axes) -> Axes:
    """Draw the error of the hoop stress (%) to an instant as contours over thickness and decay, and return the axes."""
    from matplotlib.colors import LogNorm

    thickness = known.thickness[WALLS.index(wall)]
    ratios, decays = (np.geomspace(axis[0], axis[-1], 25) for axis in (thickness, known.decay))
    values = np.array([[known.estimate(wall, wetted, ratio, decay, duration) for ratio in ratios] for decay in decays])
    ax.grid(visible=False)
    ax.set_xscale("log")
    ax.set_yscale("log")
    shown = [x for x in (0.002, 0.005, 0.01, 0.02, 0.05, 0.1) if ratios[0] <= x <= ratios[-1]]
    ax.set_xticks(shown, [f"{x:g}" for x in shown])
    ax.set_yticks([0.05, 0.2, 1.0, 5.0, 20.0], ["0.05", "0.2", "1", "5", "20"])
    ax.contourf(ratios, decays, values, np.geomspace(2e-3, 2.0, 60), norm=LogNorm(5e-3, 1.0), cmap="cividis", extend="both")
    lines = ax.contour(ratios, decays, values, _LEVELS, colors="white", linewidths=0.9)
    ax.clabel(lines, fmt=lambda level: f"{100 * level:g}", fontsize=8, inline_spacing=3)
    ax.minorticks_off()
    return ax
