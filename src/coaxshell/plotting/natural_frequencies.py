"""Natural frequencies by order, or by axial wavenumber (dispersion curves), and the shapes of modes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from coaxshell.errors import InputError
from coaxshell.model.base import shown
from coaxshell.model.loading import SystemLike, as_system
from coaxshell.numerics.late import xarray as xr
from coaxshell.numerics.scalars import plain
from coaxshell.plotting.style import COLOURS, PAGE_WIDTH, new_figure, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

LIGHTLY = 0.05
"""Damping ratio up to which a mode is drawn as a full mark; those with more are open."""
_SHELL_COLOURS = ("blue", "orange", "green", "purple", "sky", "amber", "grey")
_AMPLITUDE = 0.16
"""Largest displacement of a drawn shape, in radii of the outermost shell."""


def figure_natural_frequencies(found: xr.Dataset) -> Figure:
    """Draw what :func:`coaxshell.natural_frequencies` found on a page; see :func:`plot_natural_frequencies`."""
    with style():
        figure = new_figure(PAGE_WIDTH, 3.8)
        plot_natural_frequencies(found, figure.subplots())
    return figure


def plot_natural_frequencies(found: xr.Dataset, ax: Axes | None = None) -> Axes:
    """Draw natural frequencies over the order, dry ones as short lines; of several half wavelengths as dispersion curves.

    A mark is full up to a damping ratio of 5 %, and by order has the colour of the shell that moves most. On dispersion curves a line tells
    which waves are slower than sound outside, k > omega/c: nothing radiates there.

    Parameters
    ----------
    found : Dataset
        From :func:`coaxshell.natural_frequencies`.
    ax : Axes, optional
        Where to draw; a new figure when left out.
    """
    if ax is None:
        with style():
            ax = new_figure().subplots()
    if "axial_half_wavelength" in found.dims:
        _dispersion(found, ax)
    else:
        _by_order(found, ax)
    ax.set_yscale("log")
    ax.set_ylabel("frequency (Hz)")
    return ax


def _by_order(found: xr.Dataset, ax: Axes) -> None:
    names = [str(name) for name in found["shell"].values]
    order = found["order"].values
    frequency, ratio = found["frequency"].values, found["damping_ratio"].values
    here = np.isfinite(frequency)
    most = np.argmax(np.nan_to_num(np.abs(found["shape"].values)), axis=-1)
    places = np.broadcast_to(order[:, None], frequency.shape)
    for shell, name in enumerate(names):
        colour = COLOURS[_SHELL_COLOURS[shell % len(_SHELL_COLOURS)]]
        for full, which in ((True, ratio <= LIGHTLY), (False, ratio > LIGHTLY)):
            marks = here & (most == shell) & which
            face = colour if full else "none"
            label = f"{name} moves most" if full else None
            ax.plot(places[marks], frequency[marks], "o", color=colour, markerfacecolor=face, markersize=4.5, label=label)
        dry = found["dry_frequency"].values[shell]
        at, _ = np.nonzero(np.isfinite(dry))
        ax.plot(order[at], dry[np.isfinite(dry)], "_", color=colour, markersize=11, label=f"{name}, dry")
    ax.plot([], [], "o", color=COLOURS["grey"], markerfacecolor="none", markersize=4.5, label=f"damping above {LIGHTLY:.0%}")
    ax.set_xlabel("circumferential order $m$")
    if order.size <= 25:
        ax.set_xticks(order)
    ax.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))


def _dispersion(found: xr.Dataset, ax: Axes) -> None:
    """Draw frequencies over wavenumbers, marked by the damping, and the line below which waves are slower than sound outside."""
    k, cycle = np.pi / found["axial_half_wavelength"].values, list(COLOURS.values())
    for number, order in enumerate(found["order"].values):
        rows, ratio = (found[name].sel(order=order).values for name in ("frequency", "damping_ratio"))
        places, colour = np.broadcast_to(k[:, None], rows.shape), cycle[number % len(cycle)]
        for full in (True, False):
            marks = np.isfinite(rows) & ((ratio <= LIGHTLY) == full)
            face, label = (colour, f"$m$ = {order}") if full else ("none", None)
            ax.plot(places[marks], rows[marks], "o", color=colour, markerfacecolor=face, markersize=2.2, markeredgewidth=0.6, label=label)
    ax.plot([], [], "o", color=COLOURS["grey"], markerfacecolor="none", markersize=2.2, label=f"damping above {LIGHTLY:.0%}")
    ends = np.array([k.min(), k.max()])
    ax.plot(ends, found.attrs["sound_speed"] * ends / (2.0 * np.pi), "--", color=COLOURS["grey"], linewidth=0.9, label="sound outside")
    ax.set_xscale("log")
    ax.set_xlabel("axial wavenumber (rad/m)")
    ax.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))


def plot_mode_shape(system: SystemLike, found: xr.Dataset, order: int, mode: int = 0, ax: Axes | None = None) -> Axes:
    """Draw the section of a system as one of its modes moves it, over the section at rest.

    The instant is that at which the shell that moves most is farthest out; shells that move later by a quarter of a cycle stand still then.

    Parameters
    ----------
    system : System, str or Path
    found : Dataset
        Its natural frequencies at one half wavelength, or none.
    order : int
        m.
    mode : int
        Number of the mode of that order, from 0.
    ax : Axes, optional

    Raises
    ------
    InputError
        There is no such order or mode, or there are several half wavelengths.
    """
    described = as_system(system)
    if "axial_half_wavelength" in found.dims:
        raise InputError("found", "has several axial half wavelengths", "choose one: found.isel(axial_half_wavelength=0)")
    orders = found["order"].values.tolist()
    if plain(order) not in orders:
        raise InputError("order", f"{shown(order)} was not asked for", f"must be one of {', '.join(map(str, orders))}")
    row = found.sel(order=plain(order))
    count = int(np.isfinite(row["frequency"].values).sum())
    if plain(mode) not in range(count):
        raise InputError("mode", f"order {order} has no mode {shown(mode)}", f"must be below {count}: numbers begin at 0")
    one = row.isel(mode=plain(mode))
    if ax is None:
        with style():
            ax = new_figure(3.4, 3.6).subplots()
    angle = np.linspace(0.0, 2.0 * np.pi, 721)
    for shell, (described_shell, inward) in enumerate(zip(described.shells, np.real(one["shape"].values), strict=True)):
        radius = described_shell.radius / described.reference_radius
        moved = radius - _AMPLITUDE * inward * np.cos(order * angle)
        colour = COLOURS[_SHELL_COLOURS[shell % len(_SHELL_COLOURS)]]
        ax.plot(radius * np.cos(angle), radius * np.sin(angle), color="#BBBBBB", linewidth=0.8)
        ax.plot(moved * np.cos(angle), moved * np.sin(angle), color=colour, linewidth=1.6)
    ax.set_aspect("equal")
    ax.set_axis_off()
    ax.set_title(f"$m$ = {order}: {float(one['frequency']):.4g} Hz, damping {float(one['damping_ratio']):.2g}")
    return ax
