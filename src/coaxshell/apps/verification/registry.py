"""Checks by name, in the order in which they were registered."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from importlib import import_module

from coaxshell.apps.verification.bench import Bench
from coaxshell.apps.verification.checks import ORDER
from coaxshell.apps.verification.rows import Finding
from coaxshell.errors import InputError

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


_CHECKS: dict[str, Check] = {}


def check(name: str, title: str, *, quick: bool = True) -> Callable[[Work], Work]:
    """Register a generator of rows and sheets as a check."""

    def register(work: Work) -> Work:
        about = " ".join((work.__doc__ or "").split())
        _CHECKS[name] = Check(name, title, about, work, quick)
        return work

    return register


def checks() -> tuple[Check, ...]:
    """Return all checks in the order of the report."""
    for name in ORDER:
        import_module(f"coaxshell.apps.verification.checks.{name}")
    ours = [one for one in _CHECKS.values() if one.work.__module__.startswith("coaxshell.apps.verification.checks.")]
    return tuple(sorted(ours, key=lambda one: ORDER.index(one.work.__module__.rpartition(".")[2])))


def chosen(names: list[str] | None, quick: bool) -> tuple[Check, ...]:
    """Return the checks of those names, or the whole suite, or its quick part; InputError for a name that is not there."""
    known = {one.name: one for one in checks()}
    if names:
        for name in names:
            if name not in known:
                raise InputError("--only", f"there is no check {name!r}", f"allowed: {', '.join(known)}")
        return tuple(known[name] for name in known if name in names)
    return tuple(one for one in known.values() if one.quick or not quick)
