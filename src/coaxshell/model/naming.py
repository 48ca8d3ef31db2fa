"""Names: looked up forgivingly, the nearest one suggested when there is no match; and the names by which shells are called everywhere."""

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


def shell_name(index: int, count: int) -> str:
    """Return the name of a shell, counted from 0 inside: "inner", "middle" of three, "outer", "shell 2 of 4"; "shell" of a single one."""
    if count == 1:
        return "shell"
    return {0: "inner", count - 1: "outer"}.get(index, "middle" if count == 3 else f"shell {index + 1} of {count}")


def shell_phrase(index: int, count: int) -> str:
    """Return the name of a shell within a sentence: "inner shell", "shell 2 of 4", "shell"."""
    name = shell_name(index, count)
    return name if name.startswith("shell") else f"{name} shell"


def shell_places(count: int) -> dict[str, int]:
    """Return the words that stand for a shell in paths and arguments, and its number: "inner", "outer", "middle" of three."""
    return {"inner": 0, "outer": count - 1} | ({"middle": 1} if count == 3 else {})


def item_places(count: int) -> dict[str, int]:
    """Return the words that stand for an item of any list of a system that runs from the inside out: of its shells, fluids or layers."""
    return {**shell_places(count), "interior": 0, "exterior": count - 1}


def shell_number(name: str, count: int) -> int | None:
    """Return the number of a shell, counted from 0 inside, from one of its names; None when it is none.

    Names are those of :func:`shell_name`, digits, and "shell 1" (counted from 0), as files of earlier versions have it.
    """
    if len(name) > LONGEST:
        return None
    wanted = " ".join(name.split()).lower()
    if wanted.isdecimal() and len(wanted) < 9:
        return int(wanted) if int(wanted) < count else None
    for index in range(count):
        if wanted in (shell_name(index, count), shell_phrase(index, count), f"shell {index}"):
            return index
    return shell_places(count).get(wanted)
