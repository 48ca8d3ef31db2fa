"""What the parts of the reproduction cost before they are begun: their runs as estimated, and what fields, pictures and films add."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

from coaxshell.apps.paper import cases
from coaxshell.apps.paper.claims import systems
from coaxshell.apps.paper.figures import FIGURES
from coaxshell.apps.paper.recipes import FigureRecipe
from coaxshell.apps.paper.reproduction.plan import DIRECT_SAMPLE, Part, groups
from coaxshell.model.system import System
from coaxshell.numerics.cost import Cost
from coaxshell.solver.cost import run_cost
from coaxshell.solver.settings import Settings
from coaxshell.studies import cost

_FIELDS, _FILM = Cost(1e9, 15.0), Cost(0.7e9, 30.0)
"""Beside their runs; the fields' own blocks stay within 1 GB."""
_SLIPS = 12
"""Times that the slips solve the four presets, each and in pairs."""
_READ = 0.1
"""Seconds to read the peaks of a run and to keep it."""


def part_cost(part: Part, resolution: Settings) -> Cost:
    """Return what one part costs; seconds of one processor, within a factor of 3."""
    if part.kind == "runs":
        group = groups(resolution)[part.about]
        return _runs(group.systems.values(), group.resolution)
    if part.kind == "direct":
        sample = cases.count(systems.preset("bare"), DIRECT_SAMPLE).values()
        return _runs(sample, resolution).then(_runs(sample, replace(resolution, refinement=1), "direct"))
    if part.kind == "slips":
        each = _runs([systems.preset(name) for name in ("bare", "absorbers", "active", "hybrid")], resolution)
        return Cost(each.memory, _SLIPS * each.seconds)
    if part.kind == "film":
        return _runs([systems.preset(name) for name in ("bare", "hybrid")], resolution).then(_FILM)
    if part.kind == "fields":
        return _runs([systems.preset(part.about)], resolution).then(_FIELDS)
    recipe = FIGURES[part.about]
    presets = recipe.presets if isinstance(recipe, FigureRecipe) else ()
    return _runs([systems.preset(name) for name in presets], resolution).then(_FIELDS)


def require_room(parts: Sequence[Part], resolution: Settings, workers: int) -> Cost:
    """Return the cost of some parts, so many at a time: the memory of the largest of them side by side.

    Raises
    ------
    InputError
        They do not fit into memory side by side; it names the number of processes that do.
    """
    if not parts:
        return Cost(0.0)
    costs = [part_cost(part, resolution) for part in parts]
    each = Cost(max(one.memory for one in costs), sum(one.seconds for one in costs) / len(costs))
    return cost.require_room(each, len(costs), workers, "the reproduction of {count} parts")


def _runs(solved: Iterable[System], resolution: Settings, engine: str = "spectral") -> Cost:
    total = Cost(0.0)
    for system in solved:
        total = total.then(run_cost(system, replace(resolution, engine=engine))).then(Cost(0.0, _READ))
    return total
