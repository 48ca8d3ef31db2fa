"""A sheet of plots as an SVG picture, drawn by matplotlib without a screen."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING

from coaxshell.apps.verification.rows import Curve, Panel, Sheet
from coaxshell.plotting.style import COLOURS, literal, new_figure, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes

WIDTH, HEIGHT = 9.0, 3.1
"""Width of a sheet and height of a row of panels, inches."""

CYCLE = ("blue", "orange", "green", "purple", "sky", "amber", "grey")
DASHES = ("-", "--", "-.", ":")
FEW = 7
"""Curves in a panel whose legend still fits inside."""


def svg(sheet: Sheet) -> str:
    """Return a sheet as SVG text with its fonts as outlines, so that it looks alike everywhere; the same sheet gives the same text."""
    import matplotlib as mpl

    panels = list(sheet.panels)
    columns = min(2, len(panels)) if len(panels) != 3 else 3
    rows = -(-len(panels) // columns)
    with style(), mpl.rc_context({"svg.fonttype": "path"}):
        crowded = max(len(panel.curves) for panel in panels) > FEW
        figure = new_figure(WIDTH if columns > 1 or crowded else 0.62 * WIDTH, HEIGHT * rows + (0.4 if crowded else 0.0))
        axes = figure.subplots(rows, columns, squeeze=False)
        for ax, panel in zip(axes.flat, panels, strict=False):
            draw(ax, panel, legend=not crowded)
        for ax in axes.flat[len(panels) :]:
            ax.set_visible(False)
        if crowded:
            handles, labels = axes.flat[0].get_legend_handles_labels()
            figure.legend(handles, labels, loc="outside right upper", fontsize=7.5)
        text = io.StringIO()
        figure.savefig(text, format="svg", metadata={"Date": None})
    return text.getvalue()


def draw(ax: Axes, panel: Panel, *, legend: bool = True) -> Axes:
    """Draw one panel into axes and return them."""
    plain = 0
    for curve in panel.curves:
        if curve.colour is None:
            _curve(ax, curve, CYCLE[plain % len(CYCLE)], DASHES[plain // len(CYCLE) % len(DASHES)])
            plain += 1
        else:
            _curve(ax, curve, curve.colour, "-")
    if panel.logarithmic:
        ax.set_xscale("log")
        ax.set_yscale("log")
        for curve in panel.curves:
            ax.plot(curve.x, curve.y, ".", color="#444444", markersize=2.5)
    if panel.title:
        ax.set_title(literal(panel.title))
    ax.set_xlabel(panel.x_label)
    ax.set_ylabel(panel.y_label)
    if legend and any(curve.label for curve in panel.curves) and len(panel.curves) > 1:
        ax.legend(fontsize=7, frameon=True, framealpha=0.8, edgecolor="none", loc="best")
    return ax


def _curve(ax: Axes, curve: Curve, colour: str, dashes: str) -> None:
    label = literal(curve.label) or "_nolegend_"
    if curve.style == "points":
        ax.plot(curve.x, curve.y, "o", color=COLOURS[colour], markersize=4, markerfacecolor="white", markeredgewidth=0.9, label=label)
    else:
        ax.plot(curve.x, curve.y, "--" if curve.style == "dashed" else dashes, color=COLOURS[colour], label=label)
