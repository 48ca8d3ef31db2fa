"""Uncertain properties drawn: bars where the indices are, percentiles where the runs are, nothing where runs failed."""

from __future__ import annotations

import json

import numpy as np
import pytest
import xarray as xr

import coaxshell as cx
from coaxshell.plotting import figure_sensitivity, plot_distribution, plot_sensitivity

FIRST = np.array([[0.6, 0.5, 0.7], [0.1, -0.02, 0.2]])


VALUES = np.arange(8.0) * 1e6


def dataset(indices=True, values=VALUES):
    statistics = np.array([np.mean(values), 1e6, 0.5e6, 3.5e6, 6.5e6])
    made = xr.Dataset(
        {
            "stress": (("statistic", "estimate"), np.stack([statistics] * 3, axis=1), {"units": "Pa", "long_name": "largest"}),
            "runs.stress": ("case", values, {"units": "Pa"}),
        },
        {"statistic": ["mean", "deviation", "p5", "p50", "p95"], "estimate": ["value", "low", "high"]},
        {"metrics": json.dumps(["stress"]), "samples": 4 if indices else 8, "confidence": 0.95},
    )
    if indices:
        made = made.assign_coords(metric=["stress"], field=["a.b", "c.d"])
        made["first_order"] = (("metric", "field", "estimate"), FIRST[None])
        made["total_order"] = (("metric", "field", "estimate"), FIRST[None] + 0.1)
    return made


def test_bars_and_their_intervals():
    ax = plot_sensitivity(dataset(), "stress")
    assert [bar.get_width() for bar in ax.patches] == [0.6, 0.1, 0.7, 0.2]
    ends = [line.get_segments()[0][:, 0] for line in ax.collections]
    np.testing.assert_allclose(ends[0], [0.5, 0.7], rtol=1e-12)
    assert [text.get_text() for text in ax.get_yticklabels()] == ["a.b", "c.d"]
    assert ax.get_ylim()[0] > ax.get_ylim()[1]  # the first one on top
    assert plot_sensitivity(dataset(), "stress", ax=ax) is ax
    assert len(figure_sensitivity(dataset()).axes) == 1


def test_a_distribution_with_its_percentiles():
    ax = figure_sensitivity(dataset(indices=False)).axes[0]
    assert ax.get_xlabel() == "stress (MPa)"
    np.testing.assert_allclose(ax.lines[0].get_xdata(), np.arange(8.0), rtol=1e-12)
    np.testing.assert_allclose(ax.lines[0].get_ydata()[[0, -1]], [6.25, 93.75], rtol=1e-12)
    assert plot_distribution(dataset(), "stress", ax=ax) is ax


def test_what_cannot_be_drawn_is_refused():
    with pytest.raises(cx.InputError, match="'strain' is not in this study"):
        plot_sensitivity(dataset(), "strain")
    with pytest.raises(cx.InputError, match="has no indices"):
        plot_sensitivity(dataset(indices=False), "stress")
    with pytest.raises(cx.InputError, match="runs have failed"):
        plot_distribution(dataset(indices=False, values=np.array([1.0, np.nan])), "stress")
