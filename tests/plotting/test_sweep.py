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


@pytest.mark.parametrize("values", [[10, 100 / 3, 10 / 3, 1], [1, 2, 4], [5e3, 7e3, 9.8e3], [0.01, 0.02, 5]])
def test_equal_ratios_and_decades_are_drawn_on_a_logarithmic_axis(values):
    made = dataset(("c",), (len(values),), c=("c", [float(value) for value in values], "N"))
    assert plot_sweep(made, "stress").get_xscale() == "log"


@pytest.mark.parametrize("values", [[1, 2, 3], [0, 1, 10, 100], [-1, 1, 100], [1.0, 1.001, 1.002], [1, 8], [3]])
def test_even_steps_zeros_signs_and_pairs_are_drawn_on_a_linear_axis(values):
    made = dataset(("n", "c"), (2, len(values)), n=("n", [1, 2], "1"), c=("c", values, "1"))
    assert plot_sweep(made, "stress").get_yscale() == "linear"


@pytest.mark.parametrize(
    ("over", "how"),
    [
        ({"absorbers.mass": {"from": "1 kg/m", "to": "20 kg/m", "count": 2, "scale": "log"}}, {}),
        ({"absorbers.count": {"from": 2, "to": 9, "count": 4, "scale": "log"}}, {}),  # rounded: no equal ratios any more
        ({"absorbers.mass": {"from": 1, "to": 20, "scale": "log"}}, {"points": "sobol", "samples": 4}),
        ({"absorbers.mass": {"from": 1, "to": 20, "scale": "log"}}, {"points": "latin-hypercube", "samples": 3}),
    ],
)
def test_a_span_laid_out_by_its_logarithm_is_drawn_so(over, how):
    system, fast = cx.presets.load("absorbers"), {"modes": 3, "time_step": 0.05, "duration": 0.3, "workers": 1}
    (path,) = over
    found = cx.sweep(system, over, ["inner.peak_stress"], **how, **fast)
    assert found[path].attrs["scale"] == "log"
    metric = json.loads(found.attrs["metrics"])[0]
    assert plot_sweep(found, metric).get_xscale() == "log"
    over[path].pop("scale")
    even = cx.sweep(system, over, ["inner.peak_stress"], **how, **fast)
    assert "scale" not in even[path].attrs
    assert plot_sweep(even, metric).get_xscale() == "linear"


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
