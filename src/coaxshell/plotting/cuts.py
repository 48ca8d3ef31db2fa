"""The pressure of a three-dimensional run across the axis and along it at one instant, with the hoop stress on the shells."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from coaxshell.numerics.progress import Progress
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
from coaxshell.plotting.frames import FieldView, gathered
from coaxshell.plotting.style import new_figure, style
from coaxshell.plotting.unrolled import require_stations

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from coaxshell.response.spatial import SpatialResponse


def figure_cuts(
    response: SpatialResponse,
    time: float,
    *,
    station: Any = None,
    view: FieldView | None = None,
    pressure_limit: float | None = None,
    stress_limit: float | None = None,
    units: str = "auto",
    progress: Progress | None = None,
) -> Figure:
    """Draw the total pressure at one instant in the cross-section of a station and in the plane y = 0 along the axis, side by side.

    On the shells is their hoop stress: around the cross-section, and along the axis at head and tail as far as the stations go, joined by
    straight lines; beyond them, shells are dark lines. Where sources are alike on both sides of z = 0, stations count for both.

    Parameters
    ----------
    response : SpatialResponse
    time : float
        In transits; the run's nearest instant is drawn.
    station : float or str, optional
        Of the cross-section, m or text; the first of the run when left out.
    view : FieldView, optional
        What is seen of both; a 6 x 6 square of 450 x 450 pixels when left out.
    pressure_limit, stress_limit : float, optional
        Ends of the two colour scales, Pa; chosen from this instant when left out.
    units : str
        Of the pressure; one of PRESSURE_UNITS.
    progress : callable, optional

    Returns
    -------
    Figure

    Raises
    ------
    InputError
        The time is outside the run, the run has no such station, or the unit is unknown.
    """
    require_stations(response)
    view = view or FieldView()
    check_units(units)
    (run,) = shown_runs([response], [""], response.stations[0] if station is None else station)
    frames = [gathered(iter(parts)) for parts in zip(*run.solved([time], view, progress).frames(progress), strict=True)]
    scales = field_scales(frames, pressure_limit, stress_limit)
    with style():
        figure = new_figure(7.2, 3.3)
        axes = figure.subplots(1, 2, sharex=True)
        for ax, panel, part in zip(axes, run.panels, frames, strict=True):
            panel.draw(ax, part, 0, view, scales, absorbers=False)
            ax.set(xlabel=f"${panel.labels[0]}$", ylabel=f"${panel.labels[1]}$", title=panel.name)
        figure.suptitle(time_stamp(frames[0], 0), fontsize=9)
        for limit, colours, unit in (
            (scales.pressure, PRESSURE_COLOURS, pressure_unit(response, units, scales.pressure)),
            (scales.stress, STRESS_COLOURS, stress_unit(scales.stress)),
        ):
            add_colour_bar(axes[1].inset_axes((1.05 if colours == PRESSURE_COLOURS else 1.36, 0.0, 0.045, 1.0)), limit, unit, colours)
    return figure
