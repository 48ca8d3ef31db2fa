"""Parts of solutions that other solutions can use again, kept by what they are made from, while room lasts."""

from __future__ import annotations

from typing import Any

from coaxshell.numerics.cache import ByteBoundedCache, own_bytes

ROOM = 512 * 1024 * 1024
"""Bytes; one structure with feedback takes about 225 MB of it at the paper's resolution, 35 MB at preview."""

SharedParts = ByteBoundedCache[Any]
"""Values are arrays, or anything that tells its size as ``nbytes``."""


def shared_parts(room: int = ROOM) -> SharedParts:
    """Return an empty cache of as many bytes."""
    return ByteBoundedCache(room, own_bytes)
