"""How many times what the shells scatter comes back from the planes of the sea within a run, and what the answer is exact until."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coaxshell.solver.scaling import Problem

MOST_ROUNDS = 64
"""Rounds after which a series is broken off; what it then is exact until is told."""


@dataclass(frozen=True)
class Rounds:
    """How many reflections a run needs, and what it is exact until.

    Attributes
    ----------
    needed : int
    first : float
        2 (d - b): transits until the scattered wave is back; infinite without planes.
    start : float
        When the first front reaches the head.
    """

    needed: int
    first: float
    start: float = 0.0

    @property
    def done(self) -> int:
        """How many reflections are added up."""
        return min(self.needed, MOST_ROUNDS)

    def exact_until(self, done: int | None = None) -> float:
        """Return the transits until which a run with so many rounds is exact, all that are made unless given."""
        return self.start + (1 + (self.done if done is None else done)) * self.first


def rounds(problem: Problem, duration: float) -> Rounds:
    """Return how many reflections of the scattered wave arrive within so many transits."""
    if problem.planes is None:
        return Rounds(0, np.inf)
    first = 2.0 * (problem.planes.nearest - problem.head)
    earliest = min(source.delay for source in problem.system.sources) / problem.scales.time
    return Rounds(max(0, int(np.ceil((duration - earliest) / first)) - 1), first, earliest)
