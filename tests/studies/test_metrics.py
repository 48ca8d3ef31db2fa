"""A metric is the number that the summary, or another reading of the response, gives."""

from __future__ import annotations

import math

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.studies.metrics import metric_names, metrics_of
from coaxshell.studies.reading import MetricSource

SUMMARY = {
    "peak_stress": lambda shell: shell.stress.value,
    "peak_stress_head": lambda shell: shell.stress_head.value,
    "peak_stress_tail": lambda shell: shell.stress_tail.value,
    "rms_stress": lambda shell: shell.stress_rms,
    "peak_displacement_head": lambda shell: shell.displacement_head.value,
    "peak_displacement_tail": lambda shell: shell.displacement_tail.value,
    "peak_relative_displacement": lambda shell: shell.relative_displacement.value,
    "peak_relative_displacement_head": lambda shell: shell.relative_displacement_head.value,
    "peak_relative_displacement_tail": lambda shell: shell.relative_displacement_tail.value,
    "peak_sensor_voltage": lambda shell: shell.sensor_voltage.value,
    "peak_actuator_voltage": lambda shell: shell.actuator_voltage.value,
    "actuator_field_ratio": lambda shell: shell.actuator_voltage.value / shell.actuator_limit,
    "segment_sensor_voltage": lambda shell: shell.sensor_voltage.value,
    "segment_actuator_voltage": lambda shell: shell.actuator_voltage.value,
    "segment_field_ratio": lambda shell: shell.actuator_voltage.value / shell.actuator_limit,
    "stress_truncation": lambda shell: shell.stress_truncation,
}
POINTS = ("peak_sensor_voltage", "peak_actuator_voltage", "actuator_field_ratio")


@pytest.fixture(scope="module")
def response(hybrid, quick):
    return cx.simulate(hybrid, **quick)


@pytest.fixture(scope="module")
def value(response):
    return lambda name: metrics_of([name], response.system)[0](MetricSource(response))


@pytest.mark.parametrize("quantity", SUMMARY)
@pytest.mark.parametrize("place", [("inner", 0), ("outer", 1), ("shells[1]", 1), ("shells.0", 0)], ids=lambda place: place[0])
def test_shell_metrics_are_those_of_the_summary(response, value, place, quantity):
    name, shell = place
    summary = response.summary(segment="point" if quantity in POINTS else None)
    np.testing.assert_allclose(value(f"{name}.{quantity}"), SUMMARY[quantity](summary.shells[shell]), rtol=1e-12)


def test_absorber_metrics(response, value):
    summary = response.summary()
    assert value("absorbers.count") == 25
    assert value("absorbers.mass") == 250
    np.testing.assert_allclose(value("absorbers.peak_displacement"), summary.absorber_displacement, rtol=1e-14)
    np.testing.assert_allclose(value("absorbers.peak_force"), summary.absorber_force, rtol=1e-14)
    np.testing.assert_allclose(value("absorbers.dissipated_energy"), response.energy(1)["damper_dissipation"][-1], rtol=1e-9)


def test_masses(value):
    layers = [(7500, 0.494, 0.497), (2700, 0.497, 0.503), (7500, 0.503, 0.506)]
    inner = sum(density * math.pi * (outside**2 - inside**2) for density, inside, outside in layers)
    np.testing.assert_allclose(value("inner.mass"), inner, rtol=1e-12)
    np.testing.assert_allclose(value("system.mass"), value("inner.mass") + value("outer.mass") + 250, rtol=1e-12)


def test_pressure_is_the_mean_square_over_time(response, value):
    history = response.pressure_rms("interior")
    squares = np.trapezoid(history.to_numpy() ** 2, history["time"].to_numpy())
    np.testing.assert_allclose(value("interior.rms_pressure"), np.sqrt(squares / history["time"].to_numpy()[-1]), rtol=1e-12)


def test_every_listed_name_is_a_metric(hybrid):
    names = metric_names(hybrid)
    found = metrics_of(names, hybrid)
    assert [metric.name for metric in found] == names
    assert len({metric.identity for metric in found}) == len(names)
    assert all(metric.units and metric.long_name for metric in found)


def head_to_tail(response):
    """Return the ratio of the head's stress to the tail's."""
    head, tail = np.abs(response.stress("inner")).max("time").to_numpy()
    return head / tail


@pytest.mark.parametrize("kind", ["pseudo_velocity", "absolute_acceleration", "relative_displacement"])
def test_shock_spectra_are_metrics(response, value, kind):
    spectrum = response.shock_spectrum("outer", np.arange(0.0, 181.0, 5.0), [300.0], kind=kind.replace("_", "-")).values[0]
    np.testing.assert_allclose(value(f"outer.{kind}@300 Hz"), spectrum.max(), rtol=1e-12)
    np.testing.assert_allclose(value(f"shells[1].{kind}_head@300"), spectrum[0], rtol=1e-12)
    np.testing.assert_allclose(value(f"outer.{kind}_tail@0.3 kHz"), spectrum[-1], rtol=1e-12)
    (metric,) = metrics_of([f"outer.{kind}@300 Hz"], response.system)
    assert metric.units == {"pseudo_velocity": "m/s", "absolute_acceleration": "m/s^2", "relative_displacement": "m"}[kind]


BARE = cx.presets.load("bare")


@pytest.fixture(scope="module")
def bare_reading():
    return MetricSource(cx.simulate(BARE, duration=0.4, time_step=0.02, modes=3))


def steady(reading, name):
    return metrics_of([name], reading.system)[0](reading)


