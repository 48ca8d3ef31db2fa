"""``coaxshell.sweep``: the same numbers as single runs, labelled; bad studies told before the first case."""

from __future__ import annotations

import json

import numpy as np
import pytest
import xarray as xr

import coaxshell as cx
from coaxshell.studies.span import Span
from coaxshell.studies.varied_fields import Field, field_of

STRESS = ["inner.peak_stress"]


def test_a_grid_is_labelled_and_holds_what_single_runs_give(hybrid, quick):
    over = {"absorbers.count": range(0, 7, 3), "source.peak_pressure": ["10 kPa", 2e4]}
    found = cx.sweep(hybrid, over, [*STRESS, "absorbers.mass"], workers=1, **quick)
    assert found["inner.peak_stress"].dims == ("absorbers.count", "source.peak_pressure")
    assert found["source.peak_pressure"].attrs["units"] == "Pa"
    assert found["inner.peak_stress"].attrs["units"] == "Pa"
    assert (found["failure"] == "").all()
    assert json.loads(found.attrs["settings"])["modes"] == 6
    assert cx.System.from_toml_string(found.attrs["scenario"]) == hybrid
    np.testing.assert_array_equal(found["absorbers.mass"].sel({"source.peak_pressure": 1e4}), [0, 30, 60])
    for count in (0, 3, 6):
        for pressure in (1e4, 2e4):
            system = hybrid.with_overrides({"absorbers.count": count, "source.peak_pressure": pressure})
            peak = cx.simulate(system, **quick).summary().shells[0].stress.value
            value = found["inner.peak_stress"].sel({"absorbers.count": count, "source.peak_pressure": pressure})
            np.testing.assert_allclose(float(value), peak, rtol=1e-9)


def test_zipped_lists_and_functions(hybrid, quick):
    over = {"absorbers.mass": np.array([5.0, 10.0]), "control.saturation": [False, True]}
    found = cx.sweep(hybrid, over, {"tail": lambda r: float(abs(r.stress("outer", 180)).max())}, points="zip", workers=1, **quick)
    assert found["tail"].dims == ("case",)
    expected = [
        cx.simulate(hybrid.with_overrides({"absorbers.mass": m, "control.saturation": s}), **quick).summary().shells[1].stress_tail.value
        for m, s in ((5, False), (10, True))
    ]
    np.testing.assert_allclose(found["tail"], expected, rtol=1e-9)


@pytest.mark.slow_for("sobol")
@pytest.mark.parametrize("points", ["latin-hypercube", "sobol"])
def test_sampled_points_fill_the_box_and_repeat(hybrid, quick, points):
    over = {"absorbers.count": (1, 4), "absorbers.damping": {"from": 1e4, "to": 1e8, "scale": "log"}}
    options = {"points": points, "samples": 16, "workers": 1, **quick}
    first, again, other = (cx.sweep(hybrid, over, ["absorbers.mass"], seed=seed, **options) for seed in (3, 3, 4))
    xr.testing.assert_identical(first, again)
    assert not np.array_equal(first["absorbers.damping"], other["absorbers.damping"])
    assert (np.bincount(first["absorbers.count"], minlength=5) == [0, 4, 4, 4, 4]).all()
    decades = np.floor(np.log10(first["absorbers.damping"]))
    assert (np.bincount(decades.astype(int))[4:] == 4).all()


def test_failures_are_nan_with_reasons_and_one_grouped_warning(hybrid, quick):
    over = {"shells[0].radius": [0.4, 0.5, 0.995, 1.2], "absorbers.mass": [5, 10]}
    with pytest.warns(cx.PhysicsWarning, match=r"4 of 8 cases failed .* 4 like case 4: shells\[1\]\.radius: ") as told:
        found = cx.sweep(hybrid, over, STRESS, workers=1, **quick)
    assert len([one for one in told if "cases failed" in str(one.message)]) == 1
    failed = found["failure"] != ""
    np.testing.assert_array_equal(np.isnan(found["inner.peak_stress"]), failed)
    np.testing.assert_array_equal(failed.all("absorbers.mass"), [False, False, True, True])


