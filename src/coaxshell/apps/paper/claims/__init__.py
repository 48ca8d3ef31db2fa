"""The paper's checkable statements, each in our words, measured and judged; one module for each part of its text."""

from __future__ import annotations

from importlib import import_module

from coaxshell.apps.paper.claims.claim import REGISTERED, Claim, Finding, Judged, Verdict, judge

__all__ = ["Claim", "Finding", "Judged", "Verdict", "claims", "judge"]

ORDER = ("setting", "bare", "waves", "stiffness", "mass", "cubic", "position", "count", "damping", "active", "hybrid", "losses")
"""Modules of claims, in the order of the paper's text."""


def claims() -> tuple[Claim, ...]:
    """Return all claims in the order of the paper's text, numbered from 1."""
    for name in ORDER:
        import_module(f"coaxshell.apps.paper.claims.{name}")
    ranked = sorted(REGISTERED.items(), key=lambda item: ORDER.index(item[1][3].__module__.rpartition(".")[2]))
    return tuple(Claim(number, name, *entries) for number, (name, entries) in enumerate(ranked, 1))
