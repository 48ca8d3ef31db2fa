"""Claims in the order of the paper's text."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import TYPE_CHECKING

from coaxshell.apps.paper.claims.claim import Claim, Finding

if TYPE_CHECKING:
    from coaxshell.apps.paper.known_runs import Runs

Work = Callable[["Runs"], Finding]

ORDER = ("setting", "bare", "waves", "stiffness", "mass", "cubic", "position", "count", "damping", "active", "hybrid", "losses")
"""Modules of claims, in the order of the paper's text."""

_CLAIMS: dict[str, tuple[str, str, str, Work]] = {}


def claim(place: str, statement: str, criterion: str) -> Callable[[Work], Work]:
    """Register a function from runs to a finding as a claim; its name is the function's."""

    def register(work: Work) -> Work:
        _CLAIMS[work.__name__.replace("_", "-")] = (place, statement, criterion, work)
        return work

    return register


def claims() -> tuple[Claim, ...]:
    """Return all claims in the order of the paper's text, numbered from 1."""
    for name in ORDER:
        import_module(f"{__package__}.{name}")
    ranked = sorted(_CLAIMS.items(), key=lambda item: ORDER.index(item[1][3].__module__.rpartition(".")[2]))
    return tuple(Claim(number, name, *entries) for number, (name, entries) in enumerate(ranked, 1))
