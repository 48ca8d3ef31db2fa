"""Live answers are those of the library, and the newest revision wins."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from asking import SMALL, described, ended, solve, solved, start
from numpy.testing import assert_allclose

import coaxshell as cx
from coaxshell.apps.studio.arrays import decoded
from coaxshell.model import System, presets
from coaxshell.plotting.energy import energy_groups, group_colours

SINGLE = 1.001 * 2.0**-24
"""Rounding to single precision, in which curves are sent."""


@pytest.mark.parametrize("name", ["bare", "absorbers", "active", "hybrid", "iakovlev-evacuated"])
def test_curves_and_bars_are_those_of_the_library(client, name):
    header, arrays = solved(client, described(name))
    response = cx.simulate(presets.load(name), **SMALL)
    assert_allclose(arrays["time"], response.time, rtol=SINGLE)
    summary = response.summary()
    for shell in header["shells"]:
        if shell["rigid"]:
            continue
        i = shell["index"]
        for quantity in ("stress", "displacement", "sensor_voltage", "actuator_voltage"):
            if f"{quantity}/{i}" in arrays:
                expected = getattr(response, quantity)(i).values.T
                assert_allclose(arrays[f"{quantity}/{i}"], expected, rtol=SINGLE, atol=1e-12 * np.abs(expected).max())
        bars = {bar["name"]: bar["value"] for bar in header["bars"] if bar["shell"] == i}
        expected = next(one for one in summary.shells if one.name == shell["name"])
        assert_allclose([bars["stress"], bars["stress_rms"]], [expected.stress.value, expected.stress_rms], rtol=1e-9)
    assert ("actuator_voltage/0" in arrays) == (name in ("active", "hybrid"))
    if header["absorbers"]["count"]:
        head, tail = header["absorbers"]["head"], header["absorbers"]["tail"]
        force = response.absorber_force().values
        for side in (0, 1):
            assert_allclose(arrays[f"absorber_force/{side}"], force[[head, tail], side], rtol=SINGLE, atol=1e-12 * np.abs(force).max())
    judged = client.get(f"/api/runs/{header['run']}/judgement").json()
    assert judged["warnings"] == list(response.warnings)
    assert judged["estimates"]["errors"] == [one.errors for one in summary.shells]
    assert judged["estimates"]["stress"] == [None if np.isnan(one) else one for one in response.estimates.modal_stress]


def test_velocities_and_accelerations_come_if_they_are_asked_for(client):
    """An answer that was kept without them does not stand for one with them; one with them is enough for both."""
    system = {**described("bare"), "name": "with and without"}
    for run, (asked, given) in enumerate((("without rates", False), ("all", True), ("without rates", True))):
        answer = solve(client, system, who="rates", revision=run, histories=asked)
        header, arrays = decoded(answer.content)
        assert ("shell_velocity/0" in arrays) == ("shell_acceleration/1" in arrays) == given
        assert header["left_out"] == ([] if given else ["shell_acceleration", "shell_velocity"])
        assert "stress/1" in arrays
    listed = client.get("/api/schema").json()["quantities"]
    assert {one["name"] for one in listed if one["rate"]} == {"shell_velocity", "shell_acceleration"}
    assert solve(client, system, who="rates", revision=9, histories="some").status_code == 400


def test_bars_may_come_after_the_curves(client):
    """They take as long as a slider's run; the curves are the same, and kept without them they do not stand for those with."""
    system = {**described("absorbers"), "name": "bars later"}
    header, arrays = decoded(solve(client, system, who="bars", revision=0, bars="later").content)
    assert header["bars"] is None
    later = client.get(f"/api/runs/{header['run']}/bars").json()
    whole, same = decoded(solve(client, system, who="bars", revision=1).content)
    assert later == {"run": header["run"], "bars": whole["bars"]}
    assert {bar["name"] for bar in whole["bars"]} >= {"stress_head", "absorber_force"}
    assert header["shells"] == whole["shells"]
    assert all(np.array_equal(same[name], arrays[name]) for name in arrays)
    assert solve(client, system, who="bars", revision=2, bars="never").status_code == 400


def test_other_absorbers_on_a_structure_already_prepared_give_the_same_numbers(client):
    system = described("absorbers")
    solved(client, system)
    system["absorbers"]["mass"] = 17.0
    _, arrays = solved(client, system)
    expected = cx.simulate(System.model_validate(system), **SMALL).stress("inner").values.T
    assert_allclose(arrays["stress/0"], expected, rtol=SINGLE, atol=1e-12 * np.abs(expected).max())


def test_a_change_of_gains_or_layers_gives_the_same_numbers(client):
    for path, value in (("control.proportional", -1.5e4), ("control.derivative", -90.0), ("shells[0].layers[1].thickness", 7e-3)):
        system = presets.load("hybrid").with_overrides({path: value})
        _, arrays = solved(client, system.model_dump(mode="json"))
        expected = cx.simulate(system, **SMALL).stress("inner").values.T
        assert_allclose(arrays["stress/0"], expected, rtol=SINGLE, atol=1e-12 * np.abs(expected).max())


