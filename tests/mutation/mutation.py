"""One mutation: a small wrong change in a central place, which some test must notice."""

from __future__ import annotations

from typing import NamedTuple


class Mutation(NamedTuple):
    """One wrong change.

    Attributes
    ----------
    name : str
    file : str
        Inside src/coaxshell.
    original, mutated : str
        Text that stands there exactly once, and what to put in its place.
    breaks : str
        What is then wrong.
    nearest : str
        Tests beside it, inside tests/, asked first; several with spaces between.
    """

    name: str
    file: str
    original: str
    mutated: str
    breaks: str
    nearest: str
