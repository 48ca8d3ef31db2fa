"""Any quantity against time: one panel a shell, one curve an angle and a run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from coaxshell.errors import InputError
from coaxshell.model.places import shell_phrase
from coaxshell.numerics.arrays import FloatArray
from coaxshell.plotting.histories import QUANTITIES, TIME_LABEL, History, history, mark_peak
from coaxshell.plotting.style import COLOURS, PAGE_WIDTH, new_figure, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from coaxshell.response import Response

COLOUR_NAMES = ("blue", "orange", "green", "purple", "grey")
"""Of angles."""
DASHES: tuple[Any, ...] = ("solid", (0, (5.0, 1.6)), (0, (1.5, 1.5)), "dashdot")
"""Of runs and stations."""
Curves = dict[tuple[str, float], History]


def figure_curves(
    responses: Mapping[str, Response] | Response,
    quantity: str = "stress",
    shells: Sequence[int | str] | int | str | None = None,
    angle: Sequence[float] | float = (0.0, 180.0),
    station: Any = None,
) -> Figure:
    """Draw one quantity of one run or several at some angles of some shells.

    Parameters
    ----------
    responses : Response, or mapping of name to Response
        At most four; each has its own kind of line. So has each station of a run in three dimensions.
    quantity : str
        One of :data:`QUANTITIES`.
    shells : list of int or str, optional
        Shells by name or number; all that are elastic unless given. Runs that lack one of them leave its panel.
    angle : list of float
        Degrees from the direction theta = 0, at most five; each has its own colour.
    station : float, str, or list of them, optional
        Axial positions of runs in three dimensions, m. Of more than can be told apart, unless they are named, those that are drawn are
        spread over all of them.

    Returns
    -------
    Figure

    Raises
    ------
    InputError
        There is nothing to draw, or more than can be told apart.
    """
    runs = dict(responses) if isinstance(responses, Mapping) else {"": responses}
    angles = [float(each) for each in np.atleast_1d(np.asarray(angle, dtype=np.float64))]
    sections = sections_of(runs, station)
    if all(section.station is None for section in sections.values()) and _of_space(quantity):
        raise InputError("quantity", f"{quantity!r} belongs to three dimensions", "run with dimensions=3")
    for where, count, most in (
        ("station" if len(sections) > len(runs) else "responses", len(sections), len(DASHES)),
        ("angle", len(angles), len(COLOUR_NAMES)),
    ):
        if not 1 <= count <= most:
            raise InputError(where, f"{count} cannot be drawn", f"give 1 to {most}, so that they can be told apart")
    panels = {title: curves for title, curves in _panels(sections, quantity, shells, angles).items() if curves}
    if not panels:
        raise InputError("shells", f"no run has the {quantity.replace('_', ' ')} of these shells", "choose others, or another quantity")
    in_transits = len({round(curve.milliseconds, 9) for curves in panels.values() for curve in curves.values()}) == 1
    with style():
        figure = new_figure(PAGE_WIDTH, 0.9 + 2.2 * len(panels))
        axes = figure.subplots(len(panels), 1, squeeze=False, sharex=True)[:, 0]
        for ax, (title, curves) in zip(axes, panels.items(), strict=True):
            plot_curves(curves, ax, in_transits=in_transits)
            ax.set_title(title, loc="left", fontweight="bold")
            ax.set_ylabel(QUANTITIES[quantity].label)
        axes[-1].set_xlabel(TIME_LABEL if in_transits else "time (ms)")
        handles = _legend([name for name in sections if name], angles)
        figure.legend(handles=handles, loc="outside lower center", ncols=min(len(handles), 6))
    return figure


def plot_curves(curves: Curves, ax: Axes, *, in_transits: bool = True) -> Axes:
    """Draw curves by (run, angle): an angle's colour, a run's kind of line, a circle around each largest magnitude.

    Returns
    -------
    Axes
    """
    runs, angles = (list(dict.fromkeys(key[part] for key in curves)) for part in (0, 1))
    longest = 0.0
    for (run, angle), curve in curves.items():
        shown = curve if in_transits else History(curve.time * curve.milliseconds, curve.values, 1.0)
        colour = COLOURS[COLOUR_NAMES[angles.index(angle)]]
        ax.plot(shown.time, shown.values, color=colour, linestyle=DASHES[runs.index(run)], linewidth=1.1)
        mark_peak(shown, ax, color=colour)
        longest = max(longest, float(shown.time[-1]))
    ax.axhline(0.0, color=COLOURS["grey"], linewidth=0.6, zorder=1)
    ax.set_xlim(0.0, longest)
    return ax


class Section(NamedTuple):
    """What one kind of line shows: a run, and its station in three dimensions."""

    response: Response
    station: float | None


def sections_of(runs: Mapping[str, Response], station: Any) -> dict[str, Section]:
    """Return the runs, one in three dimensions once for each of its stations, by the names of the legend."""
    found: dict[str, Section] = {}
    for name, response in runs.items():
        if response.stations is None:
            found[name] = Section(response, None)
            continue
        chosen = _spread(response.stations, max(1, len(DASHES) // len(runs)))
        if station is not None:
            from coaxshell.response.station_choice import chosen_stations

            chosen = [response.stations[i] for i in chosen_stations(response.stations, station)[0]]
        for z in chosen:
            found[f"{name}, z = {z:g} m" if name and len(runs) > 1 else f"z = {z:g} m"] = Section(response, float(z))
    return found


def _of_space(quantity: str) -> bool:
    from coaxshell.response.quantities import QUANTITIES as TABLE

    return quantity in TABLE and TABLE[quantity].dimensions == 3


def _spread(stations: FloatArray, most: int) -> list[float]:
    """Return at most so many stations, the first and the last along the axis among them."""
    if stations.size <= most:
        return list(stations)
    if most == 1:
        return [float(stations[0])]
    ordered = np.sort(stations)
    return [float(ordered[round(i)]) for i in np.linspace(0, stations.size - 1, most)]


def _panels(
    runs: Mapping[str, Section], quantity: str, shells: Sequence[int | str] | int | str | None, angles: Sequence[float]
) -> dict[str, Curves]:
    """Return the curves of each shell by its name within a sentence."""
    panels: dict[str, Curves] = {}
    for run, (response, station) in runs.items():
        for index in response.system.shell_indices(shells):
            title = shell_phrase(index, response.shells)
            panel = panels.setdefault(title[:1].upper() + title[1:], {})
            for angle in angles:
                try:
                    panel[run, angle] = history(response, quantity, index, angle, station)
                except InputError:
                    if (len(runs) == 1 and shells is not None) or quantity not in QUANTITIES:
                        raise
    return panels


def _legend(names: Sequence[str], angles: Sequence[float]) -> list[Any]:
    from matplotlib.lines import Line2D

    grey = COLOURS["grey"]
    lines = [Line2D([], [], color=COLOURS[colour], label=f"{angle:g}°") for colour, angle in zip(COLOUR_NAMES, angles, strict=False)]
    kinds = [Line2D([], [], color=grey, linestyle=dash, label=name) for dash, name in zip(DASHES, names, strict=False)]
    circle = Line2D([], [], color=grey, marker="o", markerfacecolor="none", linestyle="none", label="largest magnitude")
    return [*lines, *kinds, circle]
