"""The report on a terminal: drawn with rich there, plain aligned text elsewhere."""

from __future__ import annotations

from typing import TYPE_CHECKING

from coaxshell.apps.verification.rows import HEADINGS, Row
from coaxshell.apps.verification.suite import Report
from coaxshell.response.summary_text import aligned

if TYPE_CHECKING:
    from rich.console import RenderableType

_COLUMNS = (0, 2, 3, 4, 5, 7)
"""Columns shown: the source and the measure are left to the files."""
_LEFT = 1


def plain(report: Report) -> str:
    """Return the report as aligned text, one block for each check and the verdict last."""
    lines = [report.title, report.circumstances]
    for result in report.results:
        lines += ["", f"{result.title} ({result.name}, {result.seconds:.1f} s)" if result.seconds else result.title]
        rows = [_headings(), *(_shown(row) for row in result.rows)]
        lines += [f"  {line}" for line in aligned(rows, _LEFT)]
    return "\n".join([*lines, "", report.verdict])


def drawn(report: Report) -> list[RenderableType]:
    """Return the report as rich tables and texts."""
    from rich import box
    from rich.markup import escape
    from rich.table import Table
    from rich.text import Text

    parts: list[RenderableType] = [Text(report.title, style="bold"), Text(report.circumstances, style="dim")]
    colours = {"pass": "green", "FAIL": "bold red", "skipped": "yellow", "noted": "cyan"}
    for result in report.results:
        name = f" [not bold dim]{escape(result.name)}, {result.seconds:.1f} s[/]" if result.seconds else ""
        table = Table(
            title=f"[bold]{escape(result.title)}[/]{name}", title_justify="left", title_style="none", box=box.SIMPLE_HEAD, expand=True
        )
        for index, heading in enumerate(_headings()):
            table.add_column(heading, justify="left" if index < _LEFT else "right", ratio=3 if index == 0 else None, no_wrap=index > 2)
        for row in result.rows:
            cells = [escape(cell) for cell in _shown(row)]
            table.add_row(*cells[:-1], f"[{colours[row.verdict]}]{row.verdict}[/]")
        parts.append(table)
    return [*parts, Text(report.verdict, style="bold red" if report.failed else "bold green")]


def _headings() -> tuple[str, ...]:
    return tuple(HEADINGS[i] for i in _COLUMNS)


def _shown(row: Row) -> tuple[str, ...]:
    return tuple(row.cells[i] for i in _COLUMNS)
