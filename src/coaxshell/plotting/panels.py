"""Square panels of sheets and films: a cross-section, or the plane along the axis; what stands still, and where walls show stress."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
import numpy.typing as npt

from coaxshell.model import RigidShell
from coaxshell.numerics.arrays import FloatArray
from coaxshell.plotting.field import ABSORBER_COLOUR, WALL_COLOUR, absorber_places, draw_frame, wall_bands
from coaxshell.plotting.field_scales import PRESSURE_COLOURS, STRESS_COLOURS, FieldScales, mappable
from coaxshell.plotting.frames import FieldView, Frames
from coaxshell.plotting.sea import cavitating, draw_planes

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from coaxshell.model import System

_FINE = 361
"""Rows of a wall along the axis in a figure."""


@dataclass(frozen=True)
class Band:
    """The pixels of a wall: where they are, rows from the top, which of its stresses they show, and how much of each the wall covers."""

    rows: npt.NDArray[np.intp]
    columns: npt.NDArray[np.intp]
    place: npt.NDArray[np.intp]
    cover: npt.NDArray[np.float32]


class Panel(Protocol):
    """What of a panel stands still."""

    @property
    def name(self) -> str:
        """Written above it."""
        ...

    @property
    def labels(self) -> tuple[str, str]:
        """Return the labels of the axis to the right and of the one upward."""
        ...

    def bands(self, view: FieldView) -> list[Band | None]:
        """Return the pixels of each stress of its frames, None where there is none."""
        ...

    def outline(self, ax: Axes, view: FieldView, zoom: float) -> None:
        """Draw walls and absorbers; *zoom* is the panel's size as a multiple of 450 pixels."""
        ...

    def cavitating(self, pressure: npt.NDArray[np.floating], view: FieldView) -> npt.NDArray[np.floating] | None:
        """Return the absolute pressure less that of vapour, Pa, rows from the lowest y upward, None where no sea tells."""
        ...

    def draw(self, ax: Axes, frames: Frames, index: int, view: FieldView, scales: FieldScales, *, absorbers: bool = True) -> None:
        """Draw a frame into axes of a figure."""
        ...


@dataclass(frozen=True)
class Section:
    """A cross-section.

    Attributes
    ----------
    system : System
    name : str
    """

    system: System
    name: str
    labels = ("x/a", "y/a")

    def bands(self, view: FieldView) -> list[Band | None]:
        """Return the pixels of each shell, with soft edges; their places are degrees."""
        return [self._band(*edges, view) for edges in wall_bands(self.system)]

    @staticmethod
    def _band(inner: float, outer: float, view: FieldView) -> Band:
        x = view.centres
        y = x[::-1, None]
        covered = 0.5 + (0.5 * (outer - inner) - np.abs(np.hypot(x, y) - 0.5 * (inner + outer))) / view.pixel
        rows, columns = np.nonzero(covered > 0)
        angle = np.degrees(np.arctan2(y[rows, 0], x[columns]))
        degree = np.rint(angle).astype(np.intp) % 360
        return Band(rows, columns, degree, np.clip(covered[rows, columns], 0.0, 1.0).astype(np.float32))

    def outline(self, ax: Axes, view: FieldView, zoom: float) -> None:
        """Draw the edges of the walls, and absorbers as dots."""
        from matplotlib.patches import Circle

        draw_planes(ax, self.system, view, zoom)
        for edges in wall_bands(self.system):
            for edge in edges:
                ax.add_patch(Circle((0, 0), edge, fill=False, edgecolor=WALL_COLOUR, linewidth=0.6 * zoom))
        if self.system.absorber_list:
            x, y = absorber_places(self.system)
            ax.plot(x, y, linestyle="none", marker="o", markersize=2.4 * zoom, color=ABSORBER_COLOUR, markeredgewidth=0)

    def cavitating(self, pressure: npt.NDArray[np.floating], view: FieldView) -> npt.NDArray[np.floating] | None:
        """Return the absolute pressure less that of vapour, Pa, rows from the lowest y upward, None where no sea tells."""
        return cavitating(self.system, pressure, view)

    def draw(self, ax: Axes, frames: Frames, index: int, view: FieldView, scales: FieldScales, *, absorbers: bool = True) -> None:
        """Draw a frame into axes of a figure."""
        draw_frame(ax, self.system, frames, index, view, scales, absorbers=absorbers)


