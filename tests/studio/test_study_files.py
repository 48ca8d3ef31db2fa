"""The study file that the page shows is the study that it starts, as the command line reads it."""

from __future__ import annotations

import re

import pytest
from asking import described
from test_optimisations import ASKED

from coaxshell.apps.studio import limits, optimisations, study_routes
from coaxshell.errors import InputError
from coaxshell.model import presets
from coaxshell.studies import OptimisationStudy, SweepStudy, read_study


def written(client, tmp_path, **body):
    answer = client.post("/api/study", json=body).json()
    assert answer["ok"], answer
    path = tmp_path / "study.toml"
    path.write_text(answer["toml"], encoding="utf-8")
    return path


def own_system():
    changed = presets.load("hybrid").with_overrides(
        {"absorbers.mass": 7.123456789012345, "source.peak_pressure": 0.1 + 0.2, "name": 'a "b" \\ é'}
    )
    return changed.replace(absorbers=changed.absorber_list[:5])


SYSTEMS = {"a preset": presets.load("absorbers"), "one of one's own": own_system()}


@pytest.mark.parametrize("system", SYSTEMS.values(), ids=SYSTEMS)
def test_an_optimisation(client, tmp_path, system):
    body = {
        **ASKED,
        "variables": {
            **ASKED["variables"],
            "shells[1].layers[0].thickness": ["4 mm", 0.006],
            "source.peak_pressure": {"from": 1e4, "to": 3e4},
        },
        "objectives": ["inner.peak_stress", {"metric": "absorbers.dissipated_energy", "maximise": True}],
        "constraints": [*ASKED["constraints"], "outer.peak_stress <= 5 MPa"],
        "population": 8,
        "system": system.model_dump(mode="json"),
    }
    path = written(client, tmp_path, **body)
    study = read_study(path, OptimisationStudy)
    problem = study.problem(tmp_path)
    settings = limits.settings_of(body["resolution"], live=False)
    assert problem.parts() == optimisations.planned(system, settings, body).parts()
    assert problem.evaluations == body["evaluations"]
    assert problem.space.base == system
    assert (study.scenario == "absorbers") == (system == presets.load("absorbers"))


@pytest.mark.parametrize("system", SYSTEMS.values(), ids=SYSTEMS)
@pytest.mark.parametrize(
    "points",
    [
        {"over": {"absorbers.mass": [5, "20 kg"], "source.peak_pressure": {"from": 1e4, "to": 3e4, "count": 3, "scale": "log"}}},
        {"over": {"absorbers.mass": [1, 20]}, "points": "sobol", "samples": 8, "seed": 5},
    ],
    ids=["grid", "sobol"],
)
def test_a_sweep(client, tmp_path, system, points):
    body = {"kind": "sweep", "metrics": ["inner.peak_stress"], "resolution": "preview", "system": system.model_dump(mode="json"), **points}
    path = written(client, tmp_path, **body)
    base, design, metrics, resolution = read_study(path, SweepStudy).parts(tmp_path)
    asked = study_routes.asked("sweep", body).arguments
    assert (base, design, metrics) == (asked[0], asked[2], asked[3])
    assert resolution.modes == limits.PREVIEW.modes
    assert resolution.time_step == limits.PREVIEW.time_step


def test_other_kinds_have_none(client):
    assert client.post("/api/study", json={"kind": "film", "system": described()}).status_code == 400


def test_a_description_in_a_study_file_is_checked(client, tmp_path):
    path = written(client, tmp_path, **ASKED, system={**described("absorbers"), "name": "mine"})
    path.write_text(path.read_text().replace("radius = 1.0", "radius = -1.0"))
    with pytest.raises(InputError, match=re.escape("scenario.shells[1].radius: -1.0 m")):
        read_study(path, OptimisationStudy).problem(tmp_path)
    path.write_text(path.read_text().replace("[scenario", "[[scenario"))
    with pytest.raises(InputError):
        read_study(path, OptimisationStudy)
    path.write_text("scenario = 5\nvariables = {}\nobjectives = []\n")
    with pytest.raises(InputError, match="scenario: 5 is not a scenario"):
        read_study(path, OptimisationStudy)
