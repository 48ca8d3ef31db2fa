"""Sheets of fields: one system at several instants (the paper's Figure 4), or several systems side by side (Figure 13)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from coaxshell.errors import InputError
from coaxshell.plotting.cut_frames import shown_runs
from coaxshell.plotting.field import time_stamp
from coaxshell.plotting.field_scales import (
    PRESSURE_COLOURS,
    STRESS_COLOURS,
    add_colour_bar,
    check_units,
    field_scales,
    pressure_unit,
    stress_unit,
)
from coaxshell.plotting.frames import FieldView, Frames, Report, gathered
from coaxshell.plotting.panels import Panel
from coaxshell.plotting.sheets import Sheet
from coaxshell.plotting.style import style

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from coaxshell.response import Response

SNAPSHOT_TIMES = (0.2, 0.5, 0.9, 1.2, 1.7, 2.0, 2.5, 3.1, 3.6, 4.5)
"""Transits: the instants that the paper names (1.2, 1.7, 2.0, 3.1, 3.6) and others from the impact on."""
COMPARISON_TIMES = (*(round(0.1 * i, 1) for i in range(1, 11)), *(0.5 * i for i in range(3, 12)))
"""Transits: steps of 0.1 up to 1.0, then of 0.5 up to 5.5; those beyond the end of a run are left out."""

_COLUMNS = 4


def figure_snapshots(
    *responses: Response,
    times: Sequence[float] | None = None,
    names: Sequence[str] = (),
    view: FieldView | None = None,
    pressure_limit: float | None = None,
    stress_limit: float | None = None,
    units: str = "auto",
    absorbers: bool = True,
    columns: int = _COLUMNS,
    progress: Report | None = None,
    station: Any = None,
) -> Figure:
    """Draw fields at several instants, all on the same two colour scales; several responses side by side at each instant.

    Of a run in three dimensions the cross-section at a station and the plane y = 0 along the axis stand side by side.

    Parameters
    ----------
    *responses : Response
        One, or several to compare.
    times : sequence of float, optional
        In transits. When left out, SNAPSHOT_TIMES for one response and COMPARISON_TIMES for several, as far as the runs go.
    names : sequence of str
        Headings of the responses; the names of their systems when left out.
    view : FieldView, optional
        What is seen; the paper's 6 x 6 square of 450 x 450 pixels when left out.
    pressure_limit, stress_limit : float, optional
        Ends of the two colour scales, Pa; chosen from all panels together when left out.
    units : str
        Of the pressure; one of PRESSURE_UNITS.
    absorbers : bool
        Mark the absorbers with dots.
    columns : int
        Instants in a row.
    progress : callable, optional
        Called with the fraction done and the name of the stage.
    station : float or str, optional
        Of the cross-sections of runs in three dimensions, m or text; the first of each when left out.

    Returns
    -------
    Figure

    Raises
    ------
    InputError
        There is nothing to draw, a time is outside a run, or the unit is unknown.
    """
    view = view or FieldView()
    chosen = _times(responses, times)
    runs = shown_runs(responses, headings(responses, names), station)
    check_units(units)
    frames: list[Frames] = []
    for number, run in enumerate(runs):
        report = share_of(progress, number, len(runs))
        frames += [gathered(iter(parts)) for parts in zip(*run.solved(chosen, view, report).frames(report), strict=True)]
    panels = [panel for run in runs for panel in run.panels]
    scales = field_scales(frames, pressure_limit, stress_limit)
    bars = pressure_unit(responses[0], units, scales.pressure), stress_unit(scales.stress)
    sheet = Sheet(len(chosen), len(panels), min(len(chosen), columns), _upward(panels))
    with style():
        figure = sheet.new_figure()
        for group in range(len(chosen)):
            for member, (panel, part) in enumerate(zip(panels, frames, strict=True)):
                panel.draw(sheet.panel(figure, group, member), part, group, view, scales, absorbers=absorbers)
            sheet.title(figure, group, time_stamp(frames[0], group))
        if len(panels) > 1:
            sheet.headings(figure, [panel.name for panel in panels])
        limits = ((scales.pressure, PRESSURE_COLOURS), (scales.stress, STRESS_COLOURS))
        for ax, unit, (limit, colours) in zip(sheet.bars(figure), bars, limits, strict=True):
            add_colour_bar(ax, limit, unit, colours, orientation="horizontal")
    return figure


def _upward(panels: Sequence[Panel]) -> str:
    """Return the label of the axes that point upward, those of all panels where they differ."""
    labels = dict.fromkeys(panel.labels[1] for panel in panels)
    return ", ".join(f"${label}$" for label in labels)


def headings(responses: Sequence[Response], names: Sequence[str] = ()) -> list[str]:
    """Return a name for each response: the given ones, those of their systems, or numbers where these do not tell them apart."""
    if len(names) == len(responses):
        return list(names)
    own = [response.system.name for response in responses]
    told = [name if name and own.count(name) == 1 else f"system {i + 1}" for i, name in enumerate(own)]
    return [name[:1].upper() + name[1:] for name in told]


def _times(responses: Sequence[Response], times: Sequence[float] | None) -> list[float]:
    if not responses:
        raise InputError("responses", "there are none", "give at least one response")
    if times is not None:
        return [float(time) for time in times]
    end = min(float(response.time[-1]) for response in responses)
    default = SNAPSHOT_TIMES if len(responses) == 1 else COMPARISON_TIMES
    return [time for time in default if time <= end * (1 + 1e-9)] or [end]


def share_of(progress: Report | None, number: int, count: int) -> Report | None:
    """Return a report for one of several equal parts of the work."""
    if progress is None:
        return None

    def report(fraction: float, stage: str) -> None:
        progress((number + fraction) / count, stage)

    return report
