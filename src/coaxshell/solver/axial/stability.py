"""Stability of feedback in three dimensions: of every order at every axial wavenumber, by passivity where that proves it, else by counting.

A wave (m, k) is a system by itself. Walls that stay passive with their feedback cannot make one grow (:mod:`coaxshell.solver.passivity`),
which is asked at a sample of wavenumbers; poles of those in doubt are counted at fewer, as they move with k as smoothly as with the order.
So does the least |D/D0| on the contour, which a pole passes at 0: between wavenumbers where that is more than it changes none is counted.
Where feedback ties walls or orders a wavenumber is a system of all that is tied (:mod:`coaxshell.solver.tied_stability`).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise

import numpy as np

from coaxshell.numerics.modes import Modes
from coaxshell.solver.axial.sampling import AxialSampling
from coaxshell.solver.passivity import passive_orders
from coaxshell.solver.scaling import Problem
from coaxshell.solver.stability import require_stable
from coaxshell.solver.tied_stability import require_stable_ties

ASKED, CHECKED, FIRST = 24, 16, 5
"""Wavenumbers at which passivity is asked, and at which poles are counted: at most, and where no zero can be near at least."""


def require_stable_waves(problem: Problem, sampling: AxialSampling, duration: float) -> None:
    """Raise InputError, naming gain, order and wavenumber, if the closed loop is unstable at a wavenumber of a run."""
    if all(wall.gains is None for wall in problem.shells):
        return
    waves = sample(sampling.modes if problem.tied else doubtful_waves(problem, sample(sampling.modes, ASKED), 1.0 / duration))

    def nearest(number: int) -> float:
        top, k = waves[number].max_order, float(waves[number].wavenumber)
        return require_stable_ties(problem, top, duration, k) if problem.tied else require_stable(problem, top, duration, wavenumber=k)

    look_closer(nearest, len(waves))


def look_closer(nearest: Callable[[int], float], count: int) -> list[int]:
    """Ask how near to growing some of *count* waves in a row are, and those between them unless they cannot come to 0; return which.

    Waves between two neighbours are left out where the lesser is more than it changes there, at the rate of this gap or of one beside it.
    """
    first = np.unique(np.rint(np.linspace(0.0, count - 1.0, min(count, FIRST))).astype(int))
    known = {int(place): nearest(int(place)) for place in first}
    while closer := _open_gaps(known):
        known |= {place: nearest(place) for place in closer}
    return sorted(known)


def _open_gaps(known: dict[int, float]) -> list[int]:
    """Return the middle of each gap between places in which what is known at its ends may come to 0."""
    gaps = list(pairwise(sorted(known)))
    rates = [0.0 if np.isinf(min(known[a], known[b])) else abs(known[b] - known[a]) / (b - a) for a, b in gaps]
    fastest = [max(rates[max(i - 1, 0) : i + 2]) for i in range(len(gaps))]
    found = ((a, b) for (a, b), rate in zip(gaps, fastest, strict=True) if b > a + 1 and min(known[a], known[b]) <= rate * (b - a))
    return [(a + b) // 2 for a, b in found]


def doubtful_waves(problem: Problem, waves: Sequence[Modes], least: float) -> list[Modes]:
    """Return the wavenumbers at which some order is not proven to grow by no more than a rate per transit."""
    if problem.two_faced:
        return list(waves)
    return [modes for modes in waves if not passive_orders(problem, modes, least).all()]


def sample(waves: Sequence[Modes], most: int = CHECKED) -> list[Modes]:
    """Return some of many wavenumbers, the first and the last among them."""
    places = np.unique(np.rint(np.linspace(0.0, len(waves) - 1.0, min(len(waves), most))).astype(int))
    return [waves[place] for place in places]
