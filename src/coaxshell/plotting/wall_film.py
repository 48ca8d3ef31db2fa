"""A film of walls of a three-dimensional run laid flat: angle across, axial position up, coloured by a component of the stress."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from coaxshell.errors import InputError
from coaxshell.model import RigidShell
from coaxshell.model.places import shell_phrase
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.cost import Cost
from coaxshell.plotting.field import time_stamp
from coaxshell.plotting.field_scales import STRESS_COLOURS, add_colour_bar
from coaxshell.plotting.film import check_film, film_times
from coaxshell.plotting.film_canvas import Stamp, colour_table, coloured, page, pixels
from coaxshell.plotting.film_files import write_film
from coaxshell.plotting.frames import Frames, Report, instants
from coaxshell.plotting.scales import round_up
from coaxshell.plotting.style import style
from coaxshell.plotting.unrolled import ANGLES, along_stations, component_unit, require_grid, require_stations, stress_component

if TYPE_CHECKING:
    from coaxshell.response.spatial import SpatialResponse

Bytes = npt.NDArray[np.uint8]

_LEFT, _RIGHT, _GAP, _TOP, _BOTTOM = 52, 14, 58, 40, 96  # at 450 pixels a panel
_SHARE = 0.999
_STAGE = "film"


def save_wall_film(
    response: SpatialResponse,
    shells: int | str | Sequence[int | str] | None = None,
    *,
    path: str | Path,
    component: str = "hoop",
    frames: int = 250,
    fps: float = 25.0,
    until: float | None = None,
    size: int = 450,
    stress_limit: float | None = None,
    progress: Report | None = None,
) -> Path:
    """Write a film of the stress of shells of a three-dimensional run, each laid flat as :func:`plot_unrolled` draws it, side by side.

    Parameters
    ----------
    response : SpatialResponse
        Of at least two stations; between them colours are interpolated.
    shells : int, str or sequence of them, optional
        All that are not rigid when left out.
    path : str or Path
        An .mp4 (needs the extra ``coaxshell[video]``) or a .webp.
    component : str
        "hoop", "axial", "shear" or "von_mises".
    frames, fps, until, progress
        As of :func:`save_film`.
    size : int
        Height of a panel in pixels.
    stress_limit : float, optional
        End of the colour scale, Pa; chosen from the whole film when left out.

    Returns
    -------
    Path

    Raises
    ------
    InputError
        An argument is not allowed, the run has a single station, or the film does not fit into memory or cannot be written.
    """
    target = Path(path)
    check_film(target, frames, fps)
    require_stations(response)
    require_grid(response)
    component = stress_component(component)
    if not 100 <= size <= 2000:
        raise InputError("pixels", f"{size} is not allowed", "give a whole number from 100 to 2000")
    numbers = _numbers(response, shells)
    index = instants(response, film_times([response], frames, until))
    wall_film_cost(response, len(numbers), frames, size).require(
        f"a film of {frames:,} frames of {response.stations.size:,} stations", "use fewer frames, or fewer stations"
    )
    few = response.at_instants(index)
    walls = [along_stations(few, number, ANGLES, None, component) for number in numbers]
    limit = stress_limit or round_up(max(float(np.quantile(abs(stress), _SHARE)) for _, stress in walls))
    names = [shell_phrase(number, len(response.system.shells)) for number in numbers]
    canvas = _WallCanvas(names, walls[0][0], size, component, limit)
    moments = few.time, 1e3 * few.time_seconds
    pictures = _pictures(canvas, [stress for _, stress in walls], moments, progress)
    write_film(target, (canvas.width, canvas.height), index.size, fps, pictures)
    return target


def wall_film_cost(response: SpatialResponse, shells: int, frames: int, size: int) -> Cost:
    """Return what a film of walls laid flat costs; the seconds hold within a factor of 3."""
    values = 8.0 * frames * 2.0 * response.stations.size * ANGLES.size
    return Cost((shells + 4.0) * values + 0.1e9, shells * (0.5 + 6e-9 * values + frames * (0.004 + 8e-8 * size**2)))


def _numbers(response: SpatialResponse, shells: int | str | Sequence[int | str] | None) -> list[int]:
    """Return the numbers of the shells to be shown."""
    described = response.system.shells
    numbers = response.system.shell_indices(shells)
    if not numbers:
        raise InputError("shells", "there are none", "name at least one elastic shell, or leave it out for all")
    for number in numbers:
        if isinstance(described[number], RigidShell):
            raise InputError("shells", f"{shell_phrase(number, response.shells)} is rigid and has no stress", "name another shell")
    return numbers


def _pictures(
    canvas: _WallCanvas, walls: Sequence[FloatArray], moments: tuple[FloatArray, FloatArray], progress: Report | None
) -> Iterator[Bytes]:
    count = len(moments[0])
    for i in range(count):
        stamp = Frames(moments[0][[i]], moments[1][[i]], np.zeros((1, 1, 1), np.float32), ())
        yield canvas.frame([stress[i] for stress in walls], time_stamp(stamp, 0, mathematics=False))
        if progress is not None:
            progress((i + 1) / count, _STAGE)


class _WallCanvas:
    """Turn stresses at stations and angles into frames.

    Parameters
    ----------
    names : sequence of str
        Written above the panels.
    z : ndarray
        Axial positions of the rows of a stress, in a, ascending.
    size : int
        Height of a panel in pixels.
    component : str
    limit : float
        End of the colour scale, Pa.
    """

    def __init__(self, names: Sequence[str], z: FloatArray, size: int, component: str, limit: float) -> None:
        self._zoom, self._height, self._width, self._limit = size / 450.0, size, round(1.15 * size), limit
        self._top = self._px(_TOP)
        self._left = [self._px(_LEFT) + i * (self._width + self._px(_GAP)) for i in range(len(names))]
        width, height = self._left[-1] + self._width + self._px(_RIGHT), self._top + size + self._px(_BOTTOM)
        self.width, self.height = width + width % 2, height + height % 2  # video wants even numbers
        heights = np.linspace(z[-1], z[0], size)
        self._up = np.stack([np.interp(heights, z, row) for row in np.eye(z.size)], axis=1)
        across = np.linspace(ANGLES[0], ANGLES[-1], self._width)
        self._across = np.stack([np.interp(across, ANGLES, row) for row in np.eye(ANGLES.size)])
        self._colours, self._stamp = colour_table(STRESS_COLOURS), Stamp(max(9, self._px(13)))
        self._background = self._draw_background(names, z, component)

    def frame(self, walls: Sequence[FloatArray], stamp: str) -> Bytes:
        """Return one frame, shape (height, width, 3), from the stress of each wall, (positions, angles)."""
        picture = self._background.copy()
        for left, stress in zip(self._left, walls, strict=True):
            values = (self._up @ stress @ self._across).astype(np.float32)
            picture[self._top : self._top + self._height, left : left + self._width] = coloured(values, self._limit, self._colours)
        self._stamp.write(picture, stamp, self._left[0], self._top)
        return picture

    def _px(self, at_450: float) -> int:
        return round(at_450 * self._zoom)

    def _draw_background(self, names: Sequence[str], z: FloatArray, component: str) -> Bytes:
        """Return the page without stresses: axes, names, colour bar."""
        size = 9.0 * self._zoom
        with style():
            figure = page(self.width, self.height)
            for number, (left, name) in enumerate(zip(self._left, names, strict=True)):
                low = self.height - self._top - self._height
                box = (left / self.width, low / self.height, self._width / self.width, self._height / self.height)
                ax = figure.add_axes(box)
                ax.set(xlim=(ANGLES[0], ANGLES[-1]), ylim=(z[0], z[-1]), xticks=np.arange(-180, 181, 90))
                ax.grid(visible=False)
                ax.tick_params(labelsize=0.85 * size, length=3 * self._zoom, pad=2 * self._zoom)
                ax.set_xlabel("angle from the source direction (degrees)", fontsize=0.95 * size, labelpad=2 * self._zoom)
                if number == 0:
                    ax.set_ylabel("$z/a$", fontsize=0.95 * size, labelpad=2 * self._zoom)
                right, height = (left + self._width) / self.width, 1.0 - 0.5 * self._top / self.height
                figure.text(right, height, name[:1].upper() + name[1:], ha="right", va="center", fontsize=1.15 * size, fontweight="bold")
            self._add_bar(figure, component, size)
            picture = pixels(figure)
        return np.ascontiguousarray(picture[..., :3])

    def _add_bar(self, figure: Any, component: str, size: float) -> None:
        length = min(0.9 * self._width, 0.8 * self.width)
        bounds = ((0.5 * (self.width - length)) / self.width, self._px(36) / self.height, length / self.width, self._px(13) / self.height)
        unit = component_unit(component, self._limit)
        bar = add_colour_bar(figure.add_axes(bounds), self._limit, unit, STRESS_COLOURS, orientation="horizontal")
        bar.ax.tick_params(labelsize=0.85 * size, length=2 * self._zoom, pad=1.5 * self._zoom)
        bar.set_label(unit.label, fontsize=0.9 * size, labelpad=0.5)
