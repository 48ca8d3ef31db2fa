"""An optimisation drawn: how it converged, the front between two objectives, and where the good designs lie."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from coaxshell.errors import InputError
from coaxshell.plotting.style import COLOURS, PAGE_WIDTH, literal, new_figure, style
from coaxshell.plotting.units import pretty, raised, scale

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from coaxshell.studies import Optimum
    from coaxshell.studies.optimisation.search import Candidate
    from coaxshell.studies.optimisation.variables import Variable

MOST_COORDINATES = 16
"""Variables that parallel coordinates show; of more, the first ones."""
_GOOD = 0.1


def figure_optimum(optimum: Optimum) -> Figure:
    """Draw convergence (or the front of two objectives) above the parallel coordinates of the designs.

    Parameters
    ----------
    optimum : Optimum

    Returns
    -------
    Figure
    """
    with style():
        figure = new_figure(PAGE_WIDTH, 5.6)
        above, below = figure.subplots(2, 1)
        if len(optimum.targets.goals) == 2:
            plot_front(optimum, above)
            above.set_title("a  Front", loc="left", fontweight="bold")
        else:
            plot_convergence(optimum, above)
            above.set_title("a  Convergence", loc="left", fontweight="bold")
        plot_parallel(optimum, below)
        below.set_title("b  Where the designs lie", loc="left", fontweight="bold")
    return figure


def plot_convergence(optimum: Optimum, ax: Axes) -> Axes:
    """Draw the first objective of every feasible design, the best so far and the baseline, against the number of evaluations.

    Where no design keeps all limits those beyond them are drawn instead.
    """
    goal = optimum.targets.goals[0].target
    some = any(one.feasible for one in optimum.history)
    drawn = np.array([one.targets.get(goal.name, np.nan) if one.feasible == some else np.nan for one in optimum.history])
    factor, unit = scale(drawn, goal.metric.units)
    numbers = np.array([one.number + 1 for one in optimum.history])
    values = drawn * factor
    if some:
        ax.plot(numbers, values, ".", color=COLOURS["sky"], markersize=2.5, label="feasible design")
        sign = -1.0 if optimum.targets.goals[0].maximise else 1.0
        best = sign * np.fmin.accumulate(sign * values)
        ax.step(numbers, best, where="post", color=COLOURS["blue"], linewidth=1.6, label="best so far")
    else:
        ax.plot(numbers, values, "x", color=COLOURS["grey"], markersize=3.5, label="design beyond a limit (all are)")
    before = optimum.baseline.targets.get(goal.name)
    if before is not None:
        ax.axhline(before * factor, color=COLOURS["orange"], linestyle=(0, (4, 1.5)), label="baseline")
    shown = values[np.isfinite(values)]
    if len(shown):
        low, high = float(shown.min()), float(np.quantile(shown, 0.95))
        extra = [before * factor] if before is not None else []
        bottom, top = min([low, *extra]), max([high, *extra])
        ax.set_ylim(bottom - 0.06 * (top - bottom or 1), top + 0.08 * (top - bottom or 1))
    ax.set_xlim(0, len(numbers))
    ax.set_xlabel("evaluations")
    ax.set_ylabel(f"{literal(goal.name)} ({unit})" if unit else literal(goal.name))
    _legend(ax)
    return ax


def plot_front(optimum: Optimum, ax: Axes) -> Axes:
    """Draw the feasible designs in the plane of the first two objectives, the front among them, and the baseline.

    Raises
    ------
    InputError
        There are not two objectives.
    """
    if len(optimum.targets.goals) < 2:
        raise InputError("objectives", "there is only one", "a front needs two")
    across, up = (goal.target for goal in optimum.targets.goals[1::-1])
    feasible, front = [one for one in optimum.history if one.feasible], optimum.front
    scales = [scale([one.targets[target.name] for one in front], target.metric.units) for target in (across, up)]

    def places(some: Sequence[Candidate]) -> np.ndarray[Any, Any]:
        return np.array([[one.targets[t.name] * s[0] for t, s in zip((across, up), scales, strict=True)] for one in some]).reshape(-1, 2)

    designs, best = places(feasible), places(front)
    ax.plot(*designs.T, ".", color=COLOURS["sky"], markersize=2.5, label="feasible design")
    ax.plot(*best[np.argsort(best[:, 0])].T, "o-", color=COLOURS["blue"], markersize=3.5, linewidth=1.0, label="front")
    if {across.name, up.name} <= set(optimum.baseline.targets):
        ax.plot(*places([optimum.baseline]).T, "*", color=COLOURS["orange"], markersize=9, label="baseline", linestyle="none")
    if len(designs):
        top = max(float(np.quantile(designs[:, 1], 0.95)), float(best[:, 1].max()))
        bottom = float(best[:, 1].min())
        ax.set_ylim(bottom - 0.06 * (top - bottom or 1), top + 0.06 * (top - bottom or 1))
    for axis, target, (_, unit) in ((ax.xaxis, across, scales[0]), (ax.yaxis, up, scales[1])):
        axis.set_label_text(f"{literal(target.name)} ({unit})" if unit else literal(target.name))
    _legend(ax)
    return ax


def plot_parallel(optimum: Optimum, ax: Axes) -> Axes:
    """Draw each good design as a line over the variables, each scaled to its range, the best on top.

    Of one objective the good ones are the best tenth of the feasible designs, of several the front.
    """
    variables = optimum.space.variables[:MOST_COORDINATES]
    feasible = sorted((one for one in optimum.history if one.feasible), key=lambda one: one.rank)
    good = optimum.front if len(optimum.targets.goals) > 1 else feasible[: max(1, round(_GOOD * len(feasible)))]
    where = np.arange(len(variables))

    def shares(one: Candidate) -> list[float]:
        return [share if (share := v.share(value)) is not None else np.nan for v, value in zip(variables, one.values, strict=False)]

    for one in good:
        ax.plot(where, shares(one), color=COLOURS["sky"], linewidth=0.5, alpha=0.5, marker=".", markersize=2)
    ax.plot([], [], color=COLOURS["sky"], label="front" if len(optimum.targets.goals) > 1 else "best tenth")
    ax.plot(where, shares(optimum.best), color=COLOURS["blue"], linewidth=1.8, marker="o", markersize=4, label="best")
    ax.plot(where, shares(optimum.baseline), color=COLOURS["orange"], linestyle="none", marker="*", markersize=8, label="baseline")
    few = len(variables) <= 8
    names = [_interval(v) if few else literal(v.name) for v in variables]
    ax.set_xticks(where, names, rotation=0 if few else 45, ha="center" if few else "right", fontsize=7 if few else 6)
    ax.set_xlim(-0.4, len(variables) - 0.6)
    ax.set_ylim(-0.04, 1.04)
    ax.set_ylabel("place within the range")
    _legend(ax)
    return ax


def _legend(ax: Axes) -> None:
    """Put the legend above the axes, where no curve is."""
    ax.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=3, borderaxespad=0.2)


def _interval(variable: Variable) -> str:
    """Return name and range of a variable on lines short enough to stand beside others."""
    ends = [str(variable.levels[i]) for i in (0, -1)] if variable.levels else [raised(variable.low), raised(variable.high)]
    place, _, name = variable.name.rpartition(".")
    lines = [f"{place}." if place else "", name, f"{ends[0]} to {ends[1]}", "" if variable.units == "1" else pretty(variable.units)]
    return "\n".join(literal(line) for line in lines if line)
