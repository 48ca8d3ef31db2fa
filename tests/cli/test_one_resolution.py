"""A resolution is checked in one place: call, study file, confirmation, page and command take the same and refuse it in the same words."""

from __future__ import annotations

import json

import pytest

import coaxshell as cx
from coaxshell.apps.cli.running import Request
from coaxshell.apps.studio import limits
from coaxshell.solver.settings import Settings
from coaxshell.studies import SweepStudy
from coaxshell.studies.optimisation.confirmation import finer

BARE = cx.presets.load("bare")
WRONG = {
    "duration": ["soon", "5 kg", "-1", "nan", "1e999", "0", "9" * 400],
    "time_step": ["soon", "0", "2", "1e-12", "3 s"],
    "modes": ["many", "0", "3.5", "5000", "-1", ""],
    "tolerance": ["x", "0", "inf"],
    "refinement": ["twice", "0", "65", "1.5"],
    "engine": ["steam", ""],
    "dimensions": ["4", "2.5", "three", ""],
    "stations": ["1 s", "", "0,0.7", "nan"],
    "axial_modes": ["0", "many", "60"],
    "axial_period": ["-1", "5 kg", "20 m"],
}
SPATIAL = {"dimensions": 3, "stations": "0 m,70 cm", "axial_modes": 40, "axial_period": "20 m"}
CASES = [(name, text) for name, texts in WRONG.items() for text in texts]


def study(table):
    return SweepStudy(scenario="bare", over={"source.peak_pressure": [1.0]}, metrics=["system.total_mass"], resolution=table)


def refusal(call, *arguments, **keywords):
    with pytest.raises(cx.InputError) as refused:
        call(*arguments, **keywords)
    return refused.value.where, refused.value.problem, refused.value.remedy


@pytest.mark.parametrize(("name", "text"), CASES)
def test_everybody_refuses_it_in_the_same_words(refused, name, text):
    where, problem, remedy = refusal(cx.simulate, BARE, **{name: text})
    assert where in (name, "time_step")  # a duration may be too short for the step
    assert refusal(cx.sweep, BARE, {"source.peak_pressure": [1.0]}, **{name: text}) == (where, problem, remedy)
    assert refusal(study({name: text}).settings, BARE) == (f"resolution.{where}", problem, remedy)
    assert refusal(finer, BARE, Settings(), {name: text}) == (f"confirm.{where}", problem, remedy)
    assert (
        refused("run", "bare", f"--{name.replace('_', '-')}={text}")
        == f"error: {cx.InputError(f'--{where}'.replace('_', '-'), problem, remedy)}\n"
    )
    if name in limits.ENTRIES:
        assert refusal(limits.settings_of, {name: text}, live=False, system=BARE) == (f"resolution.{where}", problem, remedy)


@pytest.mark.parametrize(
    "table", [{}, {"duration": "3 ms", "time_step": "4 us"}, {"modes": "auto", "tolerance": "1e-2"}, {"modes": 60.0}, SPATIAL]
)
def test_everybody_takes_the_same(table):
    found = Settings.of(BARE, table)
    texts = {name: str(value).removesuffix(".0") for name, value in table.items()}
    assert study(table).settings(BARE) == found
    assert Request(**texts).settings(BARE) == found
    if table:
        assert finer(BARE, Settings(), table)[0] == found
    if set(table) <= set(limits.ENTRIES):
        preview = limits.PREVIEW_SPATIAL if table.get("dimensions") == 3 else limits.PREVIEW
        assert limits.settings_of(table, live=False, system=BARE) == Settings.of(BARE, table, base=preview)


def test_an_item_of_an_option_is_called_by_the_option(refused):
    told = refused("run", "bare", "--dimensions", "3", "--stations", "-1,0,1 s")
    assert told == "error: --stations: '1 s' is not a length; give a length as a finite number in m or as text such as '6 mm'\n"
    assert "--stations: has no effect in two dimensions" in refused("plot", "bare", "--stations", "-0.5")
    assert "--engine: 'direct' solves two dimensions only" in refused("run", "bare", "--dimensions", "3", "--engine", "direct")


@pytest.mark.parametrize("command", [("figure", "2"), ("figure", "12")])
def test_commands_that_show_two_dimensions_say_so(refused, command, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    told = refused(*command, "--dimensions", "3")
    assert told == "error: --dimensions: 3 is not for this command, which shows two; use coaxshell run, or --dimensions 2\n"


def test_the_defaults_that_a_command_shows_are_those_of_a_run():
    assert Request().settings(BARE) == Settings() == Settings.of(BARE)


def test_an_entry_that_there_is_not_is_told_with_the_nearest():
    found = refusal(Settings.of, BARE, {"mods": 6}, where="resolution")
    assert found[:2] == ("resolution.mods", "is not an entry of a resolution")
    assert "did you mean 'modes'?" in found[2]
    assert refusal(Settings.of, BARE, 5, where="resolution")[0] == "resolution"
    assert "without a system" in refusal(Settings, duration="3 ms")[1]


def test_a_resolution_is_read_back_from_its_table():
    found = Settings(duration=3, modes="auto", engine="direct", refinement=2)
    assert Settings.of(BARE, json.loads(json.dumps(found.arguments()))) == found
    assert type(found.duration) is float
    assert found.up_to(2.0).duration == 2.0


def test_old_names_still_work_and_say_what_they_are_now():
    from coaxshell import studies
    from coaxshell.apps import paper

    for room in (studies, paper):
        with pytest.warns(DeprecationWarning, match=r"Resolution is now coaxshell\.solver\.settings\.Settings"):
            assert room.Resolution is Settings
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        studies.nothing  # noqa: B018
