"""Histories at head and tail of both walls, a panel a point: the page that reports lay several models side by side on."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from coaxshell.plotting.histories import TIME_LABEL
from coaxshell.plotting.style import PAGE_WIDTH, new_figure, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def figure_points(points: Sequence[str], draw: Callable[[int, Axes], Axes], curves: int) -> Figure:
    """Draw hoop stresses at several points, two panels a row.

    Parameters
    ----------
    points : sequence of str
        Titles of the panels.
    draw : callable
        Draws the curves of one point, by its number.
    curves : int
        How many there are at most: they stand beside each other in the legend.
    """
    with style():
        rows = -(-len(points) // 2)
        figure = new_figure(PAGE_WIDTH, 0.5 + 2.1 * rows)
        axes = figure.subplots(rows, 2, sharex=True, sharey=True, squeeze=False)
        for index, (ax, point) in enumerate(zip(axes.flat, points, strict=False)):
            draw(index, ax).set_title(point)
        for ax in axes[-1]:
            ax.set_xlabel(TIME_LABEL)
        for ax in axes[:, 0]:
            ax.set_ylabel("hoop stress (MPa)")
        figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=curves)
    return figure
