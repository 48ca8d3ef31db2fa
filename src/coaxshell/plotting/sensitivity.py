"""Uncertain properties drawn: indices as bars with their intervals, metrics as distributions with their percentiles."""

from __future__ import annotations

import json
import textwrap
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from coaxshell.errors import InputError
from coaxshell.model.naming import suggestion
from coaxshell.numerics.arrays import FloatArray
from coaxshell.plotting.style import COLOURS, PAGE_WIDTH, literal, new_figure, style
from coaxshell.plotting.units import scale

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_LARGEST = 6
_TITLE = 42
_HALF = 0.38
_ORDERS = (("first_order", "alone (first order)", "blue", -0.5), ("total_order", "with others (total order)", "amber", 0.5))


def figure_sensitivity(dataset: xr.Dataset, metrics: Sequence[str] = ()) -> Figure:
    """Draw the indices of every metric in a panel of its own, or its distribution where there are no indices.

    Parameters
    ----------
    dataset : Dataset
        What :func:`coaxshell.sensitivity` or :func:`coaxshell.robustness` returned.
    metrics : sequence of str
        Which ones; all, six at most, when left out.

    Raises
    ------
    InputError
        A metric is not there, or runs have failed and there is nothing to draw.
    """
    names = list(metrics) or json.loads(dataset.attrs.get("metrics", "[]"))[:_LARGEST]
    indices = "first_order" in dataset
    plot: Callable[[xr.Dataset, str, Axes], Axes] = plot_sensitivity if indices else plot_distribution
    height = 0.9 + 0.3 * dataset.sizes.get("field", 0) if indices else 2.6
    columns = min(2, len(names))
    rows = -(-len(names) // columns)
    with style():
        figure = new_figure(PAGE_WIDTH if columns > 1 else 0.72 * PAGE_WIDTH, height * rows + (0.35 if indices else 0.0))
        axes = list(figure.subplots(rows, columns, squeeze=False, sharey=indices).flat)
        for ax, name in zip(axes, names, strict=False):
            plot(dataset, name, ax)
        for ax in axes[len(names) :]:
            ax.remove()
        if indices:
            legend = axes[0].get_legend_handles_labels()
            figure.legend(*legend, loc="outside upper center", ncols=2)
    return figure


@style()
def plot_sensitivity(dataset: xr.Dataset, metric: str, ax: Axes | None = None) -> Axes:
    """Draw the first- and total-order indices of one metric as bars with their intervals, and return the axes.

    Raises
    ------
    InputError
        The metric is not there, does not vary, or runs have failed.
    """
    _known(dataset, metric)
    if "first_order" not in dataset or bool(dataset["first_order"].sel(metric=metric).isnull().any()):
        raise InputError(
            "metric", f"{metric!r} has no indices", "give one that varies, of a study with indices none of whose runs has failed"
        )
    if ax is None:
        ax = new_figure(0.72 * PAGE_WIDTH, 1.2 + 0.3 * dataset.sizes["field"]).subplots()
    places = np.arange(dataset.sizes["field"])
    for name, label, colour, side in _ORDERS:
        value, low, high = dataset[name].sel(metric=metric).to_numpy().T
        reach = np.maximum(np.stack([value - low, high - value]), 0.0)
        bars = {"ecolor": "#333333", "capsize": 2.0, "error_kw": {"elinewidth": 0.8, "capthick": 0.8}}
        ax.barh(places + side * _HALF, value, _HALF, xerr=reach, color=COLOURS[colour], label=label, **bars)  # type: ignore[arg-type]
    ax.set_yticks(places, [literal(str(path)) for path in dataset["field"].to_numpy()])
    ax.set_ylim(len(places) - 0.4, -0.6)  # the first field on top
    ax.set_xlim(min(0.0, ax.get_xlim()[0]), max(1.0, ax.get_xlim()[1]))
    ax.axvline(0.0, color="#333333", linewidth=0.6)
    ax.grid(visible=False, axis="y")
    ax.set_xlabel("share of the variance")
    ax.set_title(literal(metric), loc="left")
    return ax


@style()
def plot_distribution(dataset: xr.Dataset, metric: str, ax: Axes | None = None) -> Axes:
    """Draw how one metric is distributed over the runs, with its mean and percentiles and their intervals; return the axes.

    Raises
    ------
    InputError
        The metric is not there, or runs have failed.
    """
    _known(dataset, metric)
    values = dataset[f"runs.{metric}"].to_numpy()[: _sample(dataset)]
    if not np.isfinite(values).all():
        raise InputError(
            "metric", f"{metric!r} has no distribution, since runs have failed", "see the variable failure for why, and resume the study"
        )
    if ax is None:
        ax = new_figure(0.62 * PAGE_WIDTH, 2.6).subplots()
    factor, unit = scale(values, str(dataset[metric].attrs.get("units", "")))
    shares = (np.arange(values.size) + 0.5) / values.size
    ax.step(factor * np.sort(values), 100 * shares, where="mid", color=COLOURS["blue"], label="runs")
    for share, name in ((5, "p5"), (50, "p50"), (95, "p95")):
        value, low, high = factor * dataset[metric].sel(statistic=name).to_numpy()
        reach: FloatArray = np.array([[value - low], [high - value]])
        label = "percentiles" if share == 50 else None
        ax.errorbar([value], [share], xerr=reach, fmt="o", color=COLOURS["orange"], capsize=2.5, markersize=3.5, label=label)
    mean = float(factor * dataset[metric].sel(statistic="mean", estimate="value"))
    ax.axvline(mean, color=COLOURS["grey"], linestyle=(0, (4, 1.5)), label="mean")
    ax.set_ylim(0, 100)
    ax.set_xlabel(f"{literal(metric)} ({unit})" if unit else literal(metric))
    ax.set_ylabel("runs below (%)")
    ax.set_title(textwrap.fill(literal(str(dataset[metric].attrs.get("long_name", ""))), _TITLE), loc="left")
    ax.legend(loc="lower right")
    return ax


def _sample(dataset: xr.Dataset) -> int:
    """Return how many runs, from the first, are draws of the distributions: the blocks A and B where there are indices."""
    return int(dataset.attrs["samples"]) * (2 if "first_order" in dataset else 1)


def _known(dataset: xr.Dataset, metric: str) -> None:
    known = json.loads(dataset.attrs.get("metrics", "[]"))
    if metric not in known or metric not in dataset:
        raise InputError("metric", f"{metric!r} is not in this study", suggestion(metric, known))
