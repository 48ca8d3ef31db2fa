"""How much memory this process holds, keeping what it has freed for the next run, and giving it back to the system."""

from __future__ import annotations

import ctypes
import gc
import os
import sys
from contextlib import suppress
from pathlib import Path

_TRIM_THRESHOLD, _MMAP_THRESHOLD, _ARENA_MAX = -1, -3, -8
"""Names of glibc's settings (malloc.h)."""
_KEPT_BYTES, _OWN_PAGES_BYTES = 256 * 1024 * 1024, 32 * 1024 * 1024
"""Freed bytes at the top of the heap from which on some are given back, and bytes from which on an array has pages of its own."""


def held() -> int:
    """Return the bytes of memory that this process holds now; 0 where the system does not tell."""
    with suppress(OSError, ValueError, IndexError):
        return int(Path("/proc/self/statm").read_text().split()[1]) * int(os.sysconf("SC_PAGE_SIZE"))
    return 0


def keep_freed() -> None:
    """Keep memory that is freed for the next run, in one heap, until :func:`give_back`.

    A slider's run makes and drops some hundred arrays of a megabyte. Each time the C library hands such memory back, the system clears
    every page of it anew before its next use, which took a fifth of the run.
    """
    if sys.platform == "linux":
        with suppress(OSError, AttributeError):  # no glibc
            settings = ctypes.CDLL(None).mallopt
            for name, value in ((_TRIM_THRESHOLD, _KEPT_BYTES), (_MMAP_THRESHOLD, _OWN_PAGES_BYTES), (_ARENA_MAX, 1)):
                settings(name, value)


def give_back() -> None:
    """Collect what nobody refers to, and return freed memory to the system, which the C library otherwise keeps for later."""
    gc.collect()
    if sys.platform == "linux":
        with suppress(OSError, AttributeError):  # no glibc
            ctypes.CDLL(None).malloc_trim(0)
