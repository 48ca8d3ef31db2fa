"""Folders that appear whole or not at all."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from coaxshell.errors import InputError


def new_folder(target: Path, *, force: bool = False, name: str = "folder") -> Path:
    """Return *target* if a folder can be made there; InputError otherwise."""
    if target.exists() and not target.is_dir():
        raise InputError(name, f"{str(target)!r} is a file", "give the name of a folder to make")
    if target.is_dir() and any(target.iterdir()) and not force:
        raise InputError(name, f"{str(target)!r} exists already and is not empty", "give another name, or replace it with --force")
    if not target.absolute().parent.is_dir():
        raise InputError(name, f"the folder {str(target.absolute().parent)!r} does not exist", "make it first, or give another one")
    if not os.access(target.absolute().parent, os.W_OK):
        raise InputError(name, f"cannot write into {str(target.absolute().parent)!r}", "give a place that you may write to")
    return target


@contextmanager
def replacing_folder(target: Path, *, force: bool = False) -> Iterator[Path]:
    """Yield a hidden folder beside *target* to fill; it is renamed at the end, or removed when something goes wrong.

    Raises
    ------
    InputError
        The folder exists and *force* is not given, or it cannot be made.
    """
    target = new_folder(target, force=force).absolute()
    partial = target.with_name(f".{target.name}.{os.getpid()}.part")
    retired = target.with_name(f".{target.name}.{os.getpid()}.old")
    try:
        partial.mkdir()
        yield partial
        if target.exists():
            target.rename(retired)
        partial.rename(target)
    except OSError as error:
        if retired.exists() and not target.exists():
            retired.rename(target)
        raise InputError("folder", f"cannot write {str(target)!r}: {error.strerror or error}", "give a place you may write to") from None
    finally:
        shutil.rmtree(partial, ignore_errors=True)
        if target.exists():
            shutil.rmtree(retired, ignore_errors=True)
