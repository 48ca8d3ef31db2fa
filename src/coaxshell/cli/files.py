"""Files that a command is going to write: refused before the work starts, and never left half written."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from coaxshell.errors import InputError


def writable(path: Path, option: str, suffixes: Sequence[str]) -> Path:
    """Return *path* if a file of one of the kinds can be written there; InputError otherwise."""
    if path.suffix.lower() not in suffixes:
        raise InputError(option, f"{str(path)!r} has no known ending", f"allowed: {', '.join(suffixes)}")
    if path.is_dir():
        raise InputError(option, f"{str(path)!r} is a folder", "give the name of a file")
    folder = path.parent
    if not folder.is_dir():
        raise InputError(option, f"the folder {str(folder)!r} does not exist", "make it first, or give another one")
    try:
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as error:
        raise InputError(option, f"cannot write into {str(folder)!r}: {_reason(error)}", "give a folder that you may write to") from None
    return path


def drawable(path: Path | None, option: str = "--figure") -> None:
    """Refuse a figure that cannot be written; InputError names the option."""
    if path is not None:
        from coaxshell.plotting.saving import FIGURE_SUFFIXES

        writable(path, option, FIGURE_SUFFIXES)


def new_folder(path: Path, option: str, mark: str) -> Path:
    """Return *path* if a result can be written there as a folder: new, empty, or an earlier result with a file *mark* in it."""
    if path.exists() and not (path / mark).is_file() and (not path.is_dir() or any(path.iterdir())):
        raise InputError(option, f"{str(path)!r} holds something else than a result", "give a new or an empty folder")
    writable(path.with_name(f"{path.name}.toml"), option, (".toml",))
    return path


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Yield a temporary name beside *path*; rename it to *path* at the end, or remove it when something goes wrong."""
    partial = path.with_name(f".{path.stem}.{os.getpid()}.part{path.suffix}")
    try:
        yield partial
        partial.replace(path)
    finally:
        partial.unlink(missing_ok=True)


def _reason(error: OSError) -> str:
    return (error.strerror or type(error).__name__).lower()
