"""What was found about the paper's statements on absorbers with thin and with exact walls, three minutes of a processor: kept."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from functools import cache
from importlib.resources import files
from typing import Any

from coaxshell.apps.paper.claims import Finding, Judged, claims
from coaxshell.apps.paper.known_runs import CORRECTED
from coaxshell.apps.paper.sphere.kept import plain
from coaxshell.apps.paper.thickness.compared import EXACT

DATA = "absorbers.json"
_NAMES = {"thin": CORRECTED, EXACT: EXACT}


def as_table(judged: Sequence[Judged]) -> dict[str, Any]:
    """Return judged statements as plain values, numbers with five digits."""
    about = "The paper's statements on absorbers with thin and with exact walls; made by python -m coaxshell.apps.paper.thickness claims"
    rows = [{"name": one.claim.name, **{key: plain(one.findings[name]) for key, name in _NAMES.items()}} for one in judged]
    return {"about": about, "claims": rows}


def from_table(table: Mapping[str, Any]) -> tuple[Judged, ...]:
    """Return the statements that :func:`as_table` took apart."""
    known = {claim.name: claim for claim in claims()}
    return tuple(Judged(known[one["name"]], {name: Finding(**one[key]) for key, name in _NAMES.items()}) for one in table["claims"])


@cache
def known_of_absorbers() -> tuple[Judged, ...]:
    """Return the statements that the package holds."""
    return from_table(json.loads(files("coaxshell.apps.paper.thickness").joinpath(DATA).read_text(encoding="utf-8")))
