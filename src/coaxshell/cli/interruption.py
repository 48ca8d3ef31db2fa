"""Interruptions: Ctrl-C, a request to terminate that ends a command likewise, and one that leaves something behind and says what."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


class Termination:
    """Whether the process has been asked to terminate (SIGTERM)."""

    asked = False

    def end(self, *_: object) -> None:
        """Take the signal as Ctrl-C."""
        self.asked = True
        raise KeyboardInterrupt


@contextmanager
def termination() -> Iterator[Termination]:
    """Turn SIGTERM into Ctrl-C while this lasts, so that temporaries go; elsewhere than in the main thread nothing is done."""
    told = Termination()
    if threading.current_thread() is not threading.main_thread() or signal.getsignal(signal.SIGTERM) is not signal.SIG_DFL:
        yield told
        return
    signal.signal(signal.SIGTERM, told.end)
    try:
        yield told
    finally:
        signal.signal(signal.SIGTERM, signal.SIG_DFL)


class Interrupted(Exception):  # noqa: N818 - not an error: the user pressed Ctrl-C
    """Raised in place of KeyboardInterrupt by a command whose work so far is kept; its text says where and how to go on."""


@contextmanager
def kept(folder: Path, cases: int) -> Iterator[None]:
    """Turn Ctrl-C into a sentence that says how many of the cases of a study a store holds."""
    try:
        yield
    except KeyboardInterrupt:
        done = sum(1 for path in folder.glob("*.json") if path.name != "study.json")
        raise Interrupted(f"interrupted; {done} of {cases} cases are kept in {str(folder)!r}: go on with --resume") from None
