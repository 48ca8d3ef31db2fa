"""Responses with slips turned on: the ordinary solver, given other formulas."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import lru_cache
from typing import TYPE_CHECKING

from coaxshell.apps.paper.slips.growth import growth
from coaxshell.apps.paper.slips.switches import slipped
from coaxshell.errors import InputError
from coaxshell.numerics.progress import Progress
from coaxshell.numerics.texts import rounded
from coaxshell.solver.settings import Settings
from coaxshell.studies import structures
from coaxshell.studies.structures import structure_of

if TYPE_CHECKING:
    from coaxshell.model import System
    from coaxshell.response import PreparedSystem, Response

CORRECTED: frozenset[str] = frozenset()
"""No slips: the theory manual's equations."""

SELF_EXCITED = frozenset({"interior-derivative", "interior-function", "radiation-sign"})
"""Slips under which a fluid need not be passive, so that growth is looked for; feedback is checked by the solver itself."""


def simulate(system: System, resolution: Settings, slips: frozenset[str] = CORRECTED, progress: Progress | None = None) -> Response:
    """Return the response of a system with some slips turned on; without any, exactly :func:`coaxshell.simulate`'s.

    Raises
    ------
    InputError
        If a slip is not known, the system is not the paper's kind, the engine is not the spectral one, the run is in three dimensions,
        or the slip makes the system grow within the duration.
    """
    ((_, response),) = solve_each({"": system}, resolution, slips, progress)
    return response


def solve_each(
    systems: Mapping[str, System], resolution: Settings, slips: frozenset[str] = CORRECTED, progress: Progress | None = None
) -> Iterator[tuple[str, Response]]:
    """Return (name, response) of each system in turn, solved as they are taken, with some slips turned on.

    Neighbours that differ only in their absorbers share one prepared structure.

    Raises
    ------
    InputError
        As :func:`simulate`.
    """
    prepared = lru_cache(maxsize=1)(_prepared)

    def solve(system: System) -> Response:
        return prepared(structure_of(system), resolution, slips).simulate(system.absorbers)

    return structures.solve_each(systems, resolution, progress, solve if slips else None)


def _prepared(system: System, resolution: Settings, slips: frozenset[str]) -> PreparedSystem:
    from coaxshell.response import PreparedSystem

    if resolution.engine != "spectral":
        raise InputError("engine", f"{resolution.engine!r} knows no slips", 'use engine="spectral"')
    if resolution.dimensions != 2:
        raise InputError("dimensions", "3 knows no slips: the printed equations are those of two", "use dimensions=2")
    prepared = PreparedSystem(slipped(system, slips), resolution)
    if slips & SELF_EXCITED:
        assert isinstance(prepared.settings.modes, int)
        fastest = growth(system, slips, prepared.settings.modes, 1.0 / resolution.duration)
        if fastest is not None:
            raise InputError(
                "slips",
                f"{', '.join(sorted(slips))}: order {fastest.order} grows without bound, by e^({rounded(fastest.rate, 3)} t)",
                f"use a duration below {1.0 / fastest.rate:.2g}",
            )
    return prepared
