"""From the options of a command to how its study is worked on."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from coaxshell.cli.progress import progress, tell_time
from coaxshell.cli.values import named_as_options, whole
from coaxshell.errors import InputError

if TYPE_CHECKING:
    from coaxshell.model import System
    from coaxshell.solver.settings import Settings
    from coaxshell.studies import How


@contextmanager
def study_options(store: Path, resume: bool, workers: str | None, dask: str | None, quiet: bool) -> Iterator[How]:
    """Yield how a study is worked on: on a Dask cluster if there is the address of one, else by a pool of processes of our own.

    Raises
    ------
    InputError
        No number of processes, or one beside a cluster; no cluster at the address.
    """
    from coaxshell.studies import How, dask_executor

    number = None if workers is None else whole("--workers", workers)
    if number is not None and dask is not None:
        raise InputError("--workers", "has no effect with --dask, whose cluster has its own", "give one or the other")
    with ExitStack() as stack:
        executor = None
        if dask is not None:
            with named_as_options(address="dask", dask="dask"):
                executor = stack.enter_context(dask_executor(dask))
        yield How(executor, number, store, resume, stack.enter_context(progress(quiet, left=True)))


def tell_study_time(systems: Sequence[System | InputError], resolution: Settings, count: int, how: How, *, quiet: bool) -> None:
    """Say how long a study of so many runs will take, from some of its systems."""
    from coaxshell.studies.cost import case_cost
    from coaxshell.studies.executors import capacity

    if resolution.modes != "auto":
        cost = case_cost(systems, resolution).times(count, capacity(how.executor, how.workers))
        tell_time(cost, f"{count:,} runs", quiet)


def tell_code(functions: list[str]) -> None:
    """Say which functions of the user's are about to be run."""
    sys.stderr.write(f"runs code: {', '.join(functions)}\n")
