"""The figures that can be asked for by number."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING

from coaxshell.errors import InputError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from coaxshell.response import Response


@dataclass(frozen=True)
class FigureRecipe:
    """A figure of the paper that is computed from one response.

    Attributes
    ----------
    number : str
        Its number in the paper.
    title : str
        What it shows.
    preset : str
        Preset whose response it shows unless another one is given.
    draw : callable
        From the response to the figure.
    """

    number: str
    title: str
    preset: str
    draw: Callable[[Response], Figure]


def _bare_histories(response: Response) -> Figure:
    from coaxshell.plotting.bare_histories import figure_bare_histories

    return figure_bare_histories(response)


FIGURES: Mapping[str, FigureRecipe] = MappingProxyType(
    {"3": FigureRecipe("3", "stress and displacement at head and tail of each shell", "bare", _bare_histories)}
)
"""Figures by their number in the paper."""


def figure_recipe(number: str) -> FigureRecipe:
    """Return the recipe of a figure; InputError that lists the available ones if there is none."""
    try:
        return FIGURES[number]
    except KeyError:
        raise InputError("figure", f"there is no figure {number!r}", f"available: {', '.join(FIGURES)}") from None
