"""Instants written in an option: a list, or start:stop:step."""

from __future__ import annotations

import math

from coaxshell.errors import InputError

_MOST = 100_000


def times(text: str, option: str = "--times") -> list[float]:
    """Return the instants of "0.2,1.2,3.6", "0:5:0.1", or both mixed, in the order written.

    Raises
    ------
    InputError
        An item is neither a number nor a range.
    """
    found: list[float] = []
    for item in text.split(","):
        found += _range(item, option) if ":" in item else [_number(item, option)]
    return found


def _range(item: str, option: str) -> list[float]:
    parts = [_number(part, option) for part in item.split(":")]
    if len(parts) != 3 or parts[2] <= 0 or parts[1] < parts[0]:
        raise InputError(option, f"{item.strip()!r} is not a range", "write start:stop:step, as in 0:5:0.1")
    start, stop, step = parts
    count = math.floor((stop - start) / step * (1 + 1e-12) + 1e-9) + 1
    if count > _MOST:
        raise InputError(option, f"{item.strip()!r} asks for {count} instants", f"at most {_MOST} are allowed")
    return [round(start + i * step, 12) for i in range(count)]


def _number(text: str, option: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise InputError(option, f"{text.strip()!r} is not a time", "give transits, as in 0.2,1.2,3.6 or 0:5:0.1")
    return value
