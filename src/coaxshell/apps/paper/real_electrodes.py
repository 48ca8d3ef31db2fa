"""The paper's statements on control under what its layers can do: the whole actuation of its own law, and electrodes in pairs.

The criteria are those of :mod:`coaxshell.apps.paper.claims`; what changes is who solves. "whole actuation" are the paper's sensors, gains
and actuators with the traction and the moment of the latter (:mod:`coaxshell.apps.paper.slips.actuation`). "electrodes" are the same layers
self-sensing on both faces of each core, with gains of that law in the place of the paper's, k_p = 100 and k_d = 10 for -2e4 and -150.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from coaxshell.apps.paper.claims import claims
from coaxshell.apps.paper.known_runs import NoFieldsError, Runs, Solver
from coaxshell.apps.paper.slips.actuation import whole_actuation
from coaxshell.errors import InputError
from coaxshell.model import PDControl, System
from coaxshell.numerics.progress import Progress
from coaxshell.response import PreparedSystem, Response
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.settings import Settings
from coaxshell.studies.structures import solve_each

PLACES = ("Active control, Fig. 11", "Hybrid control, Fig. 12", "Hybrid control, Fig. 13")
"""Where the statements are that need no fields."""
GAINS = {-2e4: 100.0, -1e4: 50.0, -150.0: 10.0, 0.0: 0.0}
"""Gains of electrodes in the place of the paper's."""
UNSTABLE = "unstable"


class Judged(NamedTuple):
    """A statement, what was found of it, or that a loop is unstable, and one sentence why."""

    number: int
    statement: str
    verdict: str
    why: str


def with_electrodes(system: System) -> System:
    """Return a system whose paper's law, if it has one, is that of self-sensing pairs with gains in the place of its own."""
    law = system.control
    if not isinstance(law, PDControl):
        return system
    roles = {f"shells[{i}].layers[{j}].role": "self-sensing" for i in (0, 1) for j in (0, 2)}
    gains = {"proportional": GAINS[_one(law.proportional)], "derivative": GAINS[_one(law.derivative)]}
    return system.with_overrides({**roles, "control": PDControl(**gains, transducers="electrodes", saturation=False)})


def _one(gain: float | tuple[float, ...]) -> float:
    return gain if isinstance(gain, float) else gain[0]


def _pairs(systems: Mapping[str, System], resolution: Settings, progress: Progress | None = None) -> Iterator[tuple[str, Response]]:
    yield from solve_each({name: with_electrodes(system) for name, system in systems.items()}, resolution, progress)


def _wholly(systems: Mapping[str, System], resolution: Settings, progress: Progress | None = None) -> Iterator[tuple[str, Response]]:
    for place, (name, system) in enumerate(systems.items()):
        prepared = PreparedSystem(whole_actuation(dimensionless(system, settings=resolution)), resolution)
        yield name, prepared.simulate(system.absorbers)
        if progress:
            progress((place + 1) / len(systems), "solving")


SOLVERS: dict[str, Solver] = {
    "paper": solve_each,
    "whole actuation": _wholly,
    "electrodes": _pairs,
}
"""Who solves, by name."""


def judged(name: str, resolution: Settings) -> Iterator[Judged]:
    """Yield the statements on control as one of :data:`SOLVERS` leaves them, those of the places of this file."""
    runs = Runs(resolution, solver=SOLVERS[name], variant=name, has_fields=False)
    for claim in claims():
        if claim.place not in PLACES:
            continue
        try:
            found = claim.work(runs)
        except NoFieldsError:
            continue
        except InputError as error:
            if "unstable" not in error.problem:
                raise
            yield Judged(claim.number, claim.statement, UNSTABLE, f"{error.problem}.")
            continue
        yield Judged(claim.number, claim.statement, found.verdict, found.why)
