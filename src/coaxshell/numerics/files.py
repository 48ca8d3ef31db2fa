"""The one writer of files and folders: whole or not at all, with the old result in its place until the new one is.

What is written is made in a hidden place beside its target, forced to the disk, and put there in one step. Links are followed, modes
kept, and every failure is one line that names the path. What a killed writer left is reclaimed by the next one in the same folder.
"""

from __future__ import annotations

import errno
import os
import stat
from collections.abc import Collection, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from coaxshell.errors import InputError
from coaxshell.numerics.scratch import put_folder, scratch

_REMEDIES = {
    **dict.fromkeys(("ENOSPC", "EDQUOT", "EFBIG"), "make room, or choose another place"),
    **dict.fromkeys(("EACCES", "EPERM", "EROFS"), "choose a place that you may write to"),
    "ENOENT": "make the folder first",
    "ENOTDIR": "name a place inside a folder",
    "ENAMETOOLONG": "choose a shorter name",
}
_FULL = frozenset({errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO})
_NOISE = frozenset({".DS_Store", "Thumbs.db", "desktop.ini"})
"""What file managers leave in folders that were looked at."""


@contextmanager
def replacing(path: str | Path, where: str = "path", *, durable: bool = True) -> Iterator[Path]:
    """Yield a name to write to; what is there at the end of the ``with`` block becomes *path*, in one step.

    Parameters
    ----------
    path : str or Path
        A link is followed: what it points to is replaced.
    where : str
        What errors call it.
    durable : bool
        Force it to the disk, and reclaim what killed writers left. False for one of many small files that can be made again.

    Raises
    ------
    InputError
        It cannot be written, for whatever reason. The old file is as it was, and nothing else is left.
    """
    with told(path, where):
        target, old = _file(path, where)
        with scratch(target.parent, sweep=durable) as place:
            made = place / target.name
            yield made
            if durable:
                _force(made)
            if old is not None:
                _as_before(made, old)
            os.replace(made, target)
            if durable:
                _force_folder(target.parent)


@contextmanager
def replacing_folder(path: str | Path, parts: Collection[str], where: str = "folder", *, force: bool = False) -> Iterator[Path]:
    """Yield an empty folder to fill; at the end of the ``with`` block it becomes *path*, in one step where the system has one.

    Where it has none (neither Linux nor macOS, or a file system without exchange) the old folder is moved away between two renames; a
    writer killed between them is made good by the next one in the same place.

    Parameters
    ----------
    path : str or Path
        A link is followed.
    parts, force
        As in :func:`free_folder`.

    Raises
    ------
    InputError
        As :func:`free_folder`, or it cannot be written. The old folder is as it was, and nothing else is left.
    """
    target = free_folder(path, parts, where, force=force)
    with told(path, where), scratch(target.parent) as place:
        made = place / "made"
        made.mkdir()
        yield made
        for folder, _, names in os.walk(made):
            for name in names:
                _force(Path(folder, name))
            _force_folder(Path(folder))
        if target.exists():
            _as_before(made, target.stat())
        put_folder(place, made, target)
        _force_folder(target.parent)


def write_text(path: str | Path, text: str, where: str = "path", *, durable: bool = True) -> None:
    """Write a text file in UTF-8, whole or not at all; see :func:`replacing`."""
    with replacing(path, where, durable=durable) as made:
        made.write_text(text, encoding="utf-8")


def free_file(path: str | Path, where: str = "path", *, force: bool = True) -> Path:
    """Return the path if a file can be written there: tried, so that a long computation does not end with nowhere to write.

    Raises
    ------
    InputError
        It cannot, or there is a file already and *force* is false.
    """
    with told(path, where):
        target, old = _file(path, where)
        if old is not None and not force:
            raise InputError(where, f"{str(path)!r} exists already", "give another name, or --force to overwrite it")
        with scratch(target.parent):
            pass
    return Path(path)


