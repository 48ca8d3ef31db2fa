"""``coaxshell modes``."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import pytest

LOW = ("--order", "2", "--up-to", "100 Hz")


def test_table_document_csv_and_picture(run):
    told = run("modes", "hybrid", "--order", "0-1", "--up-to", "700", "-o", "modes.csv")
    assert told.code == 0
    assert "The absorbers of the system are left out." in told.out
    heading, *rows = csv.reader(Path("modes.csv").read_text(encoding="utf-8").splitlines())
    assert heading[:6] == ["kind", "axial half wavelength (m)", "order", "mode", "frequency (Hz)", "damping ratio"]
    assert rows[0][0] == "wet"
    found = json.loads(run("modes", "bare", *LOW, "--json").out)["modes"]
    assert [round(one["frequency (Hz)"], 2) for one in found] == [1.57, 8.84, 24.3, 6.08]
    assert run("modes", "bare", *LOW, "--axial-half-wavelength", "20 m,30", "-o", "modes.png").code == 0
    assert Path("modes.png").read_bytes().startswith(b"\x89PNG")


def test_none_so_low(run):
    assert "raise --up-to" in run("modes", "bare", "--order", "0", "--up-to", "10").out


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--order", "2-"), "--order: '2-' is not an order"),
        (("--order", "201"), "--order: 201 is not allowed"),
        (("--axial-half-wavelength", "0"), "--axial-half-wavelength: 0 m is not allowed"),
        (("--up-to", "often"), "--up-to: "),
        (("--most-damped", "1"), "--most-damped: 1"),
        (("--output", "a.txt"), "--output: 'a.txt' has no known ending"),
    ],
)
def test_bad_modes(refused, arguments, words):
    assert words in refused("modes", "bare", *arguments)