def test_the_same_revision_twice_is_answered_twice(client):
    def ask(_):
        return solve(client, described("hybrid"), who="twice", revision=3, resolution={"duration": 3.0, "time_step": 0.01, "modes": 31})

    with ThreadPoolExecutor(4) as pool:
        assert {answer.status_code for answer in pool.map(ask, range(4))} <= {200, 204}


def test_an_older_revision_is_answered_with_nothing(client):
    assert solve(client, described("bare"), who="revisions", revision=7).status_code == 200
    late = solve(client, described("bare"), who="revisions", revision=6)
    assert (late.status_code, late.content) == (204, b"")
    assert solve(client, described("bare"), who="revisions", revision=6, slot="bare").status_code == 200
    assert solve(client, described("bare"), who="someone-else", revision=6).status_code == 200


def test_of_many_at_once_the_newest_is_answered(client):
    def ask(revision):
        system = described("absorbers")
        system["absorbers"]["mass"] = 20.0 + revision
        return solve(client, system, who="burst", revision=revision, resolution={"duration": 5.0, "time_step": 0.01, "modes": 30})

    with ThreadPoolExecutor(12) as pool:
        answers = list(pool.map(ask, range(12)))
    assert answers[-1].status_code == 200
    assert {answer.status_code for answer in answers} <= {200, 204}


@pytest.mark.parametrize(
    ("resolution", "where"),
    [
        ({"modes": 101}, "resolution.modes"),
        ({"modes": "auto"}, "resolution.modes"),
        ({"time_step": 1e-9}, "resolution.time_step"),
        ({"time_step": 1e-3}, "resolution.time_step"),
        ({"duration": -1}, "resolution.duration"),
        ({"duration": 10**400}, "resolution.duration"),
        ({"colour": 1}, "resolution.colour"),
        ("finest", "resolution"),
    ],
)
def test_a_resolution_out_of_bounds_is_a_problem_told(client, resolution, where):
    answer = solve(client, described("bare"), resolution=resolution)
    assert answer.status_code == 200
    assert answer.json()["problem"]["where"] == where


def test_an_unstable_feedback_is_told_as_the_library_tells_it(client):
    system = described("active")
    system["control"]["derivative"] = 150.0
    with pytest.raises(cx.InputError) as refused:
        cx.simulate(System.model_validate(system), **SMALL)
    assert solve(client, system).json()["problem"]["problem"] == refused.value.problem


def test_a_run_is_known_by_its_name_and_others_are_not(client):
    header, _ = solved(client, described("hybrid"))
    again = client.get(f"/api/runs/{header['run']}")
    assert again.status_code == 200
    assert client.get("/api/runs/0123456789abcdef").json()["error"]["code"] == "unknown-run"


def test_energy_and_pressure_at_a_point(client):
    from coaxshell.apps.studio.arrays import decoded

    header, _ = solved(client, described("absorbers"))
    response = cx.simulate(presets.load("absorbers"), **SMALL)
    balance = response.energy(5)
    told, arrays = decoded(client.get(f"/api/runs/{header['run']}/energy?every=5").content)
    assert {entry["name"] for entry in told["entries"]} == set(balance.data_vars)
    assert_allclose(arrays["inner_kinetic"], balance["inner_kinetic"], rtol=SINGLE)
    job = start(client, kind="energy", run=header["run"], every=5)
    assert ended(client, job)["state"] == "done"
    again, same = decoded(client.get(f"/api/jobs/{job['id']}/result").content)
    assert [again["entries"], again["groups"]] == [told["entries"], told["groups"]]
    assert all(np.array_equal(same[name], arrays[name]) for name in arrays)
    drawn = group_colours(energy_groups(balance))
    assert [(group["name"], group["colour"]) for group in told["groups"] if group["name"] in drawn] == list(drawn.items())
    told, arrays = decoded(client.get(f"/api/runs/{header['run']}/point?x=0.2&y=-0.4").content)
    assert told["region"] == "interior"
    expected = response.pressure(x=[0.2], y=[-0.4], time=response.time).values.ravel()
    assert_allclose(arrays["pressure"], expected, rtol=SINGLE, atol=1e-12 * np.abs(expected).max())
    for query in ("x=1", "x=nan&y=0", "x=1e9&y=0", "x=a&y=b"):
        assert client.get(f"/api/runs/{header['run']}/point?{query}").status_code == 400


def test_a_finer_run_is_a_job(client):
    job = start(client, kind="solve", slot="current", revision=1, system=described("bare"), resolution={**SMALL, "modes": 20})
    done = ended(client, job)
    assert (done["state"], done["fraction"], done["error"]) == ("done", 1.0, None)
    from coaxshell.apps.studio.arrays import decoded

    _, arrays = decoded(client.get(f"/api/runs/{done['run']}").content)
    expected = cx.simulate(presets.load("bare"), **{**SMALL, "modes": 20}).stress("outer").values.T
    assert_allclose(arrays["stress/1"], expected, rtol=SINGLE, atol=1e-12 * np.abs(expected).max())
