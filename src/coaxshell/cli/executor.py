"""The executor that a study's options ask for."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import contextmanager


@contextmanager
def chosen_executor(address: str | None) -> Iterator[Executor | None]:
    """Yield an executor on the Dask cluster at an address; None without one, for a pool of processes of our own."""
    if address is None:
        yield None
        return
    from coaxshell.studies import dask_executor

    with dask_executor(address) as executor:
        yield executor
