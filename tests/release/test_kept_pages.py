"""Pages that are kept with their numbers are of this version, and agree with each other and with what the package holds."""

from __future__ import annotations

import re

import pytest

from coaxshell import __version__
from coaxshell.apps.paper.sphere.compared import SPHERE
from coaxshell.apps.paper.sphere.kept import known_claims
from coaxshell.apps.paper.thickness.compared import EXACT
from coaxshell.apps.paper.thickness.kept import known_of_absorbers
from coaxshell.apps.verification import checks
from house import PROJECT

SHORT = {"holds": "holds", "holds in part": "in part", "does not hold": "no"}
NOT_JUDGED = "–"


def text(name: str) -> str:
    return (PROJECT / "docs" / name).read_text(encoding="utf-8")


def rows(part: str) -> list[list[str]]:
    """Return the cells of the lines of tables, without rules and headings of checks."""
    lines = [line for line in part.splitlines() if line.startswith("|") and not re.match(r"\| ?(---|what )", line)]
    return [[cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]] for line in lines]


@pytest.fixture(scope="module")
def verdicts() -> dict[int, dict[str, str]]:
    """Return the verdicts of the page of statements by number and model."""
    found = rows(text("statements.md").partition("## Verdicts")[2].partition("\n## ")[0])
    models = found[0][1:]
    return {int(row[0]): dict(zip(models, row[2:], strict=True)) for row in found if row[0].isdigit()}


def test_the_conformance_report_is_of_this_version_whole_and_without_a_failure():
    page = text("conformance.md")
    assert page.startswith(f"# Conformance of version {__version__}\n")
    assert re.search(r", 20\d\d-\d\d-\d\d \d\d:\d\d UTC\.\n", page)  # a quick suite would say so here
    assert re.findall(r"^`([\w-]+)`\. ", page, re.MULTILINE) == [one.name for one in checks()]
    printed, whole = (rows(part) for part in page.partition("## Published numbers")[2].split("## The whole suite"))
    assert {row[-1] for row in printed} == {"pass"}
    assert {row[-1] for row in whole} <= {"pass", "noted", "skipped"}
    assert len(printed) > 25
    assert [row for row in printed if row not in whole] == []


def test_the_statements_have_the_verdicts_that_the_package_holds(verdicts):
    held = {one.claim.number: one.findings[SPHERE].verdict for one in known_claims().claims}
    assert {n: row["sphere"] for n, row in verdicts.items() if row["sphere"] != NOT_JUDGED} == {n: SHORT[v] for n, v in held.items()}
    for one in known_of_absorbers():
        assert verdicts[one.claim.number]["exact walls"] == SHORT[one.findings[EXACT].verdict]
    for one in known_claims().claims:
        assert verdicts[one.claim.number]["corrected"] == SHORT[one.corrected.verdict]


def test_the_pages_on_control_and_reproduction_agree_with_the_statements(verdicts):
    control = rows(text("howto/control-limits.md").partition("## What the paper says of control")[2])
    named = ("corrected", "whole actuation", "electrodes")
    assert {int(row[0]): row[2:5] for row in control if row[0].isdigit()} == {
        n: [row[name] for name in named] for n, row in verdicts.items() if row["electrodes"] != NOT_JUDGED
    }
    reproduction = text("reproduction.md")
    beyond = ("corrected", "sphere", "exact walls", "whole actuation", "electrodes")
    told = {int(row[0]): row[2:] for row in rows(reproduction.partition("## Beyond")[2]) if row[0].isdigit()}
    assert told == {
        n: [row[name] for name in beyond] for n, row in verdicts.items() if len({row[name] for name in beyond} - {NOT_JUDGED}) > 1
    }
    tallies = {row[0]: row[1:] for row in rows(reproduction.partition("## As computed")[2])}
    for model in ("corrected", "radius factor", "no projection", "both slips"):
        given = [row[model] for row in verdicts.values()]
        assert tallies[model] == [str(given.count(word)) for word in (*SHORT.values(), NOT_JUDGED)]
