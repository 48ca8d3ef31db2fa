"""Largest strokes of absorbers around the shells."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from coaxshell.model.prefixes import PREFIXES, exponent_of
from coaxshell.plotting.histories import TIME_LABEL
from coaxshell.plotting.style import COLOURS, PAGE_WIDTH, new_figure, style

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

_SIDES = (("inner", "blue", "o"), ("outer", "orange", "s"))


def figure_strokes(strokes: xr.DataArray) -> Figure:
    """Draw the largest stroke of each absorber against its angle, and the history of the one that moves most.

    Parameters
    ----------
    strokes : DataArray
        From :meth:`coaxshell.Response.absorber_stroke`.
    """
    values, angles = strokes.to_numpy(), np.asarray(strokes["angle"])
    largest = np.nan_to_num(np.abs(values).max(axis=-1))  # of no link there is none
    worst = int(largest.max(axis=1).argmax())
    power = exponent_of(float(largest.max()) or 1.0)
    with style():
        figure = new_figure(PAGE_WIDTH, 2.4)
        left, right = figure.subplots(1, 2)
        for side, (name, colour, marker) in enumerate(_SIDES):
            against = f"against the {name} shell"
            left.plot(angles, largest[:, side] / 10.0**power, marker, color=COLOURS[colour], markersize=4, label=against)
            right.plot(strokes["time"], values[worst, side] / 10.0**power, color=COLOURS[colour])
        left.set_ylim(bottom=0.0)
        left.set_xlabel("angle of the absorber (degrees)")
        left.set_ylabel(f"largest stroke ({PREFIXES[power]}m)")
        right.axhline(0.0, color=COLOURS["grey"], linewidth=0.5, zorder=1)
        right.set_xlim(0.0, float(strokes["time"][-1]))
        right.set_xlabel(TIME_LABEL)
        right.set_ylabel(f"stroke at {angles[worst]:g}° ({PREFIXES[power]}m)")
        figure.legend(loc="outside lower center", ncols=2)
    return figure
