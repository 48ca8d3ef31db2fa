"""``coaxshell run``."""

from __future__ import annotations

import numpy as np
import pytest

import coaxshell as cx


def test_prints_the_summary_and_plain_progress(run, small):
    outcome = run("run", "bare", *small)
    assert outcome.code == 0
    for word in ("bare", "inner", "outer", "stress at head", "stress at tail", "6 modes"):
        assert word in outcome.out
    assert all(line.endswith(" %") for line in outcome.err.splitlines() if not line.startswith("warning: "))
    assert "100 %" in outcome.err
    assert outcome.files == []


def test_quiet_shows_no_progress(run, small):
    outcome = run("run", "bare", *small, "--quiet")
    assert outcome.code == 0
    assert [line for line in outcome.err.splitlines() if not line.startswith("warning: ")] == []
    assert "stress at head" in outcome.out


def test_saves_what_python_computes(run, small, tmp_path):
    outcome = run(
        "run", "bare", *small, "-q", "-s", "source.peak_pressure=50 kPa", "-s", "shells[0].layers.1.thickness=8 mm", "-o", "out.nc"
    )
    assert outcome.code == 0
    assert "saved out.nc" in outcome.out
    assert outcome.files == ["out.nc"]
    loaded = cx.load_response(tmp_path / "out.nc")
    system = cx.presets.load("bare").with_overrides({"source.peak_pressure": 5e4, "shells[0].layers[1].thickness": 8e-3})
    assert loaded.system == system
    expected = cx.simulate(system, modes=6, time_step=0.02, duration=1)
    np.testing.assert_array_equal(loaded.stress("inner").to_numpy(), expected.stress("inner").to_numpy())


def test_draws_the_energy(run, small):
    outcome = run("run", "bare", *small, "-q", "--energy", "energy.png")
    assert outcome.code == 0, outcome.err
    assert outcome.files == ["energy.png"]
    assert "wrote energy.png" in outcome.out


@pytest.mark.slow
def test_draws_the_energy_over_the_whole_length(run, small):
    outcome = run("run", "bare", *small, "--dimensions", "3", "-q", "--energy", "energy.png")
    assert outcome.code == 0, outcome.err
    assert outcome.files == ["energy.png"]


def test_runs_a_file(run, small, tmp_path):
    cx.presets.load("iakovlev-filled").to_toml(tmp_path / "mine.toml")
    outcome = run("run", "mine.toml", *small, "--quiet")
    assert outcome.code == 0
    assert "iakovlev-filled" in outcome.out


