"""Optimisations from the page are those of the library."""

from __future__ import annotations

import csv
import io
import json
import re
import time

import pytest
from asking import SMALL, described, ended, start
from numpy.testing import assert_allclose

import coaxshell as cx
from coaxshell.apps.studio import limits
from coaxshell.model import System, presets

VARIABLES = {
    "absorbers.mass": {"from": "1 kg", "to": "10 kg"},
    "absorbers.damping": {"from": 1e4, "to": 1e8, "scale": "log"},
}
ASKED = {
    "kind": "optimise",
    "variables": VARIABLES,
    "objectives": ["inner.peak_stress"],
    "constraints": ["absorbers.mass <= 200 kg/m"],
    "evaluations": 20,
    "seed": 3,
    "resolution": SMALL,
}


def ranges(variables=VARIABLES):
    return {
        path: cx.Range(given["from"], given["to"], given.get("scale", "linear")) if isinstance(given, dict) else given
        for path, given in variables.items()
    }


def done(client, **changes):
    job = ended(client, start(client, **{"system": described("absorbers"), **ASKED, **changes}))
    assert job["state"] == "done", job
    return job["id"], client.get(f"/api/jobs/{job['id']}/result").json()


@pytest.fixture(scope="module")
def single(client):
    return done(client)


@pytest.fixture(scope="module")
def double(client):
    return done(client, objectives=["inner.peak_stress", {"metric": "absorbers.dissipated_energy", "maximise": True}], population=8)


def test_one_objective_is_that_of_the_library(client, single):
    name, told = single
    expected = cx.optimise(
        presets.load("absorbers"),
        variables=ranges(),
        objectives="inner.peak_stress",
        constraints=ASKED["constraints"],
        evaluations=20,
        seed=3,
        workers=1,
        **SMALL,
    )
    values = [one.targets.get("inner.peak_stress") for one in expected.history]
    assert told["history"]["objectives"] == [values]
    assert None in values, "some break the limit on the mass and are not run"
    assert told["history"]["feasible"] == [one.feasible for one in expected.history]
    assert [one["best"] for one in told["variables"]] == list(expected.best.values)
    assert [one["unit"] for one in told["variables"]] == ["kg/m", "N*s/m^2"]
    stress, mass = told["targets"]
    assert (stress["baseline"], stress["best"]) == (expected.baseline.objectives[0], expected.best.objectives[0])
    assert (stress["goal"], stress["limits"], stress["unit"]) == ("minimise", [], "Pa")
    assert (mass["goal"], mass["limits"]) == (None, [{"sign": "<=", "value": 200.0}])
    assert told["history"]["best"][-1] == stress["best"]
    best = [value for value in told["history"]["best"] if value is not None]
    assert best == sorted(best, reverse=True)
    assert (told["feasible"], told["evaluations"], told["method"], told["front"]) == (True, 20, "cma-es", [])
    assert System.model_validate(told["best"]["system"]) == expected.system
    assert client.get(f"/api/jobs/{name}/result").headers["content-type"] == "application/json"


def test_the_best_can_be_adopted_and_taken_home(client, single):
    name, told = single
    toml = client.get(f"/api/jobs/{name}/file")
    assert 'filename="absorbers-best-2' in toml.headers["content-disposition"]
    system = System.from_toml_string(toml.text)
    assert toml.text == told["best"]["toml"] == client.get(f"/api/jobs/{name}/file?what=toml").text
    assert system == System.model_validate(told["best"]["system"])
    again = cx.simulate(system, **SMALL).summary().shells[0].stress.value
    assert_allclose(again, told["targets"][0]["best"], rtol=1e-12)
    rows = list(csv.reader(io.StringIO(client.get(f"/api/jobs/{name}/file?what=csv").text)))
    assert len(rows) == 21
    column = rows[0].index("inner.peak_stress")
    assert [float(row[column]) if row[column] else None for row in rows[1:]] == told["history"]["objectives"][0]
    adopted = client.get(f"/api/jobs/{name}/designs/{told['best']['number']}").json()
    assert adopted["ok"]
    assert adopted["system"] == told["best"]["system"]
    assert "inner.peak_stress" in adopted["metrics"]
    assert client.get(f"/api/jobs/{name}/file?what=exe").status_code == 400
    for number in ("20", "-1", "x", "1e3"):
        assert client.get(f"/api/jobs/{name}/designs/{number}").status_code == 400


