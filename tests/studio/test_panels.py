"""Panels beside the curves have the library's numbers: margins and loops, spectra, the stress through a wall, the report."""

from __future__ import annotations

import numpy as np
import pytest
from asking import SMALL, described, ended, solved, start
from numpy.testing import assert_allclose

import coaxshell as cx
from coaxshell.apps.studio.arrays import decoded

SINGLE = 2.0**-23


def made(client, header, **entries):
    job = ended(client, start(client, run=header["run"], **entries))
    assert job["state"] == "done", job
    return decoded(client.get(f"/api/jobs/{job['id']}/result").content)


def refused(client, header, **entries):
    answer = client.post("/api/jobs", json={"client": "tab", "run": header["run"], **entries})
    return answer.json().get("problem") or answer.json()["error"]


@pytest.fixture(scope="module")
def electrodes(client):
    return solved(client, described("electrodes"))[0]


@pytest.fixture(scope="module")
def library():
    return cx.simulate("electrodes", **SMALL)


def test_margins_are_the_library_s(client, electrodes, library):
    header, arrays = made(client, electrodes, kind="loops")
    ours = library.stability_margins()
    assert [one["name"] for one in header["shells"]] == list(ours["shell"].values)
    for place, one in enumerate(header["shells"]):
        for kind in ("gain_margin", "phase_margin", "delay_margin"):
            values = ours[kind].values[place]
            assert (one[kind] or {"value": np.inf})["value"] == values.min()
            if one[kind]:
                assert ours["order"].values[values.argmin()] == one[kind]["order"]
        assert one["order"] == ours["delay_margin"].values[place].argmin()
        finite = np.isfinite(ours["delay_margin"].values[place])
        assert_allclose(arrays[f"delay_margin/{place}"][finite], ours["delay_margin"].values[place][finite], rtol=SINGLE)
        assert (np.diff(arrays[f"frequency/{place}"]) > 0).all()
        assert arrays[f"real/{place}"].shape == arrays[f"imaginary/{place}"].shape == arrays[f"frequency/{place}"].shape


def test_spectra_are_the_library_s(client, electrodes, library):
    header, arrays = made(client, electrodes, kind="spectra", shell=1, quantity="shell_acceleration")
    shock = library.shock_spectrum("outer")
    assert_allclose(arrays["frequency"], shock["frequency"], rtol=SINGLE)
    assert_allclose(arrays["shock"].T, shock, rtol=4 * SINGLE)
    with pytest.warns(cx.PhysicsWarning, match="is left in the last") as told:
        fourier = np.abs(library.spectrum("shell_acceleration", "outer", frequency=shock["frequency"].values))
    assert header["warnings"] == [str(one.message) for one in told]
    assert_allclose(arrays["fourier"].T, fourier, rtol=1e-6)
    assert "acceleration" in header["label"]


def test_the_stress_through_a_wall_is_the_library_s(client, electrodes, library):
    header, arrays = made(client, electrodes, kind="stressed", shell=0, component="hoop")
    peak = library.peak_stress("inner", "hoop")
    assert_allclose(header["peak"]["value"], peak.value, rtol=1e-9)
    assert (header["peak"]["layer"], header["peak"]["material"]) == (peak.layer, peak.material)
    assert [layer["material"] for layer in header["layers"]] == [layer.material.name for layer in library.system.shells[0].layers]
    largest = max(arrays[f"stress/{number}"].max() for number in range(len(header["layers"])))
    assert_allclose(largest, peak.value, rtol=0.02)  # the map has degrees and nine depths a layer
    number = len(header["layers"]) - 1
    depth = float(arrays[f"depth/{number}"][-1])
    ours = np.abs(library.stress("inner", arrays["angle"], depth - 1e-9)).max("time")
    assert_allclose(arrays[f"stress/{number}"][-1], ours, rtol=1e-4, atol=1e-6 * peak.value)


def test_what_has_no_such_panel_says_why(client):
    bare = solved(client, described("bare"))[0]
    assert "nothing is fed back" in refused(client, bare, kind="loops")["problem"]
    assert refused(client, bare, kind="spectra", shell=4)["where"] == "shell"
    assert refused(client, bare, kind="spectra", shell=0, station=3)["where"] == "station"
    assert refused(client, bare, kind="spectra", quantity="weather")["where"] == "quantity"
    assert refused(client, bare, kind="stressed", component="colour")["where"] == "component"
    assert refused(client, {"run": None}, kind="report", runs=[bare["run"]] * 3)["where"] == "runs"
    assert refused(client, bare, kind="report", runs=[bare["run"]], without=["the end"])["where"] == "without"


def test_a_report_is_taken_home(client):
    tiny = {"duration": 0.5, "time_step": 0.05, "modes": 2}
    run = solved(client, described("steel-tube"), resolution=tiny)[0]["run"]
    job = ended(client, start(client, kind="report", runs=[run], without=["spectra", "energy", "fields"]))
    assert job["state"] == "done", job
    answer = client.get(f"/api/jobs/{job['id']}/file")
    assert answer.headers["content-type"].startswith("text/html")
    assert "attachment" in answer.headers["content-disposition"]
    assert "<h1>steel-tube" in answer.text
