"""Figures of a response. Every plot function takes ``ax`` and returns it; matplotlib is imported when a figure is made."""

from __future__ import annotations

from coaxshell.plotting.bare_histories import figure_bare_histories
from coaxshell.plotting.figures import FIGURES, FigureRecipe, figure_recipe
from coaxshell.plotting.histories import QUANTITIES, PlottedQuantity, mark_peak, plot_history
from coaxshell.plotting.saving import FIGURE_SUFFIXES, save_figure
from coaxshell.plotting.style import COLOURS, style

__all__ = [
    "COLOURS",
    "FIGURES",
    "FIGURE_SUFFIXES",
    "QUANTITIES",
    "FigureRecipe",
    "PlottedQuantity",
    "figure_bare_histories",
    "figure_recipe",
    "mark_peak",
    "plot_history",
    "save_figure",
    "style",
]
