"""The paper's checkable statements, each in our words, measured and judged; one module for each part of its text."""

from __future__ import annotations

from coaxshell.apps.paper.claims.claim import Claim, Finding, Judged, Verdict, claims, judge

__all__ = ["Claim", "Finding", "Judged", "Verdict", "claims", "judge"]
