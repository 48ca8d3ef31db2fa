"""Frames of a film as arrays: what does not move is drawn once by matplotlib, and what moves is filled in by numpy."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from coaxshell.plotting.cut_frames import Shown
from coaxshell.plotting.field import time_stamp
from coaxshell.plotting.field_scales import (
    PRESSURE_COLOURS,
    STRESS_COLOURS,
    FieldScales,
    add_colour_bar,
    compressed,
    pressure_unit,
    stress_unit,
)
from coaxshell.plotting.frames import FieldView, Frames
from coaxshell.plotting.panels import Band, Panel
from coaxshell.plotting.sea import CAVITATION_COLOUR, rim
from coaxshell.plotting.style import literal, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from coaxshell.response import Response

Bytes = npt.NDArray[np.uint8]

_DPI = 100
_MARGIN, _GAP, _TOP, _BAR, _LABELS = 10, 12, 34, 14, 58  # at 450 pixels a panel; they grow with it
_LEVELS = 1024
_CAVITATION = np.array([int(CAVITATION_COLOUR[i : i + 2], 16) for i in (1, 3, 5)], dtype=np.uint8)
_FRAME = 60  # dark grey
_LONGEST = 28
_FEWEST_WITH_AXES = 240  # pixels of a panel: figures on smaller ones could not be read


class Canvas:
    """Turn fields of one or several systems into frames.

    Parameters
    ----------
    runs : sequence of Shown
        Their panels stand side by side.
    view : FieldView
        What each panel shows; its pixels are those of the film.
    scales : FieldScales
    units : str
        Of the pressure; one of PRESSURE_UNITS.
    """

    def __init__(self, runs: Sequence[Shown], view: FieldView, scales: FieldScales, units: str) -> None:
        self.view, self.scales = view, scales
        self._zoom = view.pixels / 450.0
        panels = [panel for run in runs for panel in run.panels]
        self._panels = panels
        count, side = len(panels), view.pixels
        self._top = self._px(_TOP)
        self._left = [self._px(_MARGIN) + i * (side + self._px(_GAP)) for i in range(count)]
        width = self._left[-1] + side + self._px(_MARGIN)
        height = self._top + side + self._px(_LABELS)
        self.width, self.height = width + width % 2, height + height % 2  # video wants even numbers
        self._colours = colour_table(PRESSURE_COLOURS)
        self._stress_colours = colour_table(STRESS_COLOURS)
        self._background = self._draw_background(runs[0].response, [panel.name for panel in panels], units)
        self._bands = [panel.bands(view) for panel in panels]
        self._overlays = [_Overlay(_draw_overlay(panel, view)) for panel in panels]
        self._stamp = Stamp(max(9, self._px(13)))

    def frame(self, parts: Sequence[Frames], index: int) -> Bytes:
        """Return one frame, shape (height, width, 3), from the same index of each panel's frames."""
        picture = self._background.copy()
        for left, part, bands, overlay, source in zip(self._left, parts, self._bands, self._overlays, self._panels, strict=True):
            panel = picture[self._top : self._top + self.view.pixels, left : left + self.view.pixels]
            panel[:] = coloured(compressed(part.field(index)[::-1] / np.float32(self.scales.pressure)), 1.0, self._colours)
            left_over = source.cavitating(part.field(index), self.view)
            if left_over is not None:
                panel[rim(left_over)[::-1]] = _CAVITATION
            for band, stress in zip(bands, part.stress, strict=True):
                if stress is not None and band is not None:
                    _blend(panel, band, coloured(stress[index], self.scales.stress, self._stress_colours))
            overlay.onto(panel)
            panel[[0, -1]] = panel[:, [0, -1]] = _FRAME
        self._stamp.write(picture, time_stamp(parts[0], index, mathematics=False), self._left[0], self._top)
        return picture

    def _px(self, at_450: float) -> int:
        return round(at_450 * self._zoom)

    def _draw_background(self, response: Response, names: Sequence[str], units: str) -> Bytes:
        """Return the page without fields: names, frames of the panels, colour bars."""
        with style():
            figure = page(self.width, self.height)
            size = 9.0 * self._zoom
            for left, name in zip(self._left, names, strict=True):
                right, height = (left + self.view.pixels) / self.width, 1.0 - 0.5 * self._top / self.height
                figure.text(right, height, literal(_shortened(name)), ha="right", va="center", fontsize=1.15 * size, fontweight="bold")
            bars = (
                (self.scales.pressure, pressure_unit(response, units, self.scales.pressure), PRESSURE_COLOURS),
                (self.scales.stress, stress_unit(self.scales.stress), STRESS_COLOURS),
            )
            for number, (limit, unit, colours) in enumerate(bars):
                length = min(0.42 * self.width, self.view.pixels * 0.9)
                centre = (0.26 + 0.48 * number) * self.width
                bottom = self._px(_LABELS - 9 - _BAR)
                bounds = ((centre - 0.5 * length) / self.width, bottom / self.height, length / self.width, self._px(_BAR) / self.height)
                bar = add_colour_bar(figure.add_axes(bounds), limit, unit, colours, orientation="horizontal")
                bar.ax.tick_params(labelsize=0.85 * size, length=2 * self._zoom, pad=1.5 * self._zoom)
                bar.set_label(unit.label, fontsize=0.9 * size, labelpad=0.5)
            picture = pixels(figure)
        return np.ascontiguousarray(picture[..., :3])


