"""``--json``: one document on stdout, strict JSON, with the numbers of the Python interface; the rest on stderr."""

from __future__ import annotations

import json

import pytest
import xarray as xr

import coaxshell as cx
from coaxshell.apps.cli.documents import claims_document
from coaxshell.apps.cli.output import print_document
from coaxshell.apps.paper.claims.claim import Claim, Finding, Judged
from coaxshell.apps.paper.reproduction import VARIANTS, Results
from coaxshell.solver.settings import Settings
from coaxshell.studies.metrics import metrics_of
from coaxshell.studies.reading import MetricSource

RESOLUTION = "[resolution]\nduration = 1\ntime_step = 0.02\nmodes = 6\n"
STUDY = f"""
scenario = "bare"
metrics = ["inner.peak_stress"]
[over]
source.distance = ["4 m", 5]
source.peak_pressure = [1e4, 2e4]
{RESOLUTION}"""
UNCERTAIN = f"""
scenario = "bare"
metrics = ["inner.peak_stress"]
samples = 8
[uncertain]
source.peak_pressure = {{ relative = 0.1 }}
source.distance = {{ normal = {{ mean = "5 m", deviation = "20 cm" }} }}
{RESOLUTION}"""
SEARCH = f"""
scenario = "absorbers"
objectives = ["inner.peak_stress"]
method = "differential-evolution"
evaluations = 6
population = 5
[variables]
"absorbers.mass" = {{ from = 1, to = 20 }}
{RESOLUTION}"""


def document(outcome):
    """Return what stdout holds, which no constant outside JSON may be part of."""
    assert outcome.code == 0, outcome.err
    return json.loads(outcome.out, parse_constant=lambda text: pytest.fail(f"{text} is no JSON"))


def test_run_tells_the_summary_in_si(run, small):
    outcome = run("run", "bare", *small, "--json", "-o", "out.nc")
    found = document(outcome)
    summary = cx.simulate(cx.presets.load("bare"), modes=6, time_step=0.02, duration=1).summary()
    (told,) = found["runs"]
    assert told["name"] == "bare"
    for one, shell in zip(told["shells"], summary.shells, strict=True):
        assert one["name"] == shell.name
        assert one["stress_head"]["value"] == shell.stress_head.value
    assert (found["units"]["stress_head"], found["units"]["sensor_voltage"]) == ("Pa", "V")
    assert "saved out.nc" in outcome.err
    assert "warning: " in outcome.err
    assert told["warnings"] == list(summary.warnings)
    info = document(run("info", "out.nc", "--json"))
    assert info["runs"] == found["runs"]
    assert info["file"] == "out.nc"


def test_a_run_in_three_dimensions_tells_its_stations(run):
    options = ("--duration", "1", "--time-step", "0.02", "--modes", "6", "--dimensions", "3", "--stations", "0,70 cm")
    found = document(run("run", "bare", *options, "--json"))
    summary = cx.simulate("bare", duration=1, time_step=0.02, modes=6, dimensions=3, stations=["0 m", 0.7]).summary()
    told = {key: value for key, value in found["runs"][0].items() if key not in ("name", "metrics")}
    assert told == json.loads(json.dumps(summary.to_dict()))
    assert [one["station"] for one in told["stations"]] == [0.0, 0.7]
    assert set(told["largest"][0]) - {"name"} <= set(found["units"])
    assert found["runs"][0]["metrics"]["inner.peak_von_mises_stress"] == told["largest"][0]["von_mises_stress"]["value"]
    assert (found["units"]["station"], found["units"]["von_mises_stress"]) == ("m", "Pa")
    text = run("run", "bare", *options)
    assert text.out.strip() == str(summary.without_warnings()).strip()
    assert all(warning in text.err for warning in summary.warnings)


def test_elastic_walls_of_a_scenario_have_stations(run, tmp_path):
    bare = cx.presets.load("bare")
    solid = bare.replace(shells=[shell.replace(theory="elastic") for shell in bare.shells])
    (tmp_path / "solid.toml").write_text(solid.to_toml_string(), encoding="utf-8")
    options = ("--duration", "1", "--time-step", "0.05", "--modes", "4", "--dimensions", "3", "--stations", "0,70 cm")
    found = document(run("run", str(tmp_path / "solid.toml"), *options, "--json"))["runs"][0]
    thin = document(run("run", "bare", *options, "--json"))["runs"][0]
    for one, other in zip(found["largest"], thin["largest"], strict=True):
        for name in ("stress", "axial_stress", "von_mises_stress"):
            assert one[name]["value"] == pytest.approx(other[name]["value"], rel=0.2)


def test_both_runs_of_a_comparison(run, small):
    found = document(run("run", "absorbers", "--compare", "bare", *small, "--json", "-q"))
    assert [one["name"] for one in found["runs"]] == ["absorbers", "bare"]
    assert found["runs"][0]["absorber_force"] > 0
    assert found["runs"][1]["absorber_force"] is None


def test_runs_have_the_metrics_of_studies_by_their_names(run, small):
    found = document(run("run", "hybrid", "--compare", "bare", *small, "--json", "-q", "--energy", "energy.png"))
    response = cx.simulate("hybrid", modes=6, time_step=0.02, duration=1)
    told = found["runs"][0]["metrics"]
    assert {"inner.peak_stress", "outer.segment_actuator_voltage", "outer.rms_stress", "absorbers.peak_force"} <= set(told)
    source = MetricSource(response)
    for metric in metrics_of(list(told), response.system):
        assert told[metric.name] == pytest.approx(metric(source), rel=1e-12), metric.name
        assert found["units"][metric.name] == metric.units
    other = found["runs"][1]["metrics"]
    ratios = found["first_over_second"]
    assert ratios["inner.peak_stress"] == pytest.approx(told["inner.peak_stress"] / other["inner.peak_stress"])
    assert "absorbers.peak_force" not in ratios
    energy = found["energy"]
    assert len(energy["exterior_work"]) == len(energy["time"]) == 6
    assert (energy["units"]["exterior_work"], energy["dimensions"]["exterior_work"]) == ("J/m", ["time"])


