"""A sweep drawn: curves over one field, maps over two, points of a sampled one."""

from __future__ import annotations

import json
import textwrap
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from coaxshell.errors import InputError
from coaxshell.model.naming import suggestion
from coaxshell.numerics.arrays import FloatArray
from coaxshell.plotting.style import COLOURS, PAGE_WIDTH, literal, new_figure, style
from coaxshell.plotting.units import pretty, scale

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_COLUMNS = 2
_LARGEST = 6
_TITLE = 42
CASE = "case"


def figure_sweep(dataset: xr.Dataset, metrics: Sequence[str] = ()) -> Figure:
    """Draw every metric of a sweep in a panel of its own.

    Parameters
    ----------
    dataset : Dataset
        What :func:`coaxshell.sweep` returned, over one or two fields (``dataset.sel(...)`` takes a slice of more).
    metrics : sequence of str
        Which ones; all, six at most, when left out.

    Raises
    ------
    InputError
        A metric is not there, or there are more than two fields.
    """
    known = json.loads(dataset.attrs.get("metrics", "[]"))
    names = list(metrics) or known[:_LARGEST]
    rows, columns = -(-len(names) // _COLUMNS), min(_COLUMNS, len(names))
    with style():
        figure = new_figure(PAGE_WIDTH if columns > 1 else 0.62 * PAGE_WIDTH, 2.7 * rows)
        axes = figure.subplots(rows, columns, squeeze=False).flat
        for ax, name in zip(axes, names, strict=False):
            plot_sweep(dataset, name, ax=ax)
        for ax in list(axes)[len(names) :]:
            ax.remove()
    return figure


@style()
def plot_sweep(dataset: xr.Dataset, metric: str, ax: Axes | None = None) -> Axes:
    """Draw one metric of a sweep and return the axes: a curve or points over one field, a map or coloured points over two.

    Failed cases are left out of curves and points, and grey in maps. The axis of a field is logarithmic where a span with
    ``scale = "log"`` laid it out, and where its values lie in equal ratios or over decades.

    Raises
    ------
    InputError
        The metric is not there, or there are more than two fields.
    """
    known = json.loads(dataset.attrs.get("metrics", "[]"))
    if metric not in known or metric not in dataset:
        raise InputError("metric", f"{metric!r} is not in this sweep", suggestion(metric, known))
    values = dataset[metric]
    fields = [str(name) for name, coordinate in dataset.coords.items() if coordinate.ndim]
    if not 1 <= len(fields) <= 2:
        raise InputError("sweep", f"{len(fields)} fields vary", "one or two can be drawn: take a slice, as in dataset.sel(...)")
    if ax is None:
        ax = new_figure(0.62 * PAGE_WIDTH, 2.9).subplots()
    factor, unit = scale(values.to_numpy(), str(values.attrs.get("units", "")))
    scaled = factor * values.to_numpy()
    label = f"{literal(metric)} ({unit})" if unit else literal(metric)
    if len(fields) == 1:
        x = _axis(ax.xaxis, dataset[fields[0]])
        order = np.argsort(x, kind="stable")
        whole = values.dims == (CASE,)
        ax.plot(x[order], scaled[order], color=COLOURS["blue"], marker="o", markersize=2.6, linestyle="none" if whole else "solid")
        ax.set_ylabel(label)
    else:
        _two(ax, dataset, fields, scaled, label, mapped=values.dims != (CASE,))
    ax.set_title(textwrap.fill(literal(str(values.attrs.get("long_name", ""))), _TITLE), loc="left")
    return ax


def _two(ax: Axes, dataset: xr.Dataset, fields: list[str], scaled: FloatArray, label: str, *, mapped: bool) -> None:
    if mapped:
        fields = [str(name) for name in dataset[fields[0]].dims] + [str(name) for name in dataset[fields[1]].dims]
    x, y = _axis(ax.xaxis, dataset[fields[0]]), _axis(ax.yaxis, dataset[fields[1]])
    if mapped:
        ax.set_facecolor("#BDBDBD")
        right = np.argsort(x, kind="stable"), np.argsort(y, kind="stable")
        table = np.ma.masked_invalid(scaled[np.ix_(*right)].T)
        drawn = ax.pcolormesh(_edges(x[right[0]], ax.get_xscale()), _edges(y[right[1]], ax.get_yscale()), table, cmap="cividis")
        ax.grid(visible=False)
    else:
        drawn = ax.scatter(x, y, c=scaled, cmap="cividis", s=12)  # type: ignore[assignment]
    figure = ax.get_figure()
    if figure is not None:
        figure.colorbar(drawn, ax=ax, label=label)


def _edges(centres: FloatArray, scale: str) -> FloatArray:
    """Return the edges of cells about the centres, halfway between neighbours on the scale of the axis."""
    logarithmic = scale == "log"
    at = np.log(centres) if logarithmic else centres
    if at.size == 1:
        return np.array([centres[0] - 0.5, centres[0] + 0.5])
    middle = 0.5 * (at[:-1] + at[1:])
    edges = np.concatenate([[2 * at[0] - middle[0]], middle, [2 * at[-1] - middle[-1]]])
    return np.exp(edges) if logarithmic else edges


def _axis(axis: object, coordinate: xr.DataArray) -> FloatArray:
    """Label an axis with a field; return its values, those that are no numbers as 0, 1, ... with their names at the ticks."""
    name, unit = literal(str(coordinate.name)), pretty(str(coordinate.attrs.get("units", "1")))
    raw = coordinate.to_numpy()
    if raw.dtype.kind in "OUb":
        names = list(dict.fromkeys(str(value) for value in raw))
        axis.set_ticks(range(len(names)), [literal(name) for name in names])  # type: ignore[attr-defined]
        axis.set_label_text(name)  # type: ignore[attr-defined]
        return np.array([names.index(str(value)) for value in raw], dtype=np.float64)
    values = raw.astype(np.float64)
    axis.set_label_text(name if unit == "1" else f"{name} ({unit})")  # type: ignore[attr-defined]
    if _logarithmic(values, str(coordinate.attrs.get("scale", ""))):
        axis._set_axes_scale("log")  # type: ignore[attr-defined]
    return values


def _logarithmic(values: FloatArray, scale: str) -> bool:
    """Return whether values are spread by their logarithms: as asked for, in equal ratios, or over decades rather than evenly."""
    different = np.unique(values)
    if different.size < 2 or different[0] <= 0:
        return False
    if scale == "log":
        return True
    ratios, steps = different[1:] / different[:-1], np.diff(different)
    geometric = different.size > 2 and ratios.max() < (1 + 1e-3) * ratios.min() and ratios[0] > 1.05  # closer ones are even steps too
    return bool(geometric or (different[-1] >= 30 * different[0] and steps.max() > 4 * steps.min()))
