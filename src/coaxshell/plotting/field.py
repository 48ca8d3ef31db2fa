"""The pressure around the shells at one instant, with the hoop stress on the shells themselves."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from coaxshell.model.absorbers import drawn_radii
from coaxshell.numerics.arrays import FloatArray
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
from coaxshell.plotting.frames import WALL_ANGLES, FieldView, Frames, field_frames, gathered
from coaxshell.plotting.sea import draw_cavitation, draw_planes
from coaxshell.plotting.style import new_figure, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from coaxshell.model import System
    from coaxshell.response import Response


WALL_WIDTH = 0.11
"""Drawn width of a shell, in a; true walls of a few millimetres would not be seen."""
WALL_COLOUR = "#262626"
ABSORBER_COLOUR = "#1A1A1A"


def plot_field(
    response: Response,
    time: float,
    ax: Axes | None = None,
    *,
    view: FieldView | None = None,
    pressure_limit: float | None = None,
    stress_limit: float | None = None,
    units: str = "auto",
    absorbers: bool = True,
    stamp: bool = True,
    colour_bars: bool = True,
) -> Axes:
    """Draw the total pressure around the shells at one instant, and the hoop stress on each shell in steps of 1 degree.

    Parameters
    ----------
    response : Response
    time : float
        In transits; the run's nearest instant is drawn.
    ax : Axes, optional
        Where to draw; a new figure when left out.
    view : FieldView, optional
        What is seen; the paper's 6 x 6 square of 450 x 450 pixels when left out.
    pressure_limit, stress_limit : float, optional
        Ends of the two colour scales, Pa; chosen from this instant when left out.
    units : str
        Of the pressure: "auto", "Pa", "kPa", "MPa", or "relative" for p/(rho_e c_e^2).
    absorbers : bool
        Mark the absorbers with dots.
    stamp : bool
        Write the time above the field.
    colour_bars : bool
        Add the two colour bars to the right.

    Returns
    -------
    Axes

    Raises
    ------
    InputError
        The time is outside the run, or the unit is unknown.
    """
    view = view or FieldView()
    frames = gathered(field_frames(response, [time], view))
    scales = field_scales([frames], pressure_limit, stress_limit)
    with style():
        if ax is None:
            ax = new_figure(4.6 if colour_bars else 3.6, 3.6).add_subplot()
        draw_frame(ax, response.system, frames, 0, view, scales, absorbers=absorbers)
        ax.set_xlabel("$x/a$")
        ax.set_ylabel("$y/a$")
        if stamp:
            ax.set_title(time_stamp(frames, 0))
        if colour_bars:
            _bars_beside(ax, response, scales, units)
    return ax


def draw_frame(
    ax: Axes, system: System, frames: Frames, index: int, view: FieldView, scales: FieldScales, *, absorbers: bool = True
) -> None:
    """Draw one frame into axes: pressure as an image, stress on the shells, absorbers as dots; the sea's planes and cavitation."""
    edge = view.half_width
    image: Any = mappable(scales.pressure, PRESSURE_COLOURS)
    ax.imshow(
        frames.field(index), extent=(-edge, edge, -edge, edge), origin="lower", cmap=image.cmap, norm=image.norm, interpolation="auto"
    )
    if system.sea is not None:
        draw_cavitation(ax, system, frames.field(index), view)
        draw_planes(ax, system, view)
    for band, around in zip(wall_bands(system), frames.stress, strict=True):
        _wall(ax, band, None if around is None else around[index], scales.stress)
    if absorbers and system.absorber_list:
        x, y = absorber_places(system)
        ax.plot(x, y, linestyle="none", marker="o", markersize=1.6, color=ABSORBER_COLOUR, markeredgewidth=0, zorder=4)
    ax.set_xlim(-edge, edge)
    ax.set_ylim(-edge, edge)
    ax.set_aspect("equal")
    ax.grid(visible=False)


def time_stamp(frames: Frames, index: int, *, mathematics: bool = True) -> str:
    """Return the instant of a frame in transits and in milliseconds."""
    letter = "$t$" if mathematics else "t"
    return f"{letter} = {frames.time[index]:.2f}  ({frames.milliseconds[index]:.3f} ms)"


def wall_radii(system: System) -> list[float]:
    """Return the mid-surface radius of each shell, in a."""
    return [shell.radius / system.reference_radius for shell in system.shells]


def wall_bands(system: System) -> list[tuple[float, float]]:
    """Return the radii between which each shell is drawn, in a: at least WALL_WIDTH, and all between its faces where these are wetted."""
    widths = [max(WALL_WIDTH, np.ptp(shell.wetted_radii) / system.reference_radius) for shell in system.shells]
    return [(radius - 0.5 * width, radius + 0.5 * width) for radius, width in zip(wall_radii(system), widths, strict=True)]


def absorber_places(system: System) -> tuple[FloatArray, FloatArray]:
    """Return x and y of the masses of the absorbers, in a: half-way between the shells they link, or through the outermost gap."""
    radii = wall_radii(system)
    angle = np.radians([absorber.angle for absorber in system.absorber_list])
    middle = np.array([drawn_radii(absorber, radii, radii)[1] for absorber in system.absorber_list])
    return middle * np.cos(angle), middle * np.sin(angle)


def _wall(ax: Axes, band: tuple[float, float], stress: FloatArray | None, limit: float) -> None:
    from matplotlib.collections import PolyCollection
    from matplotlib.patches import Circle

    inner, outer = band
    if stress is None:
        ax.add_patch(Circle((0, 0), 0.5 * (inner + outer), fill=False, edgecolor=WALL_COLOUR, linewidth=1.5, zorder=3))
        return
    colours = mappable(limit, STRESS_COLOURS)
    segments = PolyCollection(list(_segments(inner, outer)), array=stress, cmap=colours.cmap, norm=colours.norm, zorder=2)
    segments.set(edgecolor="face", linewidth=0.25)  # covers the hairlines between neighbours
    ax.add_collection(segments, autolim=False)
    for edge in (inner, outer):
        ax.add_patch(Circle((0, 0), edge, fill=False, edgecolor=WALL_COLOUR, linewidth=0.45, zorder=3))


def _segments(inner: float, outer: float) -> FloatArray:
    """Return the corners of one quadrilateral for each degree, centred on it, shape (360, 4, 2)."""
    start, end = np.radians(WALL_ANGLES - 0.5), np.radians(WALL_ANGLES + 0.5)
    corners = ((inner, start), (outer, start), (outer, end), (inner, end))
    return np.stack([np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1) for radius, angle in corners], axis=1)


def _bars_beside(ax: Axes, response: Response, scales: FieldScales, units: str) -> None:
    figure: Any = ax.figure
    bounds = ((1.05, 0.0, 0.045, 1.0, scales.pressure, PRESSURE_COLOURS), (1.34, 0.0, 0.045, 1.0, scales.stress, STRESS_COLOURS))
    labels = (pressure_unit(response, units, scales.pressure), stress_unit(scales.stress))
    for (left, low, width, height, limit, colours), unit in zip(bounds, labels, strict=True):
        add_colour_bar(ax.inset_axes((left, low, width, height)), limit, unit, colours)
    figure.canvas.draw_idle()