def test_modes_auto(run):
    outcome = run("run", "iakovlev-filled", "--modes", "auto", "--tolerance", "0.3", "--time-step", "0.05", "--duration", "1", "--quiet")
    assert outcome.code == 0, outcome.err
    assert "auto" not in outcome.out


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["bear"], ["SCENARIO: there is no preset 'bear'; did you mean 'bare'?", "bare, absorbers", "or a .toml file"]),
        (["missing.toml"], ["missing.toml", "cannot be read"]),
        (["done.nc"], ["'done.nc'", "saved run", "coaxshell info"]),
        (["bare", "--set", "source.peak_presure=1e4"], ["source.peak_presure", "peak_pressure"]),
        (["bare", "--set", "source.peak_pressure=6 mm"], ["source.peak_pressure", "'6 mm'", "pressure", "Pa"]),
        (["bare", "--set", "source.peak_pressure=nan"], ["source.peak_pressure", "nan", "finite"]),
        (["bare", "--set", "shells[0].radius=-1"], ["shells[0].radius", "-1", "greater than 0"]),
        (["bare", "--set", "shells[0].radius=2"], ["shells", "radius"]),
        (["bare", "--set", "shells[7].radius=1"], ["shells[7]", "allowed: 0, 1"]),
        (["bare", "--set", "source.peak_pressure"], ["--set", "'source.peak_pressure'", "path=value"]),
        (["bare", "--set", "=3"], ["--set", "path=value"]),
        (["bare", "-s", "source.distance=3", "-s", "source.distance=4"], ["--set", "'source.distance'", "twice"]),
        (["bare", "--modes", "0"], ["--modes", "0", "1 to 2000"]),
        (["bare", "--modes", "5000"], ["--modes", "5000", "1 to 2000"]),
        (["bare", "--modes", "many"], ["--modes", "'many'", '"auto"']),
        (["bare", "--modes", "3.5"], ["--modes", "'3.5'", "whole number"]),
        (["bare", "--time-step", "2"], ["--time-step", "2", "too coarse", "1.25"]),
        (["bare", "--time-step", "0"], ["--time-step", "0", "greater than 0"]),
        (["bare", "--time-step", "1e-12"], ["--time-step", "steps", "2000000 are allowed"]),
        (["bare", "--time-step", "soon"], ["--time-step", "'soon'", "number"]),
        (["bare", "--duration", "nan"], ["--duration", "nan", "finite"]),
        (["bare", "--duration", "-5"], ["--duration", "-5", "greater than 0"]),
        (["bare", "--duration", "inf"], ["--duration", "inf", "finite"]),
        (["bare", "--tolerance", "0", "--modes", "auto"], ["--tolerance", "0", "greater than 0"]),
        (["bare", "--refinement", "0"], ["--refinement", "0", "1 to 64"]),
        (["bare", "--refinement", "twice"], ["--refinement", "'twice'", "whole number"]),
        (["bare", "--engine", "steam"], ["--engine", "'steam'", "spectral"]),
        (["bare", "--output", "nowhere/out.nc"], ["--output", "'nowhere'", "does not exist"]),
        (["bare", "--output", "out.csv"], ["--output", "'out.csv'", ".nc"]),
        (["bare", "--energy", "out.nc"], ["--energy", "'out.nc'", ".png"]),
        (["bare", "--energy", "nowhere/e.png"], ["--energy", "'nowhere'", "does not exist"]),
        (["bare", "--output"], ["--output"]),
        (["bare", "--mode", "3"], ["--mode", "--modes"]),
        (["bare", "--silent"], ["--silent", "--quiet"]),
        (["bare", "absorbers"], ["absorbers", "usage"]),
        ([], ["SCENARIO", "usage"]),
    ],
    ids=" ".join,
)
def test_bad_input(refused, arguments, words):
    message = refused("run", *arguments)
    for word in words:
        assert word in message, message


WINE = """
fluids = ["water-1400", "wine"]
[[shells]]
radius = "1 m"
layers = [{ material = "aluminium", thickness = "6 mm" }]
[source]
type = "plane-shock"
peak_pressure = "25 kPa"
decay_time = "0.1 ms"
"""


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("this is not TOML", ["error: bad.toml:", "TOML"]),
        ("", ["shells", "missing"]),
        ('fluids = ["water-1400"]\nshells = []\nsource = 3', ["source"]),
        (WINE, ["fluids[1]", "'wine'", "water-1400"]),
    ],
    ids=["not TOML", "empty", "wrong kind", "unknown fluid"],
)
def test_bad_file(refused, tmp_path, text, words):
    (tmp_path / "bad.toml").write_text(text)
    message = refused("run", "bad.toml", left=["bad.toml"])
    for word in words:
        assert word in message, message


def test_binary_file(refused, tmp_path):
    (tmp_path / "bad.toml").write_bytes(bytes(range(256)))
    assert "UTF-8" in refused("run", "bad.toml", left=["bad.toml"])


def test_output_is_checked_before_the_work(refused, monkeypatch, tmp_path):
    monkeypatch.setattr("coaxshell.response.simulate", lambda *_, **__: pytest.fail("the work was started"))
    refused("run", "bare", "--output", "nowhere/out.nc")
    (tmp_path / "folder.nc").mkdir()
    assert "is a folder" in refused("run", "bare", "--output", "folder.nc", left=["folder.nc"])


def test_unwritable_folder(refused):
    # A place where not even root may make a file.
    assert "/proc" in refused("run", "bare", "--output", "/proc/out.nc")


def test_a_failing_run_leaves_the_old_file_alone(refused, tmp_path):
    (tmp_path / "out.nc").write_text("precious")
    refused("run", "bare", "--modes", "0", "--output", "out.nc", left=["out.nc"])
    assert (tmp_path / "out.nc").read_text() == "precious"
