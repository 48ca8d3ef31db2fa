"""Dotted paths into a description, such as ``shells[0].layers[1].thickness``: the one grammar, read and written.

A path is names and numbers of entries, joined by dots or in brackets: ``shells[0].radius``, ``shells.0.radius`` and
``shells.inner.radius`` are the same. Options of the command line, study files, metrics and the errors of descriptions all speak it;
:mod:`coaxshell.model.overrides` follows it into a system, and the studio's page reads and writes it in ``paths.js``.
"""

from __future__ import annotations

import re
import reprlib
from collections.abc import Sequence

from coaxshell.errors import InputError
from coaxshell.limits import PATH

EXAMPLE = "write it as source.peak_pressure or shells[0].radius"


def parts(path: str) -> list[str]:
    """Return the names and numbers of a path in their order: ``shells[0].radius`` gives "shells", "0", "radius"."""
    return [part for part in re.split(r"[.\[\]]+", path.strip()) if part]


def parsed(path: str, where: str = "") -> list[str]:
    """Return the :func:`parts` of a path that a user gave; InputError at *where* if it is no text, empty or too long."""
    if not isinstance(path, str):
        raise InputError(where, f"{reprlib.repr(path)} is not a path", EXAMPLE)
    PATH.check(len(path), where, EXAMPLE)
    found = parts(path)
    if not found:
        raise InputError(where, f"{path!r} is not a path", EXAMPLE)
    return found


def written(location: Sequence[str | int]) -> str:
    """Return the path of names and numbers: ``("shells", 0, "radius")`` gives ``shells[0].radius``."""
    text = ""
    for part in location:
        text = joined(text, f"[{part}]" if isinstance(part, int) else part)
    return text


def joined(outer: str, inner: str) -> str:
    """Join two paths; an empty one, or an inner one starting with an index, adds no dot."""
    return outer + inner if not outer or not inner or inner.startswith("[") else f"{outer}.{inner}"


def within(outer: str, error: InputError) -> InputError:
    """Return *error*, and what else is wrong, with paths continued outwards by *outer*."""
    return InputError(joined(outer, error.where), error.problem, error.remedy, tuple(within(outer, one) for one in error.also))
