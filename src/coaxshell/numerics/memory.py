"""How much memory this process may still take: what the system has free, within the limits set on the process.

The variable ``COAXSHELL_MEMORY`` overrides it in words: ``"12 GB"``, or ``"unlimited"``.
"""

from __future__ import annotations

import os
import re
import time
from pathlib import Path

from coaxshell.errors import InputError

VARIABLE = "COAXSHELL_MEMORY"
UNLIMITED = "unlimited"
_MOMENT, _MANY = 2.0, 16.0
"""Seconds for which what was free counts, for what takes less than one part in so many of it."""
_UNITS = {"b": 0, "kb": 1, "mb": 2, "gb": 3, "tb": 4}
_SIZE = re.compile(r"(\d{1,15}(?:\.\d{1,9})?) {0,3}([kmgt]?b|[kmgt]?ib)", re.IGNORECASE)


def available(environment: dict[str, str] | None = None, root: Path = Path("/")) -> int | None:
    """Return how many bytes this process may still take: the least of all limits that are known, None if there is none.

    Parameters
    ----------
    environment : mapping, optional
        Of the process unless given.
    root : Path
        Of the file system in which the kernel tells its numbers.

    Raises
    ------
    InputError
        ``COAXSHELL_MEMORY`` is not a size.
    """
    words = (os.environ if environment is None else environment).get(VARIABLE, "").strip()
    if words:
        return None if words.lower() == UNLIMITED else size_of(words)
    known = [found for found in (_free(root), _group(root), _address_space(root)) if found is not None]
    return max(0, min(known)) if known else None


def plenty(needed: float) -> bool:
    """Return whether many times what is needed was free a moment ago: the kernel takes milliseconds to tell."""
    words, now = os.environ.get(VARIABLE, ""), time.monotonic()
    if _Seen.words != words or now - _Seen.when > _MOMENT:
        _Seen.words, _Seen.when, _Seen.free = words, now, available()
    return _Seen.free is None or _MANY * needed <= _Seen.free


class _Seen:
    """What was free when the kernel was asked last, and what the variable said then."""

    words: str | None = None
    when = 0.0
    free: int | None = 0


def size_of(text: str) -> int:
    """Return the bytes of a size in words, ``"12 GB"`` or ``"500 MiB"``; InputError names the variable otherwise."""
    match = _SIZE.fullmatch(text[:50])
    if match is None:
        raise InputError(VARIABLE, f"{text[:50]!r} is not a size", f'write it as "12 GB", or "{UNLIMITED}"')
    number, unit = match.groups()
    base = 1024 if unit.lower().endswith("ib") else 1000
    return int(float(number) * base ** _UNITS[unit.lower().replace("i", "")])


def words_of(size: float) -> str:
    """Return bytes as people write them: ``"61.3 GB"``, ``"180 MB"``."""
    for unit, power in (("TB", 12), ("GB", 9), ("MB", 6), ("kB", 3)):
        if size >= 0.9995 * 10**power:
            return f"{size / 10**power:.3g} {unit}"
    return f"{size:.0f} bytes"


def _free(root: Path) -> int | None:
    """Return what the system has free without swapping; all of its memory where it does not tell."""
    for line in _text(root / "proc/meminfo").splitlines():
        if line.startswith("MemAvailable:"):
            return int(line.split()[1]) * 1024
    try:
        return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, ValueError, OSError):
        return None  # not told here, as on Windows


def _group(root: Path) -> int | None:
    """Return what the control groups of this process, and those that hold them, leave (a container's limit); None without a limit."""
    left: list[int] = []
    for line in _text(root / "proc/self/cgroup").splitlines():
        _, kinds, path = (*line.split(":", 2), "", "")[:3]
        if kinds == "":
            base, most, used = root / "sys/fs/cgroup", "memory.max", "memory.current"
        elif "memory" in kinds.split(","):
            base, most, used = root / "sys/fs/cgroup/memory", "memory.limit_in_bytes", "memory.usage_in_bytes"
        else:
            continue
        here = base / path.strip("/")
        for folder in [here, *(parent for parent in here.parents if parent == base or base in parent.parents)]:
            limit, taken = _number(folder / most), _number(folder / used)
            if limit is not None and taken is not None and limit < 1 << 60:
                left.append(limit - taken + _reclaimable(folder))
    return min(left, default=None)


def _reclaimable(folder: Path) -> int:
    """Return what the kernel gives back when it is needed: pages of files that nobody has touched lately."""
    for line in _text(folder / "memory.stat").splitlines():
        if line.startswith(("inactive_file ", "total_inactive_file ")):
            return int(line.split()[1])
    return 0


def _address_space(root: Path) -> int | None:
    """Return what ``ulimit -v`` leaves; None without it."""
    try:
        import resource
    except ImportError:
        return None
    limit = resource.getrlimit(resource.RLIMIT_AS)[0]
    if limit == resource.RLIM_INFINITY:
        return None
    pages = _text(root / "proc/self/statm").split()
    return int(limit) - (int(pages[0]) * resource.getpagesize() if pages else 0)


def _number(path: Path) -> int | None:
    text = _text(path).strip()
    return int(text) if text.isdigit() else None  # "max" where there is no limit


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="ascii", errors="replace")
    except OSError:
        return ""
