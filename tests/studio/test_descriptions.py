"""Schema, validation, links and uploads."""

from __future__ import annotations

import dataclasses
import json
import threading

import anyio
import pytest
from asking import described, solve

from coaxshell.apps.studio import limits, links, routes
from coaxshell.errors import InputError
from coaxshell.model import System, presets, units


def validated(client, **body):
    answer = client.post("/api/validate", json=body)
    assert answer.status_code == 200, answer.text
    return answer.json()


def test_the_first_unusual_unit_is_read_beside_the_event_loop(monkeypatch):
    """It takes half a second, in which the loop would answer nobody."""

    def reader():
        return anyio.run(routes.read, threading.get_ident, {})

    monkeypatch.setattr(units, "knows_all", lambda: False)
    assert reader() != threading.get_ident()
    monkeypatch.setattr(units, "knows_all", lambda: True)
    assert reader() == threading.get_ident()


def test_units_tell_whether_one_is_left_that_takes_long():
    units._registry.cache_clear()
    assert not units.knows_all()
    units.by_pint("furlong", "m")
    assert units.knows_all()


def test_the_schema_tells_units_limits_and_documentation(client):
    content = client.get("/api/schema").json()
    shell = content["schema"]["$defs"]["Shell"]["properties"]["radius"]
    assert (shell["unit"], shell["exclusiveMinimum"]) == ("m", 0)
    assert "mid-surface" in shell["description"]
    assert content["schema"]["$defs"]["SphericalShock"]["properties"]["peak_pressure"]["nonzero"] is True
    assert [preset["name"] for preset in content["presets"]] == list(presets.names())
    for preset in content["presets"]:
        assert System.model_validate(preset["system"]) == presets.load(preset["name"]) == System.from_toml_string(preset["toml"])
    assert {"pzt-4", "aluminium"} <= {material["name"] for material in content["materials"]}
    assert content["limits"]["absorbers"] == limits.ABSORBERS


@pytest.mark.parametrize("name", presets.names())
def test_json_and_toml_come_back_as_equal_systems(client, name):
    system = presets.load(name)
    by_table, by_text = validated(client, system=described(name)), validated(client, toml=system.to_toml_string())
    assert by_table == by_text
    assert System.model_validate(by_table["system"]) == system == System.from_toml_string(by_table["toml"])


def test_units_are_understood_and_numbers_derived(client):
    system = described()
    system["shells"][1]["radius"] = "100 cm"
    answer = validated(client, system=system)
    assert answer["system"]["shells"][1]["radius"] == 1.0
    derived = {row["name"]: row for row in answer["derived"]}
    assert derived["transit_time"] == {"name": "transit_time", "label": "transit time a/c", "value": 1.0 / 1400, "unit": "s"}
    assert derived["absorber_mass"]["value"] == pytest.approx(250.0, rel=1e-14)


@pytest.mark.parametrize(
    ("path", "value"),
    [
        ("shells[0].radius", -1.0),
        ("source.peak_pressure", 0),
        ("absorbers.count", -3),
        ("control.shells", "middle"),
        ("fluids", ["tea"] * 3),
    ],
)
def test_a_problem_is_told_in_the_words_of_the_library(client, path, value):
    system = described()
    *owner, last = path.replace("[0]", ".0").split(".")
    place = system
    for step in owner:
        place = place[int(step) if step.isdigit() else step]
    place[last] = value
    with pytest.raises(InputError) as refused:
        System.model_validate(system)
    problem = validated(client, system=system)["problem"]
    assert problem == {"where": refused.value.where, "problem": refused.value.problem, "remedy": refused.value.remedy}


