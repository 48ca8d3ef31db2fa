"""Where a wall is stressed most: the largest stress over time at every angle and depth, layer by layer."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from coaxshell.model.places import shell_phrase
from coaxshell.numerics.arrays import FloatArray
from coaxshell.plotting.style import PAGE_WIDTH, literal, new_figure, style
from coaxshell.response.arguments import time_window
from coaxshell.response.components import component_words
from coaxshell.response.wall_motion import WallMotion
from coaxshell.response.wall_stress import WallPeak, stress_through

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from coaxshell.response import Response

_ALIKE = 5.0
"""Ratio of largest stresses up to which maps share their scale of colours."""
_DEPTHS = 9
"""Depths in a layer."""


def plot_wall_stress(
    response: Response,
    shell: int | str,
    ax: Axes | None = None,
    *,
    component: str = "von_mises",
    window: Sequence[float] | None = None,
    station: Any = None,
) -> Axes:
    """Draw the largest magnitude of a stress within a window of time over angle and depth, with a star where it is largest.

    Layers are told apart by lines and named at the right. Colours show at each place what is largest there at any time; the star is
    :meth:`coaxshell.Response.peak_stress`.

    Parameters
    ----------
    response : Response
    shell : int or str
    ax : Axes, optional
        Where to draw; a new figure when left out.
    component : str
        "von_mises", "hoop", "axial", in three dimensions "shear", in elastic walls "radial" or "radial_hoop".
    window : (start, end), optional
        Transits; the whole run unless given.
    station : float or str, optional
        Of a run in three dimensions (m): the one with the largest stress unless given.

    Returns
    -------
    Axes

    Raises
    ------
    InputError
        As :meth:`coaxshell.Response.peak_stress`.
    """
    drawn = _mapped(response, response.system.shell_index(shell), component, window, station)
    with style():
        return _draw(drawn, ax or new_figure(5.6, 3.2).add_subplot(), drawn.largest)


class MappedWall(NamedTuple):
    """What a panel shows: the largest value with its place, and the maps of the layers by their materials."""

    response: Response
    shell: int
    peak: WallPeak
    layers: list[str]
    maps: list[tuple[FloatArray, FloatArray, FloatArray]]

    @property
    def largest(self) -> float:
        """Largest value of the maps, Pa."""
        return max(float(values.max()) for _, _, values in self.maps)


def _mapped(response: Response, shell: int, component: str, window: Sequence[float] | None, station: Any) -> MappedWall:
    peak = response.peak_stress(shell, component, window=window, station=station)
    span = time_window(response.time, window)
    ((_, motion),) = response.stations_read(peak.station if response.stations is not None else None)
    maps = layer_maps(motion, shell, component, span)
    return MappedWall(response, shell, peak, described_layers(response, shell), maps)


def _draw(drawn: MappedWall, ax: Axes, limit: float) -> Axes:
    """Draw a map on colours from zero to a limit (Pa)."""
    peak, maps, shells = drawn.peak, drawn.maps, drawn.response.shells
    unit, per_pascal = ("MPa", 1e-6) if limit >= 1e4 else ("kPa", 1e-3)
    for (angles, depths, values), name in zip(maps, drawn.layers, strict=False):
        picture = ax.pcolormesh(
            angles,
            1e3 * depths,
            per_pascal * values,
            cmap="cividis",
            vmin=0.0,
            vmax=per_pascal * limit,
            shading="gouraud",
            rasterized=True,
        )
        ax.axhline(1e3 * depths[-1], color="white", linewidth=0.8)
        middle = 500.0 * (depths[0] + depths[-1])
        ax.annotate(name, (1.01, middle), xycoords=("axes fraction", "data"), va="center", fontsize="small", annotation_clip=False)
    ax.plot(peak.angle, 1e3 * peak.depth, marker="*", markersize=11, color="white", markeredgecolor="black", clip_on=False, zorder=5)
    ax.set_ylim(1e3 * maps[0][1][0], 1e3 * maps[-1][1][-1])
    ax.set_xticks(np.arange(angles[0], angles[-1] + 1.0, 45.0 if angles[0] == 0.0 else 90.0))
    ax.set_xlabel("angle from the source direction (degrees)")
    ax.set_ylabel("depth, outward (mm)")
    ax.grid(visible=False)
    ax.set_title(f"{shell_phrase(drawn.shell, shells)}: largest {component_words(peak.component)} stress over time")
    bar = ax.figure.colorbar(picture, ax=ax, pad=0.16)
    bar.set_label(f"{component_words(peak.component)} stress ({unit})")
    bar.outline.set_linewidth(0.5)
    return ax


def figure_wall_stress(
    responses: Mapping[str, Response] | Response, shells: Sequence[int | str] | int | str | None = None, *, component: str = "von_mises"
) -> Figure:
    """Return a figure of :func:`plot_wall_stress`: a panel a shell and run.

    Parameters
    ----------
    responses : Response, or mapping of name to Response
        Side by side, a shell of all of them on one scale of colours unless their largest stresses are more than five times apart.
    shells : list of int or str, optional
        Below each other; all that are elastic unless given.
    component : str

    Raises
    ------
    InputError
        As :meth:`coaxshell.Response.peak_stress`.
    """
    return draw_walls(mapped_walls(responses, shells, component))


def mapped_walls(
    responses: Mapping[str, Response] | Response, shells: Sequence[int | str] | int | str | None, component: str
) -> dict[str, list[MappedWall]]:
    """Return by run the maps of its walls that :func:`figure_wall_stress` draws."""
    runs = dict(responses) if isinstance(responses, Mapping) else {"": responses}
    return {
        name: [_mapped(response, shell, component, None, None) for shell in response.system.shell_indices(shells)]
        for name, response in runs.items()
    }


def draw_walls(maps: Mapping[str, Sequence[MappedWall]]) -> Figure:
    """Return the figure of the maps of walls by run."""
    rows = max(len(of_run) for of_run in maps.values())
    with style():
        figure = new_figure(PAGE_WIDTH, 2.1 * rows)
        axes = figure.subplots(rows, len(maps), squeeze=False)
        for row in range(rows):
            largest = [of_run[row].largest for of_run in maps.values() if row < len(of_run)]
            together = max(largest) <= _ALIKE * min(largest)
            for ax, (name, of_run) in zip(axes[row], maps.items(), strict=True):
                if row >= len(of_run):
                    ax.remove()
                    continue
                _draw(of_run[row], ax, max(largest) if together else of_run[row].largest)
                phrase = shell_phrase(of_run[row].shell, of_run[row].response.shells)
                ax.set_title("")
                ax.set_title(
                    literal(f"{name}, {phrase}" if name else phrase[:1].upper() + phrase[1:]), loc="left", fontweight="bold", pad=8
                )
                if len(maps) > 1:
                    ax.set_xlabel("angle (degrees)")
    return figure


def described_layers(response: Response, shell: int) -> list[str]:
    """Return the names of the materials of a shell, from the inside out."""
    return [layer.material.name for layer in getattr(response.system.shells[shell], "layers", ())]


def layer_maps(motion: WallMotion, shell: int, component: str, window: slice) -> list[tuple[FloatArray, FloatArray, FloatArray]]:
    """Return for each layer angles (degrees), depths (m) and the largest magnitude of a stress over a window of time, (depths, angles)."""
    stress, solution, found = stress_through(motion, shell), motion.solution, []
    angles = np.arange(0.0, 181.0) if solution.normal.shape[1] == 1 else np.arange(-180.0, 181.0)
    for ends in stress.depths():
        depths = np.linspace(ends[0], ends[-1], _DEPTHS)
        each = stress.at([float(z) for z in depths], component)
        found.append((angles, depths, np.stack([at.at_angles(angles, window).max(axis=0) for at in each])))
    return found
