"""The report as Markdown."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from coaxshell.apps.verification.rows import HEADINGS
from coaxshell.apps.verification.suite import Report


def markdown(report: Report) -> str:
    """Return the report as Markdown text: one table for each check; plots are in the HTML report only."""
    parts = [f"# {report.title}", report.circumstances, report.note, f"**{report.verdict}**"]
    parts = [part for part in parts if part]
    if report.failed:
        parts.append("Failing:\n\n" + "\n".join(f"- {_cell(row.what)}: found {_cell(row.found)}" for row in report.failed))
    for result in report.results:
        parts.append(f"## {result.title}")
        parts.append(f"`{result.name}`, {result.seconds:.1f} s. {result.about}")
        rows = [(*row.cells[:-1], f"**{row.verdict}**" if row.verdict == "FAIL" else row.verdict) for row in result.rows]
        parts.append(table(HEADINGS, rows))
    return "\n\n".join(parts) + "\n"


def table(headings: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table as Markdown text; what would break it is escaped."""
    return "\n".join(_line(cells) for cells in (headings, ("---",) * len(headings), *rows))


def _line(cells: Sequence[str]) -> str:
    return "| " + " | ".join(_cell(cell) for cell in cells) + " |"


def _cell(text: str) -> str:
    return " ".join(text.split()).replace("|", "\\|").replace("<", "&lt;")
