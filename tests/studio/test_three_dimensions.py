"""Runs in three dimensions from the page: every station and the largest of all, a wall laid flat, studies, and what is not shown."""

from __future__ import annotations

import numpy as np
import pytest
from asking import described, ended, solve, solved, start

import coaxshell as cx
from coaxshell.apps.studio.arrays import decoded
from coaxshell.response.spatial import SpatialResponse

SPACE = {"duration": 2.0, "time_step": 0.02, "modes": 8, "dimensions": 3, "stations": [0.0, 0.5]}
SINGLE = 1.001 * 2.0**-24
POINT = {"mass": 5.0, "linear_stiffness": 1e8, "z": 0.2, "angle": 10.0}


@pytest.fixture(scope="module")
def library() -> SpatialResponse:
    found = cx.simulate("bare", **SPACE)
    assert isinstance(found, SpatialResponse)
    return found


@pytest.fixture(scope="module")
def answer(client):
    return solved(client, described("bare"), resolution=SPACE)


def finished(client, **entries):
    job = ended(client, start(client, **entries))
    assert job["state"] == "done", job
    return job


def test_every_station_has_the_library_s_histories(answer, library):
    header, arrays = answer
    assert header["stations"] == [0.0, 0.5]
    assert header["resolution"]["dimensions"] == 3
    for name, read in (
        ("stress", library.stress),
        ("displacement", library.displacement),
        ("axial_stress", lambda shell, angles: library.stress(shell, angles, component="axial")),
        ("von_mises_stress", lambda shell, angles: library.stress(shell, angles, component="von_mises")),
    ):
        for index, shell in enumerate(("inner", "outer")):
            ours = read(shell, [0, 180]).transpose("station", "angle", "time").to_numpy()
            np.testing.assert_allclose(arrays[f"{name}/{index}"], ours, rtol=0, atol=SINGLE * np.abs(ours).max())


def test_bars_are_those_of_the_summary_at_each_station_and_over_all(answer, library):
    header, _ = answer
    summary = library.summary()
    for which, largest in enumerate(summary.largest):
        bars = {bar["name"]: bar for bar in header["bars"] if bar["shell"] == which}
        assert {"von_mises_stress", "axial_stress", "stress_rms"} <= set(bars)
        for name in ("stress", "axial_stress", "von_mises_stress", "relative_displacement", "stress_rms"):
            assert (bars[name]["value"], bars[name]["station"]) == (largest[name]["value"], largest[name]["station"])
    for bars, one in zip(header["station_bars"], summary.each, strict=True):
        found = {(bar["name"], bar["shell"]): bar["value"] for bar in bars}
        assert found["stress", 1] == one.shells[1].stress.value
        assert found["stress_head", 0] == one.shells[0].stress_head.value


def test_point_absorbers_act_and_are_told_in_their_units(client):
    header, arrays = solved(client, {**described("bare"), "absorbers": [POINT]}, resolution=SPACE)
    assert header["absorbers"]["z"] == [0.2]
    forces = {bar["name"]: bar for bar in header["bars"] if bar["shell"] is None}
    assert forces["absorber_force"]["unit"] == "N"
    largest = max(np.abs(arrays[f"absorber_force/{shell}"]).max() for shell in (0, 1))
    np.testing.assert_allclose(forces["absorber_force"]["value"], largest, rtol=1e-6)  # there is one alone
    told = client.post("/api/validate", json={"system": {**described("bare"), "absorbers": [POINT]}, "resolution": SPACE}).json()
    assert told["metric_units"]["absorbers.mass"] == "kg"
    assert "inner.peak_axial_stress" in told["metrics"]
    assert "system.mass" not in told["metrics"]
    assert {row["name"]: row["unit"] for row in told["derived"]}["absorber_mass"] == "kg"


