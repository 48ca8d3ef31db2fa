"""Studies in three dimensions: every case is a run of its own, and metrics are the largest over all stations."""

from __future__ import annotations

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.response.spatial import SpatialResponse
from coaxshell.studies.metrics import metric_names, metrics_of, require_readable
from coaxshell.studies.reading import DesignReading, MetricSource

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


@pytest.mark.slow
def test_an_optimisation_and_chances_know_it():
    over = {"source.peak_pressure": (1e4, 2e4)}
    search = {"evaluations": 4, "population": 4, "confirm": {"modes": 9}, "workers": 1}
    best = cx.optimise("bare", variables=over, objectives="outer.peak_axial_stress", **search, **QUICK)
    assert {one.resolution.stations for one in best.confirmations} == {(0.5, 0.0)}
    cx.robustness("bare", {"source.peak_pressure": {"relative": 0.05}}, METRICS[:1], samples=8, workers=1, **QUICK)


POINTS = [cx.PointAbsorber(mass=5.0, damping=1e4, linear_stiffness=1e8, angle=angle, z=0.2) for angle in (40.0, -40.0, 180.0)]


@pytest.fixture(scope="module")
def fitted() -> cx.System:
    return cx.presets.load("active").replace(absorbers=POINTS)


@pytest.fixture(scope="module")
def response(fitted) -> SpatialResponse:
    found = cx.simulate(fitted, **QUICK)
    assert isinstance(found, SpatialResponse)
    return found


def test_every_metric_that_is_offered_is_read(response, fitted):
    reading = MetricSource(response)
    read = {metric.name: metric for metric in metrics_of(metric_names(fitted, 3), fitted)}
    require_readable(list(read.values()), 3)
    values = {name: metric(reading) for name, metric in read.items()}
    assert {"inner.peak_axial_stress", "outer.peak_von_mises_stress", "outer.peak_acceleration"} <= set(values)
    assert not {"interior.rms_pressure", "absorbers.dissipated_energy", "system.mass"} & set(values)
    summary = response.summary()
    assert values["absorbers.count"] == 3
    assert (values["absorbers.mass"], read["absorbers.mass"].units) == (15.0, "kg")
    assert (values["absorbers.peak_force"], read["absorbers.peak_force"].units) == (summary.absorber_force, "N")
    assert values["absorbers.peak_displacement"] == summary.absorber_displacement
    np.testing.assert_allclose(values["absorbers.spacing"], np.radians(80) * 0.5, rtol=1e-12)


def test_voltages_are_the_largest_of_all_stations(response, fitted):
    points, means = response.summary(segment="point"), response.summary()
    names = ["peak_sensor_voltage", "peak_actuator_voltage", "segment_sensor_voltage", "segment_actuator_voltage"]
    metrics = metrics_of([f"outer.{name}" for name in names], fitted)
    found, turned = ([metric(MetricSource(one)) for metric in metrics] for one in (response, response.at([0.0, 0.5])))
    assert found == turned
    keys = [(points, "sensor_voltage"), (points, "actuator_voltage"), (means, "sensor_voltage"), (means, "actuator_voltage")]
    np.testing.assert_allclose(found, [summary.largest[1][key]["value"] for summary, key in keys], rtol=1e-12)
    for summary, key in keys:
        each = [getattr(one.shells[1], key).value for one in summary.each]
        assert max(each) > min(each)


def test_distances_along_the_axis_count_as_those_around(fitted):
    apart = [cx.PointAbsorber(mass=1.0, z=z, angle=angle) for z, angle in ((0.0, 0.0), (0.3, 0.0), (0.3, 350.0))]
    reading = DesignReading(fitted.replace(absorbers=apart))
    np.testing.assert_allclose(reading.absorber_spacing, np.radians(10) * 0.5, rtol=1e-12)
    np.testing.assert_allclose(DesignReading(fitted.replace(absorbers=apart[:2])).absorber_spacing, 0.3, rtol=1e-12)
    np.testing.assert_allclose(DesignReading(fitted.replace(absorbers=apart[:1])).absorber_spacing, np.pi, rtol=1e-12)


