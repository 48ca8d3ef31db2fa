"""A history for many offsets of one absorber, coloured by the offset (the paper's Figure 8)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from coaxshell.plotting.histories import TIME_LABEL, History
from coaxshell.plotting.scales import common_scales
from coaxshell.plotting.style import COLOURS, PAGE_WIDTH, new_figure, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.colors import Colormap, Normalize
    from matplotlib.figure import Figure

Offsets = Mapping[float, History]


def figure_offsets(panels: Mapping[str, tuple[History, Offsets]], label: str) -> Figure:
    """Draw panels of histories without an absorber (black), with it at the head (red) and beside the head (dashed, by colour).

    Parameters
    ----------
    panels : mapping of str to (History, mapping of float to History)
        By title: the bare history, and the others by offset in degrees, the same offsets in all panels.
    label : str
        Name and unit of the quantity.

    Returns
    -------
    Figure
    """
    from matplotlib import colormaps
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    everything = [curve for bare, moved in panels.values() for curve in (bare, *moved.values())]
    (scale,) = common_scales([(float(min(c.values.min() for c in everything)), float(max(c.values.max() for c in everything)))])
    offsets = [offset for offset in next(iter(panels.values()))[1] if offset]
    colours, norm = colormaps["viridis"], Normalize(0.0, max(offsets))
    with style():
        figure = new_figure(PAGE_WIDTH, 3.3)
        axes = figure.subplots(1, len(panels), squeeze=False, sharey=True)[0]
        for index, (ax, (title, (bare, moved))) in enumerate(zip(axes, panels.items(), strict=True)):
            _panel(ax, bare, moved, colours, norm)
            ax.set_ylim(*scale.limits)
            ax.set_yticks(scale.ticks)
            ax.set_title(f"{'abcd'[index]}  {title}", loc="left", fontweight="bold")
            ax.set_xlabel(TIME_LABEL)
        axes[0].set_ylabel(label)
        bar = figure.colorbar(ScalarMappable(norm, colours), ax=list(axes), pad=0.01, aspect=28)
        bar.set_label("offset of the absorber (degrees)")
        figure.legend(handles=_legend(colours), loc="outside lower center", ncols=3)
    return figure


def _panel(ax: Axes, bare: History, moved: Offsets, colours: Colormap, norm: Normalize) -> None:
    for offset, curve in moved.items():
        if offset:
            ax.plot(curve.time, curve.values, color=colours(norm(offset)), linestyle=(0, (3.5, 1.2)), linewidth=0.8, label=f"{offset:g}")
    ax.plot(bare.time, bare.values, color="black", linewidth=1.3, label="bare")
    if 0.0 in moved:
        ax.plot(moved[0.0].time, moved[0.0].values, color=_AT_HEAD, linewidth=1.3, label="0")
    ax.axhline(0.0, color=COLOURS["grey"], linewidth=0.5, zorder=1)
    ax.set_xlim(0.0, float(bare.time[-1]))


_AT_HEAD = "#CC0000"


def _legend(colours: Any) -> list[Any]:
    from matplotlib.lines import Line2D

    return [
        Line2D([], [], color="black", linewidth=1.3, label="bare"),
        Line2D([], [], color=_AT_HEAD, linewidth=1.3, label="absorber at the head"),
        Line2D([], [], color=colours(0.5), linestyle=(0, (3.5, 1.2)), linewidth=0.8, label="absorber beside the head"),
    ]