@pytest.mark.slow
def test_two_objectives_give_the_library_s_front(client, double):
    name, told = double
    expected = cx.optimise(
        presets.load("absorbers"),
        variables=ranges(),
        objectives=["inner.peak_stress", cx.Objective("absorbers.dissipated_energy", maximise=True)],
        constraints=ASKED["constraints"],
        evaluations=20,
        population=8,
        seed=3,
        workers=1,
        **SMALL,
    )
    assert told["method"] == "nsga2"
    assert [one["number"] for one in told["front"]] == [one.number for one in expected.front]
    assert [one["targets"][1] for one in told["front"]] == [one.targets["absorbers.dissipated_energy"] for one in expected.front]
    assert told["history"]["best"] is None
    last = told["front"][-1]
    adopted = client.get(f"/api/jobs/{name}/designs/{last['number']}").json()
    again = cx.simulate(System.model_validate(adopted["system"]), **SMALL).summary().shells[0].stress.value
    assert_allclose(again, last["targets"][0], rtol=1e-12)


@pytest.mark.slow
def test_choices_counts_gains_and_layers_are_those_of_the_library(client):
    variables = {
        "absorbers.count": {"from": 5, "to": 12},
        "control.proportional": {"from": -2e4, "to": 0},
        "shells[1].layers[1].thickness": ["4 mm", "6 mm", "8 mm"],
        "fluids[0]": ["water-1400", "seawater"],
    }
    _, told = done(client, system=described("hybrid"), variables=variables, constraints=[], evaluations=9)
    expected = cx.optimise(
        presets.load("hybrid"), variables=ranges(variables), objectives="inner.peak_stress", evaluations=9, seed=3, workers=1, **SMALL
    )
    assert told["history"]["objectives"][0] == [one.targets["inner.peak_stress"] for one in expected.history]
    assert told["variables"][3]["baseline"] == "water-1400"
    json.dumps(told, allow_nan=False)


def test_designs_that_cannot_be_solved_are_told_and_the_others_go_on(client):
    variables = {"control.derivative": {"from": -150, "to": 1500}}
    name, told = done(client, system=described("active"), variables=variables, constraints=[], evaluations=8)
    assert None in told["history"]["objectives"][0]
    assert told["feasible"]
    assert "unstable" in client.get(f"/api/jobs/{name}/file?what=csv").text


def test_an_optimisation_tells_its_best_on_the_way_and_is_cancelled_midway(client):
    longer = {"evaluations": 2000, "resolution": {"duration": 2.0, "time_step": 1e-3, "modes": 60}}
    job = start(client, system=described("absorbers"), **{**ASKED, **longer})
    end = time.monotonic() + 60
    while "best" not in job["stage"] and time.monotonic() < end:
        time.sleep(0.02)
        job = client.get(f"/api/jobs/{job['id']}").json()["job"]
    assert job["state"] == "running"
    assert re.fullmatch(r"\d+: best inner\.peak_stress \d+\.\d+ kPa", job["stage"]), job["stage"]
    assert 0 < job["fraction"] < 0.1
    assert client.get(f"/api/jobs/{job['id']}/result").json()["error"]["code"] == "not-ready"
    beside = start(client, kind="solve", slot="beside", revision=1, system=described("bare"), resolution={**SMALL, "modes": 10})
    assert ended(client, beside)["state"] == "done", "nothing else waits for a study"
    assert client.get(f"/api/jobs/{job['id']}").json()["job"]["state"] == "running"
    assert client.delete(f"/api/jobs/{job['id']}").status_code == 204
    assert client.get(f"/api/jobs/{job['id']}").json()["job"]["state"] == "cancelled"
    assert client.get(f"/api/jobs/{job['id']}/designs/0").json()["error"]["code"] == "cancelled"
    next_one = ended(client, start(client, kind="sweep", system=described("absorbers"), over={"absorbers.mass": [5]}, resolution=SMALL))
    assert next_one["state"] == "done"


