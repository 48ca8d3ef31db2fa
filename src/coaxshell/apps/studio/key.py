"""The key of the studio: whoever has not been given it, another user of this machine say, is not answered.

It is in the address that the command prints, and in a cookie from then on. It stays the same from one start to the next, so that pages
left open, and links kept, go on working; it lies in a file that only its owner may read.
"""

from __future__ import annotations

import os
import secrets
import stat
import sys
from contextlib import suppress
from pathlib import Path

BYTES = 24


def key_file() -> Path:
    """Return where the key is kept: in the folder that the system has for what programs remember of one user."""
    if sys.platform == "win32":
        state = os.environ.get("LOCALAPPDATA", "")
    else:
        state = os.environ.get("XDG_STATE_HOME", "")
    return (Path(state) if os.path.isabs(state) else Path.home() / ".local" / "state") / "coaxshell" / "studio-key"


def kept_key() -> str:
    """Return the key, made and kept at the first call; one for this time only where it cannot be kept to its owner."""
    with suppress(OSError, RuntimeError, ValueError):  # no home, a full disk, a file of somebody else: the server starts all the same
        path = key_file()
        found = _read(path)
        if found is not None:
            return found
        path.parent.mkdir(parents=True, exist_ok=True)
        with suppress(FileNotFoundError):
            path.unlink()  # unreadable, or open to others: what it held is known to them
        made = secrets.token_urlsafe(BYTES)
        with os.fdopen(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "w", encoding="ascii") as file:
            file.write(made)
        return made
    return secrets.token_urlsafe(BYTES)


def _read(path: Path) -> str | None:
    """Return the key in a file that nobody else can read or write; None if there is none."""
    try:
        state = path.lstat()
    except FileNotFoundError:
        return None
    ours = sys.platform == "win32" or (state.st_uid == os.getuid() and not state.st_mode & 0o077)
    if not ours or not stat.S_ISREG(state.st_mode) or state.st_size > 200:
        return None
    text = path.read_text(encoding="ascii").strip()
    return text if len(text) >= BYTES and text.replace("-", "a").replace("_", "a").isalnum() else None
