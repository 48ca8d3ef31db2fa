"""The paper's statements about its bare shells, judged with thin walls and with exact ones by the same criteria."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from coaxshell.apps.paper.claims import Judged, claims
from coaxshell.apps.paper.known_runs import CORRECTED, Runs
from coaxshell.apps.paper.sphere.judged import RESOLUTION, topic
from coaxshell.apps.paper.thickness.compared import EXACT, with_walls

if TYPE_CHECKING:
    from coaxshell.model import System
    from coaxshell.numerics.progress import Progress
    from coaxshell.response import Response
    from coaxshell.solver.settings import Settings

MODULES = ("setting", "bare", "waves")
"""Of claims about the bare shells: their histories, and the waves around them, which are read where the fluids wet the walls."""

ENERGY = "energy-is-radiated-away"
"""What the sphere has no energy per length for."""


def _each(wanted: Mapping[str, System], resolution: Settings, progress: Progress | None) -> Iterator[tuple[str, Response]]:
    from coaxshell.response import simulate

    for number, (name, system) in enumerate(wanted.items()):
        if progress:
            progress(number / len(wanted), "solving with exact walls")
        yield name, simulate(with_walls(system, theory="elastic"), settings=resolution)


def judged_with_both(resolution: Settings = RESOLUTION) -> tuple[Judged, ...]:
    """Return the statements with what is found with thin walls, under the name of the corrected model, and with exact ones, "exact"."""
    known = {claim.name: claim for claim in claims()}
    variants = {CORRECTED: Runs(resolution), EXACT: Runs(resolution, solver=_each, variant=EXACT)}
    names = [*(name for module in MODULES for name in topic(module).names), ENERGY]
    return tuple(Judged(known[name], {which: known[name].work(runs) for which, runs in variants.items()}) for name in names)


def rows(judged: tuple[Judged, ...]) -> list[tuple[str, ...]]:
    """Return a row a statement: its number and text, both verdicts, and what is found with each."""
    pairs = [(one, (one.findings[CORRECTED], one.findings[EXACT])) for one in judged]
    return [(str(one.claim.number), one.claim.statement, *(x.verdict for x in both), *(x.why for x in both)) for one, both in pairs]
