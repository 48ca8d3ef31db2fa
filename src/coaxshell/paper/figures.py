"""The figures that can be asked for by number."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING

from coaxshell.errors import InputError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from coaxshell.plotting.frames import Report
    from coaxshell.response import Response


@dataclass(frozen=True)
class FigureRecipe:
    """A figure of the paper that is computed from one response or from several.

    Attributes
    ----------
    number : str
        Its number in the paper.
    title : str
        What it shows.
    presets : tuple of str
        Presets whose responses it shows, in this order, unless others are given.
    draw : callable
        From the responses and a report of progress (or None) to the figure.
    """

    number: str
    title: str
    presets: tuple[str, ...]
    draw: Callable[[list[Response], Report | None], Figure]


def _bare_histories(responses: list[Response], progress: Report | None) -> Figure:
    from coaxshell.plotting.bare_histories import figure_bare_histories

    return figure_bare_histories(responses[0])


def _snapshots(responses: list[Response], progress: Report | None) -> Figure:
    from coaxshell.plotting.snapshots import figure_snapshots

    return figure_snapshots(*responses, units="relative", progress=progress)


def _pressure_rms(responses: list[Response], progress: Report | None) -> Figure:
    from coaxshell.plotting.pressure_rms import figure_pressure_rms

    return figure_pressure_rms(*responses)


_COMPARED = ("bare", "hybrid")

FIGURES: Mapping[str, FigureRecipe] = MappingProxyType(
    {
        recipe.number: recipe
        for recipe in (
            FigureRecipe("3", "stress and displacement at head and tail of each shell", ("bare",), _bare_histories),
            FigureRecipe("4", "snapshots of the acoustic field and of the stress", ("bare",), _snapshots),
            FigureRecipe("13", "acoustic field and stress, bare against hybrid", _COMPARED, _snapshots),
            FigureRecipe("14", "RMS of the pressure outside and inside, bare against hybrid", _COMPARED, _pressure_rms),
        )
    }
)
"""Figures by their number in the paper."""


def figure_recipe(number: str) -> FigureRecipe:
    """Return the recipe of a figure; InputError that lists the available ones if there is none."""
    try:
        return FIGURES[number]
    except KeyError:
        raise InputError("figure", f"there is no figure {number!r}", f"available: {', '.join(FIGURES)}") from None