def free_folder(path: str | Path, parts: Collection[str], where: str = "folder", *, force: bool = False) -> Path:
    """Return where a folder can be made: links followed, tried as by :func:`free_file`.

    Parameters
    ----------
    path : str or Path
    parts : collection of str
        Names that a result of this kind holds: a folder with anything else in it is never replaced.
    where : str
    force : bool
        Whether an earlier result may be replaced.

    Raises
    ------
    InputError
        It cannot be made, something is there already, or it holds what is no part of a result.
    """
    with told(path, where):
        target = _real(path, where)
        if target.exists() and not target.is_dir():
            raise InputError(where, f"{str(path)!r} is a file", "give the name of a folder to make")
        held = sorted(set(os.listdir(target)) - _NOISE) if target.exists() else []
        strangers = [name for name in held if name not in parts]
        if strangers:
            raise InputError(
                where, f"{str(path)!r} holds something else than a result ({strangers[0]!r})", "give the name of a new or an empty folder"
            )
        if held and not force:
            raise InputError(where, f"{str(path)!r} exists already and is not empty", "give another name, or replace it with --force")
        if target in (here := Path.cwd().resolve(), *here.parents):
            raise InputError(where, f"{str(path)!r} is the folder that you are in", "give the name of a new folder")
        with scratch(target.parent):
            pass
    return target


@contextmanager
def told(path: str | Path, where: str = "path") -> Iterator[None]:
    """Tell failures of the system while *path* is written as one InputError."""
    try:
        yield
    except InputError:
        raise
    except Exception as error:
        failure = _of_the_system(error)
        if failure is None:
            raise
        remedy = _REMEDIES.get(errno.errorcode.get(failure.errno or 0, ""), "choose another place")
        raise InputError(where, f"cannot write {str(path)!r}: {reason(failure)}", remedy) from error


def _of_the_system(error: BaseException) -> OSError | None:
    """Return what the system said, where a library has made another error of a full disk (as zlib does for a PDF); None if nothing."""
    if isinstance(error, OSError):
        return error
    before = error.__cause__ or error.__context__
    while before is not None:
        if isinstance(before, OSError) and before.errno in _FULL:
            return before
        before = before.__cause__ or before.__context__
    return None


def reason(error: OSError) -> str:
    """Return in words what the system says is wrong; h5py buries it in a long report of its own."""
    return os.strerror(error.errno).lower() if error.errno else str(error) or type(error).__name__


def _real(path: str | Path, where: str) -> Path:
    """Return where a path leads, links followed; InputError if it is no path at all."""
    try:
        text = os.fsencode(path)
    except UnicodeError:
        text = b"\0"
    if b"\0" in text or not text:
        raise InputError(where, f"{str(path)!r} is not the name of a file", "give another one")
    target = Path(os.path.realpath(path))
    for folder in (Path(path).parent, target.parent):  # named as the user did, if it is his own
        if not folder.is_dir():
            problem = "is a file" if folder.exists() else "does not exist"
            raise InputError(where, f"cannot write {str(path)!r}: the folder {str(folder)!r} {problem}", "make it first")
    return target


def _file(path: str | Path, where: str) -> tuple[Path, os.stat_result | None]:
    """Return where a file goes, and the state of the one that is there."""
    target = _real(path, where)
    try:
        old = target.stat()
    except FileNotFoundError:
        return target, None
    if stat.S_ISDIR(old.st_mode):
        raise InputError(where, f"cannot write {str(path)!r}: it is a folder", "give the name of a file")
    if not stat.S_ISREG(old.st_mode):
        raise InputError(where, f"cannot write {str(path)!r}: it is a device or a pipe", "give the name of a file")
    if not os.access(target, os.W_OK):
        raise InputError(where, f"cannot write {str(path)!r}: it is write-protected", "give another name")
    return target, old


def _as_before(made: Path, old: os.stat_result) -> None:
    """Give what was made the owner, where that is allowed, and the mode of what it replaces."""
    with suppress(OSError, AttributeError):  # Windows has no chown
        if (old.st_uid, old.st_gid) != (os.getuid(), os.getgid()):
            os.chown(made, old.st_uid, old.st_gid)
    os.chmod(made, stat.S_IMODE(old.st_mode))


def _force(path: Path) -> None:
    """Wait until a file is on the disk."""
    file = os.open(path, os.O_RDONLY if os.name == "posix" else os.O_RDWR)
    try:
        os.fsync(file)
    finally:
        os.close(file)


def _force_folder(path: Path) -> None:
    """Wait until the names in a folder are on the disk, where the system can."""
    with suppress(OSError):
        _force(path)