@dataclass(frozen=True)
class AlongAxis:
    """The plane y = 0 along the axis: each wall twice, at head and tail, its stress as far as the stations go.

    Attributes
    ----------
    system : System
    name : str
    ends : (float, float) or None
        The lowest and the highest station, in a; None where there are fewer than two.
    """

    system: System
    name: str
    ends: tuple[float, float] | None
    labels = ("x/a", "z/a")

    @property
    def sides(self) -> list[tuple[float, float, bool]]:
        """Between which x each wall is drawn, head and tail of each shell in turn, and whether it is rigid."""
        walls = zip(wall_bands(self.system), self.system.shells, strict=True)
        both = (((inner, outer), (-outer, -inner), isinstance(shell, RigidShell)) for (inner, outer), shell in walls)
        return [(*place, rigid) for head, tail, rigid in both for place in (head, tail)]

    def covered(self, view: FieldView) -> FloatArray:
        """Return the heights of the rows of pixels, upward, at which walls show their stress."""
        z = view.centres
        return z[:0] if self.ends is None else z[(z >= self.ends[0]) & (z <= self.ends[1])]

    def bands(self, view: FieldView) -> list[Band | None]:
        """Return the pixels of each wall, with soft edges; their places are rows upward from the first that is covered."""
        return [None if rigid or not self.covered(view).size else self._band(left, right, view) for left, right, rigid in self.sides]

    def _band(self, left: float, right: float, view: FieldView) -> Band:
        heights, centres = self.covered(view), view.centres
        across = np.clip(0.5 + (0.5 * (right - left) - np.abs(centres - 0.5 * (left + right))) / view.pixel, 0.0, 1.0)
        first = int(np.searchsorted(centres, heights[0] - 0.5 * view.pixel))
        place, column = (each.ravel() for each in np.meshgrid(np.arange(heights.size), np.flatnonzero(across), indexing="ij"))
        return Band(view.pixels - 1 - first - place, column, place, across[column].astype(np.float32))

    def outline(self, ax: Axes, view: FieldView, zoom: float) -> None:
        """Draw the edges of the walls where they show their stress, a line each where they do not."""
        self._lines(ax, view, 0.6 * zoom, 1.3 * zoom)

    def cavitating(self, pressure: npt.NDArray[np.floating], view: FieldView) -> npt.NDArray[np.floating] | None:
        """Return None: what cavitates is told in cross-sections."""
        return None

    def _lines(self, ax: Axes, view: FieldView, thin: float, thick: float) -> None:
        edge, ends = view.half_width, self.ends or (0.0, 0.0)
        low, high = max(ends[0], -edge), min(ends[1], edge)
        for left, right, rigid in self.sides:
            middle = 0.5 * (left + right)
            if rigid or high <= low:
                ax.vlines(middle, -edge, edge, color=WALL_COLOUR, linewidth=thick, zorder=3)
                continue
            ax.vlines([left, right], low, high, color=WALL_COLOUR, linewidth=thin, zorder=3)
            for start, end in ((-edge, low), (high, edge)):
                if end > start:
                    ax.vlines(middle, start, end, color=WALL_COLOUR, linewidth=thick, zorder=3)

    def draw(self, ax: Axes, frames: Frames, index: int, view: FieldView, scales: FieldScales, *, absorbers: bool = True) -> None:
        """Draw a frame into axes of a figure."""
        edge = view.half_width
        image: Any = mappable(scales.pressure, PRESSURE_COLOURS)
        whole = (-edge, edge, -edge, edge)
        ax.imshow(frames.field(index), extent=whole, origin="lower", cmap=image.cmap, norm=image.norm, interpolation="auto")
        heights = self.covered(view)
        colours: Any = mappable(scales.stress, STRESS_COLOURS)
        for (left, right, _), along in zip(self.sides, frames.stress, strict=True):
            if along is None or not heights.size:
                continue
            fine = np.linspace(heights[0] - 0.5 * view.pixel, heights[-1] + 0.5 * view.pixel, _FINE)
            rows = np.interp(0.5 * (fine[1:] + fine[:-1]), heights, along[index])
            place = (left, right, fine[0], fine[-1])
            ax.imshow(rows[:, None], extent=place, origin="lower", cmap=colours.cmap, norm=colours.norm, aspect="auto", zorder=2)
        self._lines(ax, view, 0.45, 1.0)
        ax.set_xlim(-edge, edge)
        ax.set_ylim(-edge, edge)
        ax.set_aspect("equal")
        ax.grid(visible=False)
