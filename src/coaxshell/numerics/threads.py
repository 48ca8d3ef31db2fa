"""The threads of this process: kept from one piece of work to the next, for starting one takes as long as a small piece of work."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from typing import TypeVar

Item = TypeVar("Item")
Result = TypeVar("Result")

WORKERS = min(os.cpu_count() or 1, 8)
"""Threads for FFTs and for blocks of Laplace nodes."""


class _Here(threading.local):
    """Whether a thread is one of those kept."""

    working = False


_here = _Here()


def map_on_threads(work: Callable[[Item], Result], items: Iterable[Item]) -> Iterator[Result]:
    """Yield what a function makes of each item, in their order, on all threads; within one of them, or where there is one, here.

    NumPy releases the interpreter's lock, so that several items are worked at a time. What the function raises is raised when its turn
    comes, and no item that is not begun by then is begun.
    """
    if _here.working or WORKERS == 1:
        return map(work, items)
    return _threads(os.getpid()).map(work, items)


@cache
def _threads(process: int) -> ThreadPoolExecutor:
    """Return the threads of a process; a forked one has none of its parent's."""
    return ThreadPoolExecutor(WORKERS, "coaxshell", initializer=_begin)


def _begin() -> None:
    _here.working = True
