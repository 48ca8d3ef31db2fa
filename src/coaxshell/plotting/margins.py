"""Loops of feedback: what each order's stands, and Bode and Nyquist of those that stand least."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from coaxshell.numerics.late import xarray as xr
from coaxshell.plotting.style import COLOURS, PAGE_WIDTH, new_figure, style
from coaxshell.response.margins import LoopResponse

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_SHELLS = ("blue", "orange", "green", "purple", "sky", "amber", "grey")
_FAR = 2.5
"""How far from 0 a Nyquist plot reaches: what matters lies by 1."""


def figure_margins(margins: xr.Dataset, worst: list[LoopResponse]) -> Figure:
    """Draw delay margins by order, and size, phase and Nyquist plot of the loop of each shell that stands the least delay.

    Parameters
    ----------
    margins : Dataset
        From :func:`coaxshell.stability_margins`.
    worst : list of LoopResponse
    """
    with style():
        figure = new_figure(PAGE_WIDTH, 5.4)
        delay, nyquist, size, phase = figure.subplots(2, 2).ravel()
        plot_delay_margins(margins, delay)
        plot_nyquist(worst, nyquist)
        plot_bode(worst, size, phase)
    return figure


def plot_delay_margins(margins: xr.Dataset, ax: Axes | None = None) -> Axes:
    """Draw the delay that each order's loop stands, in three dimensions the least of all axial wavenumbers."""
    from matplotlib.ticker import MaxNLocator

    ax = _axes(ax)
    for place, name in enumerate(margins["shell"].values):
        each = margins["delay_margin"].isel(shell=place)
        each = each.min("wavenumber") if "wavenumber" in each.dims else each
        ax.plot(each["order"], 1e6 * each, ".-", color=COLOURS[_SHELLS[place % len(_SHELLS)]], label=str(name))
    if np.isfinite(margins["delay_margin"]).any():
        ax.set_yscale("log")
    cut = margins.attrs.get("segments")
    ax.set_xlabel("circumferential order $m$" if cut is None else f"pattern $q$ of {cut} segments")
    ax.set_ylabel("delay margin (µs)")
    ax.xaxis.set_major_locator(MaxNLocator("auto", steps=[1, 2, 5, 10], integer=True))  # no half orders
    ax.legend()
    return ax


def plot_nyquist(worst: list[LoopResponse], ax: Axes | None = None) -> Axes:
    """Draw L in the complex plane; 1 is where the loop would grow."""
    ax = _axes(ax)
    turn = np.linspace(0.0, 2.0 * np.pi, 200)
    ax.plot(np.cos(turn), np.sin(turn), color=COLOURS["grey"], linewidth=0.6)
    for place, loop in enumerate(worst):
        colour = COLOURS[_SHELLS[place % len(_SHELLS)]]
        ax.plot(loop.values.real, loop.values.imag, color=colour, label=f"{loop.shell}, order {loop.order}{_along(loop)}")
    ax.plot(1.0, 0.0, "+", color=COLOURS["grey"], markersize=9)
    ax.set_xlim(-_FAR, _FAR)
    ax.set_ylim(-_FAR, _FAR)
    ax.set_aspect("equal")
    ax.set_xlabel("Re $L$")
    ax.set_ylabel("Im $L$")
    ax.legend(loc="upper left", frameon=True, framealpha=0.85, edgecolor="none")  # loops run under it
    return ax


def plot_bode(worst: list[LoopResponse], size: Axes, phase: Axes) -> None:
    """Draw size and phase of L over frequency; grey where the size is 1 and the phase 0."""
    for place, loop in enumerate(worst):
        colour, there = COLOURS[_SHELLS[place % len(_SHELLS)]], loop.frequency > 0.0
        size.loglog(loop.frequency[there], np.abs(loop.values[there]), color=colour)
        phase.semilogx(loop.frequency[there], np.degrees(np.angle(loop.values[there])), ".", markersize=1.5, color=colour)
    size.axhline(1.0, color=COLOURS["grey"], linewidth=0.6)
    phase.axhline(0.0, color=COLOURS["grey"], linewidth=0.6)
    size.set_ylabel("$|L|$")
    phase.set_ylabel("phase of $L$ (deg)")
    phase.set_yticks([-180, -90, 0, 90, 180])
    for ax in (size, phase):
        ax.set_xlabel("frequency (Hz)")
        ax.set_xlim(left=min((loop.frequency[loop.frequency > 0.0][0] for loop in worst), default=1.0))


def _along(loop: LoopResponse) -> str:
    return f", $k$ = {loop.wavenumber:.3g}/m" if loop.wavenumber else ""


def _axes(ax: Axes | None) -> Axes:
    if ax is not None:
        return ax
    with style():
        return new_figure().subplots()
