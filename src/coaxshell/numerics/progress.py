"""How long computations tell where they are: the share done, from 0 to 1, with or without what is being done."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from functools import partial

Progress = Callable[[float, str], None]
ShareDone = Callable[[float], None]

_listener: ContextVar[ShareDone | None] = ContextVar("listener", default=None)


@contextmanager
def heard_by(listener: ShareDone) -> Iterator[None]:
    """Make a listener hear how far the work inside a ``with`` block is; it may raise an exception to end it."""
    token = _listener.set(listener)
    try:
        yield
    finally:
        _listener.reset(token)


def tell_share(share: float) -> None:
    """Tell whoever listens to this work what share of it is done; for work that may run on any thread, process or machine."""
    listener = _listener.get()
    if listener is not None:
        listener(share)


def of_stage(progress: Progress | None, stage: str) -> ShareDone | None:
    """Return what tells the share done of one stage; None if nobody asked for progress."""
    return None if progress is None else partial(_told, progress, stage)


def _told(progress: Progress, stage: str, share: float) -> None:
    progress(share, stage)
