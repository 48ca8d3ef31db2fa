"""What a study costs before its first case: the largest of a sample of its cases, as many at a time as there are processes."""

from __future__ import annotations

from collections.abc import Sequence

from coaxshell.errors import InputError
from coaxshell.model.system import System
from coaxshell.numerics.cost import Cost
from coaxshell.solver.cost import run_cost
from coaxshell.solver.settings import Settings

_LOOKED_AT = 12
"""Cases of which the cost is estimated; they are spread over the study."""


def case_cost(systems: Sequence[System | InputError], resolution: Settings) -> Cost:
    """Return the cost of the largest of some cases spread over a study, and the mean of their times."""
    possible = [system for system in systems if isinstance(system, System)]
    step = max(1, (len(possible) - 1) // (_LOOKED_AT - 1))
    costs = [run_cost(system, resolution) for system in possible[::step]]
    return Cost(max((cost.memory for cost in costs), default=0.0), sum(cost.seconds for cost in costs) / max(1, len(costs)))


def require_room(case: Cost, count: int, workers: int, what: str = "a study of {count:,} cases") -> Cost:
    """Return the cost of so many cases; InputError, with the number of processes that fit, if they do not fit into memory side by side."""
    together = case.times(count, workers)
    if not together.fits:
        fewer = next((n for n in range(min(count, workers), 0, -1) if case.times(count, n).fits), 0)
        remedy = f"use workers={fewer}" if fewer else "use fewer orders or a coarser step"
        together.require(f"{what.format(count=count)} in {min(count, workers)} processes", remedy)
    return together
