"""Sweeps drawn: every value where it belongs, units with prefixes, failed cases left out."""

from __future__ import annotations

import json

import numpy as np
import pytest
import xarray as xr

import coaxshell as cx
from coaxshell.plotting import figure_sweep, plot_sweep


def dataset(dims, shape, **coordinates):
    values = np.arange(float(np.prod(shape))).reshape(shape) * 1e6
    values.flat[1] = np.nan
    made = xr.Dataset({"stress": (dims, values, {"units": "Pa", "long_name": "largest"})}, attrs={"metrics": json.dumps(["stress"])})
    return made.assign_coords({k: (d, v, {"units": u}) for k, (d, v, u) in coordinates.items()})


def test_a_curve():
    made = dataset(("n",), (4,), n=("n", [0, 1, 2, 3], "1"))
    ax = plot_sweep(made, "stress")
    np.testing.assert_array_equal(ax.lines[0].get_ydata(), [0, np.nan, 2, 3])
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("n", "stress (MPa)")
    assert plot_sweep(made, "stress", ax=ax) is ax


def test_a_map_on_a_logarithmic_axis():
    made = dataset(("n", "c"), (2, 3), n=("n", [5, 2], "1"), c=("c", [1e4, 1e5, 1e6], "N*s/m^2"))
    figure = figure_sweep(made)
    ax, bar = figure.axes
    (mesh,) = ax.collections
    np.testing.assert_array_equal(mesh.get_array(), np.ma.masked_invalid([[3, 0], [4, np.nan], [5, 2]]))  # n sorted: 2, 5
    assert ax.get_yscale() == "log"
    np.testing.assert_allclose(ax.get_ylim(), [10**3.5, 10**6.5], rtol=1e-12)
    assert (ax.get_xlabel(), ax.get_ylabel(), bar.get_ylabel()) == ("n", "c (N s/m²)", "stress (MPa)")


def test_sampled_points_and_names():
    made = dataset(("case",), (4,), x=("case", [0.1, 0.4, 0.2, 0.3], "m"), kind=("case", ["a", "b", "a", "b"], "1"))
    ax = figure_sweep(made).axes[0]
    np.testing.assert_array_equal(ax.collections[0].get_offsets()[:, 1], [0, 1, 0, 1])
    assert [text.get_text() for text in ax.get_yticklabels()] == ["a", "b"]


def test_what_cannot_be_drawn_is_refused():
    made = dataset(("a", "b", "c"), (2, 1, 1), a=("a", [0, 1], "1"), b=("b", [0], "1"), c=("c", [0], "1"))
    with pytest.raises(cx.InputError, match="3 fields vary"):
        figure_sweep(made)
    with pytest.raises(cx.InputError, match="'strain' is not in this sweep"):
        plot_sweep(made, "strain")
