"""What was found about the paper's claims under slice and sphere at the finest resolution, ten minutes of a processor: kept."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict
from functools import cache
from importlib.resources import files
from typing import Any

from coaxshell.apps.paper.claims import Finding, Judged, claims
from coaxshell.apps.paper.known_runs import CORRECTED
from coaxshell.apps.paper.sphere.compared import SPHERE
from coaxshell.apps.paper.sphere.judged import Judgement
from coaxshell.solver.settings import Settings

DATA = "claims.json"
_NAMES = {"slice": CORRECTED, SPHERE: SPHERE}


def plain(finding: Finding) -> dict[str, Any]:
    """Return what is found about a claim as plain values, numbers with five digits."""
    return {**asdict(finding), "measured": {name: float(f"{value:.5g}") for name, value in finding.measured.items()}}


def as_table(found: Judgement) -> dict[str, Any]:
    """Return a judgement as plain values, numbers with five digits."""

    def row(one: Judged) -> dict[str, Any]:
        at = found.resolutions[one.claim.name].arguments()
        return {"name": one.claim.name, "resolution": at, **{key: plain(one.findings[name]) for key, name in _NAMES.items()}}

    about = "The paper's claims under the slice and under the sphere; made by python -m coaxshell.apps.paper.sphere claims"
    return {"about": about, "claims": [row(one) for one in found.claims]}


def from_table(table: Mapping[str, Any]) -> Judgement:
    """Return the judgement that :func:`as_table` took apart."""
    known = {claim.name: claim for claim in claims()}
    judged = tuple(Judged(known[one["name"]], {name: Finding(**one[key]) for key, name in _NAMES.items()}) for one in table["claims"])
    return Judgement({one["name"]: Settings(**one["resolution"]) for one in table["claims"]}, judged)


@cache
def known_claims() -> Judgement:
    """Return the judgement that the package holds."""
    return from_table(json.loads(files("coaxshell.apps.paper.sphere").joinpath(DATA).read_text(encoding="utf-8")))
