"""``coaxshell response``."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np
import pytest

import coaxshell as cx

FEW = ("--frequency", "100:400:4", "--modes", "8")


def test_table_document_csv_and_pictures(run):
    told = run("response", "bare", *FEW, "-o", "echo.csv")
    assert told.code == 0
    assert "target strength (dB re 1 m) of bare, 4 frequencies, orders up to 8" in told.out
    expected = cx.frequency_response("bare", [100.0, 200.0, 300.0, 400.0], modes=8)
    heading, *rows = csv.reader(Path("echo.csv").read_text(encoding="utf-8").splitlines())
    assert heading == ["frequency (Hz)", "target strength (dB re 1 m)"]
    np.testing.assert_allclose([float(row[1]) for row in rows], expected, rtol=1e-11)
    asked = ("--quantity", "stress", "--shell", "inner", "--angle", "0,90")
    (found,) = json.loads(run("response", "bare", *FEW, *asked, "--json").out)["answers"]
    stress = cx.frequency_response("bare", found["frequency"], "stress", shell="inner", angle=[0, 90], modes=8)
    assert [curve["place"] for curve in found["curves"]] == ["0°", "90°"]
    np.testing.assert_allclose([curve["magnitude"] for curve in found["curves"]], np.abs(stress.values.T))
    assert run("response", "bare", *FEW, *asked, "--resonances", "2", "-o", "stress.png").code == 0
    around = run("response", "bare", *FEW, "--angle", "0:360:73", "--polar", "-o", "polar.png").out
    echo = cx.frequency_response("bare", [100.0, 400.0], angle=np.linspace(0.0, 360.0, 73), modes=8).values
    assert "at (deg)" in around
    for hertz, levels in zip((100, 400), echo, strict=True):  # a row a frequency, not one an angle
        row = next(line.split() for line in around.splitlines() if line.startswith(f"{hertz} Hz"))
        assert [row[2], row[4]] == [f"{levels.max():.4g}", f"{levels.min():.4g}"]
    assert len(around.splitlines()) == 8
    assert Path("stress.png").read_bytes().startswith(b"\x89PNG")
    assert Path("polar.png").read_bytes().startswith(b"\x89PNG")
    told = run("response", "bare", *FEW, "--quantity", "receptance", "--line-force", "inner,30", "--compare", "bare")
    assert "of bare (2)" in told.out
    told = run("response", "bare", *FEW, "--quantity", "insertion-loss", "--against", "bare")
    assert "insertion loss (dB) of bare" in told.out


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--frequency", "10:20"), "--frequency: '10:20' is not a range"),
        (("--frequency", "often"), "--frequency: "),
        (("--quantity", "noise"), "--quantity: 'noise' is unknown"),
        (("--angle", "up"), "--angle: 'up' is not a number"),
        (("--quantity", "receptance", "--line-force", "outer"), "--line-force: 'outer' is not a shell and an angle"),
        (("--quantity", "stress", "--length", "3 m"), "--length: has no effect"),
        (("--polar", "-o", "a.png"), "--angle: is no answer over the angle"),
        (("--compare", "bare", "-o", "a.csv"), "--compare: has two systems"),
        (("--modes", "many"), "--modes: 'many' is not a whole number"),
        (("--output", "a.txt"), "--output: 'a.txt' has no known ending"),
    ],
)
def test_bad_responses(refused, arguments, words):
    assert words in refused("response", "bare", *arguments)
