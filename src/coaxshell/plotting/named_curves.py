"""Panels of named curves: one quantity at several points for several systems (the paper's Figures 5 to 7 and 10 to 12)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from coaxshell.errors import InputError
from coaxshell.plotting.histories import TIME_LABEL, History
from coaxshell.plotting.insets import add_inset, window_around
from coaxshell.plotting.scales import Scale, common_scales
from coaxshell.plotting.style import COLOURS, PAGE_WIDTH, new_figure, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

LOOKS: tuple[tuple[str, Any, float], ...] = (
    ("#000000", "solid", 1.3),
    (COLOURS["sky"], (0, (6.0, 1.2)), 1.1),
    (COLOURS["blue"], (0, (3.5, 1.2)), 1.1),
    (COLOURS["green"], "solid", 1.1),
    (COLOURS["orange"], (0, (5.0, 1.2, 1.2, 1.2)), 1.1),
    (COLOURS["purple"], (0, (1.3, 1.1)), 1.3),
)
"""Colour, dashes and width of the first, second, ... curve: told apart by dashes as well."""

_ROOM = 0.4
"""Added to the scale for insets above or below the curves, relative to its length."""


@dataclass(frozen=True)
class CurvePanel:
    """One panel.

    Attributes
    ----------
    title : str
    curves : mapping of str to History
        By their names in the legend, the same ones in every panel; the first is the reference.
    magnified : float or None
        Half the width, in transits, of a magnified view around the largest magnitude of the first curve; none if None.
    """

    title: str
    curves: Mapping[str, History]
    magnified: float | None = None


def figure_named_curves(
    panels: Sequence[CurvePanel], label: str, *, legend_title: str = "", columns: int = 2, legend_columns: int = 3
) -> Figure:
    """Draw panels of named curves on one scale, with one legend below.

    Parameters
    ----------
    panels : sequence of CurvePanel
    label : str
        Name and unit of the quantity.
    legend_title : str
    columns, legend_columns : int
        Panels and legend entries in a row.

    Returns
    -------
    Figure

    Raises
    ------
    InputError
        There is no panel, or there are more curves than looks.
    """
    names = list(panels[0].curves) if panels else []
    if not 1 <= len(names) <= len(LOOKS):
        raise InputError("curves", f"{len(names)} curves cannot be told apart", f"give 1 to {len(LOOKS)}")
    values = [curve.values for panel in panels for curve in panel.curves.values()]
    (scale,) = common_scales([(float(min(v.min() for v in values)), float(max(v.max() for v in values)))])
    limits = _with_room(scale, panels)
    rows = -(-len(panels) // columns)
    inset = any(panel.magnified for panel in panels)
    with style():
        figure = new_figure(PAGE_WIDTH, (2.9 if inset else 2.1) * rows + 0.75)
        axes = figure.subplots(rows, columns, squeeze=False, sharex=True, sharey=True)
        for index, (ax, panel) in enumerate(zip(axes.flat, panels, strict=True)):
            plot_named_curves(panel.curves, ax)
            ax.set_ylim(*limits)
            ax.set_yticks(scale.ticks)
            ax.set_title(f"{'abcdef'[index]}  {panel.title}", loc="left", fontweight="bold")
            if panel.magnified:
                _magnify(ax, panel, panel.magnified)
            if index % columns == 0:
                ax.set_ylabel(label)
            if index // columns == rows - 1:
                ax.set_xlabel(TIME_LABEL)
        lines = axes.flat[0].lines[: len(names)]
        figure.legend(
            handles=lines,
            labels=names,
            loc="outside lower center",
            ncols=legend_columns,
            title=legend_title or None,
        )
    return figure


def plot_named_curves(curves: Mapping[str, History], ax: Axes) -> Axes:
    """Draw named curves over each other, the first one lowest, in the looks of :data:`LOOKS`; return the axes.

    Parameters
    ----------
    curves : mapping of str to History
    ax : Axes
    """
    for (name, curve), (colour, dash, width) in zip(curves.items(), LOOKS, strict=False):
        ax.plot(curve.time, curve.values, color=colour, linestyle=dash, linewidth=width, label=name)
    ax.axhline(0.0, color=COLOURS["grey"], linewidth=0.5, zorder=1)
    ax.set_xlim(0.0, max(float(curve.time[-1]) for curve in curves.values()))
    return ax


def _with_room(scale: Scale, panels: Sequence[CurvePanel]) -> tuple[float, float]:
    """Return the limits of the value axis, with room on the sides to which the magnified extrema point."""
    low, high = scale.limits
    signs = {panel.curves[next(iter(panel.curves))].peak[1] < 0 for panel in panels if panel.magnified}
    room = _ROOM * (high - low)
    return low - room * (True in signs), high + room * (False in signs)


def _magnify(ax: Axes, panel: CurvePanel, half_width: float) -> None:
    curves = list(panel.curves.values())
    time, _ = curves[0].peak
    window = window_around(curves, time, half_width)
    inset = add_inset(ax, curves, window)
    plot_named_curves(panel.curves, inset)
    inset.set_xlim(window.start, window.end)
    inset.set_ylim(window.low, window.high)
    ax.indicate_inset_zoom(inset, edgecolor=COLOURS["grey"], linewidth=0.7)
