"""Dask as an executor: a study on a cluster, given the address of its scheduler."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from typing import Any

from coaxshell.errors import InputError


@contextmanager
def dask_executor(address: str, timeout: float = 10.0) -> Iterator[Executor]:
    """Yield an executor on the Dask cluster whose scheduler is at *address*, such as ``tcp://10.0.0.1:8786``.

    The workers need coaxshell of the same version; the store stays on this machine.

    Raises
    ------
    InputError
        Dask is not installed, or nobody answers within *timeout* seconds.
    """
    try:
        from distributed import Client
    except ImportError:
        raise InputError("dask", "needs the package distributed", 'install it: pip install "coaxshell[cluster]"') from None
    try:
        client: Any = Client(address, timeout=timeout, set_as_default=False)  # type: ignore[no-untyped-call]
    except (OSError, ValueError, TypeError) as error:
        raise InputError(
            "address", f"no scheduler answers at {address!r} ({error})", "give its address, as in tcp://10.0.0.1:8786"
        ) from None
    try:
        # What a worker was about when it died is done again elsewhere; three deaths under one task are not chance.
        yield client.get_executor(retries=0)
    finally:
        client.close()
