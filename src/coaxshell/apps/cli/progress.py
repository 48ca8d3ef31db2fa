"""Progress of a computation: a bar on a terminal, lines of per cent elsewhere, always on stderr; and its interruption, told."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from coaxshell.numerics.progress import Progress

if TYPE_CHECKING:
    from coaxshell.numerics.cost import Cost

from coaxshell.apps.cli.output import printable

_LINES = 10


def tell_time(cost: Cost, what: str, quiet: bool) -> None:
    """Say on stderr how long something will take, if that is longer than anyone waits without asking."""
    if not quiet and cost.seconds >= 30.0:
        sys.stderr.write(f"{what}: about {cost.duration} on a machine that has nothing else to do\n")
        sys.stderr.flush()


@contextmanager
def progress(quiet: bool = False, *, left: bool = False) -> Iterator[Progress | None]:
    """Yield a function of (fraction done, stage) that shows them, with the time *left* if asked; None when nothing is to be shown."""
    if quiet:
        yield None
    elif sys.stderr.isatty():
        with _bar(left) as report:
            yield report
    else:
        yield _lines(left)


@contextmanager
def _bar(left: bool) -> Iterator[Progress]:
    from rich import progress as rich_progress
    from rich.console import Console
    from rich.progress import BarColumn, ProgressColumn, TaskProgressColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn

    columns: tuple[ProgressColumn, ...] = (
        TextColumn("{task.description:<20}", markup=False),
        BarColumn(),
        TaskProgressColumn(),
        TimeElapsedColumn(),
    )
    if left:
        columns = (*columns, TextColumn("left"), TimeRemainingColumn())
    with rich_progress.Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("solving", total=1.0)

        def report(fraction: float, stage: str) -> None:
            bar.update(task, completed=fraction, description=printable(stage))

        yield report


def _lines(left: bool) -> Progress:
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


class Interrupted(Exception):  # noqa: N818 - not an error: the user pressed Ctrl-C
    """Raised in place of KeyboardInterrupt by a command whose work so far is kept; its text says where and how to go on."""


@contextmanager
def kept(folder: Path, cases: int) -> Iterator[None]:
    """Turn Ctrl-C into a sentence that says how many of the cases of a study a store holds."""
    try:
        yield
    except KeyboardInterrupt:
        done = sum(1 for path in folder.glob("*.json") if path.name != "study.json")
        raise Interrupted(f"interrupted; {done} of {cases} cases are kept in {str(folder)!r}: go on with --resume") from None
