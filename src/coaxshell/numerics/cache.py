"""A cache bounded by bytes: the least recently used go first when they run out."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Hashable
from threading import Lock
from typing import Any, Generic, Protocol, TypeVar

import numpy as np


class Sized(Protocol):
    """Anything that tells its size."""

    @property
    def nbytes(self) -> int:
        """Bytes it takes."""
        ...


T = TypeVar("T")


def own_bytes(value: Sized) -> int:
    """Return the bytes that a value says it takes."""
    return value.nbytes


class ByteBoundedCache(Generic[T]):
    """Keep values by keys that hold all that they depend on, up to a number of bytes in all. Several threads may share one.

    Parameters
    ----------
    most : int
        Bytes. 0 keeps nothing.
    size : callable
        Bytes of a value; asked again at every put, because prepared structures grow with use.
    """

    def __init__(self, most: int, size: Callable[[T], int]) -> None:
        self.most, self.size = most, size
        self._held: OrderedDict[Hashable, tuple[T, int]] = OrderedDict()
        self._bytes = 0
        self._lock = Lock()

    def get(self, key: Hashable) -> T | None:
        """Return a value, or None."""
        with self._lock:
            found = self._held.get(key)
            if found is None:
                return None
            self._held.move_to_end(key)
            return found[0]

    def put(self, key: Hashable, value: T) -> None:
        """Keep a value, or weigh it again; the oldest others leave for it. One that is too large alone is not kept, and they stay."""
        size = self.size(value)
        with self._lock:
            self._bytes -= self._held.pop(key, (value, 0))[1]
            if size > self.most:
                return
            self._held[key] = (value, size)
            self._bytes += size
            while self._bytes > self.most:
                self._bytes -= self._held.popitem(last=False)[1][1]

    def get_or_make(self, key: Hashable, make: Callable[[], T]) -> T:
        """Return the value of a key, made now if it is not here; it must not be changed. Threads make different values at the same time."""
        found = self.get(key)
        if found is None:
            found = make()
            self.put(key, found)
        return found

    def clear(self) -> None:
        """Let go of everything."""
        self._held.clear()
        self._bytes = 0

    def latest(self, fits: Callable[[T], bool]) -> T | None:
        """Return the value used last among those that fit, or None."""
        return next((value for value, _ in reversed(self._held.values()) if fits(value)), None)

    @property
    def bytes(self) -> int:
        """Bytes of all that is kept."""
        return self._bytes

    def __len__(self) -> int:
        return len(self._held)


def held_bytes(thing: Any) -> int:
    """Return the bytes of all arrays that an object holds, directly or through its parts; views count as what they view."""
    total, seen, waiting = 0, set[int](), [thing]
    while waiting:
        one = waiting.pop()
        kind = type(one)
        if kind in _PLAIN or id(one) in seen:
            continue
        seen.add(id(one))
        if isinstance(one, np.ndarray):
            if isinstance(one.base, np.ndarray):
                waiting.append(one.base)
            else:
                total += one.nbytes
        elif isinstance(one, dict):
            waiting += one.values()
        elif isinstance(one, list | tuple):
            waiting += one
        elif kind.__module__.startswith("coaxshell.") and hasattr(one, "__dict__"):
            waiting += vars(one).values()
    return total


_PLAIN = frozenset({float, int, bool, str, type(None)})
