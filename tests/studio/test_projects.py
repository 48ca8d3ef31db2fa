"""A project file holds designs exactly: what is written is read back equal, and what is no project is refused in words."""

from __future__ import annotations

import pytest
from asking import SMALL, described

import coaxshell as cx
from coaxshell.apps.studio import limits, projects
from coaxshell.model import presets

SPACE = {"dimensions": 3, "stations": [0.0, 0.5], "axial_period": 40.0, **SMALL}


def written(client, designs):
    return client.post("/api/project", json={"designs": designs}).json()


def opened(client, text):
    return client.post("/api/project/open", json={"toml": text}).json()


def recorded():
    pulse = cx.Sampled(time=[k * 1e-5 for k in range(300)], pressure=[1e4 / (1 + k) for k in range(300)])
    return presets.load("coated").replace(source=cx.PlaneWave(pulse=pulse)).model_dump(mode="json")


def test_designs_come_back_as_they_were(client):
    changed = described("hybrid") | {"name": 'a "b" é'}
    designs = [
        {"name": "A", "system": changed, "resolution": SMALL},
        {"name": "B", "system": described("absorbers"), "resolution": SPACE},
        {"name": "with a record", "system": recorded(), "resolution": {}},
        *({"name": name, "system": described(name), "resolution": SMALL} for name in presets.names()),
    ]
    answer = written(client, designs)
    assert answer["ok"], answer
    back = opened(client, answer["toml"])
    assert back["ok"], back
    assert [one["name"] for one in back["designs"]] == [one["name"] for one in designs]
    for one, before in zip(back["designs"], designs, strict=True):
        assert cx.System.model_validate(one["system"]) == cx.System.model_validate(before["system"]), one["name"]
        assert before["resolution"].items() <= one["resolution"].items()
    assert [name for name, *_ in projects.designs_in(answer["toml"])] == [one["name"] for one in designs]


GOOD = {"name": "A", "system": described("bare"), "resolution": SMALL}
REFUSED = {
    "designs": [[], None, "x", {}, [GOOD] * (limits.DESIGNS + 1)],
    "designs[1]": [[GOOD, 1]],
    "designs[0].name": [[{**GOOD, "name": name}] for name in ("", " ", 3, "x" * 300, "\x00")],
    "designs[0].system": [[{**GOOD, "system": None}]],
    "designs[0].system.shells[0].radius": [[{**GOOD, "system": described("steel-tube") | {"shells": [{"radius": -1, "layers": []}]}}]],
    "designs[0].resolution.modes": [[{**GOOD, "resolution": {"modes": 10**6}}]],
}


@pytest.mark.parametrize("where", REFUSED)
def test_what_is_wrong_is_named_by_its_place(client, where):
    for designs in REFUSED[where]:
        problem = written(client, designs)["problem"]
        assert problem["where"] == where, problem
        assert problem["remedy"]


@pytest.mark.parametrize("text", ["", "version = 1", "version = 2\n[[designs]]", "a = [", "version = 1\ndesigns = 3"])
def test_what_is_no_project_is_refused(client, text):
    answer = opened(client, text)
    assert not answer["ok"]
    assert answer["problem"]["problem"]


def test_a_project_names_no_file_of_this_machine(client):
    text = written(client, [GOOD])["toml"]
    text = text.replace("peak_pressure = 25000.0\ndecay_time = 0.0001314", 'pulse = { type = "sampled", file = "/etc/passwd" }')
    assert "passwd" in text
    assert opened(client, text)["problem"]["where"].endswith("source.pulse.file")
