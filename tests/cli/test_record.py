"""``coaxshell record``: what is understood of a pressure record."""

from __future__ import annotations

import json

import numpy as np
import pytest

import coaxshell as cx


@pytest.fixture
def gauge(tmp_path):
    """Write a record with a known peak, decay and impulse, 2 kPa of baseline and 0.2 ms before the trigger."""
    time = np.arange(-200, 4000) * 1e-3
    pressure = np.where(time >= 0, 250 * np.exp(-np.maximum(time, 0) / 0.5), 0.0)
    rows = [f"{t:.3f};{p + 10:.6f};{-p:.6f}".replace(".", ",") for t, p in zip(time, pressure, strict=True)]
    (tmp_path / "gauge.csv").write_text("Zeit [ms];p1 [kPa];p2 [kPa]\n" + "\n".join(rows) + "\n")


def test_numbers_of_a_known_record(run, gauge):
    outcome = run("record", "gauge.csv", "--pressure-column", "p1", "--baseline", "pre-trigger", "--json")
    assert outcome.code == 0, outcome.err
    found = json.loads(outcome.out)
    assert found["samples"] == 4200
    assert found["peak"] == pytest.approx(250e3, rel=1e-9)
    assert (found["peak_time"], found["rise_time"]) == (0, 0)
    assert found["decay_time"] == pytest.approx(0.5e-3, rel=1e-5)
    assert found["impulse"] == pytest.approx(250e3 * 0.5e-3 * (1 - np.exp(-8)), rel=1e-5)
    assert found["duration"] == pytest.approx(3.999e-3)
    assert found["nyquist"] == pytest.approx(0.5e6)
    # Energy of exp(-t/T) below f: (2/pi) arctan(2 pi f T), here of what lies below the Nyquist frequency.
    whole = np.arctan(2 * np.pi * 0.5e6 * 0.5e-3)
    assert found["band"] == pytest.approx(np.tan(0.99 * whole) / (2 * np.pi * 0.5e-3), rel=0.06)  # the rule weakens what is near it
    assert found["remarks"] == []
    assert found["reference"] == "gauge.csv: time 'Zeit' in ms, pressure 'p1' in kPa"


def test_the_table_the_picture_and_the_scenario(run, gauge, tmp_path):
    outcome = run("record", "gauge.csv", "--pressure-column", "2", "--figure", "gauge.png")
    assert outcome.code == 0, outcome.err
    for words in (
        "peak",
        "260.0 kPa at 0 s",
        "sampling rate",
        "1.000 MHz",
        "remark: before t = 0 the record stands at 10.00 kPa",
        "wrote gauge.png",
    ):
        assert words in outcome.out
    assert outcome.files == ["gauge.csv", "gauge.png"]
    entry = next(line for line in outcome.out.splitlines() if line.startswith("in a scenario: ")).partition("pulse = ")[2]
    head, _, _ = cx.presets.text("iakovlev-filled").partition("[source]")
    (tmp_path / "case.toml").write_text(f'{head}[source]\ntype = "plane-wave"\npulse = {entry}\n')
    pulse = cx.System.from_toml(tmp_path / "case.toml").sources[0].pulse
    assert pulse == cx.Sampled.from_file(tmp_path / "gauge.csv", pressure_column=2)
    assert "exists already" in run("record", "gauge.csv", "--pressure-column", "2", "--figure", "gauge.png").err


def test_problems_name_the_option(refused, gauge):
    left = ["gauge.csv"]
    assert "give pressure_column" in refused("record", "gauge.csv", left=left)
    for option, value, told in (
        ("--pressure-column", "p9", "--pressure-column: 'p9' is no column"),
        ("--time-unit", "kPa", "--time-unit: 'kPa' is no unit of time"),
        ("--scale", "two", "--scale: 'two' is not a plain number"),
        ("--end", "-1 s", "--end: nothing of the record"),
    ):
        arguments = () if option == "--pressure-column" else ("--pressure-column", "p1")
        assert told in refused("record", "gauge.csv", option, value, *arguments, left=left)
    assert "no such file" in refused("record", "none.csv", left=left)
    assert "a pipe or a device" in refused("record", "/dev/zero", left=left)
