"""Parts of solutions that other solutions can use again, kept by what they are made from, while room lasts."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Hashable
from threading import Lock
from typing import Protocol, TypeVar, cast


class Part(Protocol):
    """Anything that tells its size."""

    @property
    def nbytes(self) -> int:
        """Bytes it takes."""
        ...


P = TypeVar("P", bound=Part)

ROOM = 512 * 1024 * 1024
"""Bytes; one structure with feedback takes about 225 MB of it at the paper's resolution, 35 MB at preview."""


class Workshop:
    """Keep parts by keys that hold all that they depend on; let go of those longest unused when there is no more room.

    Parameters
    ----------
    room : int
        Bytes that the parts may take together. 0 keeps nothing.
    """

    def __init__(self, room: int = ROOM) -> None:
        self.room = room
        self._parts: OrderedDict[Hashable, Part] = OrderedDict()
        self._taken = 0
        self._lock = Lock()

    @property
    def taken(self) -> int:
        """Bytes that the parts take now."""
        return self._taken

    def part(self, key: Hashable, make: Callable[[], P]) -> P:
        """Return the part of a key, made now if it is not here. Its arrays must not be written to."""
        with self._lock:
            if key in self._parts:
                self._parts.move_to_end(key)
                return cast("P", self._parts[key])
        made = make()  # outside the lock: threads make different parts at the same time
        with self._lock:
            if made.nbytes <= self.room and key not in self._parts:
                self._parts[key] = made
                self._taken += made.nbytes
                while self._taken > self.room:
                    _, dropped = self._parts.popitem(last=False)
                    self._taken -= dropped.nbytes
        return made
