"""Two runs side by side on stdout, and how each peak of the first stands to that of the second."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from typing import TYPE_CHECKING

from coaxshell.apps.cli.output import echo, printable, tell_warnings
from coaxshell.response.run_comparison import comparison_rows

if TYPE_CHECKING:
    from coaxshell.response import Response
    from coaxshell.response.spatial_summary import SpatialSummary
    from coaxshell.response.summary import Summary


def print_comparison(responses: Mapping[str, Response]) -> None:
    """Print two named runs side by side on stdout and their warnings on stderr."""
    (first, second), summaries = responses, [response.summary() for response in responses.values()]
    rows = comparison_rows(*summaries)
    title = printable(f"{first} against {second}")
    header = ("shell", "largest magnitude", first, second, "the first is")
    notes = [f"{name}: {_run(summary)}" for name, summary in zip(responses, summaries, strict=True)]
    if sys.stdout.isatty():
        from rich.console import Console
        from rich.markup import escape
        from rich.table import Table

        table = Table(title=escape(title), title_justify="left", title_style="bold", box=None, pad_edge=False)
        for number, heading in enumerate(header):
            table.add_column(escape(printable(heading)), justify="left" if number < 2 else "right", no_wrap=number > 1)
        for row in rows:
            table.add_row(*map(escape, row))
        Console().print(table)
    else:
        from coaxshell.response.summary_text import aligned

        echo("\n".join([title, "", *aligned([header, *rows], left=2)]))
    echo("\n" + "\n".join(notes))
    for name, summary in zip(responses, summaries, strict=True):
        tell_warnings(f"{name}: {text}" for text in summary.warnings)


def _run(summary: Summary | SpatialSummary) -> str:
    plain = summary.to_dict()
    settings, (start, end) = plain["settings"], plain["window"]
    stations = ", ".join(f"{one['station']:g}" for one in plain.get("stations", ()))
    return (
        f"{settings['engine']} engine, {settings['modes']} modes, time step {settings['time_step']:g}, t = {start:g} to {end:g} transits"
        + (f", three dimensions, largest over z = {stations} m" if stations else "")
    )