@pytest.mark.parametrize(
    ("change", "where"),
    [
        ({"absorbers": {"count": 10**9, "mass": 1}}, "absorbers.count"),
        ({"absorbers": [{"mass": 1, "angle": 0}] * 201}, "absorbers"),
        ({"shells": [{"radius": 1, "rigid": True}] * 7}, "shells"),
        ({"source": {"type": "plane-wave", "pulse": {"type": "sampled", "file": "/etc/passwd"}}}, "source.pulse.file"),
        ({"source": [{"type": "plane-wave", "pulse": {"type": "sampled", "file": "../x"}}]}, "source[0].pulse.file"),
    ],
)
def test_what_is_too_large_or_a_file_is_refused_before_it_is_read(client, change, where):
    assert validated(client, system={**described(), **change})["problem"]["where"] == where


def test_a_link_holds_the_whole_system(client):
    content = {"v": 1, "system": described(), "resolution": {"modes": 80}, "view": {"tab": "field"}}
    fragment = client.post("/api/link", json=content).json()["fragment"]
    assert len(fragment) < 1250
    opened = client.post("/api/link/open", json={"fragment": "#" + fragment}).json()
    assert opened["ok"]
    assert System.model_validate(opened["system"]) == presets.load("hybrid")
    assert (opened["resolution"], opened["view"]) == ({"modes": 80}, {"tab": "field"})
    for broken in (fragment[:-9], "s=!!", "x", "s=", fragment[:9] + "A" + fragment[10:]):
        assert client.post("/api/link/open", json={"fragment": broken}).status_code == 400


def recorded(samples):
    """Return a description whose source is a record of so many samples."""
    system = described("bare")
    pulse = {"type": "sampled", "time": [1e-6 * k for k in range(samples)], "pressure": [1e4 * 0.999**k for k in range(samples)]}
    return {**system, "source": {"type": "plane-wave", "angle": 0.0, "pulse": pulse}}


def test_a_long_record_makes_no_long_link_and_comes_back_as_long_as_the_server_runs(client):
    short, long = ({"v": 1, "system": recorded(samples)} for samples in (100, 20_000))
    for content, kept in ((short, 0), (long, 20_000)):
        answer = client.post("/api/link", json=content).json()
        assert answer["samples_kept"] == kept
        assert len(answer["fragment"]) < 3_000
        back = client.post("/api/link/open", json={"fragment": answer["fragment"]}).json()
        assert back["system"] == validated(client, system=content["system"])["system"]
    other = {**long, "system": recorded(20_000)}
    other["system"]["source"]["pulse"] = {"type": "sampled", "kept": "0" * 32}
    lost = client.post("/api/link/open", json={"fragment": links.fragment(other)}).json()
    assert lost["problem"]["where"] == "link"
    assert "file" in lost["problem"]["remedy"]


def test_all_that_is_wrong_is_told_at_once(client):
    system = described("hybrid")
    system["absorbers"].update(mass="-3 kg/m", damping="heavy")
    system["shells"][1]["layers"][0]["thickness"] = "6 kg"
    told = validated(client, system=system, resolution={"duration": -1, "modes": 301, "time_step": 0.001, "refinement": 1})
    places = [problem["where"] for problem in told["problems"]]
    assert told["problem"] == told["problems"][0]
    assert sorted(places) == [
        "absorbers.damping",
        "absorbers.mass",
        "resolution.duration",
        "resolution.modes",
        "shells[1].layers[0].thickness",
    ]
    for problem in told["problems"]:
        assert problem["problem"]
        assert problem["remedy"]


def test_a_link_that_unpacks_to_too_much_is_refused(client):
    from coaxshell.apps.studio.links import fragment

    bomb = fragment({"v": 1, "system": {"name": "a" * 50_000_000}})
    assert len(bomb) < 200_000
    assert client.post("/api/link/open", json={"fragment": bomb}).status_code == 400


