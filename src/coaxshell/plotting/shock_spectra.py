"""Shock response spectra on four-coordinate paper: pseudo-velocity by frequency, with slanted scales of displacement and acceleration.

On logarithmic axes a displacement z = v/omega is a line that rises, an acceleration omega v one that falls: one curve reads as all three.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from coaxshell.errors import InputError
from coaxshell.model.places import shell_phrase
from coaxshell.numerics.arrays import FloatArray
from coaxshell.plotting.curves import COLOUR_NAMES, DASHES, sections_of
from coaxshell.plotting.style import COLOURS, PAGE_WIDTH, literal, new_figure, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from coaxshell.response import Response

ENVELOPE_ANGLES = 360
"""Angles over which an envelope is taken."""


def figure_shock_spectra(
    responses: Mapping[str, Response] | Response,
    shells: Sequence[int | str] | int | str | None = None,
    angle: Sequence[float] | float = (0.0, 180.0),
    station: Any = None,
    frequency: Sequence[float] | None = None,
    quality_factor: float = 10.0,
    *,
    envelope: bool = True,
) -> Figure:
    """Draw pseudo-velocity spectra of one run or several on four-coordinate paper, a panel a shell.

    Parameters
    ----------
    responses : Response, or mapping of name to Response
        At most four runs, or stations of runs in three dimensions; each has its own kind of line.
    shells : list of int or str, optional
        Shells by name or number; all that are elastic unless given.
    angle : list of float
        Degrees from the direction theta = 0, at most four; each has its own colour.
    station : float, str, or list of them, optional
        Axial positions of runs in three dimensions, m.
    frequency : list of float, optional
        Natural frequencies, Hz; chosen from the run unless given.
    quality_factor : float
        Q = 1/(2 zeta).
    envelope : bool
        Whether the largest over all angles is drawn too, in grey.

    Returns
    -------
    Figure

    Raises
    ------
    InputError
        There is nothing to draw, more than can be told apart, or an argument that the spectrum refuses.
    """
    runs = dict(responses) if isinstance(responses, Mapping) else {"": responses}
    angles = [float(each) for each in np.atleast_1d(np.asarray(angle, dtype=np.float64))]
    sections = sections_of(runs, station)
    for where, count, most in (("responses", len(sections), len(DASHES)), ("angle", len(angles), len(COLOUR_NAMES) - 1)):
        if not 1 <= count <= most:
            raise InputError(where, f"{count} cannot be drawn", f"give 1 to {most}, so that they can be told apart")
    panels: dict[str, list[tuple[str, str, Any, FloatArray, FloatArray]]] = {}
    for dash, section in zip(DASHES, sections.values(), strict=False):
        response = section.response
        circle = np.linspace(0.0, 360.0, ENVELOPE_ANGLES, endpoint=False)
        for index in response.system.shell_indices(shells):
            around = [*angles, *(circle if envelope else ())]
            found = response.shock_spectrum(index, around, frequency, station=section.station, quality_factor=quality_factor)
            title = shell_phrase(index, response.shells)
            drawn = panels.setdefault(title[:1].upper() + title[1:], [])
            values, hertz = found.to_numpy(), found["frequency"].to_numpy()
            drawn += [("grey", "all around", dash, hertz, values[:, len(angles) :].max(axis=1))] if envelope else []
            drawn += [(COLOUR_NAMES[i], f"{each:g}°", dash, hertz, values[:, i]) for i, each in enumerate(angles)]
    if not panels:
        raise InputError("shells", "no run has an elastic one of these", "choose others")
    return _sheet(panels, list(sections), quality_factor)


def plot_four_coordinates(ax: Axes) -> Axes:
    """Put the slanted scales of displacement and acceleration on logarithmic axes of frequency (Hz) and pseudo-velocity (m/s).

    The limits of the axes stand already; lines are drawn at powers of ten.

    Returns
    -------
    Axes
    """
    (low, high), (bottom, top) = ax.get_xlim(), ax.get_ylim()
    f = np.array([low, high])
    omega = 2.0 * np.pi * f
    for exponent in _decades(bottom / omega[1], top / omega[0]):
        ax.plot(f, 10.0**exponent * omega, color=COLOURS["sky"], linewidth=0.5, zorder=1)
        _write(ax, 10.0**exponent * 2.0 * np.pi, 1.0, _length(exponent), COLOURS["blue"])
    for exponent in _decades(bottom * omega[0], top * omega[1]):
        ax.plot(f, 10.0**exponent / omega, color=COLOURS["amber"], linewidth=0.5, zorder=1)
        _write(ax, 10.0**exponent / (2.0 * np.pi), -1.0, _power(exponent, "m/s²"), COLOURS["orange"])
    ax.set_xlim(low, high)
    ax.set_ylim(bottom, top)
    return ax


def _decades(lowest: float, highest: float) -> range:
    return range(int(np.ceil(np.log10(lowest))), int(np.floor(np.log10(highest))) + 1)


def _length(exponent: int) -> str:
    units = {-3: "mm", -6: "µm", -9: "nm", 0: "m"}
    base = min(units, key=lambda unit: (unit > exponent, abs(exponent - unit)))
    return f"{10 ** (exponent - base):g} {units[base]}" if 0 <= exponent - base <= 2 else _power(exponent, "m")


def _power(exponent: int, unit: str) -> str:
    return f"{10**exponent:g} {unit}" if 0 <= exponent <= 3 else f"$10^{{{exponent}}}$ {unit}"


def _write(ax: Axes, factor: float, slope: float, text: str, colour: str) -> None:
    """Write along the line v = factor f^slope: below its end where a rising one leaves at the top, else after the line has entered."""
    from matplotlib.patheffects import AbstractPathEffect, withStroke

    (low, high), (bottom, top) = ax.get_xlim(), ax.get_ylim()
    width, height = np.log(high / low), np.log(top / bottom)
    start, end = sorted(float(np.log((edge / factor) ** (1.0 / slope) / low) / width) for edge in (bottom, top))
    at_end = slope > 0 and end < 1.0
    x = min(end, 1.0) - 0.06 if at_end else max(start, 0.0) + 0.02
    f = low * np.exp(x * width)
    if not 0.02 <= x <= 0.95 or not bottom < factor * f**slope < top:
        return
    window = ax.get_window_extent()
    turned = np.degrees(np.arctan2(slope * window.height / height, window.width / width))
    side = "right" if at_end else "left"
    halo: list[AbstractPathEffect] = [withStroke(linewidth=2.0, foreground=ax.get_facecolor())]  # curves pass behind it
    told = ax.text(f, factor * f**slope, text, color=colour, fontsize=6.5, rotation=turned, rotation_mode="anchor", ha=side, va="bottom")
    told.set_path_effects(halo)


def _sheet(panels: Mapping[str, list[tuple[str, str, Any, FloatArray, FloatArray]]], names: list[str], quality_factor: float) -> Figure:
    from matplotlib.lines import Line2D

    with style():
        figure = new_figure(PAGE_WIDTH, 0.8 + 3.1 * ((len(panels) + 1) // 2))
        axes = figure.subplots((len(panels) + 1) // 2, min(2, len(panels)), squeeze=False, sharey=True).ravel()
        values = np.concatenate([v for curves in panels.values() for *_, v in curves])
        values = values[values > 0.0]
        largest = float(values.max()) if values.size else 1.0
        for ax, (title, curves) in zip(axes, panels.items(), strict=False):
            ax.set(xscale="log", yscale="log", xlabel="natural frequency (Hz)")
            ax.set_title(title, loc="left", fontweight="bold")
            for colour, _, dash, hertz, velocity in curves:
                ax.plot(hertz, velocity, color=COLOURS[colour], linestyle=dash, linewidth=1.3 if colour == "grey" else 1.1, zorder=3)
            ax.set_xlim(min(c[3].min() for c in curves), max(c[3].max() for c in curves))
            ax.set_ylim(max(0.7 * float(values.min()) if values.size else 0.0, 1e-4 * largest), 2.0 * largest)
        for ax in axes[len(panels) :]:
            ax.set_visible(False)
        axes[0].set_ylabel("pseudo-velocity (m/s)")
        kinds = {label: colour for curves in panels.values() for colour, label, *_ in curves}
        handles = [Line2D([], [], color=COLOURS[colour], label=label) for label, colour in kinds.items()]
        handles += [
            Line2D([], [], color="black", linestyle=dash, label=literal(name)) for dash, name in zip(DASHES, names, strict=False) if name
        ]
        figure.legend(handles=handles, loc="outside lower center", ncols=min(len(handles), 6), title=f"Q = {quality_factor:g}")
        figure.canvas.draw()  # places the axes, along whose lines is written
        for ax in axes[: len(panels)]:
            plot_four_coordinates(ax)
    return figure
