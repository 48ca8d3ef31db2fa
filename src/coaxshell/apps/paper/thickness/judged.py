"""The paper's statements about its shells and its absorbers, judged with thin walls and with exact ones by the same criteria."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
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
OF_ABSORBERS = ("stiffness", "mass", "cubic", "count", "damping")
"""Of claims about absorbers, which hold thin walls along lines, exact ones over arcs as long as these are thick."""

ENERGY = "energy-is-radiated-away"
"""What the sphere has no energy per length for."""


def _each(wanted: Mapping[str, System], resolution: Settings, progress: Progress | None) -> Iterator[tuple[str, Response]]:
    from coaxshell.response import simulate

    for number, (name, system) in enumerate(wanted.items()):
        if progress:
            progress(number / len(wanted), "solving with exact walls")
        yield name, simulate(with_walls(system, theory="elastic"), settings=resolution)


def judged_with_both(resolution: Settings = RESOLUTION) -> tuple[Judged, ...]:
    """Return statements about bare shells by what is found with thin walls, named as the corrected model, and with exact ones, "exact"."""
    return _judged([*((name, resolution) for module in MODULES for name in topic(module).names), (ENERGY, resolution)])


def absorbers_judged_with_both(resolution: Settings = RESOLUTION, modules: Sequence[str] = OF_ABSORBERS) -> tuple[Judged, ...]:
    """Return those about absorbers: some fifty runs, three minutes of a processor.

    Parameters
    ----------
    resolution : Settings
        Finest of all runs; those of a topic are no finer than is enough for it.
    modules : sequence of str
        Of the claims.
    """
    return _judged([(name, topic(module).resolution(resolution)) for module in modules for name in topic(module).names])


def _judged(asked: Sequence[tuple[str, Settings]]) -> tuple[Judged, ...]:
    """Return statements by name, judged from runs of their resolutions; those of one resolution share their runs."""
    known = {claim.name: claim for claim in claims()}
    variants: dict[Settings, dict[str, Runs]] = {}
    found = []
    for name, at in asked:
        both = variants.setdefault(at, {CORRECTED: Runs(at), EXACT: Runs(at, solver=_each, variant=EXACT)})
        found.append(Judged(known[name], {which: known[name].work(runs) for which, runs in both.items()}))
    return tuple(found)


def rows(judged: tuple[Judged, ...]) -> list[tuple[str, ...]]:
    """Return a row a statement: its number and text, both verdicts, and what is found with each."""
    pairs = [(one, (one.findings[CORRECTED], one.findings[EXACT])) for one in judged]
    return [(str(one.claim.number), one.claim.statement, *(x.verdict for x in both), *(x.why for x in both)) for one, both in pairs]