def test_cost_is_told_beforehand(client):
    preview = {"duration": 5.0, "time_step": 0.01, "modes": 32, "dimensions": 3}
    full = {**preview, "time_step": 1e-3, "modes": 150, "stations": [0.0]}
    told = client.post("/api/validate", json={"system": described("bare"), "resolution": full, "preview": preview}).json()
    costs = told["costs"]
    assert costs["full"]["seconds"] > 20 * costs["preview"]["seconds"] > 0
    assert costs["full"]["duration"].split()[1] in ("s", "min")
    world = client.get("/api/schema").json()["resolutions"]
    assert world["preview_spatial"]["dimensions"] == 3
    assert solve(client, described("bare"), resolution={"dimensions": 3, "duration": 1.0, "modes": 4}).status_code == 200


def test_a_job_is_told_on_the_way_and_can_be_cancelled(client):
    entries = {"kind": "solve", "slot": "slow", "revision": 1, "system": described("bare")}
    job = start(client, **entries, resolution={**SPACE, "time_step": 1e-3, "duration": 5.0, "modes": 100})
    seen = set()
    while len(seen) < 3:
        now = client.get(f"/api/jobs/{job['id']}").json()["job"]
        assert now["state"] in ("waiting", "running")
        seen.add(now["fraction"])
    assert client.delete(f"/api/jobs/{job['id']}").status_code == 204
    assert ended(client, job)["state"] == "cancelled"
    assert solved(client, described("bare"))[0]["ok"], "the worker is free"


@pytest.mark.parametrize("entries", [{"kind": "field", "every": 1, "size": 200}, {"kind": "energy", "every": 1}])
def test_panels_are_cancelled_on_the_way(client, answer, entries):
    job = start(client, run=answer[0]["run"], **entries)
    while (now := client.get(f"/api/jobs/{job['id']}").json()["job"])["state"] == "waiting":
        pass
    assert now["state"] == "running"
    assert client.delete(f"/api/jobs/{job['id']}").status_code == 204
    assert ended(client, job)["state"] == "cancelled"


def test_margins_are_the_least_over_all_waves(client):
    few, gains = {**SPACE, "duration": 0.5, "modes": 2}, {"control.proportional": -1e5, "control.derivative": -30.0}
    system = cx.presets.load("active").with_overrides(gains)
    run = solved(client, system.model_dump(mode="json"), resolution=few)[0]["run"]
    packed = client.get(f"/api/jobs/{finished(client, kind='loops', run=run)['id']}/result").content
    header, arrays = decoded(packed)
    ours = cx.stability_margins(system, **few)
    found = []
    for place, one in enumerate(header["shells"]):
        least = np.nanmin(ours["delay_margin"].values[place], axis=0)
        np.testing.assert_allclose(arrays[f"delay_margin/{place}"], np.where(np.isfinite(least), least, 0.0), rtol=SINGLE)
        told, delay = one["delay_margin"], ours["delay_margin"].values[place]
        if told is None:
            assert np.isinf(least).all()
            continue
        wave, order = np.unravel_index(np.nanargmin(delay), delay.shape)
        assert (told["value"], told["order"], one["order"]) == (delay[wave, order], order, order)
        assert told["wavenumber"] == one["wavenumber"] == ours["wavenumber"].values[wave]
        found.append(told["value"])
    assert found


@pytest.mark.parametrize("quantity", ["stress", "shear_stress"])
def test_a_wall_laid_flat(client, answer, library, quantity):
    header, _ = answer
    job = finished(client, kind="unrolled", run=header["run"], shell=1, quantity=quantity, frames=26)
    told, arrays = decoded(client.get(f"/api/jobs/{job['id']}/result").content)
    assert arrays["z"].tolist() == [-0.5, 0.0, 0.5]
    assert told["label"] == {"stress": "hoop stress", "shear_stress": "shear stress"}[quantity]
    assert (told["signed"], told["run"]) == (True, header["run"])
    ours = library.stress("outer", arrays["angle"], component={"stress": "hoop", "shear_stress": "shear"}[quantity])
    ours = ours.transpose("time", "station", "angle").to_numpy()[::4]
    np.testing.assert_allclose(arrays["time"], np.asarray(library.time)[::4], rtol=1e-6)
    np.testing.assert_allclose(arrays["values"][:, 1:], ours, rtol=0, atol=SINGLE * np.abs(ours).max())
    sign = -1.0 if quantity == "shear_stress" else 1.0
    np.testing.assert_array_equal(arrays["values"][:, 0], sign * arrays["values"][:, 2])
    assert 0.5 * np.abs(ours).max() < told["limit"] < 2.0 * np.abs(ours).max()


