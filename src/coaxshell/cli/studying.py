"""From the options of a command to how its study is worked on."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING

from coaxshell.cli.progress import progress
from coaxshell.cli.values import whole
from coaxshell.errors import InputError

if TYPE_CHECKING:
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
    with dask_executor(dask) if dask is not None else nullcontext() as executor, progress(quiet, left=True) as report:
        yield How(executor, number, store, resume, report)