def test_natural_frequencies(run):
    found = document(run("modes", "bare", "--order", "2", "--up-to", "400 Hz", "--json"))
    assert all(mode["order"] == 2 and mode["frequency (Hz)"] < 400.0 for mode in found["modes"])
    assert found["modes"]


def test_spectra(run, small):
    asked = ("--shell", "inner", "--angle", "0,90", "--frequency", "200,800", "--json", "-q")
    outcome = run("spectrum", "bare", *small, *asked)
    found = document(outcome)
    expected = cx.simulate("bare", modes=6, time_step=0.02, duration=1).shock_spectrum("inner", [0, 90], [200.0, 800.0])
    assert [one["pseudo_velocity"] for one in found["spectra"]] == expected.values.T.tolist()
    assert (found["spectra"][1]["angle"], found["units"]["absolute_acceleration"], outcome.files) == (90.0, "m/s^2", [])
    assert run("spectrum", "bare", *small, *asked, "-o", "a.csv").files == ["a.csv"]


def test_participation(run, small):
    asked = ("participation", "bare", *small, "--up-to", "600 Hz", "-q")
    found = document(run(*asked, "--json"))
    assert found["value"] == pytest.approx(sum(found["orders"]["order_contribution"]) + found["other_orders"] * found["value"])
    assert (found["units"]["contribution"], found["quantity"]) == ("Pa", "stress")
    assert {"order", "frequency", "damping_ratio", "contribution", "share"} <= set(found["modes"][0])
    text = run(*asked, "-o", "modes.png")
    assert "carried by no mode of these orders" in text.out
    assert text.files == ["modes.png"]


def test_conformance_report(run):
    outcome = run("verify", "--quick", "--only", "statics", "--quiet", "--json")
    found = document(outcome)
    (check,) = found["checks"]
    assert (check["name"], found["failed"], len(check["rows"])) == ("statics", 0, 13)
    assert all(row["verdict"] == "pass" and row["error"] <= row["tolerance"] for row in check["rows"])
    assert "wrote verification-report" in outcome.err
    assert {"name", "title"} == set(document(run("verify", "--list", "--json"))["checks"][0])


def test_claims_of_the_paper():
    claim = Claim(1, "a-claim", "Figure 3", "It falls.", "by half", lambda runs: None)
    name = next(iter(VARIANTS))
    judged = Judged(claim, {name: Finding({"stress (Pa)": 2.0}, "holds", "It does.") for name in VARIANTS})
    told = claims_document(Results(Settings(), judged=(judged,), seconds={"claims": 1.5}))
    assert told["tally"][name] == {"holds": 1}
    assert told["claims"][0]["findings"][name] == {"verdict": "holds", "why": "It does.", "measured": {"stress (Pa)": 2.0}}
    assert json.loads(json.dumps(told)) == told


def test_presets(run):
    found = document(run("presets", "--json"))["presets"]
    assert [one["name"] for one in found] == list(cx.presets.names())
    assert all(one["description"] for one in found)


def test_sweep_case_by_case(run, study, tmp_path):
    outcome = run("sweep", study(), "--workers", "1", "--json")
    found = document(outcome)
    dataset = xr.load_dataset(tmp_path / "study.nc", engine="h5netcdf")
    assert len(found["cases"]) == 4
    case = next(one for one in found["cases"] if one["source.peak_pressure"] == 1e4 and one["source.distance"] == 5)
    expected = dataset["inner.peak_stress"].sel({"source.peak_pressure": 1e4, "source.distance": 5})
    assert case["inner.peak_stress"] == float(expected)
    assert found["units"]["inner.peak_stress"] == "Pa"
    assert "wrote study.nc" in outcome.err


@pytest.mark.slow
def test_statistics(run, study, tmp_path):
    found = document(run("sensitivity", study(UNCERTAIN), "--workers", "1", "--json", "-q"))
    dataset = xr.load_dataset(tmp_path / "study.nc", engine="h5netcdf")
    assert (found["runs"], found["failed"]) == (32, 0)
    assert found["statistics"]["inner.peak_stress"]["mean"] == dataset["inner.peak_stress"].sel(statistic="mean").values.tolist()
    assert set(found["first_order"]["inner.peak_stress"]) == {"source.peak_pressure", "source.distance"}


def test_optimum(run, study, tmp_path):
    found = document(run("optimise", study(SEARCH), "--workers", "1", "--json", "-q"))
    assert found == json.loads((tmp_path / "study.optimum" / "optimum.json").read_text())
    assert found["units"]["inner.peak_stress"] == "Pa"


def test_what_is_not_finite_becomes_null(capsys):
    print_document({"a": [float("nan"), float("inf"), 1.5], "b": {"c": (-float("inf"), None, True)}})
    assert json.loads(capsys.readouterr().out) == {"a": [None, None, 1.5], "b": {"c": [None, None, True]}}


def test_a_refusal_prints_no_document(refused):
    assert "'bear'" in refused("run", "bear", "--json")
