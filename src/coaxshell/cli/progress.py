"""Progress of a computation: a bar on a terminal, lines of per cent elsewhere, always on stderr."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from coaxshell.numerics.cost import Cost

from coaxshell.cli.streams import printable

Report = Callable[[float, str], None]

_LINES = 10


def tell_time(cost: Cost, what: str, quiet: bool) -> None:
    """Say on stderr how long something will take, if that is longer than anyone waits without asking."""
    if not quiet and cost.seconds >= 30.0:
        sys.stderr.write(f"{what}: about {cost.duration} on a machine that has nothing else to do\n")
        sys.stderr.flush()


@contextmanager
def progress(quiet: bool = False, *, left: bool = False) -> Iterator[Report | None]:
    """Yield a function of (fraction done, stage) that shows them, with the time *left* if asked; None when nothing is to be shown."""
    if quiet:
        yield None
    elif sys.stderr.isatty():
        with _bar(left) as report:
            yield report
    else:
        yield _lines(left)


@contextmanager
def _bar(left: bool) -> Iterator[Report]:
    from rich.console import Console
    from rich.progress import BarColumn, Progress, ProgressColumn, TaskProgressColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn

    columns: tuple[ProgressColumn, ...] = (
        TextColumn("{task.description:<20}", markup=False),
        BarColumn(),
        TaskProgressColumn(),
        TimeElapsedColumn(),
    )
    if left:
        columns = (*columns, TextColumn("left"), TimeRemainingColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("solving", total=1.0)

        def report(fraction: float, stage: str) -> None:
            bar.update(task, completed=fraction, description=printable(stage))

        yield report


def _lines(left: bool) -> Report:
    """Return a report that writes a line whenever a stage passes another tenth."""
    last: dict[str, int] = {}
    begun: dict[str, tuple[float, float]] = {}

    def report(fraction: float, stage: str) -> None:
        name, _, news = stage.partition(": ")  # the news beside a stage's name changes while it lasts
        begun.setdefault(name, (time.monotonic(), fraction))
        tenth = int(min(max(fraction, 0.0), 1.0) * _LINES + 1e-9)
        if tenth > last.get(name, 0):
            last[name] = tenth
            told = f", {_time_left(*begun[name], fraction)} left" if left and fraction > begun[name][1] else ""
            sys.stderr.write(printable(f"{name}: {100 * tenth // _LINES} %{told}{f', {news}' if news else ''}\n"))
            sys.stderr.flush()

    return report


def _time_left(begun: float, done_then: float, done: float) -> str:
    """Return how long the rest takes at the pace so far; what was done before the start (a resumed study) does not count."""
    seconds = round((time.monotonic() - begun) / (done - done_then) * (1.0 - done))
    hours, minutes = seconds // 3600, seconds % 3600 // 60
    return f"{hours} h {minutes} min" if hours else f"{minutes} min {seconds % 60} s" if minutes else f"{seconds} s"
