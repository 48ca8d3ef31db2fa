"""Another code's file: what is read, what is refused, and what the comparison says."""

from __future__ import annotations

import numpy as np
import pytest

from coaxshell.errors import InputError
from coaxshell.model import presets
from coaxshell.verification.against import against, template
from coaxshell.verification.histories_csv import read_histories

CASE = presets.load("iakovlev-double")


@pytest.fixture
def write(tmp_path):
    def call(text):
        path = tmp_path / "fem.csv"
        path.write_text(text, encoding="utf-8")
        return path

    return call


@pytest.fixture(scope="module")
def ours(tmp_path_factory):
    """Return our own numbers as a file, t = 0 to 2."""
    return template(CASE, tmp_path_factory.mktemp("ours") / "ours.csv", duration=2.0, modes=20)


def test_our_own_file_agrees(ours):
    report = against(ours, CASE, modes=20, tolerance=1e-4)
    assert len(report.rows) == 16
    assert not report.failed
    assert [len(sheet.panels) for sheet in report.results[0].sheets] == [4, 4]


def test_units_names_and_instants_are_free(write, ours):
    known = read_histories(ours)
    column = {column.name: column.values for column in known.columns}
    table = np.stack([known.time / 1.4, column["stress_outer_tail"] / 1e6, column["displacement_inner_head"] * 1e6], axis=1)[1::3]
    lines = ["# made by hand", "Time (ms); stress_OUTER_180deg [MPa]; displacement_0_head [um]"]
    lines += ["; ".join(f"{number:.9g}" for number in row) for row in table]
    report = against(write("\n".join(lines)), CASE, modes=20, tolerance=1e-3)
    assert not report.failed, [row.cells for row in report.failed]


def test_errors_are_those_put_in(write):
    time = np.arange(0, 2.001, 0.01)
    body = "\n".join(f"{t:.2f}, 0, 0" for t in time)
    rows = against(write("time [transits], displacement_inner_head, stress_outer_tail\n" + body), CASE, modes=20).rows
    assert [row.error for row in rows] == [1.0] * 4
    assert {row.verdict for row in rows} == {"noted"}


def test_a_reversed_sign_is_pointed_out(write, ours):
    known = read_histories(ours)
    column = next(column for column in known.columns if column.name == "displacement_outer_head")
    text = "time_transits,displacement_outer_head\n" + "\n".join(f"{t},{-w}" for t, w in zip(known.time, column.values, strict=True))
    row = against(write(text), CASE, modes=20, tolerance=0.1).rows[0]
    assert row.verdict == "FAIL"
    assert "with the sign reversed" in row.found


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("time,stress_inner_head\n0,1\n1,2", r"'time': has no unit"),
        ("time [h],stress_inner_head\n0,1\n1,2", r"unknown unit 'h'"),
        ("time [s],stress_inner_head [kg]\n0,1\n1,2", r"unknown unit 'kg'; allowed: Pa, kPa"),
        ("time [s],velocity_inner_head\n0,1\n1,2", r"column 'velocity_inner_head': is not a name"),
        ("time [s],stress_middle_head\n0,1\n0.001,2", r"'middle' is not a shell"),
        ("time [s],stress_9_head\n0,1\n0.001,2", r"'9' is not a shell"),
        ("time [s],time_transits,stress_inner_head\n0,0,1\n1,1,2", r"is a second time"),
        ("stress_inner_head\n1\n2", r"no column of times"),
        ("time [s]\n1\n2", r"has times only"),
        ("time [s],stress_inner_head\n0,1\n0,2", r"time 0 does not follow 0"),
        ("time [s],stress_inner_head\n-1,1\n0,2", r"time -1 is negative"),
        ("time [s],stress_inner_head\n0,1\n1,x", r"line 3: 'x' in column 'stress_inner_head' is not a finite number"),
        ("time [s],stress_inner_head\n0,1\n1,nan", r"is not a finite number"),
        ("time [s],stress_inner_head\n0,1\n1", r"line 3: 1 values for 2 columns"),
        ("time [transits],stress_inner_head\n0,1\n0.003,2", r"are they in seconds"),
        ("time [s],stress_inner_head\n0,1\n5,2", r"are they in ms or us"),
        ("time [s],stress_inner_head\n0,1", r"holds no histories"),
        ("", r"holds no histories"),
    ],
)
def test_what_is_wrong_is_told_on_one_line(write, text, told):
    with pytest.raises(InputError, match=told) as caught:
        against(write(text), CASE, modes=8)
    assert "fem.csv" in str(caught.value)
    assert "\n" not in str(caught.value)


def test_no_file_and_no_text(tmp_path):
    with pytest.raises(InputError, match="no such file"):
        read_histories(tmp_path / "none.csv")
    (tmp_path / "picture.csv").write_bytes(b"\xff\xfe\x00\x81")
    with pytest.raises(InputError, match="not a text file"):
        read_histories(tmp_path / "picture.csv")
