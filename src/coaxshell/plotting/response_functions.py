"""Response functions of a fluid region: curves of several orders over a map of all orders, with the arrivals of the fronts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.plotting.histories import TIME_LABEL
from coaxshell.plotting.style import COLOURS, PAGE_WIDTH, new_figure, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.colors import Colormap
    from matplotlib.figure import Figure
    from matplotlib.image import AxesImage

_MOST_FRONTS = 24


@dataclass(frozen=True, eq=False)
class ResponseFunction:
    """One function of all orders from 0, to be drawn.

    Attributes
    ----------
    title : str
    time : ndarray, shape (T,)
    values : ndarray, shape (orders, T)
        Of the orders 0, 1, 2, ...; infinite values are left out.
    growth : float
        Slope in time of the mean of order 0, which a closed volume has; the curve is drawn without it.
    fronts : sequence of (float, bool)
        Arrivals and whether they are logarithms instead of jumps.
    """

    title: str
    time: FloatArray
    values: FloatArray
    growth: float
    fronts: Sequence[tuple[float, bool]]


def figure_response_functions(functions: Sequence[ResponseFunction], modes: Sequence[int]) -> Figure:
    """Draw each function in one column: curves of *modes* above, time and order below.

    Parameters
    ----------
    functions : sequence of ResponseFunction
        One, or two side by side.
    modes : sequence of int
        Orders drawn as curves, at most seven.
    """
    with style():
        figure = new_figure(PAGE_WIDTH, 5.6)
        axes = figure.subplots(2, len(functions), squeeze=False, sharex="col", sharey="row", height_ratios=(1.0, 0.95))
        shown = [np.where(np.isfinite(each.values), each.values, np.nan) for each in functions]
        for values, each in zip(shown, functions, strict=True):
            values[0] -= each.growth * each.time * (each.time >= each.fronts[0][0] if each.fronts else 0.0)
        largest = max(float(np.nanpercentile(np.abs(values), 99.0)) for values in shown) or 1.0
        for column, (values, each) in enumerate(zip(shown, functions, strict=True)):
            top, bottom = axes[0, column], axes[1, column]
            _curves(top, values, each, modes)
            image = _map(bottom, values, each, largest)
            letter = f"{'abcd'[column]}  " if len(functions) > 1 else ""
            top.set_title(letter + each.title, loc="left", fontweight="bold")
            bottom.set_xlabel(TIME_LABEL)
        axes[0, 0].set_ylabel("response function")
        axes[1, 0].set_ylabel("order $m$")
        axes[0, 0].set_ylim(*_limits([values[list(modes)] for values in shown]))
        figure.colorbar(image, ax=axes[1, :].tolist(), extend="both", pad=0.015, aspect=22, label="response function")
        handles, labels = axes[0, 0].get_legend_handles_labels()
        figure.legend(
            handles,
            labels,
            loc="outside lower center",
            ncols=min(len(labels), 6 if len(labels) < 7 else 5),
            columnspacing=1.4,
            handlelength=1.6,
        )
    return figure


def _curves(ax: Axes, values: FloatArray, function: ResponseFunction, modes: Sequence[int]) -> None:
    colours = [COLOURS[name] for name in ("blue", "orange", "green", "purple", "sky", "amber", "grey")]
    _mark(ax, function)
    ax.axhline(0.0, color=COLOURS["grey"], linewidth=0.6, zorder=1)
    for colour, mode in zip(colours, modes, strict=False):
        label = f"$m$ = {mode}" + (", growth removed" if mode == 0 and function.growth else "")
        ax.plot(function.time, values[mode], color=colour, linewidth=1.0, label=label)
    ax.set_xlim(float(function.time[0]), float(function.time[-1]))


def _map(ax: Axes, values: FloatArray, function: ResponseFunction, largest: float) -> AxesImage:
    step = float(function.time[1] - function.time[0])
    extent = (float(function.time[0]) - 0.5 * step, float(function.time[-1]) + 0.5 * step, -0.5, values.shape[0] - 0.5)
    image = ax.imshow(
        values, aspect="auto", origin="lower", extent=extent, cmap=diverging_map(), vmin=-largest, vmax=largest, interpolation="antialiased"
    )
    ax.set(xlim=(float(function.time[0]), float(function.time[-1])))
    ax.grid(visible=False)
    for front, _ in _drawn(function):
        ax.plot([front], [1.0], marker="v", markersize=4.0, color="black", clip_on=False, transform=ax.get_xaxis_transform(), zorder=5)
    return image


def _mark(ax: Axes, function: ResponseFunction) -> None:
    seen: set[bool] = set()
    for front, logarithm in _drawn(function):
        name = ("front, a logarithm" if logarithm else "front") if logarithm not in seen else None
        seen.add(logarithm)
        ax.axvline(front, color=COLOURS["grey"], linewidth=0.7, linestyle=":" if logarithm else (0, (5, 2)), label=name, zorder=1.5)


def _drawn(function: ResponseFunction) -> Sequence[tuple[float, bool]]:
    return function.fronts if len(function.fronts) <= _MOST_FRONTS else ()


def _limits(curves: Sequence[FloatArray]) -> tuple[float, float]:
    """Return limits that leave out what is only reached beside logarithms."""
    every = np.concatenate([values.ravel() for values in curves])
    low, high = (float(value) for value in np.nanpercentile(every, (0.15, 99.85)))
    room = 0.08 * (high - low) or 1.0
    return low - room, high + room


def diverging_map() -> Colormap:
    """Return blue, white, red with equal steps of lightness and of colour: straight lines in CIELAB."""
    from matplotlib.colors import ListedColormap

    ends = (np.array([38.0, 6.0, -46.0]), np.array([38.0, 52.0, 30.0]))
    middle = np.array([97.0, 0.0, 0.0])
    part = np.linspace(0.0, 1.0, 128)[:, None]
    lab = np.concatenate([ends[0] + part * (middle - ends[0]), middle + part * (ends[1] - middle)])
    return ListedColormap(_rgb(lab).tolist(), name="lab_blue_red")


def _rgb(lab: FloatArray) -> FloatArray:
    """Return sRGB of CIELAB colours under D65."""
    y = (lab[:, 0] + 16.0) / 116.0
    f = np.stack([y + lab[:, 1] / 500.0, y, y - lab[:, 2] / 200.0], axis=1)
    xyz = np.where(f > 6.0 / 29.0, f**3, 3.0 * (6.0 / 29.0) ** 2 * (f - 4.0 / 29.0)) * np.array([0.95047, 1.0, 1.08883])
    linear = xyz @ np.array([[3.2406, -0.9689, 0.0557], [-1.5372, 1.8758, -0.2040], [-0.4986, 0.0415, 1.0570]])
    linear = np.clip(linear, 0.0, 1.0)
    return np.asarray(np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055), dtype=np.float64)
