"""From the options of a command to how its study is worked on."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from coaxshell.cli.progress import progress, tell_time
from coaxshell.cli.values import named_as_options

if TYPE_CHECKING:
    from coaxshell.errors import InputError
    from coaxshell.model import System
    from coaxshell.solver.settings import Settings
    from coaxshell.studies import Execution


@contextmanager
def study_options(store: Path, resume: bool, workers: str | None, dask: str | None, quiet: bool) -> Iterator[Execution]:
    """Yield how a study is worked on: on a Dask cluster if there is the address of one, else by a pool of processes of our own.

    Raises
    ------
    InputError
        No number of processes, or one beside a cluster; no cluster at the address.
    """
    from coaxshell.solver.settings import whole
    from coaxshell.studies import Execution
    from coaxshell.studies.executors import MAX_WORKERS

    with ExitStack() as stack:
        with named_as_options(workers="workers", address="dask", dask="dask"):
            number = None if workers is None else whole("workers", workers, MAX_WORKERS)
            asked = Execution(workers=number, store=store, resume=resume, dask=dask)
            ready = stack.enter_context(asked.started())
        yield replace(ready, progress=stack.enter_context(progress(quiet, left=True)))


def tell_study_time(systems: Sequence[System | InputError], resolution: Settings, count: int, execution: Execution, *, quiet: bool) -> None:
    """Say how long a study of so many runs will take, from some of its systems."""
    from coaxshell.studies.cost import case_cost

    if resolution.modes != "auto":
        cost = case_cost(systems, resolution).times(count, execution.capacity)
        tell_time(cost, f"{count:,} runs", quiet)


def tell_code(functions: list[str]) -> None:
    """Say which functions of the user's are about to be run."""
    sys.stderr.write(f"runs code: {', '.join(functions)}\n")
