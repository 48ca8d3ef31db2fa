"""``coaxshell control``."""

from __future__ import annotations

import json
from pathlib import Path

import pytest


def test_margins_are_printed_and_drawn(run):
    told = run("control", "electrodes", "--modes", "4", "--output", "loops.png")
    assert told.code == 0
    lines = told.out.splitlines()
    assert lines[0] == "What the feedback of electrodes stands"
    assert any(line.split()[:2] == ["inner", "delay"] and "µs" in line and "Hz" in line for line in lines)
    assert any(line.split() == ["outer", "gain", "10", "times", "or", "more"] for line in lines)
    assert Path("loops.png").read_bytes().startswith(b"\x89PNG")
    rows = json.loads(run("control", "electrodes", "--modes", "4", "--json").out)["margins"]
    assert {row["margin"] for row in rows} == {"gain_margin", "lesser_gain_margin", "phase_margin", "delay_margin"}
    assert all(row["value"] is None for row in rows if row["margin"] == "gain_margin")


def test_margins_of_electrodes_cut_along_the_axis_say_what_is_tied(run):
    told = run("control", "electrodes", "--set", "control.segment_pitch=2", "--modes", "2", "--dimensions", "3").out.splitlines()
    assert told[-1] == "Wavenumbers k with those that electrodes 2 m apart along the axis tie to them."
    assert told[2].split()[-1] == "k"


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("bare",), "control: nothing is fed back"),
        (("active", "--set", "control.proportional=2e4", "--modes", "4"), "makes the closed loop unstable"),
        (("active", "--modes", "auto"), "--modes: 'auto' is not allowed here"),
        (("active", "--output", "a.txt"), "--output: 'a.txt' has no known ending"),
    ],
)
def test_refused(run, arguments, words):
    told = run("control", *arguments)
    assert told.code == 2
    assert words in told.err


def test_a_law_is_designed(run):
    arguments = ("--design", "--delay", "5 us", "--kind", "rate", "--modes", "1", "--duration", "0.5", "--save", "led.toml")
    told = run("control", "electrodes", *arguments)
    assert told.code == 0
    assert "rate feedback" in told.out
    assert 'transducers = "electrodes"' in Path("led.toml").read_text()
    assert run("control", "electrodes", "--delay", "5 us").err.startswith("error: --delay: belongs to --design")
