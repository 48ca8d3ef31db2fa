"""Where a scenario may come from: files of any name and encoding, standard input; never a pipe or a device that could keep one waiting."""

from __future__ import annotations

import io
import os

import pytest

import coaxshell as cx


@pytest.mark.parametrize("name", ["-", "/dev/stdin"])
def test_a_scenario_from_standard_input(run, small, monkeypatch, name):
    text = cx.presets.text("iakovlev-filled").encode("utf-8-sig")
    monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(text)))
    outcome = run("run", name, *small, "--quiet")
    assert outcome.code == 0, outcome.err
    assert outcome.out == run("run", "iakovlev-filled", *small, "--quiet").out


@pytest.mark.parametrize("name", ["mine.txt", "mine", "mine.scenario", "bare.toml"])
def test_a_file_of_any_name(run, small, tmp_path, name):
    (tmp_path / name).write_bytes(b"\xef\xbb\xbf" + cx.presets.text("iakovlev-filled").encode())
    outcome = run("run", name, *small, "--quiet")
    assert outcome.code == 0, outcome.err
    assert "iakovlev-filled" in outcome.out


def test_what_is_no_scenario_is_refused(refused, monkeypatch, tmp_path):
    for content, word in ((b"\xff\xff", "not text"), (b"fluids = [", "standard input"), (b"", "shells"), (b"[" * 100, "nesting")):
        monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(content)))
        assert word in refused("run", "-")
    os.mkfifo(tmp_path / "pipe.toml")
    assert "a pipe or a device" in refused("run", "pipe.toml", left=("pipe.toml",))
    assert "a pipe or a device" in refused("sweep", "pipe.toml", left=("pipe.toml",))
    assert "no preset" in refused("run", "nowhere", left=("pipe.toml",))


def test_a_change_is_one_value(run, refused, small):
    assert "peak_pressure" in refused("run", "bare", "--set", "source.peak_pressure=1\nother=2", *small)
    assert "peak_pressure" in refused("run", "bare", "--set", "source.peak_pressure=" + "[" * 3000, *small)
    assert run("run", "bare", "--set", "source.peak_pressure=25 kpa", *small, "-q").code == 0
