"""Where the energy goes, as stacked areas against time."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.plotting.histories import TIME_LABEL
from coaxshell.plotting.style import COLOURS, PAGE_WIDTH, new_figure, style

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


_FIXED = {
    "interior fluid": COLOURS["sky"],
    "gap fluid": COLOURS["blue"],
    "inner shell": COLOURS["amber"],
    "middle shell": "#B0A040",
    "outer shell": COLOURS["orange"],
    "shell": COLOURS["orange"],
    "absorbers": COLOURS["purple"],
    "dampers": "#8A4F73",
    "actuators": COLOURS["green"],
}
_SPARE = ("#3E7CB1", "#7FB685", "#A0522D", "#9A9A9A", "#5D576B")
_PER_JOULE = 1e3


def energy_groups(energy: xr.Dataset) -> dict[str, FloatArray]:
    """Return stores and losses in mJ/m, in three dimensions in mJ, by what they belong to, innermost first, those that vanish left out."""
    groups: dict[str, FloatArray] = {}
    for role in ("store", "loss"):
        for name, variable in energy.data_vars.items():
            if variable.attrs.get("role") == role:
                values = _PER_JOULE * energy[name].to_numpy()
                group = variable.attrs["group"]
                groups[group] = groups[group] + values if group in groups else values
    shown = {group: values for group, values in groups.items() if np.any(values)}
    return {group: shown[group] for group in group_colours(shown)}


def group_colours(groups: Iterable[str]) -> dict[str, str]:
    """Return the colour of each group, in the order in which they are stacked: what is lost for good last."""
    names = list(groups)
    order = [*_FIXED, *names]
    spare = iter(_SPARE * (len(names) // len(_SPARE) + 1))
    ranked = sorted(names, key=lambda name: (name in ("dampers", "actuators"), order.index(name)))
    return {name: _FIXED.get(name) or next(spare) for name in ranked}


def plot_energy(energy: xr.Dataset, ax: Axes | None = None) -> Axes:
    """Draw stores and losses as stacked areas with the work of the exterior pressure, which they add up to, as a line.

    Parameters
    ----------
    energy : Dataset
        From ``Response.energy``.
    ax : Axes, optional
        Where to draw; a new figure when left out.

    Returns
    -------
    Axes
    """
    time = energy["time"].to_numpy()
    with style():
        if ax is None:
            ax = new_figure(PAGE_WIDTH, 3.6).add_subplot()
        above, below = np.zeros_like(time), np.zeros_like(time)
        groups = energy_groups(energy)
        colours = group_colours(groups)
        for group, values in groups.items():
            # What is given back (actuators that drive) is stacked below zero, or it would hide its neighbours.
            for base, part in ((above, np.maximum(values, 0.0)), (below, np.minimum(values, 0.0))):
                if np.any(part):
                    label = group if base is above or not np.any(values > 0) else None
                    ax.fill_between(time, base, base + part, color=colours[group], linewidth=0.3, edgecolor="white", label=label)
                    base += part
        ax.plot(time, _PER_JOULE * energy["exterior_work"].to_numpy(), color="black", linewidth=1.0, label="work of the exterior pressure")
        ax.axhline(0.0, color="black", linewidth=0.5)
        ax.set_xlabel(TIME_LABEL)
        per_length = energy["exterior_work"].attrs["units"] == "J/m"
        ax.set_ylabel("energy per length (mJ/m)" if per_length else "energy over the whole length (mJ)")
        ax.set_xlim(float(time[0]), float(time[-1]))
        handles, labels = ax.get_legend_handles_labels()
        ax.legend(handles[::-1], labels[::-1], loc="upper left", bbox_to_anchor=(1.0, 1.0), reverse=False)
        largest = float(np.abs(energy["closure_relative"].to_numpy()).max())
        ax.set_title(f"closure within {largest:.1g} of the largest work", loc="right", color=COLOURS["grey"])
    return ax


def figure_energy(energy: xr.Dataset) -> Figure:
    """Return a figure of the energy balance (from ``Response.energy``) alone."""
    with style():
        figure = new_figure()
        plot_energy(energy, figure.subplots())
    return figure