def test_answers_at_frequencies_are_metrics(bare_reading):
    head, tail = np.abs(cx.frequency_response(BARE, 400.0, "stress", shell="inner", angle=[0.0, 180.0]).values)
    np.testing.assert_allclose(steady(bare_reading, "inner.stress_head@400 Hz"), head, rtol=1e-12)
    np.testing.assert_allclose(steady(bare_reading, "shells[0].stress_tail@0.4 kHz"), tail, rtol=1e-12)
    assert steady(bare_reading, "inner.stress@400 Hz") >= max(head, tail)
    echo = float(cx.frequency_response(BARE, 400.0, "target_strength"))
    np.testing.assert_allclose(steady(bare_reading, "system.target_strength@400"), echo, rtol=1e-12)
    within = float(cx.frequency_response(BARE, 400.0, "transmission_loss", region="gap"))
    np.testing.assert_allclose(steady(bare_reading, "gap.transmission_loss@400 Hz"), within, rtol=1e-12)


def test_of_a_band_the_power_is_averaged(bare_reading):
    hertz = np.linspace(200.0, 400.0, 201)
    echo = cx.frequency_response(BARE, hertz, "target_strength").values
    np.testing.assert_allclose(
        steady(bare_reading, "system.target_strength@200..400 Hz"), 10 * np.log10(np.mean(10 ** (echo / 10))), rtol=1e-12
    )
    loss = cx.frequency_response(BARE, hertz, "transmission_loss").values
    np.testing.assert_allclose(
        steady(bare_reading, "system.transmission_loss@0.2 kHz..0.4 kHz"), -10 * np.log10(np.mean(10 ** (-loss / 10))), rtol=1e-12
    )


def test_equipment_that_the_shell_feels_is_a_metric(bare_reading):
    found = cx.mounted_spectrum(BARE, "outer", [900.0], 40.0, 180.0, settings=bare_reading.response.settings)
    name = "outer.mounted_pseudo_velocity_tail@900 Hz, 40 kg/m"
    np.testing.assert_allclose(steady(bare_reading, name), float(found["mounted"][0]), rtol=1e-12)
    (metric,) = metrics_of([name], BARE)
    assert metric.units == "m/s"
    assert "40 kg/m mounted at the tail" in metric.long_name


def test_shock_factors_are_metrics_of_charges(bare_reading):
    charge = cx.UnderwaterExplosion(charge_mass=16.0, stand_off=8.0, angle=-60.0)
    struck = BARE.replace(source=charge)
    reading = MetricSource(cx.simulate(struck, duration=0.4, time_step=0.02, modes=3))
    assert steady(reading, "system.hull_shock_factor") == 0.5
    np.testing.assert_allclose(steady(reading, "system.keel_shock_factor"), charge.keel_shock_factor(), rtol=1e-15)
    assert "system.hull_shock_factor" in metric_names(struck)
    assert "system.hull_shock_factor" not in metric_names(BARE)
    with pytest.raises(cx.InputError, match="no source is a charge"):
        metrics_of(["system.hull_shock_factor"], BARE)


def test_functions_of_the_user(response, tmp_path):
    (tmp_path / "mine.py").write_text('def twice(response):\n    """Twice two."""\n    return 4\n\n\ntwice.units = "Pa"\n')
    asked = {"ratio": head_to_tail, "four": f"{tmp_path / 'mine.py'}:twice", "stress": "inner.peak_stress"}
    ratio, four, stress = metrics_of(asked, response.system)
    reading = MetricSource(response)
    assert ratio(reading) == head_to_tail(response)
    assert ratio.long_name == "Return the ratio of the head's stress to the tail's"
    assert (four(reading), four.units, four.long_name) == (4.0, "Pa", "Twice two")
    assert stress.name == "stress"
    with pytest.raises(cx.InputError, match="ZeroDivisionError"):
        metrics_of({"bad": lambda response: 1 / 0}, response.system)[0](reading)


@pytest.mark.parametrize(
    ("asked", "message"),
    [
        (["inner.peak_stres"], r"metrics\[0\]: 'inner.peak_stres' is not a known metric; did you mean 'inner.peak_stress'\?"),
        (["inner.rms_stress", "iner.rms_stress"], r"metrics\[1\].*did you mean 'inner.rms_stress'"),
        (["shells[2].peak_stress"], "not a known metric"),
        (["fluids[7].rms_pressure"], "not a metric of this system"),
        ([], "the list is empty"),
        (["inner.mass", "inner.mass"], "asked for twice"),
        ([3], "is not a metric"),
        ([lambda response: 0.0], "has no name"),
        (["missing.py:f"], "there is no Python file"),
        (["inner.pseudo_velocity@500 kg"], r"metrics\[0\]: '500 kg'"),
        (["inner.pseudo_velocity@0"], r"metrics\[0\]: 0 Hz is not allowed"),
        (["inner.velocity@500 Hz"], "is not a known metric; give inner or another shell with relative_displacement"),
        (["gap.pseudo_velocity@500 Hz"], "is not a known metric; give inner"),
        (["gap.target_strength@500 Hz"], "is not a known metric; give inner"),
        (["system.target_strength@500..100 Hz"], "a band from 500 to 100 Hz is empty"),
        (["system.target_strength@500 kg"], r"metrics\[0\]: '500 kg'"),
        (["inner.mounted_pseudo_velocity_head@500 Hz"], "has no mass"),
        (["inner.mounted_pseudo_velocity_head@500 Hz, 0 kg/m"], "0 kg/m is not allowed"),
        (["inner.mounted_pseudo_velocity@500 Hz, 3"], "is not a known metric"),
    ],
)
def test_bad_metrics(hybrid, asked, message):
    with pytest.raises(cx.InputError, match=message):
        metrics_of(asked, hybrid)


def test_a_metric_needs_its_layer():
    with pytest.raises(cx.InputError, match="needs a shell that has a layer with the role 'actuator'"):
        metrics_of(["inner.peak_actuator_field"], cx.presets.load("iakovlev-double"))
