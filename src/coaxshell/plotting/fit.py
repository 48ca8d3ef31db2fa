"""A fit drawn: every record beside the run that meets them best, and what is left."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from coaxshell.plotting.style import COLOURS, PAGE_WIDTH, literal, new_figure, style
from coaxshell.plotting.units import scale

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from coaxshell.studies.fitting.fitted import Fit, FittedRecord

MOST_RECORDS = 8
"""Records that are drawn; of more, the first ones."""


def figure_fit(fit: Fit) -> Figure:
    """Draw the records of a fit beside the run that it found, one panel each.

    Parameters
    ----------
    fit : Fit

    Returns
    -------
    Figure
    """
    shown = fit.records[:MOST_RECORDS]
    rows = (len(shown) + 1) // 2
    with style():
        figure = new_figure(PAGE_WIDTH, 0.5 + 1.8 * rows)
        panels = figure.subplots(rows, 1 if len(shown) == 1 else 2, squeeze=False).ravel()
        for one, ax in zip(shown, panels, strict=False):
            plot_fitted_record(one, ax)
        for ax in panels[len(shown) :]:
            ax.set_axis_off()
        panels[0].legend(loc="best", fontsize="small")
    return figure


def plot_fitted_record(one: FittedRecord, ax: Axes) -> Axes:
    """Draw a record, and the run at its place, against the time since the run began."""
    factor, unit = _scaled(one)
    milliseconds = 1e3 * one.time
    ax.plot(milliseconds, one.measured * factor, ".", color=COLOURS["sky"], markersize=1.8, label="measured")
    ax.plot(milliseconds, one.modelled * factor, color=COLOURS["blue"], linewidth=1.0, label="fitted")
    ax.set_xlabel("time (ms)")
    words = one.quantity.replace("_", " ")
    ax.set_ylabel(f"{words} ({unit})" if unit else words)
    ax.set_title(literal(f"{one.name}: {one.place}"), fontsize="small", loc="left")
    return ax


def _scaled(one: FittedRecord) -> tuple[float, str]:
    if one.quantity == "strain":
        return 1e6, "10⁻⁶"
    return scale(np.concatenate([one.measured, one.modelled]).tolist(), one.unit)
