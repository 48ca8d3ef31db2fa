"""Another code's file: what is read, what is refused, and what the comparison says."""

from __future__ import annotations

import functools
import math

import numpy as np
import pytest

import coaxshell.model as cx
from coaxshell.apps.verification.against import against, template
from coaxshell.apps.verification.causes import likely_cause
from coaxshell.apps.verification.histories_csv import read_histories
from coaxshell.errors import InputError
from coaxshell.export import export_csv
from coaxshell.model import presets
from coaxshell.response.simulation import simulate

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
    table = np.stack([known.transits / 1.4, column["stress_outer_tail"] / 1e6, column["displacement_inner_head"] * 1e6], axis=1)[1::3]
    lines = ["# made by hand", "Time (ms); stress_OUTER_180deg [MPa]; displacement_0_head [um]"]
    lines += ["; ".join(f"{number:.9g}" for number in row) for row in table]
    report = against(write("\n".join(lines)), CASE, modes=20, tolerance=1e-3)
    assert not report.failed, [row.cells for row in report.failed]


def test_errors_are_those_put_in(write):
    time = np.arange(0, 2.001, 0.01)
    body = "\n".join(f"{t:.2f}, 0, 0" for t in time)
    file = write("time [transits], displacement_inner_head, stress_outer_tail\n" + body)
    report = against(file, CASE, modes=20)
    assert [row.error for row in report.rows] == [1.0] * 4
    assert len(report.failed) == 4, "all of it is missing, which passes within no tolerance of a comparison"
    assert "likely" not in report.rows[0].found
    assert {row.verdict for row in against(file, CASE, modes=20, tolerance=math.inf).rows} == {"noted"}
    with pytest.raises(InputError, match="tolerance: 0 is not allowed"):
        against(file, CASE, tolerance=0.0)


def test_a_reversed_sign_is_pointed_out(write, ours):
    known = read_histories(ours)
    column = next(column for column in known.columns if column.name == "displacement_outer_head")
    text = "time_transits,displacement_outer_head\n" + "\n".join(f"{t},{-w}" for t, w in zip(known.transits, column.values, strict=True))
    row = against(write(text), CASE, modes=20, tolerance=0.1).rows[0]
    assert row.verdict == "FAIL"
    assert "likely the sign reversed" in row.found


def test_our_own_export_is_accepted(tmp_path):
    """Every column: both times, voltages and absorbers; the head is where the source strikes, which is not 0 degrees here."""
    angled = presets.load("hybrid").with_overrides({"source.angle": 30.0, "absorbers.count": 3})
    response = simulate(angled, duration=0.4, time_step=4e-3, modes=8)
    file = export_csv(response, tmp_path / "hybrid.csv")
    report = against(file, angled, time_step=4e-3, modes=8, tolerance=1e-6)
    assert len(report.rows) == 2 * (file.read_text().split("\n")[0].count(",") - 1) > 20
    assert not report.failed, [row.cells for row in report.failed]
    with pytest.raises(InputError, match=r"times end at 0.4 transits and at .* is --case what the file holds"):
        against(file, angled.replace_path("shells[1].radius", 1.1), time_step=4e-3, modes=8)
    with pytest.raises(InputError, match=r"'inner sensor voltage head': is of a shell without a layer that is its sensor"):
        against(file, CASE, time_step=4e-3, modes=8)


def test_names_of_four_shells_and_of_one(write):
    steel = cx.Shell(radius=1.0, layers=(cx.Layer(material="steel", thickness=0.01),))
    four = cx.System(
        shells=[steel.replace(radius=r) for r in (0.4, 0.6, 0.8, 1.0)],
        fluids=["air", "water", "water", "water", "water"],
        source=cx.PlaneShock(peak_pressure=1e5, decay_time=1e-4),
    )
    columns = read_histories(write("time [s],shell 2 of 4 stress head (kPa),displacement_3_-45deg [um]\n0,0,0\n1e-3,1,1")).columns
    assert [(one.quantity, one.shell, one.place, one.values[1]) for one in columns] == [
        ("stress", "shell 2 of 4", "head", 1e3),
        ("displacement", "3", "-45", pytest.approx(1e-6)),
    ]
    assert len(against(write("time [s],shell 2 of 4 stress head (kPa)\n0,0\n1e-4,1"), four, modes=4, time_step=4e-3).rows) == 2
    assert read_histories(write("time [s]\tshell stress tail (MPa)\n0\t0\n1\t2,5")).columns[0].values[1] == 2.5e6


