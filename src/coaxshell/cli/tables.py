"""Tables on stdout: drawn ones on a terminal, plain aligned text elsewhere. Warnings go to stderr, each once."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Iterable
from dataclasses import asdict, replace
from typing import TYPE_CHECKING

from coaxshell.cli.output import echo, printable
from coaxshell.errors import PhysicsWarning

if TYPE_CHECKING:
    from rich.table import Table

    from coaxshell.response import Response
    from coaxshell.response.peaks import Peak
    from coaxshell.response.summary import Summary


def print_summary(response: Response) -> None:
    """Print the summary of a run on stdout and its warnings on stderr."""
    whole = response.summary()
    summary = replace(whole, warnings=())
    if sys.stdout.isatty():
        from rich.console import Console

        from coaxshell.response.summary_text import notes

        console = Console()
        console.print(summary_table(summary))
        console.print("\n".join(printable(note) for note in notes(summary.to_dict())), markup=False, highlight=False)
    else:
        echo(str(summary).rstrip())
    tell_warnings(whole.warnings)


def tell_warnings(texts: Iterable[str]) -> None:
    """Tell the warnings of a run."""
    for text in texts:
        warnings.warn(PhysicsWarning(text), stacklevel=2)


def summary_table(summary: Summary) -> Table:
    """Return the summary as a table with one section for each shell."""
    from rich import box
    from rich.markup import escape
    from rich.table import Table

    from coaxshell.response.quantities import summary_rows

    title, run, *_ = printable(str(summary)).splitlines()
    table = Table(title=f"{escape(title)}\n[not bold]{escape(run)}[/]", title_justify="left", title_style="bold", box=box.SIMPLE_HEAD)
    table.add_column("shell", style="bold")
    table.add_column("largest magnitude")
    for heading in ("value", "t (a/c)", "angle (°)"):
        table.add_column(heading, justify="right", no_wrap=True)
    for shell in summary.shells:
        rows = [(label, cells) for key, label, unit in summary_rows() if (cells := _cells(getattr(shell, key), unit))]
        for number, (label, cells) in enumerate(rows):
            table.add_row(shell.name if number == 0 else "", label, *cells, end_section=number == len(rows) - 1)
    return table


def _cells(value: Peak | float | None, unit: str) -> tuple[str, ...]:
    """Return value, time and angle as text; nothing at all for what a shell does not have."""
    from coaxshell.model.prefixes import engineering
    from coaxshell.response.summary_text import when

    if value is None:
        return ()
    if isinstance(value, int | float):
        return engineering(value, unit), "", ""
    return engineering(value.value, unit), when(asdict(value)), f"{value.angle:.4g}"
