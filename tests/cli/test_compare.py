"""``coaxshell run --compare`` and ``--figure``; what is wrong with absorbers and control is told in one line."""

from __future__ import annotations

import re

import pytest

import coaxshell as cx
from coaxshell.apps.cli.running import load_reference
from coaxshell.response.run_comparison import comparison_rows, labels

COARSE = {"modes": 6, "time_step": 0.02, "duration": 1}


def rows(text):
    """Return {(shell, quantity): cells} of the printed table."""
    cells = [re.split(r" {2,}", line.strip()) for line in text.splitlines() if re.match(r"(inner|outer|absorbers|shell) ", line)]
    return {(row[0], row[1]): row[2:] for row in cells}


def test_prints_both_side_by_side_in_words(run, small):
    outcome = run("run", "hybrid", "--compare", "bare", *small, "--quiet")
    assert outcome.code == 0, outcome.err
    assert outcome.files == []
    assert outcome.out.splitlines()[0] == "hybrid against bare"
    found = rows(outcome.out)
    hybrid, bare = (cx.simulate(cx.presets.load(name), **COARSE).summary() for name in ("hybrid", "bare"))
    for ours, theirs in zip(hybrid.shells, bare.shells, strict=True):
        cells = found[ours.name, "stress at head"]
        assert cells[0].startswith(f"{ours.stress_head.value / 1e3:#.4g}")
        assert cells[1].startswith(f"{theirs.stress_head.value / 1e3:#.4g}")
        assert cells[2] == f"smaller by {100 * (1 - ours.stress_head.value / theirs.stress_head.value):.1f} %"
    assert found["outer", "actuator voltage asked"][1:] == ["-", "-"]  # the bare system has none
    assert found["absorbers", "force on a shell"][1:] == ["-", "-"]
    assert outcome.out.count("6 modes") == 2


def test_warnings_tell_whose_they_are(run, small):
    outcome = run("run", "active", "--compare", "bare", "--duration", "1", "--time-step", "0.01", "--modes", "20", "-q")
    assert outcome.code == 0
    lines = outcome.err.splitlines()
    assert all(line.startswith(("warning: active: ", "warning: bare: ")) for line in lines)
    assert any("active: outer shell" in line and "1.770 kV" in line for line in lines)


def test_a_file_against_a_preset_and_saves_the_first(run, small, tmp_path):
    cx.presets.load("absorbers").replace(name="mine").to_toml(tmp_path / "mine.toml")
    outcome = run("run", "mine.toml", "--compare", "bare", *small, "-q", "-o", "out.nc", "--figure", "both.png")
    assert outcome.code == 0, outcome.err
    assert outcome.files == ["both.png", "mine.toml", "out.nc"]
    assert (tmp_path / "both.png").read_bytes().startswith(b"\x89PNG")
    assert cx.load_response(tmp_path / "out.nc").system.name == "mine"
    assert "saved out.nc" in outcome.out
    assert "wrote both.png" in outcome.out
    assert "mine against bare" in outcome.out


def test_a_file_as_the_reference(run, small, tmp_path):
    cx.presets.load("bare").replace(name="").to_toml(tmp_path / "mine.toml")
    outcome = run("run", "bare", "--compare", "mine.toml", *small, "-q")
    assert outcome.code == 0, outcome.err
    assert set(rows(outcome.out)["inner", "stress at head"][2:]) == {"the same"}


def test_figure_of_one_system(run, small):
    outcome = run("run", "bare", *small, "-q", "--figure", "bare.svg")
    assert outcome.code == 0, outcome.err
    assert outcome.files == ["bare.svg"]
    assert "stress at head" in outcome.out


@pytest.mark.slow
def test_one_shell_against_two(run, small):
    outcome = run("run", "iakovlev-filled", "--compare", "iakovlev-double", *small, "-q", "--figure", "one-two.png")
    assert outcome.code == 0, outcome.err
    found = rows(outcome.out)
    assert found["shell", "stress at head"][1:] == ["-", "-"]
    assert found["inner", "stress at head"][0] == "-"


def test_changes_are_made_to_both_where_they_fit():
    source = "source.peak_pressure=50 kPa"
    bare = load_reference("bare", [source, "absorbers.count=50", "control.derivative=-10", "absorbers[0].mass=3"])
    assert bare == cx.presets.load("bare").with_overrides({"source.peak_pressure": 5e4})
    absorbers = load_reference("absorbers", [source, "absorbers.count=50", "control.derivative=-10"])
    assert len(absorbers.absorber_list) == 50
    assert absorbers.control is None
    assert absorbers.sources[0].peak_pressure == 5e4


def test_equal_names_are_told_apart():
    bare = cx.presets.load("bare")
    assert labels(bare, bare) == ("bare", "bare (compared)")
    assert labels(bare.replace(name=""), bare.replace(name="")) == ("first", "second")


