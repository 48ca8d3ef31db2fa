"""Names looked up forgivingly, the nearest one suggested when there is no match."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from difflib import get_close_matches
from typing import TypeVar

from coaxshell.errors import InputError

T = TypeVar("T")

LONGEST = 100
"""Letters of a name that are compared with those of a library."""


def plain(name: str) -> str:
    """Reduce a name to lower-case letters and digits, so that ``PZT4``, ``pzt-4`` and ``PZT 4`` are one name."""
    return "".join(c for c in name.lower() if c.isalnum())


def slug(name: str) -> str:
    """Turn a name into a bare TOML key: lower case, words joined by ``-``; empty when nothing is left."""
    words = "".join(c if c.isascii() and c.isalnum() else " " for c in name.lower()).split()
    return "-".join(words)


def suggestion(name: str, allowed: Iterable[str]) -> str:
    """Return ``did you mean 'x'? allowed: a, b, c`` (the question only when something is near)."""
    options = list(allowed)
    wanted = plain(name[:LONGEST])
    near = get_close_matches(wanted, [plain(option) for option in options], n=1, cutoff=0.6)
    # A piece of a name ("peak" of "peak_pressure") is far from it letter by letter, yet plainly meant.
    holding = [plain(option) for option in options if len(wanted) > 2 and wanted in plain(option)]
    guess = next((option for option in options if plain(option) in (near or holding)[:1]), None)
    listing = "allowed: " + ", ".join(options) if options else "nothing is allowed here"
    return f"did you mean {guess!r}? {listing}" if guess else listing


def lookup(table: Mapping[str, T], name: str, kind: str, where: str = "") -> T:
    """Return the entry of *table* called *name* (case and punctuation ignored); InputError with the names otherwise."""
    wanted = plain(name) if len(name) <= LONGEST else ""
    for key, value in table.items():
        if plain(key) == wanted:
            return value
    raise InputError(where, f"{name[: LONGEST + 1]!r} is not a known {kind}", suggestion(name, table))
