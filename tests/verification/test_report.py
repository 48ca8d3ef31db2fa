"""Rows, verdicts, and the three forms of the report."""

from __future__ import annotations

import re

import pytest

from coaxshell.apps.verification import checks, chosen, run, write_report
from coaxshell.apps.verification.markdown import markdown
from coaxshell.apps.verification.page import page
from coaxshell.apps.verification.rows import close, orders, within
from coaxshell.apps.verification.terminal import drawn, plain
from coaxshell.errors import InputError


def test_verdicts(report):
    by_check = {result.name: [row.verdict for row in result.rows] for result in report.results}
    assert by_check == {"good": ["pass", "pass"], "bad": ["FAIL", "FAIL", "skipped", "FAIL"], "broken": ["pass", "FAIL"], "empty": ["FAIL"]}
    assert report.verdict.startswith("9 rows: 3 pass, 5 fail, 1 skipped; 4 checks in ")
    assert "ValueError: it broke" in report.results[2].rows[1].found


def test_errors_are_measured_as_said():
    assert close("x", "", 4.0, 5.0, 1.0).error == 0.25
    assert close("x", "", 4.0, 5.0, 1.0, measure="absolute").error == 1.0
    assert close("x", "", 0.0, 5.0, 1.0).verdict == "FAIL"  # nothing to be relative to
    assert close("x", "", 0.0, 5.0, 1.0, scale=10.0).error == 0.5
    assert within("x", "", "", 1.0, float("inf")).verdict == "noted"
    assert list(orders([1.0, 0.25, 0.0625])) == [2.0, 2.0]


def test_markdown_has_a_table_for_each_check(report):
    text = markdown(report)
    assert text.count("| what | source | expected | found | error | tolerance | measure | verdict |") == 4
    assert "a \\| history" in text
    assert "the &lt;other's>" in text
    assert text.count("**FAIL**") == 5


def test_plain_text_ends_with_the_verdict(report):
    lines = plain(report).splitlines()
    assert lines[-1] == report.verdict
    assert sum(line.endswith("FAIL") for line in lines) == 5


def test_drawn_tables_can_be_printed(report, capsys):
    from rich.console import Console

    Console(width=120).print(*drawn(report), sep="\n")
    assert report.verdict in capsys.readouterr().out


def test_page_is_whole_and_asks_for_nothing(good_report, report):
    text = page(good_report)
    assert text.count("<img") == text.count('src="data:image/svg+xml;base64,') == 1
    assert not re.search(r"""(src|href)=["'](?!data:|#)""", text)
    assert not re.search(r"@import|url\(", text)
    assert "A parabola &lt;b&gt;" in text
    assert "<script" not in text
    assert page(report).count("class=fail") == 5


def test_files_are_written_whole(good_report, tmp_path):
    paths = write_report(good_report, tmp_path / "a" / "b")
    assert sorted(path.name for path in (tmp_path / "a" / "b").iterdir()) == ["report.html", "report.md"]
    assert all(path.stat().st_size > 500 for path in paths)
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="cannot make the folder"):
        write_report(good_report, tmp_path / "file")


def test_every_check_is_described_and_named_once():
    known = checks()
    assert len({one.name for one in known}) == len(known) >= 19
    for one in known:
        assert one.about.endswith("."), one.name
        assert re.fullmatch(r"[a-z-]+", one.name)
    assert [one.name for one in chosen(["statics", "energy"], quick=False)] == ["energy", "statics"]
    with pytest.raises(InputError, match="no check 'shell'"):
        chosen(["shell"], quick=False)


def test_progress_runs_to_the_end():
    told = []
    run(chosen(["statics", "disc-limit"], quick=True), quick=True, progress=lambda fraction, stage: told.append((fraction, stage)))
    fractions = [fraction for fraction, _ in told]
    assert fractions == sorted(fractions)
    assert told[0] == (0.0, "check statics")
    assert told[-1] == (1.0, "checks")