def test_files_are_uploaded(client, tmp_path):
    import coaxshell as cx

    system = presets.load("absorbers")
    toml = client.post("/api/upload", content=system.to_toml_string(), headers={"Content-Type": "application/toml"}).json()
    assert System.model_validate(toml["system"]) == system
    path = cx.simulate(system, duration=1.0, time_step=0.02, modes=8).save(tmp_path / "run.nc")
    header = {"Content-Type": "application/x-netcdf"}
    opened = client.post("/api/upload", content=path.read_bytes(), headers=header).json()
    assert System.model_validate(opened["system"]) == system
    assert opened["resolution"] == {"duration": 1.0, "time_step": 0.02, "modes": 8, "refinement": 1}
    for damaged in (b"", b"CDF\x01", path.read_bytes()[:3000], path.read_bytes()[:200] + b"\xff" * 4000):
        assert client.post("/api/upload", content=damaged, headers=header).json()["problem"]["where"] == "file"
    assert client.post("/api/upload", content=b"x", headers={"Content-Type": "application/x-pickle"}).status_code == 415
    assert (
        client.post("/api/upload", content=b"\xff\xfe", headers={"Content-Type": "application/toml"}).json()["problem"]["where"] == "file"
    )


def test_bodies_are_bounded(client):
    header = {"Content-Type": "application/json"}
    assert client.post("/api/validate", content=b"x" * (limits.BODY_BYTES + 1), headers=header).status_code == 413
    parts = (b"x" * 100_000 for _ in range(20))
    assert client.post("/api/validate", content=parts, headers=header).status_code == 413
    assert client.post("/api/validate", content=json.dumps({"toml": "x"})).status_code == 415


def test_a_resolution_in_three_dimensions_is_checked_as_everywhere(client):
    spatial = {"duration": 1.0, "time_step": 0.02, "modes": 8, "dimensions": 3, "stations": ["0 m", "70 cm"], "axial_period": "20 m"}
    answer = validated(client, system=described("bare"), resolution=spatial)
    assert answer["resolution"] == {**spatial, "stations": [0.0, 0.7], "axial_period": 20.0}
    plane = {name: spatial[name] for name in ("duration", "time_step", "modes")}
    assert validated(client, system=described("bare"), resolution=plane)["resolution"] == plane
    for changes, told in (
        ({"dimensions": 4}, ["dimensions: 4 is not allowed"]),
        ({"dimensions": 2}, ["stations: has no effect in two dimensions", "axial_period: has no effect in two dimensions"]),
        ({"stations": [0.0, "1 s"], "modes": 0}, ["modes: 0 is not allowed", "stations[1]: '1 s' is not a length"]),
        ({"stations": list(range(21))}, ["stations: 21 stations are too many here"]),
    ):
        refused = validated(client, system=described("bare"), resolution={**spatial, **changes})
        found = [f"{problem['where']}: {problem['problem']}" for problem in refused["problems"]]
        assert [problem.removeprefix("resolution.") for problem in found] == told


def test_a_source_off_the_plane_is_told_before_anything_is_begun(client):
    system = described("bare")
    system["source"]["z"] = 0.7
    assert validated(client, system=system)["ok"], "a description does not know in how many dimensions it is solved"
    answer = solve(client, system).json()
    assert (answer["problem"]["where"], answer["ok"]) == ("source.z", False)
    assert "off the plane of a run in two dimensions" in answer["problem"]["problem"]


def test_what_other_choices_cost_is_told_before_they_are_made(client):
    body = {"system": described("bare"), "resolution": {"duration": 3.0, "modes": 40}, "choices": True}
    costs = client.post("/api/validate", json=body).json()["costs"]
    system, settings = presets.load("bare"), limits.settings_of(body["resolution"], live=False)
    elastic = limits.cost_of(system.with_overrides({"shells[1].theory": "elastic"}), settings)
    assert costs["theories"][1] == elastic
    assert costs["dimensions"] == limits.cost_of(system, dataclasses.replace(limits.FULL_SPATIAL, duration=3.0))
    cut = presets.load("electrodes-hybrid").with_overrides({"control.segments": 24}).model_dump(mode="json")
    controlled = client.post("/api/validate", json={**body, "system": cut}).json()["costs"]
    assert controlled["dimensions"] is None, "cubic lines beside segments are not solved in three dimensions"
    assert "dimensions" not in client.post("/api/validate", json={**body, "choices": False}).json()["costs"]
