"""The report as Markdown."""

from __future__ import annotations

from coaxshell.verification.rows import HEADINGS
from coaxshell.verification.suite import Report


def markdown(report: Report) -> str:
    """Return the report as Markdown text: one table for each check; plots are in the HTML report only."""
    parts = [f"# {report.title}", report.circumstances, report.note, f"**{report.verdict}**"]
    parts = [part for part in parts if part]
    if report.failed:
        parts.append("Failing:\n\n" + "\n".join(f"- {_cell(row.what)}: found {_cell(row.found)}" for row in report.failed))
    for result in report.results:
        parts.append(f"## {result.title}")
        parts.append(f"`{result.name}`, {result.seconds:.1f} s. {result.about}")
        lines = [_line(HEADINGS), _line(("---",) * len(HEADINGS))]
        lines += [_line((*row.cells[:-1], f"**{row.verdict}**" if row.verdict == "FAIL" else row.verdict)) for row in result.rows]
        parts.append("\n".join(lines))
    return "\n\n".join(parts) + "\n"


def _line(cells: tuple[str, ...]) -> str:
    return "| " + " | ".join(_cell(cell) for cell in cells) + " |"


def _cell(text: str) -> str:
    return " ".join(text.split()).replace("|", "\\|").replace("<", "&lt;")
