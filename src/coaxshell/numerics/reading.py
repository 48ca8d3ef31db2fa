"""Files from outside, read whole within a bound: regular files only, so that nothing waits, and nothing is endless."""

from __future__ import annotations

import codecs
import os
import stat
from pathlib import Path

from coaxshell.errors import InputError
from coaxshell.limits import Limit

_MARKS = ((codecs.BOM_UTF8, "utf-8"), (codecs.BOM_UTF32_LE, "utf-32"), (codecs.BOM_UTF32_BE, "utf-32"), (codecs.BOM_UTF16_LE, "utf-16"),
          (codecs.BOM_UTF16_BE, "utf-16"))  # fmt: skip


def regular_bytes(path: Path, limit: Limit, remedy: str = "") -> bytes:
    """Return the bytes of a regular file (links are followed).

    A pipe, a device, a folder and what is larger than the bound are refused before anything is read.

    Raises
    ------
    InputError
        Naming the file, and why it cannot be read.
    """
    where = str(path)
    try:
        # Without waiting: the other end of a pipe may never come.
        handle = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0) | getattr(os, "O_CLOEXEC", 0))
    except (OSError, ValueError) as error:  # ValueError: a NUL in the name
        raise unreadable(path, error, remedy) from None
    try:
        status = os.fstat(handle)
        if not stat.S_ISREG(status.st_mode):
            kind = "a folder" if stat.S_ISDIR(status.st_mode) else "a pipe or a device"
            raise InputError(where, f"is {kind}, not a file", remedy)
        limit.check(status.st_size, where, remedy)
        with os.fdopen(handle, "rb", closefd=False) as file:
            content = file.read(limit.value + 1)  # it may grow meanwhile
    except OSError as error:
        raise unreadable(path, error, remedy) from None
    finally:
        os.close(handle)
    limit.check(len(content), where, remedy)
    return content


def unreadable(path: Path, error: Exception, remedy: str) -> InputError:
    """Return the error of a file that cannot be read."""
    reason = (error.strerror if isinstance(error, OSError) else None) or str(error) or type(error).__name__
    return InputError(str(path)[:300], f"cannot be read ({reason.lower()})", remedy)


def decoded(content: bytes, fallback: str | None = None) -> str:
    r"""Return bytes as text: UTF-8, or UTF-16 and UTF-32 by their byte order mark; line ends become ``\n``.

    Parameters
    ----------
    content : bytes
    fallback : str, optional
        Encoding of bytes that are none of these; UTF-16 without a mark is recognised too then.

    Raises
    ------
    UnicodeError
        They are not text.
    """
    encoding = next((name for mark, name in _MARKS if content.startswith(mark)), "")
    if encoding == "utf-8":
        content = content[3:]
    if not encoding and fallback and (half := _half_empty(content)):
        encoding = half
    try:
        text = content.decode(encoding or "utf-8")
    except UnicodeError:
        if encoding or fallback is None:
            raise
        text = content.decode(fallback)
    return text.replace("\r\n", "\n").replace("\r", "\n")


def _half_empty(content: bytes) -> str:
    """Tell UTF-16 without a mark by the zeros that every other byte of plain letters then is."""
    head = content[:200]
    pairs = len(head) // 2
    if pairs < 4:
        return ""
    return "utf-16-le" if head[1::2].count(0) > 0.9 * pairs else "utf-16-be" if head[0::2].count(0) > 0.9 * pairs else ""
