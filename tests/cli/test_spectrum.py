"""``coaxshell spectrum``."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest

SHORT = ("--modes", "4", "--time-step", "0.05", "--duration", "1")


def test_picture_and_table(run):
    assert run("spectrum", "bare", *SHORT, "-o", "spectra.png").code == 0
    assert Path("spectra.png").read_bytes().startswith(b"\x89PNG")
    asked = ("--frequency", "200,800", "--shell", "inner", "--angle", "0", "--compare", "hybrid", "-o", "spectra.csv")
    assert run("spectrum", "bare", *SHORT, *asked).code == 0
    heading, *rows = csv.reader(Path("spectra.csv").read_text(encoding="utf-8").splitlines())
    assert heading[1] == "bare inner 0 deg pseudo velocity (m/s)"
    assert heading[4] == "hybrid inner 0 deg pseudo velocity (m/s)"
    assert [float(row[0]) for row in rows] == [200.0, 800.0]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--frequency", "1e9"), "--frequency: 1e+09 Hz is above"),
        (("--frequency", "-3"), "--frequency: -3 Hz is not allowed"),
        (("--quality", "0.3"), "--quality: 0.3 is not allowed"),
        (("--shell", "middle"), "--shell: "),
        (("--output", "a.txt"), "--output: 'a.txt' has no known ending"),
    ],
)
def test_bad_spectra(refused, arguments, words):
    assert words in refused("spectrum", "bare", *SHORT, "--quiet", *arguments)
