"""Which natural modes carry a peak: shares at the instant, and what the largest of them carry over time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from coaxshell.model.prefixes import PREFIXES, engineering, exponent_of
from coaxshell.plotting.histories import TIME_LABEL
from coaxshell.plotting.style import COLOURS, PAGE_WIDTH, new_figure, style
from coaxshell.response.participation import largest_modes

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

_BARS, _CURVES = 10, 4
_COLOURS = ("blue", "orange", "green", "purple")


def figure_participation(found: xr.Dataset) -> Figure:
    """Draw the shares of the modes that carry most of a peak as bars, and the four largest over time beside the whole.

    Parameters
    ----------
    found : Dataset
        From :meth:`coaxshell.Response.participation`.
    """
    rows = largest_modes(found, _BARS)
    power = exponent_of(float(np.abs(found["order_history"]).max()) or 1.0)
    time, unit = found["time"].to_numpy(), f"{PREFIXES[power]}{found.attrs['units']}"
    with style():
        figure = new_figure(PAGE_WIDTH, 3.0)
        left, right = figure.subplots(1, 2, width_ratios=(1.0, 1.4))
        colours = [COLOURS[_COLOURS[i]] if i < _CURVES else COLOURS["grey"] for i in range(len(rows))]
        places = np.arange(len(rows))[::-1]
        left.barh(places, [100.0 * row.share for row in rows], color=colours)
        left.set_yticks(places, [f"m = {row.order}, {engineering(row.frequency, 'Hz')}" for row in rows])
        left.axvline(0.0, color="black", linewidth=0.6)
        left.set_xlabel("share of the peak (%)")
        left.grid(visible=False, axis="y")
        right.plot(time, found["order_history"].sum("order") / 10.0**power, color="black", label="these orders together")
        for row, colour in zip(rows[:_CURVES], _COLOURS, strict=False):
            values = found["history"].sel(order=row.order).isel(mode=row.mode) / 10.0**power
            right.plot(time, values, color=COLOURS[colour], linewidth=0.9)
        right.axvline(found.attrs["time"], color=COLOURS["grey"], linewidth=0.7, linestyle="dashed", label="the instant")
        right.set_xlim(0.0, float(time[-1]))
        right.set_xlabel(TIME_LABEL)
        right.set_ylabel(f"{found.attrs['quantity'].replace('_', ' ')} at {found.attrs['angle']:.4g}° ({unit})")
        right.legend(loc="best")
    return figure
