"""The paper's Figures 5 to 7 and 10 to 12: stress at head and tail for several systems."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from coaxshell.apps.paper import cases
from coaxshell.apps.paper.known_runs import Runs
from coaxshell.apps.paper.observed import SIDES, Observed
from coaxshell.apps.paper.recipes import Drawn
from coaxshell.numerics.progress import Progress
from coaxshell.plotting.histories import QUANTITIES, History, history

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from coaxshell.model import System
    from coaxshell.response import Response

INNER: tuple[tuple[str, float], ...] = (("inner", 0.0), ("inner", 180.0))
BOTH: tuple[tuple[str, float], ...] = (*INNER, ("outer", 0.0), ("outer", 180.0))
"""Shells and degrees from the head."""

PER_LENGTH = "one absorber at the head; constants per metre of the shells' length"
MAGNIFIED = 0.2
"""Half the width of a magnified view, transits."""

Points = Sequence[tuple[str, float]]
Curves = dict[tuple[str, float], dict[str, History]]


def point_name(shell: str, turn: float) -> str:
    """Return the title of a point's panel."""
    return f"{shell.capitalize()} shell, {'tail' if turn else 'head'}"


def add_curves(curves: Curves, name: str, response: Response, points: Points, quantity: str) -> None:
    """Add a response's history at each point under a name."""
    head = cases.head_of(response.system)
    for shell, turn in points:
        curves.setdefault((shell, turn), {})[name] = history(response, quantity, shell, head + turn)


def history_of(run: Observed, quantity: str, shell: str, turn: float) -> History:
    """Return the curve of a run at a point, so many degrees from the head, in drawn units."""
    side = next(name for name, angle in SIDES.items() if angle == turn)
    return History(run.time, QUANTITIES[quantity].per_si * run.at(quantity, shell, side), 1e3 * run.transit_time)


def solved_curves(
    systems: cases.Cases, points: Points, quantity: str, runs: Runs, progress: Progress | None, last: float = math.inf
) -> tuple[Curves, tuple[str, ...]]:
    """Return the histories of each system at each point up to *last* transits, and the warnings with the systems' names."""
    curves: Curves = {}
    warnings: list[tuple[str, str]] = []
    for name, run in runs.each(systems, progress, resolution=runs.resolution.up_to(last)):
        for point in points:
            curves.setdefault(point, {})[name] = history_of(run, quantity, *point)
        warnings += [(plain(name), text) for text in run.warnings]
    return curves, named_warnings(warnings)


def stress_study(
    varied: Callable[[System], cases.Cases], points: Points, legend_title: str, magnified: float | None
) -> Callable[[list[System], Runs, Progress | None], Drawn]:
    """Return what draws the stress of varied systems at the given points."""

    def draw(systems: list[System], runs: Runs, progress: Progress | None) -> Drawn:
        curves, warnings = solved_curves(varied(systems[0]), points, "stress", runs, progress)
        return Drawn(_figure(curves, legend_title, magnified), warnings)

    return draw


def hybrid(responses: list[Response], progress: Progress | None) -> Figure:
    """Draw Figure 12: the stress at head and tail of both shells without control, with each kind and with both."""
    curves: Curves = {}
    for name, response in zip(("bare", "absorbers", "active", "hybrid"), responses, strict=True):
        add_curves(curves, name, response, BOTH, "stress")
    return _figure(curves, "", None, legend_columns=4)


def named_warnings(told: Sequence[tuple[str, str]]) -> tuple[str, ...]:
    """Return each warning of (name of the run, warning) once, with the name of its first run and the number of the others."""
    runs: dict[str, list[str]] = {}
    for name, text in told:
        runs.setdefault(text, []).append(name)
    return tuple(f"{names[0]}{f' and {len(names) - 1} more' if names[1:] else ''}: {text}" for text, names in runs.items())


def plain(name: str) -> str:
    """Return a name in the legend without its mathematical markup, for the terminal."""
    for mark, text in (("\\mathrm", ""), ("\\times", "x"), ("10^", "1e"), ("$", ""), ("{", ""), ("}", ""), (" x 1e", "e")):
        name = name.replace(mark, text)
    return name


def _figure(curves: Curves, legend_title: str, magnified: float | None, legend_columns: int = 3) -> Figure:
    from coaxshell.plotting.named_curves import CurvePanel, figure_named_curves

    panels = [CurvePanel(point_name(*point), named, magnified) for point, named in curves.items()]
    return figure_named_curves(panels, QUANTITIES["stress"].label, legend_title=legend_title, legend_columns=legend_columns)
