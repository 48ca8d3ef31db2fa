"""Progress of a computation: a bar on a terminal, lines of per cent elsewhere, always on stderr."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

Report = Callable[[float, str], None]

_LINES = 10


@contextmanager
def progress(quiet: bool = False) -> Iterator[Report | None]:
    """Yield a function of (fraction done, stage) that shows them, or None when nothing is to be shown."""
    if quiet:
        yield None
    elif sys.stderr.isatty():
        with _bar() as report:
            yield report
    else:
        yield _lines()


@contextmanager
def _bar() -> Iterator[Report]:
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeElapsedColumn

    columns = (TextColumn("{task.description:<20}"), BarColumn(), TaskProgressColumn(), TimeElapsedColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("solving", total=1.0)

        def report(fraction: float, stage: str) -> None:
            bar.update(task, completed=fraction, description=stage)

        yield report


def _lines() -> Report:
    """Return a report that writes a line whenever a stage passes another tenth."""
    last: dict[str, int] = {}

    def report(fraction: float, stage: str) -> None:
        tenth = int(min(max(fraction, 0.0), 1.0) * _LINES + 1e-9)
        if tenth > last.get(stage, 0):
            last[stage] = tenth
            sys.stderr.write(f"{stage}: {100 * tenth // _LINES} %\n")
            sys.stderr.flush()

    return report