def test_rows_follow_the_shells_from_the_inside():
    bare = cx.simulate(cx.presets.load("bare"), **COARSE).summary()
    names = [row[0] for row in comparison_rows(bare, bare)]
    assert names == sorted(names)  # inner before outer


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["hybrid", "--compare", "bear"], ["--compare: there is no preset 'bear'", "bare, absorbers"]),
        (["hybrid", "--compare", "missing.toml"], ["missing.toml", "cannot be read"]),
        (["bear", "--compare", "bare"], ["'bear'"]),
        (["hybrid", "--compare"], ["--compare"]),
        (["hybrid", "--compare", "bare", "--compare-with", "x"], ["--compare-with", "--compare"]),
        (["hybrid", "--compare", "bare", "--figure", "both.jpeg"], ["--figure", "'both.jpeg'", ".png, .pdf, .svg"]),
        (["hybrid", "--compare", "bare", "--figure", "nowhere/both.png"], ["--figure", "'nowhere'", "does not exist"]),
        (["bare", "--figure", "/proc/both.png"], ["--figure", "/proc"]),
        (["hybrid", "--compare", "bare", "--output", "nowhere/out.nc"], ["--output", "'nowhere'"]),
        (["hybrid", "--compare", "bare", "--modes", "0"], ["--modes", "0", "1 to 2000"]),
        (["hybrid", "--compare", "bare", "-s", "source.distance=0.5"], ["source.distance", "0.5", "greater than"]),
        (["hybrid", "--compare", "iakovlev-double", "-s", "source.distance=4"], ["source.distance", "distance"]),
        (["hybrid", "--compare", "bare", "-s", "absorbers.cuont=3"], ["absorbers.cuont", "count"]),
    ],
    ids=" ".join,
)
def test_bad_input(refused, monkeypatch, arguments, words):
    if "--modes" not in arguments:
        monkeypatch.setattr("coaxshell.solver.solve", lambda *_, **__: pytest.fail("the work was started"))
    message = refused("run", *arguments)
    for word in words:
        assert word in message, message


def test_a_failing_comparison_leaves_old_files_alone(refused, tmp_path):
    (tmp_path / "both.png").write_text("precious")
    arguments = ("active", "--compare", "bare", "-s", "control.derivative=150", "--modes", "20", "--figure", "both.png", "-q")
    assert "'both.png' exists already; give another name, or --force" in refused("run", *arguments, left=["both.png"])
    assert "control.derivative: 150" in refused("run", *arguments, "--force", left=["both.png"])
    assert (tmp_path / "both.png").read_text() == "precious"


RING = "absorbers={count=3,mass=10,linear_stiffness=1e8}"
GAINS = "control={proportional=-2e4,derivative=-150}"


@pytest.mark.slow_for("active-control.derivative=150-words24")
@pytest.mark.parametrize(
    ("scenario", "change", "words"),
    [
        ("iakovlev-filled", RING, ["absorbers", "links two shells", "has 1"]),
        ("absorbers", "absorbers.mass=-1", ["absorbers.mass", "-1", "at least 0"]),
        ("absorbers", "absorbers.damping=-3", ["absorbers.damping", "-3", "at least 0"]),
        ("absorbers", "absorbers.linear_stiffness=-3", ["absorbers.linear_stiffness", "-3", "at least 0"]),
        ("absorbers", "absorbers.cubic_stiffness=nan", ["absorbers.cubic_stiffness", "nan", "finite"]),
        ("absorbers", "absorbers.cubic_stiffness=1 GPa", ["absorbers.cubic_stiffness", "1 GPa", "N/m^4"]),
        ("absorbers", "absorbers.mass=6 mm", ["absorbers.mass", "6 mm", "kg/m"]),
        ("absorbers", "absorbers.count=2.5", ["absorbers.count", "2.5", "whole number"]),
        ("absorbers", "absorbers.count=-2", ["absorbers.count", "-2"]),
        ("absorbers", "absorbers.inner_shell=1", ["absorbers.inner_shell", "1", "at most 0"]),
        ("absorbers", "absorbers={count=3,mass=0}", ["absorbers.mass", "undetermined"]),
        ("absorbers", "absorbers=[{angle=0}]", ["absorbers[0].mass", "missing"]),
        ("absorbers", "absorbers=[{angle=0,mass=1,cubic=3}]", ["absorbers[0].cubic", "cubic_stiffness"]),
        ("absorbers", "absorbers=3", ["absorbers", "3"]),
        ("bare", "absorbers.count=3", ["absorbers.count", "no absorbers"]),
        ("iakovlev-double", GAINS, ["control.shells", "shells[0] has no sensor layer"]),
        ("bare", "control={proportional=-1,derivative=-1,shells=[5]}", ["control.shells", "5", "0 to 1"]),
        ("active", "control.shells=inner,inner", ["control.shells", "only once"]),
        ("active", "control.shells=middle", ["control.shells", "'middle'", "'inner' or 'outer'"]),
        ("active", "control.proportional=inf", ["control.proportional", "inf", "finite"]),
        ("active", "control.field_limit=0", ["control.field_limit", "0", "greater than 0"]),
        ("active", "control.saturation=perhaps", ["control.saturation", "perhaps"]),
        ("active", "control={proportional=-1}", ["control.derivative", "missing"]),
        ("active", "control.proportional=2e4", ["control.proportional", "20000", "unstable", "order 2", "negative gains"]),
        ("active", "control.derivative=150", ["control.derivative", "150", "unstable", "order"]),
        ("hybrid", "control.derivative=150", ["control.derivative", "150", "unstable", "order"]),
    ],
)
def test_bad_absorbers_and_control(refused, scenario, change, words):
    message = refused("run", scenario, "--set", change, "--modes", "20", "--time-step", "0.02", "--quiet")
    for word in words:
        assert word in message, message


def test_a_sensor_without_an_actuator(refused, tmp_path):
    system = cx.presets.load("bare")
    lone = system.shells[0].replace(layers=[*system.shells[0].layers[:2], system.shells[0].layers[2].replace(role="passive")])
    text = system.replace(shells=[lone, system.shells[1]]).to_toml_string()
    (tmp_path / "lone.toml").write_text(text + "\n[control]\nproportional = -2e4\nderivative = -150\n")
    message = refused("run", "lone.toml", "--quiet", left=["lone.toml"])
    assert "shells[0] has no actuator layer" in message
    assert "shells = ['outer']" in message
