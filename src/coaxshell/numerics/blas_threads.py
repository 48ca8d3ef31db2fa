"""BLAS held to one thread while a case, or a block of a run, is worked on."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from typing import Any

from threadpoolctl import ThreadpoolController

_lock = threading.Lock()
_inside = 0
_limiter: Any = None


@cache
def _controller() -> ThreadpoolController:
    return ThreadpoolController()  # looks through the process's libraries: milliseconds, so once


@contextmanager
def one_blas_thread() -> Iterator[None]:
    """Hold BLAS to one thread in this process inside a ``with`` block; nested blocks and other threads' share one limit.

    Ask for it before threads are started: threadpoolctl from 3.8 on lets the first thread of a process that sets the limit set it alone.

    Workers that each use all cores would only stand in each other's way, and the last bits of BLAS depend on its number of threads.
    """
    global _inside, _limiter
    with _lock:
        if _inside == 0:
            _limiter = _controller().limit(limits=1, user_api="blas")
        _inside += 1
    try:
        yield
    finally:
        with _lock:
            _inside -= 1
            if _inside == 0:
                _limiter.restore_original_limits()
