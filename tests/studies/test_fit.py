"""Properties identified from histories whose truth is known: values, intervals, what cannot be told, and what is refused."""

from __future__ import annotations

import json

import numpy as np
import pytest
from numpy.testing import assert_allclose

import coaxshell as cx
from coaxshell.apps.cli import main
from coaxshell.plotting import figure_fit
from coaxshell.response.strain import hoop_strain
from coaxshell.studies import FIT_PARTS
from coaxshell.studies.fitting.certainty import certainty, correlation_time

COARSE = {"modes": 6, "time_step": 0.02}
DRAWING = cx.presets.load("bare")
TRUTH = DRAWING.with_overrides({"source.distance": 5.4, "fluids[1].sound_speed": 1390.0})
TIME = np.arange(0.0, 7e-4, 7e-6)
BLANK = {"time": TIME, "values": 0.0 * TIME}


@pytest.fixture(scope="module")
def records():
    """A strain and an acceleration on clocks of their own, without noise."""
    run = cx.simulate(TRUTH, duration=1.4, **COARSE)
    strain = cx.Measurement(quantity="strain", shell="outer", depth="outer", name="SG", clock_range="0.1 ms", **BLANK)
    motion = cx.Measurement(quantity="acceleration", shell="inner", angle=30, name="ACC", clock=2e-5, **BLANK)
    return [strain.replace(values=strain.expected(run, clock=3e-5)), motion.replace(values=motion.expected(run, clock=2e-5))]


def test_values_clocks_and_what_is_told_of_them(records, tmp_path):
    found = cx.fit(DRAWING, records, variables=["source.distance", "fluids[1].sound_speed"], workers=1, **COARSE)
    assert found.converged
    assert_allclose([one.value for one in found.values], [5.4, 1390.0, 3e-5], rtol=2e-4)
    assert [one.name for one in found.values] == ["source.distance", "fluids[1].sound_speed", "clock of SG"]
    assert all(one.identified and one.low < one.value < one.high for one in found.values)
    assert found.system.sources[0].distance == found["source.distance"].value
    assert min(one.explained for one in found.records) > 0.9999
    assert found.resolution.duration * cx.simulate(DRAWING, duration=0.1, **COARSE).solution.problem.scales.time > TIME[-1]
    assert "SG" in str(found)
    assert found.to_dataset()["correlation"].shape == (3, 3)
    folder = found.save(tmp_path / "out")
    assert sorted(path.name for path in folder.iterdir()) == sorted(FIT_PARTS)
    assert json.loads((folder / "fit.json").read_text())["values"][0]["identified"]
    assert cx.System.from_toml(folder / "fitted.toml").sources[0].distance == found["source.distance"].value
    assert len(figure_fit(found).axes) == 2


def test_what_cannot_be_told_is_said_by_name(records):
    variables = {"source.delay": cx.Range(0, 1e-4), "source.peak_pressure": None}
    clean = np.asarray(records[0].values)
    noisy = records[0].replace(values=clean + 0.05 * clean.std() * np.random.default_rng(0).standard_normal(clean.size))
    found = cx.fit(TRUTH, [noisy], variables=variables, workers=1, iterations=5, **COARSE)
    assert [one.identified for one in found.values] == [False, True, False]
    (told,) = found.unidentified
    assert "source.delay and clock of SG but in combination" in told
    assert "not identified" in str(found)