class _Overlay:
    """A transparent picture laid over a panel; only the pixels that it touches are worked on."""

    def __init__(self, picture: Bytes) -> None:
        alpha = picture[..., 3].astype(np.float32) / 255.0
        self.rows, self.columns = np.nonzero(alpha)
        cover = alpha[self.rows, self.columns, None]
        self._ink = picture[self.rows, self.columns, :3] * cover
        self._rest = 1.0 - cover

    def onto(self, panel: Bytes) -> None:
        """Lay the picture over a panel."""
        under = panel[self.rows, self.columns]
        panel[self.rows, self.columns] = (under * self._rest + self._ink + 0.5).astype(np.uint8)


class Stamp:
    """Writes the time at the top left in matplotlib's own font, whose figures all have the same width."""

    def __init__(self, size: int) -> None:
        from matplotlib import font_manager
        from PIL import ImageFont

        self._font: Any = ImageFont.truetype(font_manager.findfont("DejaVu Sans"), size)

    def write(self, picture: Bytes, text: str, left: int, top: int) -> None:
        """Write a text centred in the strip above the panels, its left edge given."""
        from PIL import Image, ImageDraw

        strip = Image.fromarray(picture[:top])
        ImageDraw.Draw(strip).text((left, top // 2), text, fill=(0, 0, 0), font=self._font, anchor="lm")
        picture[:top] = np.asarray(strip)


def page(width: int, height: int) -> Figure:
    """Return an empty figure of so many pixels."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width / _DPI, height / _DPI), dpi=_DPI)
    FigureCanvasAgg(figure)
    return figure


def pixels(figure: Figure) -> Bytes:
    """Return a figure as it is drawn, shape (height, width, 4)."""
    canvas: Any = figure.canvas
    canvas.draw()
    return np.array(canvas.buffer_rgba(), dtype=np.uint8)


def _draw_overlay(panel: Panel, view: FieldView) -> Bytes:
    """Return walls and absorbers on a transparent ground, shape (pixels, pixels, 4)."""
    with style():
        figure = page(view.pixels, view.pixels)
        figure.patch.set_alpha(0.0)
        ax = figure.add_axes((0.0, 0.0, 1.0, 1.0))
        ax.set_axis_off()
        ax.set(xlim=(-view.half_width, view.half_width), ylim=(-view.half_width, view.half_width))
        zoom = view.pixels / 450.0
        panel.outline(ax, view, zoom)
        if view.pixels >= _FEWEST_WITH_AXES:
            _mark_axes(ax, view.half_width, zoom, panel.labels)
        return pixels(figure)


def _mark_axes(ax: Axes, edge: float, zoom: float, labels: tuple[str, str]) -> None:
    """Mark both axes along the lower and the left edge, inside: a panel has no room around it."""
    from matplotlib.ticker import MaxNLocator

    ink: dict[str, Any] = {"color": "0.25", "fontsize": 6.0 * zoom}
    places = [place for place in MaxNLocator(nbins=6, steps=[1, 2, 5, 10]).tick_values(-edge, edge) if abs(place) < 0.93 * edge]
    for place in places:
        ax.plot([place, place], [-edge, -0.975 * edge], color="0.25", linewidth=0.7 * zoom)
        ax.plot([-edge, -0.975 * edge], [place, place], color="0.25", linewidth=0.7 * zoom)
        ax.text(place, -0.965 * edge, f"{place:g}", ha="center", va="bottom", **ink)
        ax.text(-0.96 * edge, place, f"{place:g}", ha="left", va="center", **ink)
    ax.text(0.985 * edge, -0.965 * edge, labels[0], ha="right", va="bottom", **ink)
    ax.text(-0.96 * edge, 0.985 * edge, labels[1], ha="left", va="top", **ink)


def _shortened(name: str) -> str:
    """Return a name that leaves room for the time."""
    return name if len(name) <= _LONGEST else name[: _LONGEST - 1].rstrip() + "…"


def colour_table(name: str) -> Bytes:
    """Return a colour map as a table of _LEVELS colours."""
    from matplotlib import colormaps

    return np.asarray(colormaps[name](np.linspace(0.0, 1.0, _LEVELS), bytes=True)[:, :3], dtype=np.uint8)


def coloured(values: npt.NDArray[Any], limit: float, table: Bytes) -> Bytes:
    """Return the colours of values on a scale from -limit to limit, shape (..., 3)."""
    half = 0.5 * (_LEVELS - 1)
    index = np.clip(values * np.float32(half / limit) + np.float32(half + 0.5), 0, _LEVELS - 1).astype(np.intp)
    return np.asarray(table[index], dtype=np.uint8)


def _blend(panel: Bytes, band: Band, colours: Bytes) -> None:
    under = panel[band.rows, band.columns].astype(np.float32)
    cover = band.cover[:, None]
    panel[band.rows, band.columns] = (under + cover * (colours[band.place] - under) + 0.5).astype(np.uint8)