@pytest.mark.parametrize("whole", [False, pytest.param(True, marks=pytest.mark.slow)], ids=["swept", "optimised too"])
def test_where_and_how_heavy_point_absorbers_are_can_be_varied(fitted, whole):
    plain, over = fitted.replace(control=None), {"absorbers[0].z": ["20 cm", 0.5]}
    found = cx.sweep(plain, over, ["outer.peak_stress"], workers=1, **QUICK)
    moved = plain.with_overrides({"absorbers[0].z": 0.5})
    largest = [cx.simulate(system, **QUICK).summary().largest[1]["stress"]["value"] for system in (plain, moved)]
    np.testing.assert_array_equal(found["outer.peak_stress"], largest)
    assert largest[0] != largest[1]
    assert found["absorbers[0].z"].attrs["units"] == "m"
    if not whole:
        return
    over = {"absorbers.z": (0.0, 0.6), "absorbers[*].mass": {"from": 1, "to": "9 kg", "each": "mirror"}}
    search = {"evaluations": 4, "population": 4, "workers": 1, "constraints": ["absorbers.mass <= 20 kg"]}
    best = cx.optimise(plain, variables=over, objectives="outer.peak_stress", **search, **QUICK)
    z, pair, alone = best.best.values
    fits = best.system.point_absorbers
    assert [one.z for one in fits] == [z] * 3
    assert [one.mass for one in fits] == [pair, pair, alone]
    assert 2 * pair + alone <= 20.0


@pytest.mark.parametrize(
    ("metric", "changes", "told"),
    [
        ("interior.rms_pressure", {}, r"^interior\.rms_pressure: is not read in three dimensions"),
        ("absorbers.dissipated_energy", {}, r"^absorbers\.dissipated_energy: is not read in three dimensions"),
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


@pytest.mark.parametrize(
    ("metric", "told"),
    [
        ("system.mass", r"^metrics\[0\]: 'system\.mass': masses at points and masses per metre do not add up; use absorbers\.mass \(kg\)"),
        ("absorbers.dissipated_energy", r"^metrics\[0\]: .* is not read of point absorbers"),
    ],
)
def test_what_points_do_not_have_is_refused(fitted, metric, told):
    with pytest.raises(cx.InputError, match=told):
        cx.sweep(fitted, OVER, [metric], workers=1, **QUICK)


def test_systems_that_three_dimensions_do_not_know_are_refused():
    saturating = cx.presets.load("hybrid")
    saturating = saturating.replace(control=saturating.control.replace(saturation=True))
    with pytest.raises(cx.InputError, match=r"saturation: .*are cut at their limit in two dimensions alone"):
        cx.sweep(saturating, OVER, METRICS[:1], workers=1, **QUICK)


@pytest.mark.slow
def test_line_absorbers_are_varied_and_read():
    system = cx.presets.load("bare").replace(absorbers=cx.absorber_ring(4, mass=20.0, damping=1e4, linear_stiffness=1e8))
    metrics = ["absorbers.mass", "absorbers.peak_force", "absorbers.peak_displacement", "outer.peak_stress"]
    found = cx.sweep(system, {"absorbers.count": [4, 5]}, metrics, workers=1, **QUICK)
    for count in (4, 5):
        case, response = found.sel({"absorbers.count": count}), cx.simulate(system.replace_path("absorbers.count", count), **QUICK)
        assert float(case["absorbers.mass"]) == 20.0 * count
        np.testing.assert_allclose(case["absorbers.peak_force"], abs(response.absorber_force()).max(), rtol=1e-9)
        np.testing.assert_allclose(case["absorbers.peak_displacement"], abs(response.absorber_displacement()).max(), rtol=1e-9)