def test_the_command(records, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    one = records[1]
    rows = "\n".join(f"{1e3 * t!r},{y / 9.80665!r}" for t, y in zip(one.time, one.values, strict=True))
    (tmp_path / "acc.csv").write_text(f"time (ms),a (g)\n{rows}\n")
    study = """
scenario = "bare"
set = { "fluids[1].sound_speed" = 1390 }
variables = { "source.distance" = { from = 4, to = 7 } }
measured = [{ file = "acc.csv", quantity = "acceleration", shell = "inner", angle = 30, clock = "20 us" }]
resolution = { modes = 6, time_step = 0.02 }
"""
    (tmp_path / "study.toml").write_text(study)
    assert main(["fit", "study.toml", "--workers", "1", "-q", "--json", "--figure", "fit.png"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert_allclose(told["values"][0]["value"], 5.4, rtol=1e-4)
    assert (tmp_path / "fit.png").exists()
    assert (tmp_path / "study.fit" / "records.csv").exists()
    assert main(["fit", "study.toml", "--workers", "1", "-q"]) == 2


def test_intervals_hold_the_truth_as_often_as_they_say():
    """A straight line with noise that hangs together over some samples: 95 % intervals, of 300 trials."""
    rng = np.random.default_rng(0)
    x = np.linspace(-1.0, 1.0, 400)
    jacobian = np.stack([np.ones_like(x), x], axis=1)
    inside = np.zeros(2)
    for _ in range(300):
        noise = np.convolve(rng.standard_normal(x.size + 7), np.ones(8), mode="valid")
        answer = np.linalg.lstsq(jacobian, noise, rcond=None)[0]
        found = certainty(jacobian, noise - jacobian @ answer, [slice(0, x.size)], [False], 0.95)
        inside += np.abs(answer) <= found.factor * found.deviation
    assert np.all(inside / 300 > 0.88)
    assert correlation_time(rng.standard_normal(4000)) < 1.5


def test_what_the_noise_told_does_not_explain_is_said(records):
    wrong = records[1].replace(values=1.5 * np.asarray(records[1].values), noise=1e-2)
    found = cx.fit(TRUTH, [wrong], variables=["source.decay_time"], workers=1, iterations=4, **COARSE)
    assert any("times its noise only" in text for text in found.remarks)


@pytest.mark.parametrize("theory", ["thin", "elastic"])
def test_strain_belongs_to_the_stress(theory):
    layers = [[layer.replace(thickness=0.012) for layer in shell.layers if layer.role == "core"] for shell in TRUTH.shells]
    shells = [shell.replace(theory=theory, layers=core) for shell, core in zip(TRUTH.shells, layers, strict=True)]
    run = cx.simulate(TRUTH.replace(shells=shells), duration=1.0, **COARSE)
    metal = layers[1][0].material
    hoop = run.stress("outer", 30, depth="outer").values
    radial = 0.0 if theory == "thin" else run.stress("outer", 30, depth="outer", component="radial").values
    nu = metal.poisson_ratio
    expected = (1.0 + nu) / metal.youngs_modulus * ((1.0 - nu) * hoop - nu * radial)
    found = hoop_strain(run.motion, 1, np.array([30.0]), "outer")[:, 0]
    assert_allclose(found, expected, rtol=1e-9, atol=1e-9 * float(np.abs(expected).max()))


@pytest.mark.parametrize(
    ("entries", "told"),
    [
        ({"quantity": "pressure"}, "radius: is missing"),
        ({"quantity": "strain", "radius": 0.5}, "radius: belongs to a pressure"),
        ({"quantity": "acceleration", "depth": "outer"}, "depth: belongs to strain"),
        ({"quantity": "strain", "component": "tangential"}, "component: "),
        ({"quantity": "heat"}, "quantity: "),
        ({"quantity": "strain", "clock": ""}, "clock: '' is no clock"),
        ({"quantity": "strain", "end": -1.0}, "samples from start to end are too few"),
        ({"quantity": "strain", "values": [0.0]}, "values: 1 values do not match"),
    ],
)
def test_measurements_that_are_refused(entries, told):
    with pytest.raises(cx.InputError, match=told):
        cx.Measurement(**{**BLANK, **entries})


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"variables": []}, "variables: there are none"),
        ({"variables": ["source.distant"]}, "variables.source.distant"),
        ({"variables": ["source.delay"]}, "begins at 0"),
        ({"variables": ["absorbers.count"]}, "variables"),
        ({"variables": {"source.distance": cx.Range(6, 7)}}, "outside its range"),
        ({"variables": ["source.distance", "source.distance"]}, "looked for twice"),
        ({"confidence": 1.0}, "confidence"),
        ({"iterations": 0}, "iterations"),
        ({"measured": []}, "measured"),
        ({"measured": [1.0]}, r"measured\[0\]"),
        ({"duration": 0.08, "measured": None}, "lie within the run"),
    ],
)
def test_fits_that_are_refused(records, changes, told):
    asked = {"measured": records, "variables": ["source.distance"], **COARSE, **changes}
    asked["measured"] = records if asked["measured"] is None else asked["measured"]
    with pytest.raises(cx.InputError, match=told):
        cx.fit(DRAWING, workers=1, **asked)


def test_files_in_units_of_gauges(tmp_path):
    (tmp_path / "g.csv").write_text("time (us),SG1 (microstrain),SG2\n0,1,2\n10,3,4\n20,5,6\n")
    read = cx.Measurement.from_file(tmp_path / "g.csv", quantity="strain", value_column="SG1", scale=2.0)
    assert_allclose(read.values, [2e-6, 6e-6, 1e-5])
    assert_allclose(read.time, [0.0, 1e-5, 2e-5])
    assert read.name == "g"
    other = cx.Measurement.from_file(tmp_path / "g.csv", quantity="strain", value_column=3, value_unit="ue")
    assert_allclose(other.values, [2e-6, 4e-6, 6e-6])
    (tmp_path / "h.csv").write_text("time (us),SG1,SG2\n0,1,2\n10,3,4\n20,5,6\n")
    with pytest.raises(cx.InputError, match="give value_column"):
        cx.Measurement.from_file(tmp_path / "h.csv", quantity="strain")
    with pytest.raises(cx.InputError, match="no unit of value"):
        cx.Measurement.from_file(tmp_path / "g.csv", quantity="acceleration", value_column="SG1")
