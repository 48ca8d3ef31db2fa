"""The pressure of a three-dimensional run across the axis and along it at one instant, with the hoop stress on the shells."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from coaxshell.model import RigidShell
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.progress import Progress
from coaxshell.plotting.field import WALL_COLOUR, draw_frame, time_stamp, wall_bands
from coaxshell.plotting.field_scales import (
    PRESSURE_COLOURS,
    STRESS_COLOURS,
    FieldScales,
    add_colour_bar,
    field_scales,
    mappable,
    pressure_unit,
    stress_unit,
)
from coaxshell.plotting.frames import WALL_ANGLES, FieldView, Frames, instants
from coaxshell.plotting.style import new_figure, style
from coaxshell.plotting.unrolled import along_stations, require_stations

if TYPE_CHECKING:
    from matplotlib.axes import Axes
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
    chosen = response.at(response.stations[0] if station is None else station)
    index = int(instants(response, [time])[0])
    across, along = (_pressure(response, index, view, progress, number, float(chosen.stations[0])) for number in (0, 1))
    stress = tuple(
        None if isinstance(shell, RigidShell) else np.asarray(chosen.stress(i, WALL_ANGLES))[[index], 0]
        for i, shell in enumerate(response.system.shells)
    )
    frames = Frames(
        time=np.asarray(response.time)[[index]],
        milliseconds=1e3 * np.asarray(response.time_seconds)[[index]],
        pressure=across[None],
        stress=stress,
    )
    both = Frames(frames.time, frames.milliseconds, np.stack([across, along]), stress)
    scales = field_scales([both], pressure_limit, stress_limit)
    with style():
        figure = new_figure(7.2, 3.3)
        left, right = figure.subplots(1, 2, sharex=True)
        draw_frame(left, response.system, frames, 0, view, scales, absorbers=False)
        left.set(xlabel="$x/a$", ylabel="$y/a$", title=f"across, $z$ = {chosen.stations[0]:g} m")
        _draw_along(right, response, along, index, view, scales)
        right.set(xlabel="$x/a$", ylabel="$z/a$", title="along, $y$ = 0")
        figure.suptitle(time_stamp(frames, 0), fontsize=9)
        for limit, colours, unit in (
            (scales.pressure, PRESSURE_COLOURS, pressure_unit(response, units, scales.pressure)),
            (scales.stress, STRESS_COLOURS, stress_unit(scales.stress)),
        ):
            add_colour_bar(right.inset_axes((1.05 if colours == PRESSURE_COLOURS else 1.36, 0.0, 0.045, 1.0)), limit, unit, colours)
    return figure


def _pressure(response: SpatialResponse, index: int, view: FieldView, progress: Progress | None, number: int, station: float) -> Any:
    """Return the pressure across the axis at a station (0) or along it (1), rows upward, (pixels, pixels)."""

    def report(fraction: float, stage: str) -> None:
        if progress is not None:
            progress(0.5 * (number + fraction), stage)

    x, when, a = view.centres, float(response.time[index]), response.system.reference_radius
    if number == 0:
        found = response.pressure(x=x, y=x, z=station / a, time=when, front="matched", progress=report)
    else:
        found = response.pressure(x=x, z=x, y=0.0, time=when, front="matched", progress=report)
    return np.asarray(found, dtype=np.float32)


def _draw_along(ax: Axes, response: SpatialResponse, pressure: Any, index: int, view: FieldView, scales: FieldScales) -> None:
    edge = view.half_width
    image: Any = mappable(scales.pressure, PRESSURE_COLOURS)
    ax.imshow(pressure, extent=(-edge, edge, -edge, edge), origin="lower", cmap=image.cmap, norm=image.norm, interpolation="auto")
    for number, ((inner, outer), shell) in enumerate(zip(wall_bands(response.system), response.system.shells, strict=True)):
        for side, angle in (((inner, outer), 0.0), ((-outer, -inner), 180.0)):
            if isinstance(shell, RigidShell):
                ax.axvline(0.5 * sum(side), color=WALL_COLOUR, linewidth=1.5, zorder=3)
                continue
            z, stress = along_stations(response, number, [angle], index)
            _band(ax, side, z, stress[:, 0], edge, scales.stress)
    ax.set_xlim(-edge, edge)
    ax.set_ylim(-edge, edge)
    ax.set_aspect("equal")
    ax.grid(visible=False)


def _band(ax: Axes, place: tuple[float, float], z: FloatArray, stress: FloatArray, edge: float, limit: float) -> None:
    """Draw a wall as a band, coloured as far as its stations go."""
    left, right = place
    colours: Any = mappable(limit, STRESS_COLOURS)
    low, high = max(float(z.min()), -edge), min(float(z.max()), edge)
    if high > low:
        fine = np.linspace(low, high, 361)
        rows = np.interp(0.5 * (fine[1:] + fine[:-1]), z, stress)
        ax.imshow(
            rows[:, None], extent=(left, right, low, high), origin="lower", cmap=colours.cmap, norm=colours.norm, aspect="auto", zorder=2
        )
        ax.vlines([left, right], low, high, color=WALL_COLOUR, linewidth=0.45, zorder=3)
    for start, end in ((-edge, low), (high, edge)):
        if end > start:
            ax.vlines(0.5 * (left + right), start, end, color=WALL_COLOUR, linewidth=1.0, zorder=3)