@pytest.mark.parametrize(
    ("entries", "where"),
    [
        ({"kind": "field", "plane": "aslant"}, "plane"),
        ({"kind": "field", "station": 2}, "station"),
        ({"kind": "unrolled", "shell": 2}, "shell"),
    ],
)
def test_what_there_is_not_is_refused_in_one_line(client, answer, entries, where):
    told = client.post("/api/jobs", json={"client": "tab", "run": answer[0]["run"], **entries}).json()
    assert (told.get("problem") or told["error"])["where"] == where


@pytest.mark.slow_for("across")
@pytest.mark.parametrize("plane", ["along", "across"])
def test_the_pressure_on_a_cut_is_the_library_s(client, answer, library, plane):
    asked = {"kind": "field", "run": answer[0]["run"], "plane": plane, "station": 1, "every": 25, "size": 32, "half_width": 1.6}
    job = finished(client, **asked)
    told = client.get(f"/api/jobs/{job['id']}/result").json()
    assert (told["frames"], told["plane"], told["station"]) == (5, plane, 0.5)
    _, arrays = decoded(client.get(f"/api/jobs/{job['id']}/frames?count=5&format=float16").content)
    pressure = told["scale"] * arrays["pressure"].astype(float)
    x = 0.1 * (np.arange(32) - 15.5)
    cut = {"y": 0.0, "z": x[16:]} if plane == "along" else {"y": x[16:], "z": 0.5}
    ours = library.pressure(x=x, **cut, time=told["time"], front="matched").to_numpy()
    np.testing.assert_allclose(pressure[:, 16:], ours, rtol=2**-11, atol=1e-6 * np.abs(ours).max())  # halves of floats
    np.testing.assert_array_equal(pressure[:, :16], pressure[:, :15:-1])
    if plane == "across":
        ours = library.stress("outer", np.arange(360.0), station=0.5).to_numpy()[::25]
        np.testing.assert_allclose(arrays["stress/1"], ours, rtol=0, atol=SINGLE * np.abs(ours).max())
        return
    first, count = told["rows"]
    assert [side["rigid"] for side in told["sides"]] == [False] * 4
    assert x[first] >= -0.5 > x[first - 1]
    assert arrays["stress/3"].shape == (5, count)
    tail = library.stress("outer", 180).transpose("time", "station").to_numpy()[::25] @ [0.9, 0.1]  # at z = 0.05
    np.testing.assert_allclose(arrays["stress/3"][:, 16 - first], tail, rtol=0, atol=SINGLE * np.abs(tail).max())


def test_energy_over_the_whole_length_and_what_it_costs(client):
    tiny = {**SPACE, "duration": 1.0, "modes": 4}
    run = solved(client, described("bare"), resolution=tiny)[0]["run"]
    costs = client.get(f"/api/runs/{run}/costs?every=25&size=64").json()
    assert min(costs[name]["seconds"] for name in ("along", "across", "energy")) > 0.0
    job = finished(client, kind="energy", run=run, every=25)
    header, arrays = decoded(client.get(f"/api/jobs/{job['id']}/result").content)
    ours = cx.simulate("bare", **tiny).energy(25)
    assert header["extent"] == "over the whole length"
    assert next(one["unit"] for one in header["arrays"] if one["name"] == "exterior_work") == "J"
    np.testing.assert_allclose(arrays["exterior_work"], ours["exterior_work"], rtol=1e-6)
    run = solved(client, described("bare"))[0]["run"]
    assert client.get(f"/api/runs/{run}/costs").json()["error"]["where"] == "run"
    refused = client.post("/api/jobs", json={"client": "tab", "kind": "field", "run": run, "plane": "along"})
    assert refused.json()["error"]["where"] == "plane", "of two dimensions"