def test_processes_give_the_same_bits_and_netcdf_keeps_them(hybrid, quick, tmp_path):
    over = {"absorbers.count": range(8)}
    alone = cx.sweep(hybrid, over, STRESS, workers=1, **quick)
    fractions = []
    shared = cx.sweep(hybrid, over, STRESS, workers=2, progress=lambda f, s: fractions.append(f), **quick)
    xr.testing.assert_identical(alone, shared)
    assert fractions == sorted(fractions)
    assert fractions[-1] == 1
    shared.to_netcdf(tmp_path / "sweep.nc", engine="h5netcdf")
    xr.testing.assert_identical(xr.load_dataset(tmp_path / "sweep.nc", engine="h5netcdf"), shared)


@pytest.mark.parametrize(
    ("over", "options", "message"),
    [
        ({"source.peak_presure": [1e4]}, {}, r"over\.source\.peak_presure: .*did you mean 'peak_pressure'"),
        ({"absorbers.mass": []}, {}, "over.absorbers.mass: the range is empty"),
        ({"absorbers.count": range(5, 5)}, {}, "over.absorbers.count: the range is empty"),
        ({"absorbers.mass": {"from": 5, "to": 1, "count": 3}}, {}, "over.absorbers.mass: the range from 5.0 to 1.0 is empty"),
        ({"absorbers.mass": [1, "2 m"]}, {}, r"over.absorbers.mass\[1\]: '2 m' is not a mass per metre of length"),
        ({"absorbers.mass": {"from": "1 s", "to": 2, "count": 3}}, {}, "over.absorbers.mass.from: '1 s' is not a mass"),
        ({"absorbers.mass": {"from": 1, "to": 2, "number": 3}}, {}, "over.absorbers.mass.number: is not an entry"),
        ({"absorbers.mass": {"from": 1, "to": 2}}, {}, "needs either count or step"),
        ({"absorbers.mass": {"from": 0, "to": 2, "count": 3, "scale": "log"}}, {}, "has no logarithm"),
        ({"absorbers.mass": 5}, {}, "5 is not a list"),
        ({"absorbers.count": [1.5]}, {}, "is not a count"),
        ({"absorbers.mass": [1, 2], "absorbers.count": [3]}, {"points": "zip"}, "lists differ in length"),
        ({"absorbers.mass": [1]}, {"points": "gird"}, "points: 'gird' is unknown; did you mean 'grid'"),
        ({"absorbers.mass": (1, 2)}, {"points": "sobol"}, "samples: None is not allowed"),
        ({"absorbers.mass": [1, 2, 3]}, {"points": "sobol", "samples": 4}, "are not two ends"),
        ({"absorbers.mass": [1]}, {"metrics": ["inner.peak"]}, r"metrics\[0\]: 'inner.peak' is not a known metric"),
        ({"absorbers.mass": [1]}, {"modes": 0}, "modes: 0 is not allowed"),
        ({"absorbers.mass": [1]}, {"workers": 0}, "workers: 0 is not allowed"),
        ({"shells[0].radius": [2, 3]}, {}, "no case is possible"),
        ({}, {}, "nothing to vary"),
        ({"absorbers.mass": [1]}, {"metrics": {"f": lambda r: 1.0}, "workers": 2}, "cannot be sent to another process"),
    ],
)
def test_bad_studies(hybrid, quick, over, options, message, tmp_path):
    store = tmp_path / "store"
    with pytest.raises(cx.InputError, match=message):
        cx.sweep(hybrid, over, **{"metrics": STRESS, "workers": 1, "store": store, **quick, **options})
    assert not any(path.name != "study.json" for path in store.glob("*"))


def test_a_million_points_of_a_span_are_checked_by_their_ends_alone(monkeypatch):
    field = field_of(cx.presets.load("bare"), "source.peak_pressure")
    asked = []
    value = Field.value
    monkeypatch.setattr(Field, "value", lambda self, given, where: asked.append(given) or value(self, given, where))
    shares = np.linspace(0.0, 1.0, 1_000_000).tolist()
    found = Span(start="1 kPa", to="4 kPa", scale="log").at(shares, field, "over")
    assert asked == ["1 kPa", "4 kPa"]
    assert found[0] == 1e3
    assert found[-1] == pytest.approx(4e3)
    assert found[500_000] == pytest.approx(2e3, rel=1e-5)
