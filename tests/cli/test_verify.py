"""coaxshell verify: what is printed, written, refused, and the exit codes."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path

import pytest

from coaxshell.apps.verification import registry
from coaxshell.apps.verification.rows import within

REPORT = ["report.html", "report.md", "verification-report"]


def test_one_check(run):
    outcome = run("verify", "--quick", "--only", "statics", "--quiet")
    assert outcome.code == 0, outcome
    assert outcome.files == REPORT
    assert "Static compliance (statics, " in outcome.out
    assert outcome.out.splitlines()[-2].startswith("13 rows: 13 pass, 0 fail; 1 check in ")
    assert outcome.out.splitlines()[-1] == "wrote verification-report/report.md, verification-report/report.html"
    assert outcome.err == ""


def test_list(run):
    outcome = run("verify", "--list")
    assert outcome.code == 0
    assert outcome.files == []
    assert {"statics", "energy", "paper-double"} <= {line.split()[0] for line in outcome.out.splitlines()}


def test_progress_is_told(run):
    assert "check disc-limit: 50 %" in run("verify", "--quick", "--only", "disc-limit", "--only", "statics").err


def test_a_failing_row_exits_with_1(run, monkeypatch):
    def work(bench):
        yield within("a thing", "nowhere", "0", 2.0, 1.0)

    failing = registry.Check("failing", "Failing", "It fails.", work, True)
    monkeypatch.setattr(import_module("coaxshell.apps.verification.checks"), "checks", lambda: (failing,))
    outcome = run("verify", "--only", "failing", "--output", "there", "--quiet")
    assert outcome.code == 1
    assert outcome.files == ["report.html", "report.md", "there"]
    assert "1 row: 0 pass, 1 fail" in outcome.out
    assert outcome.err == ""


@pytest.mark.parametrize("whole", [False, pytest.param(True, marks=pytest.mark.slow)])
def test_another_codes_histories(run, whole):
    written = run("verify", "--template", "mine.csv", "--case", "iakovlev-double", "--modes", "12")
    assert (written.code, written.out) == (0, "wrote mine.csv\n")
    outcome = run("verify", "--against", "mine.csv", "--case", "iakovlev-double", "--modes", "12", "--quiet")
    assert outcome.code == 0
    assert outcome.files == ["mine.csv", *REPORT]
    assert "16 rows: 16 pass, 0 fail" in outcome.out
    again = run("verify", "--against", "mine.csv", "--case", "iakovlev-double", "--modes", "12", "--quiet")
    assert again.code == 2
    assert "exists already" in again.err
    if not whole:
        return
    strict = run(
        "verify", "--against", "mine.csv", "--case", "iakovlev-double", "--modes", "4", "--tolerance", "1e-6", "--quiet", "--force"
    )
    assert strict.code == 1
    smaller = Path("mine.csv").read_text().replace("[m]", "[mm]")
    Path("millimetres.csv").write_text(smaller)
    wrong = run("verify", "--against", "millimetres.csv", "--case", "iakovlev-double", "--modes", "12", "--quiet", "--force")
    assert wrong.code == 1, "a deviation fails without --tolerance too"
    assert "likely 1,000 times too small (its unit?)" in wrong.out


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (("--only", "nothing"), "no check 'nothing'"),
        (("--against", "none.csv"), "--case: is missing"),
        (("--case", "bare"), "--case: is for --against or --template"),
        (("--against", "none.csv", "--case", "bare"), "none.csv: cannot be read"),
        (("--against", "none.csv", "--case", "nowhere"), "--case: there is no preset 'nowhere'"),
        (("--against", "none.csv", "--case", "bare", "--modes", "auto"), "--modes: 'auto' is not allowed"),
        (("--against", "none.csv", "--case", "bare", "--tolerance", "x"), "--tolerance: 'x' is not a number"),
        (("--template", "mine.txt", "--case", "bare"), "--template: 'mine.txt' has no known ending"),
    ],
)
def test_bad_input_is_one_line(refused, arguments, told):
    assert told in refused("verify", *arguments)
