"""Answers at given frequencies: levels, or magnitude and phase, with resonances marked, and directivity in polar coordinates."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from coaxshell.errors import InputError
from coaxshell.numerics.late import xarray as xr
from coaxshell.plotting.curves import COLOUR_NAMES, DASHES
from coaxshell.plotting.style import COLOURS, PAGE_WIDTH, literal, new_figure, style
from coaxshell.response.frequency.curves import curves_of, is_level

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.projections.polar import PolarAxes

RINGING = 0.2
"""Damping ratio up to which a natural frequency is marked."""
SPAN = 40.0
"""Decibels below the largest level that a directivity shows."""
_LABELLED = 30
"""Marks that are labelled with their orders at most."""


def figure_frequency_response(found: Mapping[str, xr.DataArray] | xr.DataArray, resonances: xr.Dataset | None = None) -> Figure:
    """Draw answers over the frequency: levels in one panel, amplitudes by magnitude and phase in two.

    Parameters
    ----------
    found : DataArray, or mapping of name to DataArray
        From :func:`coaxshell.frequency_response` or :meth:`coaxshell.Response.spectrum`; several of one quantity, each with its own kind
        of line.
    resonances : Dataset, optional
        From :func:`coaxshell.natural_frequencies`: lightly damped wet modes are marked, with their orders.

    Raises
    ------
    InputError
        There is nothing to draw, or more than can be told apart.
    """
    named = dict(found) if isinstance(found, Mapping) else {"": found}
    first = next(iter(named.values()), None)
    if first is None or len(named) > len(DASHES):
        raise InputError("found", f"{len(named)} answers cannot be drawn", f"give 1 to {len(DASHES)}, so that they can be told apart")
    with style():
        if is_level(first):
            figure = new_figure(PAGE_WIDTH, 3.6)
            axes = [figure.subplots()]
        else:
            figure = new_figure(PAGE_WIDTH, 5.0)
            axes = list(figure.subplots(2, 1, sharex=True, height_ratios=(2, 1)))
        single = all(len(list(curves_of(one))) == 1 for one in named.values())
        for number, (dash, (name, answer)) in enumerate(zip(DASHES, named.items(), strict=False)):
            first_colour = number if single else 0
            one = answer.assign_attrs({**first.attrs, **answer.attrs})  # older xarray loses them where answers are added to or scaled
            plot_frequency_response(one, axes[0], name=name, dash=dash, first_colour=first_colour)
            if len(axes) == 2:
                plot_frequency_response(one, axes[1], name=name, dash=dash, first_colour=first_colour, part="phase")
        if len(axes) == 2:
            axes[0].set_xlabel("")
        if resonances is not None:
            for number, ax in enumerate(axes):
                _mark(ax, resonances, labelled=number == 0)
        handles, labels = axes[0].get_legend_handles_labels()
        if len(handles) > 1:
            figure.legend(handles, labels, loc="outside lower center", ncols=min(len(handles), 5))
    return figure


def plot_frequency_response(
    found: xr.DataArray, ax: Axes | None = None, *, name: str = "", dash: object = "-", part: str = "magnitude", first_colour: int = 0
) -> Axes:
    """Draw an answer over the frequency.

    Parameters
    ----------
    found : DataArray
        From :func:`coaxshell.frequency_response` or :meth:`coaxshell.Response.spectrum`.
    ax : Axes, optional
        Where to draw; a new figure when left out.
    name : str
        Of the system, for the legend.
    dash : str
        Kind of line.
    part : str
        Of amplitudes, "magnitude" (on a logarithmic scale) or "phase" (degrees).
    first_colour : int
        Number of the colour of the first curve.

    Raises
    ------
    InputError
        There is more than can be told apart.
    """
    curves, colours = list(curves_of(found)), COLOUR_NAMES[first_colour:]
    if len(curves) > len(colours):
        raise InputError("found", f"{len(curves)} curves cannot be drawn", f"choose 1 to {len(colours)}, so that they can be told apart")
    if ax is None:
        with style():
            ax = new_figure(PAGE_WIDTH, 3.6).subplots()
    hertz, level = found["frequency"].to_numpy(), is_level(found)
    for colour, curve in zip(colours, curves, strict=False):
        label = ", ".join(each for each in (literal(name), curve.label) if each) or None
        values = curve.values if level else np.abs(curve.values) if part == "magnitude" else np.degrees(np.angle(curve.values))
        if part == "phase":
            values = np.where(np.abs(np.diff(values, prepend=values[:1])) > 180.0, np.nan, values)  # no line where it wraps
        ax.plot(hertz, values, color=COLOURS[colour], linestyle=dash, label=label)
    words, unit = found.attrs.get("long_name", str(found.name)), found.attrs.get("units", "")
    if part == "phase" and not level:
        ax.set(ylabel="phase (degrees)", ylim=(-180.0, 180.0), yticks=range(-180, 181, 90))
    else:
        ax.set_ylabel(f"{words} ({unit})" if unit != "1" else words)
        if not level:
            ax.set_yscale("log")
    spacing = np.diff(hertz)
    if hertz.size > 2 and hertz.min() > 0.0 and np.ptp(spacing) > 0.5 * np.abs(spacing).max() and hertz.max() > 20.0 * hertz.min():
        ax.set_xscale("log")
    ax.set_xlim(hertz.min(), hertz.max())
    ax.set_xlabel("frequency (Hz)")
    return ax


def _mark(ax: Axes, resonances: xr.Dataset, *, labelled: bool) -> None:
    """Mark wet natural frequencies by lines, and their orders above."""
    low, high = ax.get_xlim()
    frequency, ratio = (resonances[name].transpose("order", "mode").to_numpy() for name in ("frequency", "damping_ratio"))
    with np.errstate(invalid="ignore"):
        rows, columns = np.nonzero((frequency >= low) & (frequency <= high) & (ratio <= RINGING))
    for row, column in zip(rows, columns, strict=True):
        ax.axvline(frequency[row, column], color=COLOURS["grey"], linewidth=0.6, linestyle=(0, (1, 2)), zorder=0)
    if not labelled or rows.size > _LABELLED:
        return
    orders, turned = resonances["order"].to_numpy(), ax.get_xaxis_transform()
    place, row_up = -np.inf, 0
    for at in np.argsort(frequency[rows, columns]):
        hertz = float(frequency[rows[at], columns[at]])
        here = float(np.log(hertz / low) / np.log(high / low)) if ax.get_xscale() == "log" else (hertz - low) / (high - low)
        row_up = (row_up + 1) % 3 if here - place < 0.025 else 0  # close ones stand above each other
        text = f"{orders[rows[at]]}"
        ax.text(hertz, 1.01 + 0.045 * row_up, text, transform=turned, ha="center", va="bottom", fontsize=6.5, color=COLOURS["grey"])
        place = here
    ax.text(-0.015, 1.01, "$m$ =", transform=ax.transAxes, ha="right", va="bottom", fontsize=6.5, color=COLOURS["grey"])


def figure_directivity(found: xr.DataArray, frequency: Sequence[float] | float | None = None) -> Figure:
    """Draw an answer over the angle at some frequencies, the source to the right; see :func:`plot_directivity`."""
    with style():
        figure = new_figure(4.6, 4.9)
        ax = figure.add_subplot(projection="polar")
        plot_directivity(found, frequency, ax)  # type: ignore[arg-type]
        figure.suptitle(ax.get_title(), fontsize=ax.title.get_fontsize())  # a title over the 90 degrees has no room of its own
        ax.set_title("")
        figure.legend(loc="outside lower center", ncols=3)
    return figure


def plot_directivity(found: xr.DataArray, frequency: Sequence[float] | float | None = None, ax: PolarAxes | None = None) -> PolarAxes:
    """Draw an answer over the angle in polar coordinates, theta = 0 to the right: levels down to 40 dB below the largest, or magnitudes.

    Parameters
    ----------
    found : DataArray
        With a dim angle, all the way around.
    frequency : float or list of them, optional
        Hz, of those that were asked for the nearest ones; all unless given, at most five.
    ax : PolarAxes, optional
        Where to draw; a new figure when left out.

    Raises
    ------
    InputError
        There are no angles, too many frequencies, or other dims.
    """
    if not isinstance(found, xr.DataArray) or "angle" not in found.dims or set(found.dims) - {"frequency", "angle"}:
        raise InputError("found", "is no answer over the angle alone", "ask for angle=range(361), at one radius")
    one = found if "frequency" in found.dims else found.expand_dims("frequency")
    if frequency is not None:
        one = one.sel(frequency=np.atleast_1d(np.asarray(frequency, dtype=np.float64)), method="nearest")
    if not 1 <= one.sizes["frequency"] <= len(COLOUR_NAMES):
        remedy = f"give 1 to {len(COLOUR_NAMES)}, so that they can be told apart"
        raise InputError("frequency", f"{one.sizes['frequency']} cannot be drawn", remedy)
    if ax is None:
        with style():
            ax = new_figure(4.6, 4.6).add_subplot(projection="polar")  # type: ignore[assignment]
    assert ax is not None
    level, theta = is_level(one), np.radians(one["angle"].to_numpy())
    values = one.transpose("frequency", "angle").to_numpy()
    values = values if level else np.abs(values)
    top = 5.0 * np.ceil(values.max() / 5.0) if level else float(values.max())
    for colour, hertz, row in zip(COLOUR_NAMES, one["frequency"].to_numpy(), values, strict=False):
        ax.plot(theta, np.maximum(row, top - SPAN) if level else row, color=COLOURS[colour], label=f"{hertz:.4g} Hz")
    if level:
        ax.set_ylim(top - SPAN, top)
        ax.set_yticks(np.arange(top - SPAN + 10.0, top + 1.0, 10.0))
    words, unit = one.attrs.get("long_name", str(one.name)), one.attrs.get("units", "")
    ax.set_title(f"{words} ({unit})" if unit != "1" else words)
    ax.set_rlabel_position(67.5)
    return ax
