"""What a check is, and how one is registered."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from coaxshell.apps.verification.bench import Bench
from coaxshell.apps.verification.rows import Finding

Work = Callable[[Bench], Iterator[Finding]]


@dataclass(frozen=True)
class Check:
    """One check of the suite.

    Attributes
    ----------
    name, title : str
        As typed on the command line, and as the report heads it.
    about : str
        What it compares: its docstring.
    work : callable
        From a bench to rows and sheets.
    quick : bool
        Whether it is part of the quick suite.
    """

    name: str
    title: str
    about: str
    work: Work
    quick: bool


REGISTERED: dict[str, Check] = {}
"""Checks by name."""


def check(name: str, title: str, *, quick: bool = True) -> Callable[[Work], Work]:
    """Register a generator of rows and sheets as a check."""

    def register(work: Work) -> Work:
        about = " ".join((work.__doc__ or "").split())
        REGISTERED[name] = Check(name, title, about, work, quick)
        return work

    return register
