"""The RMS of the pressure outside and inside against time (the paper's Figure 14)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from coaxshell.errors import InputError
from coaxshell.plotting.histories import TIME_LABEL
from coaxshell.plotting.snapshots import headings
from coaxshell.plotting.style import COLOURS, PAGE_WIDTH, literal, new_figure, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from coaxshell.response import Response

_LOOKS = (("blue", "solid"), ("orange", (0, (5.0, 1.6))), ("green", (0, (1.5, 1.5))), ("purple", "dashdot"))


def figure_pressure_rms(*responses: Response, radius: float = 3.0, names: Sequence[str] = ()) -> Figure:
    """Draw the RMS of the total pressure over the exterior within a radius, and over the interior, against time.

    Parameters
    ----------
    *responses : Response
        At most four.
    radius : float
        Outer radius of the exterior domain, in a.
    names : sequence of str
        In the legend; the names of the systems when left out.

    Returns
    -------
    Figure

    Raises
    ------
    InputError
        There are no responses, or more than four.
    """
    if not 1 <= len(responses) <= len(_LOOKS):
        raise InputError("responses", f"{len(responses)} cannot be drawn", f"give 1 to {len(_LOOKS)}")
    panels = (("exterior", f"a  Exterior, $r < {radius:g}\\,a$"), ("interior", "b  Interior"))
    with style():
        figure = new_figure(PAGE_WIDTH, 2.8)
        axes = figure.subplots(1, len(panels))
        for ax, (region, title) in zip(axes, panels, strict=True):
            within = radius if region == "exterior" else None
            _panel(ax, [response.pressure_rms(region, within) for response in responses])
            ax.set_title(title, loc="left", fontweight="bold")
        lines = axes[0].lines
        labels = [literal(name) for name in headings(responses, names)]
        figure.legend(handles=lines, labels=labels, loc="outside lower center", ncols=len(lines))
    return figure


def _panel(ax: Axes, curves: Sequence[Any]) -> None:
    """Draw labelled histories in Pa, each at its own instants."""
    largest = max(float(curve.max()) for curve in curves)
    unit, per_pascal = ("kPa", 1e-3) if largest >= 1e3 else ("Pa", 1.0)
    for curve, (colour, dash) in zip(curves, _LOOKS, strict=False):
        ax.plot(np.asarray(curve["time"]), per_pascal * np.asarray(curve), color=COLOURS[colour], linestyle=dash)
    ax.set_xlim(0.0, max(float(curve["time"][-1]) for curve in curves))
    ax.set_ylim(bottom=0.0)
    ax.set_xlabel(TIME_LABEL)
    ax.set_ylabel(f"RMS pressure ({unit})")
