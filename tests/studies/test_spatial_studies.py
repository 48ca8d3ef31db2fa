"""Studies in three dimensions: every case is a run of its own, and metrics are the largest over all stations."""

from __future__ import annotations

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.response.spatial import SpatialResponse

QUICK = {"duration": 1.0, "time_step": 2e-2, "modes": 8, "dimensions": 3, "stations": [0.5, 0.0]}
OVER = {"source.peak_pressure": [1e4, 2e4]}
METRICS = ["inner.peak_stress", "outer.peak_axial_stress", "inner.peak_von_mises_stress", "outer.rms_stress", "outer.mass"]


def test_a_sweep_reads_the_largest_of_all_stations():
    found = cx.sweep("bare", OVER, METRICS, workers=1, **QUICK)
    response = cx.simulate("bare", **QUICK)
    assert isinstance(response, SpatialResponse)
    inner, outer = response.summary().largest
    for metric, largest in (
        ("inner.peak_stress", inner["stress"]),
        ("outer.peak_axial_stress", outer["axial_stress"]),
        ("inner.peak_von_mises_stress", inner["von_mises_stress"]),
    ):
        value = float(found[metric].sel({"source.peak_pressure": 1e4}))
        own = cx.presets.load("bare").source.peak_pressure
        np.testing.assert_allclose(value * own / 1e4, largest["value"], rtol=1e-9)
    np.testing.assert_allclose(found["outer.rms_stress"][1], 2 * found["outer.rms_stress"][0], rtol=1e-9)


def test_an_optimisation_and_chances_know_it():
    over = {"source.peak_pressure": (1e4, 2e4)}
    search = {"evaluations": 4, "population": 4, "confirm": {"modes": 9}, "workers": 1}
    best = cx.optimise("bare", variables=over, objectives="outer.peak_axial_stress", **search, **QUICK)
    assert {one.resolution.stations for one in best.confirmations} == {(0.5, 0.0)}
    cx.robustness("bare", {"source.peak_pressure": {"relative": 0.05}}, METRICS[:1], samples=8, workers=1, **QUICK)


@pytest.mark.parametrize(
    ("metric", "changes", "told"),
    [
        ("interior.rms_pressure", {}, r"^interior\.rms_pressure: is not read in three dimensions"),
        ("absorbers.count", {}, r"^absorbers\.count: is not read in three dimensions"),
        (
            "inner.peak_axial_stress",
            {"dimensions": 2, "stations": (0.0,)},
            r"^inner\.peak_axial_stress: is read at stations of a run in three",
        ),
    ],
)
def test_metrics_of_other_dimensions_are_refused(metric, changes, told):
    with pytest.raises(cx.InputError, match=told):
        cx.sweep("bare", OVER, [metric], workers=1, **{**QUICK, **changes})


def test_systems_that_three_dimensions_do_not_know_are_refused():
    with pytest.raises(cx.InputError, match=r"line absorbers are uniform along the axis"):
        cx.sweep("hybrid", OVER, METRICS[:1], workers=1, **QUICK)
