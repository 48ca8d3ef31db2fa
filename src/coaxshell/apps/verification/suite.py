"""Run checks one after another; what goes wrong in one becomes a failing row and the others go on."""

from __future__ import annotations

import math
import platform
import time
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime

import numpy as np
import scipy

from coaxshell._version import __version__
from coaxshell.apps.verification.bench import Bench
from coaxshell.apps.verification.registry import Check
from coaxshell.apps.verification.rows import Row, Sheet
from coaxshell.numerics.progress import Progress

SOURCES = (
    'Sources: "theory N" is section N of the theory manual, "reference" the values of high precision that come with the package, '
    "Eq. and Fig. those of the paper. A row passes if its error is at most its tolerance."
)


@dataclass(frozen=True)
class Result:
    """What one check found, and how long it took."""

    name: str
    title: str
    about: str
    rows: tuple[Row, ...]
    sheets: tuple[Sheet, ...]
    seconds: float


@dataclass(frozen=True)
class Report:
    """All results and the circumstances."""

    title: str
    results: tuple[Result, ...]
    circumstances: str
    note: str = ""

    @property
    def rows(self) -> tuple[Row, ...]:
        """The rows of all checks."""
        return tuple(row for result in self.results for row in result.rows)

    @property
    def seconds(self) -> float:
        """Time of all checks together."""
        return sum(result.seconds for result in self.results)

    @property
    def failed(self) -> tuple[Row, ...]:
        """The rows that fail."""
        return tuple(row for row in self.rows if row.verdict == "FAIL")

    @property
    def verdict(self) -> str:
        """Return the outcome in one line."""
        counted = Counter(row.verdict for row in self.rows)
        judged = counted["pass"] + counted["FAIL"]
        parts = [f"{counted['pass']} pass", f"{counted['FAIL']} fail"] if judged else []
        parts += [f"{counted[name]} {name}" for name in ("noted", "skipped") if counted[name]]
        text = ("1 row" if len(self.rows) == 1 else f"{len(self.rows)} rows") + f": {', '.join(parts)}"
        checks = "1 check" if len(self.results) == 1 else f"{len(self.results)} checks"
        return f"{text}; {checks} in {self.seconds:.0f} s"


def run(checks: Sequence[Check], *, quick: bool = False, progress: Progress | None = None) -> Report:
    """Carry out checks and return the report.

    Parameters
    ----------
    checks : sequence of Check
    quick : bool
        Smaller versions of them.
    progress : callable, optional
        Called with the fraction done and the name of the check at work.
    """
    results: list[Result] = []
    current = ""

    def tell(fraction: float) -> None:
        if progress is not None:
            progress((len(results) + min(fraction, 1.0)) / len(checks), f"check {current}")

    bench = Bench(quick=quick, progress=tell)
    for one in checks:
        current = one.name
        tell(0.0)
        results.append(_carried_out(one, bench))
    if progress is not None:
        progress(1.0, "checks")
    return Report("coaxshell: conformance report", tuple(results), circumstances(quick), SOURCES)


def _carried_out(one: Check, bench: Bench) -> Result:
    start = time.perf_counter()
    rows: list[Row] = []
    sheets: list[Sheet] = []
    try:
        for finding in one.work(bench):
            if isinstance(finding, Row):
                rows.append(finding)
            else:
                sheets.append(finding)
    except Exception as error:  # noqa: BLE001  (a check that breaks is a check that fails)
        told = f"{type(error).__name__}: {' '.join(str(error).split())}"
        rows.append(Row("the whole check", "", "to be carried out", told, math.nan, 0.0, "broken"))
    if not rows:
        rows.append(Row("the whole check", "", "at least one row", "nothing", math.nan, 0.0, "broken"))
    return Result(one.name, one.title, one.about, tuple(rows), tuple(sheets), time.perf_counter() - start)


def circumstances(quick: bool = False) -> str:
    """Return versions, machine and date in one line."""
    versions = f"coaxshell {__version__}, Python {platform.python_version()}, NumPy {np.__version__}, SciPy {scipy.__version__}"
    when = datetime.now(UTC).strftime("%Y-%m-%d %H:%M UTC")
    return f"{versions}, {platform.system()} {platform.machine()}; {when}{'; quick suite' if quick else ''}"
