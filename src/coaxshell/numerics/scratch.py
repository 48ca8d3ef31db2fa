"""Hidden places beside a target in which its successor is made; those of killed writers are found and reclaimed.

A place is a folder ``.coaxshell.TOKEN`` with a file ``lock`` that its writer keeps locked while it lives. Whoever gets the lock of a
place that is not his own knows that its writer is gone.
"""

from __future__ import annotations

import os
import shutil
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

if sys.platform != "win32":
    import fcntl

PREFIX = ".coaxshell."
_LOCK, _OLD, _NEW = "lock", "old", "new"
_LONGEST_WRITER = 24 * 3600.0
"""Seconds after which a place is taken for left behind where files cannot be locked."""
_AT_FDCWD, _RENAME_EXCHANGE, _RENAME_SWAP = -100, 2, 2


@contextmanager
def scratch(folder: Path, *, sweep: bool = True) -> Iterator[Path]:
    """Yield a new hidden place in *folder*; it is gone afterwards, whatever happens but a kill.

    Parameters
    ----------
    folder : Path
    sweep : bool
        Look first for what killed writers left in *folder*, and remove it.
    """
    if sweep:
        reclaim(folder)
    place, lock = _occupied(folder)
    try:
        yield place
    finally:
        os.close(lock)  # first: on Windows nothing that is open can be removed
        shutil.rmtree(place, ignore_errors=True)


def _occupied(folder: Path) -> tuple[Path, int]:
    """Return a new place and its lock, held."""
    while True:
        place = folder / f"{PREFIX}{os.urandom(8).hex()}"
        place.mkdir(mode=0o700)
        try:
            lock = os.open(place / _LOCK, os.O_RDWR | os.O_CREAT, 0o600)
        except FileNotFoundError:  # another writer came to reclaim it before it was locked
            continue
        except BaseException:
            shutil.rmtree(place, ignore_errors=True)
            raise
        if _held(place, lock) is not False:
            return place, lock
        os.close(lock)


def _held(place: Path, lock: int) -> bool | None:
    """Try to lock a place: False if somebody else holds it or has removed it, None where files cannot be locked."""
    if sys.platform == "win32":
        return None
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        return os.path.samestat(os.fstat(lock), (place / _LOCK).stat())
    except (BlockingIOError, FileNotFoundError):
        return False
    except OSError:
        return None


def reclaim(folder: Path) -> None:
    """Remove what killed writers left in a folder; a folder that one of them had begun to replace is put in its place."""
    with suppress(OSError):
        for entry in list(os.scandir(folder)):
            if entry.name.startswith(PREFIX) and entry.is_dir(follow_symlinks=False):
                with suppress(OSError):
                    _reclaim(Path(entry.path))


def _reclaim(place: Path) -> None:
    age = time.time() - place.stat().st_mtime
    lock = os.open(place / _LOCK, os.O_RDWR | os.O_CREAT, 0o600)
    held = _held(place, lock)
    gone = age > _LONGEST_WRITER if held is None else held
    try:
        if gone:
            _complete(place)
    finally:
        os.close(lock)
        if gone:
            shutil.rmtree(place, ignore_errors=True)


def _complete(place: Path) -> None:
    """Finish the replacement of a folder that was killed between its two renames: its own name is free then."""
    for old in place.glob(f"{_OLD}/*"):
        target = place.parent / old.name
        if not target.exists():
            new = place / _NEW / old.name
            os.rename(new if new.exists() else old, target)


def put_folder(place: Path, made: Path, target: Path) -> None:
    """Put a folder made in *place* where *target* is: in one step, by an exchange, wherever the system knows one.

    Elsewhere the old folder moves into *place* first; whoever comes after a kill between the two renames completes them.
    """
    if not target.exists():
        os.rename(made, target)
        return
    if exchange(made, target):
        return
    old, new = place / _OLD / target.name, place / _NEW / target.name
    new.parent.mkdir()
    old.parent.mkdir()
    os.rename(made, new)
    os.rename(target, old)
    try:
        os.rename(new, target)
    except BaseException:
        if not target.exists():
            os.rename(old, target)
        raise


def exchange(one: Path, other: Path) -> bool:
    """Exchange two files or folders in one step; False, and nothing done, where that is not possible."""
    import ctypes

    names = os.fsencode(one), os.fsencode(other)
    try:
        library = ctypes.CDLL(None)
        if sys.platform == "darwin":
            return bool(library.renamex_np(*names, _RENAME_SWAP) == 0)
        return bool(library.renameat2(_AT_FDCWD, names[0], _AT_FDCWD, names[1], _RENAME_EXCHANGE) == 0)
    except (AttributeError, OSError, TypeError):  # no such function, or (Windows) no such library
        return False
