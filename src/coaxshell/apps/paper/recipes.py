"""What a recipe is, and what it gives."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from coaxshell.numerics.progress import Progress

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from coaxshell.apps.paper.known_runs import Runs
    from coaxshell.model import System
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
    caption : str
        What is drawn how, in a sentence or two.
    """

    number: str
    title: str
    presets: tuple[str, ...]
    draw: Callable[[list[Response], Progress | None], Figure]
    caption: str


@dataclass(frozen=True)
class Drawn:
    """A figure and the physics warnings of its runs, each with the name of its run."""

    figure: Figure
    warnings: tuple[str, ...] = ()


@dataclass(frozen=True)
class StudyRecipe:
    """A figure of the paper that is computed from many runs, varied from one system or from several.

    Attributes
    ----------
    number, title, caption : str
        As those of :class:`FigureRecipe`.
    presets : tuple of str
        Presets that are varied, in this order, unless other systems are given.
    draw : callable
        From the systems, the runs and a report of progress (or None) to what was drawn.
    """

    number: str
    title: str
    presets: tuple[str, ...]
    draw: Callable[[list[System], Runs, Progress | None], Drawn]
    caption: str
