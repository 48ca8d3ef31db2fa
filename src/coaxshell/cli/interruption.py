"""An interruption that leaves something behind, and says what."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


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