def test_points_energies_at_once_and_figures_of_fields_are_not_there(client, answer):
    run = answer[0]["run"]
    for path in ("point?x=1&y=1", "energy", "figure.png?quantity=field"):
        refused = client.get(f"/api/runs/{run}/{path}")
        assert (refused.status_code, refused.json()["error"]["where"]) == (422, "run")


def test_a_wall_at_one_station_or_of_two_dimensions_is_not_laid_flat(client):
    for resolution, where in (({**SPACE, "stations": [0.0]}, "stations"), ({"duration": 2.0, "time_step": 0.02, "modes": 8}, "run")):
        header, _ = solved(client, described("bare"), resolution=resolution)
        told = client.post("/api/jobs", json={"client": "tab", "kind": "unrolled", "run": header["run"]}).json()
        assert told["problem"]["where"] == where


def test_runs_are_taken_home(client, answer, library, tmp_path):
    run = answer[0]["run"]
    path = tmp_path / "run.nc"
    path.write_bytes(client.get(f"/api/runs/{run}/download.nc").content)
    loaded = cx.load_response(path)
    assert isinstance(loaded, SpatialResponse)
    np.testing.assert_array_equal(loaded.stress("outer"), library.stress("outer"))
    heading = client.get(f"/api/runs/{run}/download.csv").text.splitlines()[0]
    assert "outer stress head z = 0.5 m (Pa)" in heading
    assert client.get(f"/api/runs/{run}/figure.png").content.startswith(b"\x89PNG")
    upload = client.post("/api/upload", content=path.read_bytes(), headers={"Content-Type": "application/x-netcdf"}).json()
    assert upload["resolution"]["dimensions"] == 3
    assert upload["resolution"]["stations"] == [0.0, 0.5]


@pytest.mark.parametrize("whole", [False, pytest.param(True, marks=pytest.mark.slow)], ids=["sweep", "optimisation too"])
def test_studies_are_of_three_dimensions_too(client, whole):
    system = {**described("bare"), "absorbers": [POINT]}
    small = {**SPACE, "duration": 1.0, "modes": 6}
    over = {"absorbers[0].z": {"from": 0, "to": "40 cm", "count": 2}}
    body = {"kind": "sweep", "system": system, "resolution": small, "over": over, "metrics": ["outer.peak_axial_stress"]}
    job = finished(client, **body)
    found = client.get(f"/api/jobs/{job['id']}/result").json()["metrics"][0]["values"]
    ours = cx.sweep(cx.System.model_validate(system), {"absorbers[0].z": [0, 0.4]}, ["outer.peak_axial_stress"], workers=1, **small)
    np.testing.assert_allclose(found, ours["outer.peak_axial_stress"], rtol=1e-12)
    assert "dimensions = 3" in client.post("/api/study", json={"client": "tab", **body}).json()["toml"]
    search = {
        "variables": {"absorbers[0].mass": {"from": 1, "to": 9}},
        "objectives": ["outer.peak_stress"],
        "evaluations": 4,
        "population": 4,
    }
    if whole:
        job = finished(client, kind="optimise", system=system, resolution=small, **search)
        assert client.get(f"/api/jobs/{job['id']}/result").json()["evaluations"] == 4
    refused = client.post("/api/jobs", json={"client": "tab", **body, "metrics": ["interior.rms_pressure"]}).json()
    assert refused["problem"]["where"] == "metrics[0]"
