"""A bound on what a library may allocate for data from outside."""

from __future__ import annotations

import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

if sys.platform != "win32":
    import resource

_ONE_AT_A_TIME = threading.RLock()


@contextmanager
def at_most(size: int) -> Iterator[None]:
    """Let the process grow by so many bytes inside a ``with`` block; what asks for more fails, as if memory were short.

    HDF5 makes room for whatever length a file claims before it looks. Where the system knows no such bound (anything but Linux), there
    is none.
    """
    with _ONE_AT_A_TIME:
        before = _bounded(size)
        try:
            yield
        finally:
            if before is not None:
                with suppress(OSError, ValueError):
                    resource.setrlimit(resource.RLIMIT_AS, before)


def _bounded(size: int) -> tuple[int, int] | None:
    """Set the bound and return the one before; None if there is none to set."""
    if sys.platform != "linux":
        return None
    try:
        pages = int(Path("/proc/self/statm").read_text().split()[0])
        before = resource.getrlimit(resource.RLIMIT_AS)
        limit = pages * resource.getpagesize() + size
        if before[0] != resource.RLIM_INFINITY and before[0] < limit:
            return None
        resource.setrlimit(resource.RLIMIT_AS, (limit, before[1]))
    except (OSError, ValueError):
        return None
    return before
