"""Sheets of panels, each with its own curves, quantity and legend (the paper's Figure 2)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from coaxshell.numerics.arrays import FloatArray
from coaxshell.plotting.histories import TIME_LABEL
from coaxshell.plotting.style import COLOURS, PAGE_WIDTH, new_figure, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class SheetCurve:
    """One curve: its name in the legend, times in transits, values, colour (of the package's) and dashes."""

    name: str
    time: FloatArray
    values: FloatArray
    colour: str
    dash: Any = "solid"


@dataclass(frozen=True)
class SheetPanel:
    """One panel: its title with its letter, the label of its values, and its curves."""

    title: str
    label: str
    curves: Sequence[SheetCurve]


def figure_curve_sheet(panels: Sequence[SheetPanel], columns: int = 2) -> Figure:
    """Draw panels, each on its own scale with its own legend below the time axis.

    Parameters
    ----------
    panels : sequence of SheetPanel
    columns : int
        Panels in a row.

    Returns
    -------
    Figure
    """
    rows = -(-len(panels) // columns)
    with style():
        figure = new_figure(PAGE_WIDTH, 2.75 * rows)
        axes = figure.subplots(rows, columns, squeeze=False)
        for ax, panel in zip(axes.flat, panels, strict=False):
            _panel(ax, panel)
        for ax in axes.flat[len(panels) :]:
            ax.remove()
    return figure


def _panel(ax: Axes, panel: SheetPanel) -> None:
    for curve in panel.curves:
        ax.plot(curve.time, curve.values, color=COLOURS[curve.colour], linestyle=curve.dash, label=curve.name)
    ax.axhline(0.0, color=COLOURS["grey"], linewidth=0.5, zorder=1)
    ax.set_xlim(0.0, max(float(curve.time[-1]) for curve in panel.curves))
    ax.set_title(panel.title, loc="left", fontweight="bold")
    ax.set_xlabel(TIME_LABEL)
    ax.set_ylabel(panel.label)
    wide = sum(len(curve.name) for curve in panel.curves) > _LINE
    columns = -(-len(panel.curves) // (2 if wide else 1))
    ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.24), ncols=columns, **_COMPACT)


_LINE = 30
"""Characters of one line of a legend."""
_COMPACT: dict[str, Any] = {"fontsize": 7.5, "columnspacing": 0.9, "handlelength": 1.9, "handletextpad": 0.4, "borderaxespad": 0.0}
