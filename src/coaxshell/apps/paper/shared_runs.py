"""The many runs of one figure on all cores: in shares of neighbours, each solved by a process with a structure of its own."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from coaxshell.apps.paper.observed import Observed, observe
from coaxshell.errors import PhysicsWarning
from coaxshell.numerics.progress import Progress
from coaxshell.solver.settings import Settings
from coaxshell.studies.executors import completed
from coaxshell.studies.threads import one_blas_thread

if TYPE_CHECKING:
    from coaxshell.model import System
    from coaxshell.response import Response

Solver = Callable[["Mapping[str, System]", Settings, "Progress | None"], "Iterator[tuple[str, Response]]"]
"""Solves systems in turn; :func:`coaxshell.studies.structures.solve_each` or one with slips turned on."""

FEWEST = 12
"""Below it the start of the processes costs more than it saves."""

_SHARES = 6
"""Shares a process: few, since each prepares its structure; several, since they take unequal times."""


@dataclass(frozen=True)
class Share:
    """Systems that one process solves one after another, as sent to it."""

    solver: Solver
    systems: Mapping[str, System]
    resolution: Settings
    peaks_only: bool


def in_turn(share: Share, progress: Progress | None = None) -> Iterator[tuple[str, Observed]]:
    """Yield (name, run) of each system, solved in this process."""
    for name, response in share.solver(share.systems, share.resolution, progress):
        yield name, observe(response, peaks_only=share.peaks_only)


def shared_out(share: Share, workers: int, progress: Progress | None = None) -> Iterator[tuple[str, Observed]]:
    """Yield (name, run) of each system, solved by several processes; in any order, the runs the same as in turn."""
    names, count, done = list(share.systems), len(share.systems), 0
    size = -(-count // (_SHARES * workers))
    parts = [{name: share.systems[name] for name in names[start : start + size]} for start in range(0, count, size)]
    tasks = [Share(share.solver, part, share.resolution, share.peaks_only) for part in reversed(parts)]  # the longest come last
    for task, found in completed(tasks, _carried_out, workers=workers):
        if isinstance(found, Exception):
            raise found
        done += len(task.systems)
        if progress:
            progress(done / count, "solving")
        yield from found.items()


def _carried_out(share: Share) -> dict[str, Observed]:
    with one_blas_thread(), warnings.catch_warnings():
        warnings.simplefilter("ignore", PhysicsWarning)  # every run keeps its own
        return dict(in_turn(share))
