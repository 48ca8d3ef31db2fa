"""The evaluations of an optimisation: generations of designs, each evaluated once, kept in a store and counted against a budget."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from coaxshell.errors import InputError
from coaxshell.model.system import System
from coaxshell.numerics.arrays import FloatArray
from coaxshell.solver.settings import Settings
from coaxshell.studies.evaluation import Outcome
from coaxshell.studies.optimisation.targets import FAILED, UNSOLVED, Targets
from coaxshell.studies.optimisation.variables import Space
from coaxshell.studies.reading import DesignReading

Scenarios = Callable[[System], Sequence[System | InputError]]
"""From a design to itself and, after it, its samples under uncertain properties."""
Run = Callable[[Sequence[System | InputError], Settings], list[Outcome]]
"""Runs systems at a resolution: a :class:`coaxshell.studies.running.WorkerPool`, or a program with workers of its own."""


_Evaluated = tuple[dict[str, float], str, FloatArray | None]


class EnoughError(Exception):
    """All evaluations asked for are made."""


@dataclass(frozen=True)
class Candidate:
    """One evaluated design.

    Attributes
    ----------
    number : int
        From 0, in the order in which the method asked.
    generation : int
    values : tuple
        Of the variables.
    targets : dict of str to float
        Objectives and constrained metrics by name; those that were not computed are missing.
    objectives : tuple of float
        What is made small; NaN if not computed.
    violation : float
        0 for a feasible design.
    reason : str
        Why there are no values, or which limits kept it from being run; "" otherwise.
    """

    number: int
    generation: int
    values: tuple[Any, ...]
    targets: dict[str, float]
    objectives: tuple[float, ...]
    violation: float
    reason: str = ""

    @property
    def feasible(self) -> bool:
        """Whether it keeps all limits."""
        return self.violation == 0.0

    @property
    def rank(self) -> tuple[float, float]:
        """Order among the designs of a study of one objective: by violation, then by objective."""
        return self.violation, self.objectives[0] if self.feasible else 0.0


class Evaluations:
    """Evaluate points of the unit cube, generation by generation, until the budget is spent.

    Parameters
    ----------
    space, targets, scenarios, resolution
        The problem.
    run : callable
        From systems and a resolution to their outcomes.
    budget : int
    told : callable
        Called with all candidates after every generation.
    slopes : bool
        Whether the metrics hold slopes, which the search wants of designs that break limits too.
    """

    def __init__(
        self,
        space: Space,
        targets: Targets,
        scenarios: Scenarios,
        resolution: Settings,
        run: Run,
        budget: int,
        told: Callable[[list[Candidate]], None],
        *,
        slopes: bool = False,
    ) -> None:
        self.space, self.targets, self.scenarios, self.resolution = space, targets, scenarios, resolution
        self.run, self.budget, self.told, self._slopes = run, budget, told, slopes
        self.candidates: list[Candidate] = []
        self._known: dict[tuple[Any, ...], Candidate] = {}
        self._tables: dict[tuple[Any, ...], FloatArray] = {}
        self._generation = 0

    def __call__(self, points: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return objectives (K, objectives) and violations (K,) of a generation; EnoughError when the budget is spent with it."""
        asked = [self.space.values(point) for point in points[: self.budget - len(self.candidates)]]
        fresh = list(dict.fromkeys(values for values in asked if values not in self._known))
        found = self._evaluated([self.space.system(values) for values in fresh], refuse=not self._slopes)
        for values, (targets, reason, table) in zip(fresh, found, strict=True):
            if table is not None and self._slopes:
                self._tables[values] = table
            self._known[values] = self._judged(values, targets, reason)
        for values in asked:
            first = self._known[values]
            self.candidates.append(
                Candidate(len(self.candidates), self._generation, values, first.targets, first.objectives, first.violation, first.reason)
            )
        self._generation += 1
        self.told(self.candidates)
        if len(self.candidates) >= self.budget:
            raise EnoughError
        latest = self.candidates[-len(asked) :]
        return np.array([one.objectives for one in latest]), np.array([one.violation for one in latest])

    def tables(self, points: FloatArray) -> list[FloatArray | None]:
        """Return the metrics of a generation, each of shape (samples, metrics), None for a design that could not be run; as a call."""
        self(points)
        return [self._tables.get(self.space.values(point)) for point in points]

    def baseline(self) -> Candidate:
        """Return the base system, run whether it keeps the limits or not, and outside the count."""
        ((targets, reason, _),) = self._evaluated([self.space.base], refuse=False)
        return self._judged(self.space.present(), targets, reason)

    def _evaluated(self, systems: Sequence[System | InputError], refuse: bool = True) -> list[_Evaluated]:
        """Return the targets of each design (what could be computed), the reason if that is not all, and its metrics if it was run."""
        found: list[_Evaluated | None] = [self._of_design(system) if refuse else None for system in systems]
        waiting = [(k, system) for k, system in enumerate(systems) if found[k] is None and isinstance(system, System)]
        samples = [list(self.scenarios(system)) for _, system in waiting]
        flat = [one for several in samples for one in several]
        outcomes = iter(self.run(flat, self.resolution) if flat else ())
        for (k, _), several in zip(waiting, samples, strict=True):
            mine = [next(outcomes) for _ in several]
            failed = next((outcome for outcome in mine if outcome.failed), None)
            if failed is not None:
                found[k] = ({}, failed.reason, None)
            else:
                table = np.array([outcome.values for outcome in mine], dtype=np.float64)
                found[k] = (self.targets.values(table), "", table)
        return [one for one in found if one is not None]

    def _of_design(self, system: System | InputError) -> _Evaluated | None:
        """Return the broken limits of a design that needs no run to be refused; None if it has to be run."""
        if isinstance(system, InputError):
            return {}, str(system), None
        reading = DesignReading(system)
        limits = [limit for limit in self.targets.limits if limit.target.metric.of_design and not limit.target.statistic]
        values = {limit.target.name: limit.target.metric(reading) for limit in limits}
        broken = [limit.text for limit in limits if limit.excess(values[limit.target.name]) > 0]
        return (values, f"not run: breaks {' and '.join(broken)}", None) if broken else None

    def _judged(self, values: tuple[Any, ...], targets: dict[str, float], reason: str) -> Candidate:
        violation = self.targets.violation(targets)
        if reason:
            violation += UNSOLVED if targets else FAILED
            objectives: tuple[float, ...] = (float("nan"),) * len(self.targets.goals)
        else:
            objectives = self.targets.objectives(targets)
        return Candidate(-1, -1, values, targets, objectives, violation, reason)


def non_dominated(candidates: Sequence[Candidate]) -> list[Candidate]:
    """Return the feasible designs that no other one beats in every objective, equal ones once, by their first objective."""
    found: list[Candidate] = []
    values = np.empty((0, 0))
    for one in sorted((c for c in candidates if c.feasible), key=lambda c: (*c.objectives, c.number)):
        if not found or not (values <= one.objectives).all(axis=1).any():
            found.append(one)
            values = np.vstack([values, one.objectives]) if len(found) > 1 else np.array([one.objectives])
    return found
