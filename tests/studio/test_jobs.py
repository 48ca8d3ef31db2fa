"""Jobs: fields, films, downloads, cancelling, events."""

from __future__ import annotations

import numpy as np
import pytest
from asking import SMALL, described, ended, solved, start
from numpy.testing import assert_allclose

import coaxshell as cx
from coaxshell.apps.studio.arrays import decoded
from coaxshell.model import System, presets
from coaxshell.plotting.frames import FieldView, field_frames, gathered


@pytest.fixture(scope="module")
def run(client):
    return solved(client, described("absorbers"))[0]["run"]


@pytest.fixture(scope="module")
def field(client, run):
    return ended(client, start(client, kind="field", run=run, every=10, size=40))


def test_frames_are_those_of_the_library(client, field):
    about = client.get(f"/api/jobs/{field['id']}/result").json()
    response = cx.simulate(presets.load("absorbers"), **SMALL)
    expected = gathered(field_frames(response, response.time[::10], FieldView(3.0, 40)))
    assert about["frames"] == len(expected) == 11
    assert_allclose(about["time"], expected.time, rtol=1e-12)
    whole = np.stack([expected.field(i) for i in range(11)])[4:7]
    for kind, fineness in (("float16", 1e-3), ("uint8", 1 / 254)):
        _, arrays = decoded(client.get(f"/api/jobs/{field['id']}/frames?start=4&count=3&format={kind}").content)
        header = decoded(client.get(f"/api/jobs/{field['id']}/frames?start=4&count=3&format={kind}").content)[0]
        scale = next(entry["scale"] for entry in header["arrays"] if entry["name"] == "pressure")
        values = arrays["pressure"].astype(np.float64) - (128 if kind == "uint8" else 0)
        limit = about["pressure_limit"] if kind == "uint8" else np.inf
        assert_allclose(scale * values, np.clip(whole, -limit, limit), rtol=2e-3, atol=1.01 * fineness * np.abs(about["pressure_limit"]))
        assert_allclose(arrays["stress/0"], expected.stress[0][4:7], rtol=1e-4, atol=1e-6 * np.abs(expected.stress[0]).max())


def test_the_bytes_of_frames_may_end_elsewhere(client, field):
    """So that fields beside each other share their colours, whatever each one's own ends are."""
    limit = 0.25 * client.get(f"/api/jobs/{field['id']}/result").json()["pressure_limit"]
    pressure = {}
    for query, zero in (("format=float16", 0), (f"limit={limit}", 128)):
        header, arrays = decoded(client.get(f"/api/jobs/{field['id']}/frames?start=4&count=3&{query}").content)
        scale = next(entry["scale"] for entry in header["arrays"] if entry["name"] == "pressure")
        pressure[zero] = scale * (arrays["pressure"].astype(np.float64) - zero)
    assert np.abs(pressure[0]).max() > 2 * limit
    assert_allclose(pressure[128], np.clip(pressure[0], -limit, limit), rtol=0, atol=0.51 * limit / 127)


@pytest.mark.parametrize("query", ["limit=0", "limit=nan", "start=-1", "start=11", "count=0", "count=x", "format=float64"])
def test_frames_out_of_bounds_are_refused(client, field, query):
    assert client.get(f"/api/jobs/{field['id']}/frames?{query}").status_code == 400


@pytest.mark.parametrize("change", [{"size": 4000}, {"size": 0}, {"every": 0}, {"half_width": 1e9}, {"run": "../../etc"}, {"run": 5}])
def test_a_field_out_of_bounds_is_refused(client, run, change):
    answer = client.post("/api/jobs", json={"client": "tab", "kind": "field", "run": run, **change})
    assert answer.status_code == 400


def test_downloads(client, run, tmp_path):
    system = presets.load("absorbers")
    folder = client.app.app.state.studio.folder
    before = set(folder.iterdir())
    toml = client.get(f"/api/runs/{run}/download.toml")
    assert System.from_toml_string(toml.text) == system
    assert 'attachment; filename="absorbers-2' in toml.headers["content-disposition"]
    assert 'filename="absorbers-histories-2' in client.get(f"/api/runs/{run}/download.csv").headers["content-disposition"]
    path = tmp_path / "run.nc"
    path.write_bytes(client.get(f"/api/runs/{run}/download.nc").content)
    assert cx.load_response(path).system == system
    table = client.get(f"/api/runs/{run}/download.csv").text.splitlines()
    assert table[0].startswith("time (a/c),")
    assert len(table) == 102
    other = solved(client, described("bare"))[0]["run"]
    assert client.get(f"/api/runs/{run}/figure.png?compare={other}").content[:8] == b"\x89PNG\r\n\x1a\n"
    assert b"<svg" in client.get(f"/api/runs/{run}/figure.svg").content
    for path in ("download.exe", "figure.toml", "..%2fx.toml", "download.png"):
        assert client.get(f"/api/runs/{run}/{path}").status_code == 404
    assert set(folder.iterdir()) <= before, "nothing stays behind"


def test_a_film(client, run):
    job = start(client, kind="film", runs=[run], frames=3, size=64, format="webp")
    assert client.get(f"/api/jobs/{job['id']}/file").status_code in (200, 409)
    assert ended(client, job)["state"] == "done"
    film = client.get(f"/api/jobs/{job['id']}/file")
    assert (film.headers["content-type"], film.content[8:12]) == ("image/webp", b"WEBP")
    assert client.delete(f"/api/jobs/{job['id']}").status_code == 204
    assert client.get(f"/api/jobs/{job['id']}").json()["error"]["code"] == "unknown-job"


def test_a_job_is_cancelled_soon_and_the_next_one_runs(client):
    heavy = {"duration": 10.0, "time_step": 1e-3, "modes": 150}
    job = start(client, kind="solve", slot="long", revision=1, system=described("hybrid"), resolution=heavy)
    assert client.delete(f"/api/jobs/{job['id']}").status_code == 204
    assert client.get(f"/api/jobs/{job['id']}").json()["job"]["state"] == "cancelled"
    light = start(client, kind="solve", slot="long", revision=2, system=described("bare"), resolution={**SMALL, "modes": 9})
    assert ended(client, light)["state"] == "done"
    late = client.post(
        "/api/jobs",
        json={"client": "tab", "kind": "solve", "slot": "long", "revision": 1, "system": described("bare"), "resolution": SMALL},
    )
    assert late.json()["error"]["code"] == "cancelled"


def test_too_many_jobs_are_refused(client):
    heavy = {"duration": 10.0, "time_step": 1e-3, "modes": 150}
    answers = [
        client.post(
            "/api/jobs",
            json={"client": "greedy", "kind": "solve", "slot": f"s{n}", "revision": 1, "system": described("hybrid"), "resolution": heavy},
        )
        for n in range(8)
    ]
    assert [answer.status_code for answer in answers] == [202] * 6 + [429] * 2
    assert answers[-1].headers["retry-after"] == "1"
    for job in client.get("/api/jobs?client=greedy").json()["jobs"]:
        client.delete(f"/api/jobs/{job['id']}")
