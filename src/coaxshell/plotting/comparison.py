"""Hoop stress at head and tail of each shell of two or more systems, one drawn over the other."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from coaxshell.errors import InputError
from coaxshell.model import Shell
from coaxshell.model.prefixes import against
from coaxshell.plotting.histories import QUANTITIES, TIME_LABEL, History, at_station, history, mark_peak
from coaxshell.plotting.scales import common_scales
from coaxshell.plotting.style import COLOURS, PAGE_WIDTH, literal, new_figure, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from coaxshell.response import Response

_POINTS = (("head", 0.0), ("tail", 180.0))
_LOOKS = (("blue", "solid"), ("orange", (0, (5.0, 1.6))), ("green", (0, (1.5, 1.5))), ("purple", "dashdot"), ("grey", "dotted"))
Curves = dict[str, History]


def figure_comparison(responses: Mapping[str, Response], quantity: str = "stress", station: float | str | None = None) -> Figure:
    """Draw one quantity at head and tail of the innermost and outermost shell for several systems.

    All panels share one scale. The circles mark the largest magnitudes; above each panel stands what the first system's is of the
    last one's. Time is in transits if that is the same for all systems, else in milliseconds.

    Parameters
    ----------
    responses : mapping of str to Response
        By the name in the legend, at most five; the last one is what the others are compared with.
    quantity : str
        One of :data:`QUANTITIES`.
    station : float or str, optional
        Axial position of runs in three dimensions, m; the first of each unless given. Runs in two may stand beside them.

    Returns
    -------
    Figure

    Raises
    ------
    InputError
        There are no or too many systems, they have no elastic shell in common, or the quantity is unknown.
    """
    if not 1 <= len(responses) <= len(_LOOKS):
        raise InputError("responses", f"{len(responses)} systems cannot be drawn", f"give 1 to {len(_LOOKS)}")
    ends = _common_ends(responses)
    places = {name: at_station(response, station if response.stations is not None else None) for name, response in responses.items()}
    panels = {(end, point): _curves(responses, places, quantity, end, turn) for end in ends for point, turn in _POINTS}
    values = [curve.values for curves in panels.values() for curve in curves.values()]
    (scale,) = common_scales([(float(min(v.min() for v in values)), float(max(v.max() for v in values)))])
    in_transits = len({round(curve.milliseconds, 9) for curve in next(iter(panels.values())).values()}) == 1
    with style():
        figure = new_figure(PAGE_WIDTH, 1.2 + 2.05 * len(ends))
        axes = figure.subplots(len(ends), 2, squeeze=False, sharex=True, sharey=True)
        for row, end in enumerate(ends):
            for column, (point, _) in enumerate(_POINTS):
                ax: Axes = axes[row, column]
                curves = panels[end, point]
                plot_comparison(curves, ax, in_transits=in_transits)
                ax.set_ylim(*scale.limits)
                ax.set_yticks(scale.ticks)
                ax.set_title(f"{'abcd'[2 * row + column]}  {_wall(responses, end)}, {point}", loc="left", fontweight="bold")
                if column == 0:
                    ax.set_ylabel(QUANTITIES[quantity].label)
                if row == len(ends) - 1:
                    ax.set_xlabel(TIME_LABEL if in_transits else "time (ms)")
        names = [name if (z := places[name]) is None else f"{name}, z = {z:g} m" for name in responses]
        figure.suptitle(_title(names, quantity), fontsize=10)
        figure.legend(handles=_legend(names), loc="outside lower center", ncols=len(responses) + 1)
    return figure


def plot_comparison(curves: Curves, ax: Axes, *, in_transits: bool = True) -> Axes:
    """Draw named curves over each other with their peaks, and the change from the last to the first above them.

    Parameters
    ----------
    curves : dict of str to History
    ax : Axes
    in_transits : bool
        Whether time is in transits, else in milliseconds.

    Returns
    -------
    Axes
    """
    longest = 0.0
    for (colour, dash), curve in reversed(list(zip(_LOOKS, curves.values(), strict=False))):
        shown = curve if in_transits else History(curve.time * curve.milliseconds, curve.values, 1.0)
        ax.plot(shown.time, shown.values, color=COLOURS[colour], linestyle=dash, linewidth=1.1)
        mark_peak(shown, ax, color=COLOURS[colour])
        longest = max(longest, float(shown.time[-1]))
    ax.axhline(0.0, color=COLOURS["grey"], linewidth=0.6, zorder=1)
    ax.set_xlim(0.0, longest)
    peaks = [abs(curve.peak[1]) for curve in curves.values()]
    if len(peaks) > 1 and any(curve.still_grows for curve in curves.values()):
        ax.set_title("still growing", loc="right", fontsize=8)  # a change would be that of the runs' length
    elif len(peaks) > 1 and peaks[-1] > 0:
        ax.set_title(f"peak {against(peaks[0], peaks[-1], decimals=0)}", loc="right", fontsize=8)
    return ax


def _curves(responses: Mapping[str, Response], places: Mapping[str, float | None], quantity: str, end: str, turn: float) -> Curves:
    return {name: history(r, quantity, end, r.system.sources[0].angle + turn, places[name]) for name, r in responses.items()}


def _common_ends(responses: Mapping[str, Response]) -> list[str]:
    """Return "inner" and "outer" as far as that shell is elastic in all systems; one of them for systems of a single shell."""
    systems = [response.system for response in responses.values()]
    ends = [end for end in ("inner", "outer") if all(isinstance(system.shells[system.shell_index(end)], Shell) for system in systems)]
    if not ends:
        raise InputError("shells", "no shell is elastic in all systems", "draw systems that have an elastic innermost or outermost shell")
    return ends[-1:] if all(len(system.shells) == 1 for system in systems) else ends


def _wall(responses: Mapping[str, Response], end: str) -> str:
    return "Shell" if all(len(response.system.shells) == 1 for response in responses.values()) else f"{end.capitalize()} shell"


def _title(names: list[str], quantity: str) -> str:
    what = QUANTITIES[quantity].label.partition(" (")[0].capitalize()
    return f"{what}: {literal(names[0])}" + (f" against {' and '.join(map(literal, names[1:]))}" if len(names) > 1 else "")


def _legend(names: list[str]) -> list[Any]:
    from matplotlib.lines import Line2D

    lines = [
        Line2D([], [], color=COLOURS[colour], linestyle=dash, label=literal(name))  # type: ignore[arg-type]
        for (colour, dash), name in zip(_LOOKS, names, strict=False)
    ]
    circle = Line2D([], [], color=COLOURS["grey"], marker="o", markerfacecolor="none", linestyle="none", label="largest magnitude")
    return [*lines, circle]
