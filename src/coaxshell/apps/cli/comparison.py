"""Two runs side by side on stdout, and how each peak of the first stands to that of the second."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from typing import TYPE_CHECKING

from coaxshell.apps.cli.output import echo, printable, tell_warnings

if TYPE_CHECKING:
    from coaxshell.model import System
    from coaxshell.response import Response
    from coaxshell.response.peaks import Peak
    from coaxshell.response.summary import Summary

_NONE = "-"


def labels(first: System, second: System) -> tuple[str, str]:
    """Return a name for each of two systems, different even where theirs are not."""
    one, other = first.name or "first", second.name or "second"
    return (one, other) if one != other else (one, f"{other} (compared)")


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


def comparison_rows(first: Summary, second: Summary) -> list[tuple[str, ...]]:
    """Return (shell, quantity, first value, second value, how these stand) for each shell and quantity that either run has.

    Where a value still grows at the end of its run that would be a matter of the run's length: it is not given.
    """
    from coaxshell.model.prefixes import against, engineering
    from coaxshell.response.quantities import summary_rows
    from coaxshell.response.summary_text import GROWING

    ours, theirs = ({shell.name: shell for shell in summary.shells} for summary in (first, second))
    rows = []
    for name in dict.fromkeys([*ours, *theirs]):
        for key, label, unit in summary_rows():
            found = [getattr(shells.get(name), key, None) for shells in (ours, theirs)]
            pair = [_number(value) for value in found]
            if any(value is not None for value in pair):
                texts = [_NONE if value is None else engineering(value, unit) for value in pair]
                grows = any(getattr(value, "growing", False) for value in found)
                rows.append((name, label, *texts, GROWING if grows else against(pair[0], pair[1])))
    for key, label, unit in (("absorber_displacement", "displacement of masses", "m"), ("absorber_force", "force on a shell", "N/m")):
        pair = [getattr(summary, key) for summary in (first, second)]
        if any(value is not None for value in pair):
            rows.append(("absorbers", label, *(_NONE if v is None else engineering(v, unit) for v in pair), against(pair[0], pair[1])))
    return rows


def _number(value: Peak | float | None) -> float | None:
    return value if value is None or isinstance(value, int | float) else value.value


def _run(summary: Summary) -> str:
    settings = summary.settings
    return (
        f"{settings['engine']} engine, {settings['modes']} modes, time step {settings['time_step']:g}, "
        f"t = {summary.window[0]:g} to {summary.window[1]:g} transits"
    )