BAD = {
    "nothing varied": ({"variables": {}}, "variables"),
    "a list for variables": ({"variables": [1]}, "variables"),
    "too many": ({"variables": {f"shells[{i}].radius": [1, 2] for i in range(9)}}, "variables"),
    "an unknown path": ({"variables": {"absorbers.colour": {"from": 1, "to": 2}}}, "variables.absorbers.colour"),
    "one end": ({"variables": {"absorbers.mass": {"from": 1}}}, "variables.absorbers.mass"),
    "an empty range": ({"variables": {"absorbers.mass": {"from": 2, "to": 1}}}, "variables.absorbers.mass"),
    "another entry": ({"variables": {"x": {"from": 2, "to": 3, "paths": ["absorbers.mass"]}}}, "variables.x.paths"),
    "a wrong unit": ({"variables": {"absorbers.mass": {"from": 1, "to": "10 Pa"}}}, "variables.absorbers.mass.to"),
    "a logarithm of 0": ({"variables": {"absorbers.mass": {"from": 0, "to": 2, "scale": "log"}}}, "variables.absorbers.mass"),
    "too many absorbers": ({"variables": {"absorbers.count": {"from": 1, "to": 1e12}}}, "variables.absorbers.count"),
    "201 absorbers": ({"variables": {"absorbers.count": {"from": 1, "to": 201}}}, "variables.absorbers.count"),
    "a table as a choice": (
        {"variables": {"source": [{"type": "plane-wave", "pulse": {"type": "sampled", "file": "/etc/passwd"}}, 1]}},
        "variables.source[0]",
    ),
    "too many in all": (
        {"variables": {f"absorbers[*].{name}": {"from": 1, "to": 2} for name in ("mass", "damping", "linear_stiffness")}},
        "variables",
    ),
    "no path": ({"variables": {"\u2603": {"from": 1, "to": 2}}}, "variables"),
    "no objective": ({"objectives": []}, "objectives"),
    "three objectives": ({"objectives": ["inner.peak_stress", "outer.peak_stress", "absorbers.mass"]}, "objectives"),
    "one twice": ({"objectives": ["inner.peak_stress", "inner.peak_stress"]}, "objectives"),
    "a function in a file": ({"objectives": ["/elsewhere/user.py:metric"]}, "objectives[0]"),
    "a function in a file, to limit": ({"constraints": ["/elsewhere/user.py:metric <= 1"]}, "constraints[0]"),
    "a statistic": ({"objectives": ["mean(inner.peak_stress)"]}, "objectives[0]"),
    "a statistic to limit": ({"constraints": ["p95(inner.peak_stress) <= 1 MPa"]}, "constraints[0]"),
    "an entry of an objective": ({"objectives": [{"metric": "inner.peak_stress", "least": True}]}, "objectives[0].least"),
    "neither true nor false": ({"objectives": [{"metric": "inner.peak_stress", "maximise": "x"}]}, "objectives[0].maximise"),
    "no constraint": ({"constraints": ["absorbers.mass"]}, "constraints[0]"),
    "a number as a constraint": ({"constraints": [5]}, "constraints[0]"),
    "a constraint in a wrong unit": ({"constraints": ["absorbers.mass <= 2 kPa"]}, "constraints[0]"),
    "a constraint that is a bomb": ({"constraints": ["absorbers.mass <= 9**9**9**9 kg/m"]}, "constraints[0]"),
    "an impossible constraint": ({"constraints": ["absorbers.mass <= 2 kg/m"]}, "constraints"),
    "uncertain properties": ({"uncertain": {"absorbers.mass": {"type": "normal", "mean": 10, "deviation": 1}}}, "uncertain"),
    "no method": ({"method": "simplex"}, "method"),
    "a method for one objective": ({"objectives": ["inner.peak_stress", "absorbers.mass"], "method": "cma-es"}, "method"),
    "no evaluations": ({"evaluations": 0}, "evaluations"),
    "too many evaluations": ({"evaluations": limits.EVALUATIONS + 1}, "evaluations"),
    "half an evaluation": ({"evaluations": 2.5}, "evaluations"),
    "a small population": ({"population": 2}, "population"),
    "a negative seed": ({"seed": -1}, "seed"),
    "too fine": ({"resolution": {**SMALL, "modes": 5000}}, "resolution.modes"),
    "no system": ({"system": {"shells": []}}, "fluids"),
}


@pytest.mark.parametrize("case", BAD)
def test_what_is_wrong_is_told_before_anything_starts(client, case):
    change, where = BAD[case]
    body = {"client": "tab", "system": described("absorbers"), **ASKED, **change}
    for path in ("/api/jobs", "/api/study"):
        answer = client.post(path, content=json.dumps(body).encode(), headers={"Content-Type": "application/json"})
        assert answer.status_code == 200, answer.text
        problem = answer.json()["problem"]
        assert problem["where"].startswith(where), problem
        assert "\n" not in "".join(problem.values())
        assert "Traceback" not in answer.text


def test_nsga2_without_its_package_is_told_before_anything_starts(client, monkeypatch):
    monkeypatch.setattr("coaxshell.studies.optimisation.methods.find_spec", lambda name: None)
    body = {"client": "tab", "system": described("absorbers"), **ASKED, "objectives": ["inner.peak_stress", "absorbers.mass"]}
    problem = client.post("/api/jobs", json=body).json()["problem"]
    assert problem["where"] == "method"
    assert "coaxshell[optimise]" in problem["remedy"]