SLIPS = {
    "late": (lambda t, w, other: (t + 0.07, w), ["transits) too late"]),
    "early": (lambda t, w, other: (t[t >= 0.3] - 0.3, w[t >= 0.3]), ["transits) too early"]),
    "kPa for Pa": (lambda t, w, other: (t, w / 1e3), ["1,000 times too small"]),
    "per cent": (lambda t, w, other: (t, w * 100), ["100 times too large"]),
    "um for m": (lambda t, w, other: (t, w * 1e6), ["1,000,000 times too large"]),
    "exchanged": (lambda t, w, other: (t, other), ["head and tail exchanged"]),
    "sign": (lambda t, w, other: (t, -w), ["the sign reversed"]),
    "sign, unit and lag": (lambda t, w, other: (t + 0.05, -1e3 * w), ["sign reversed", "1,000 times too large", "transits) too late"]),
    "exchanged, late": (lambda t, w, other: (t + 0.1, other), ["exchanged", "transits) too late"]),
}


LAGS = {"late": 0.07, "early": -0.3, "sign, unit and lag": 0.05, "exchanged, late": 0.1}


@pytest.mark.parametrize("slip", SLIPS)
@pytest.mark.parametrize("quantity", ["displacement", "stress"])
def test_the_likely_cause_is_named(slip, quantity):
    rng = np.random.default_rng(3)
    response = _reference()
    head, tail = np.asarray(getattr(response, quantity)("outer", [0.0, 180.0])).T
    turn, told = SLIPS[slip]
    for ours, opposite in ((head, tail), (tail, head)):
        time, theirs = turn(response.time, ours, opposite)
        theirs = theirs * (1 + 0.02 * rng.standard_normal(theirs.size))  # another code errs too
        there = np.interp(time, response.time, ours)
        error = float(np.linalg.norm(theirs - there) / np.linalg.norm(there))
        cause = likely_cause(time, theirs, float(response.time[1]), ours, opposite, error)
        assert cause is not None
        assert cause.left < 0.05
        assert cause.slips == len(told)
        assert cause.lag == pytest.approx(LAGS.get(slip, 0.0), abs=2e-3)  # half a step, for the noise
        text = cause.text(1e-3)
        assert all(part in text for part in told), text


def test_what_no_slip_explains_is_not_explained():
    response = _reference()
    head, tail = np.asarray(response.stress("outer", [0.0, 180.0])).T
    time, step = response.time, float(response.time[1])
    rng = np.random.default_rng(5)
    for theirs in (1.3 * head, head + 0.3 * head.std() * rng.standard_normal(head.size), 0 * head, np.sin(40 * time), head * (time < 1)):
        error = float(np.linalg.norm(theirs - head) / np.linalg.norm(head))
        assert likely_cause(time, theirs, step, head, tail, error) is None
    assert likely_cause(time, head, step, 0 * head, 0 * tail, math.inf) is None


@functools.cache
def _reference():
    return simulate(CASE, duration=2.5, time_step=4e-3, modes=20)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("time,stress_inner_head\n0,1\n1,2", r"'time': has no unit"),
        ("time [parrots],stress_inner_head\n0,1\n1,2", r"unknown unit 'parrots'"),
        ("time [s],stress_inner_head [kg]\n0,1\n1,2", r"unknown unit 'kg'; allowed: Pa, kPa, MPa"),
        ("time [s],velocity_inner_head\n0,1\n1,2", r"column 'velocity_inner_head': is not a name"),
        ("time [s],stress_middle_head\n0,1\n0.001,2", r"'middle' is not a shell"),
        ("time [s],stress_9_head\n0,1\n0.001,2", r"'9' is not a shell"),
        ("time [s],time [ms],stress_inner_head\n0,0,1\n1,1,2", r"is a second time"),
        ("time [s],time_transits,stress_inner_head\n0,0,1\n1,1,2", r"times end at 1 transits and at 1 s"),
        ("stress_inner_head\n1\n2", r"no column of times"),
        ("time [s]\n1\n2", r"has times only"),
        ("time [s],stress_inner_head\n0,1\n0,2", r"time 0 does not follow 0"),
        ("time [s],stress_inner_head\n-1,1\n0,2", r"time -1 is negative"),
        ("time [s],stress_inner_head\n0,1\n1,x", r"line 3: stress_inner_head 'x' is not a finite number"),
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
    (tmp_path / "picture.csv").write_bytes(b"\x89\x00\x01\x81")
    with pytest.raises(InputError, match="not a text file"):
        read_histories(tmp_path / "picture.csv")


def test_an_export_with_more_absorbers_than_a_record_may_have_columns(tmp_path):
    case = CASE.replace(absorbers=cx.absorber_ring(300, mass=1.0, linear_stiffness=1e7))
    response = simulate(case, duration=1.0, time_step=0.01, modes=8)
    report = against(export_csv(response, tmp_path / "many.csv"), case, time_step=0.01, modes=8, tolerance=0.05)
    assert len(report.rows) > 300
    assert not report.failed, [row.cells for row in report.failed][:3]
