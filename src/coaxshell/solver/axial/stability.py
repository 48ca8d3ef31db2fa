"""Stability of feedback in three dimensions: of every order at every axial wavenumber, by passivity where that proves it, else by counting.

A wave (m, k) is a system by itself. Laws that take energy alone (:mod:`coaxshell.solver.taking_bands`) cannot make one grow, nor can walls
that stay passive with their feedback (:mod:`coaxshell.solver.passivity`), which is asked at a sample of wavenumbers; poles of those in
doubt are counted at fewer, as they move with k as smoothly as with the order. So does the least |D/D0| on the contour, which a pole passes
at 0: between wavenumbers where that is more than it changes none is counted.
Where feedback ties walls or orders a wavenumber is a system of all that is tied (:mod:`coaxshell.solver.tied_stability`), and where
electrodes are cut along the axis a class of wavenumbers is (:mod:`coaxshell.solver.axial.belts`), or all with single dead ones.

Inclined plane waves have wavenumbers up to k = omega sin alpha of the highest frequency, and answers at frequencies those that travel:
these are asked at real k, as a wall that grows there does so whatever k Laplace's s has in the run.

Where one grows the fastest of them is told: each of the others is asked for poles beyond the fastest growth found so far alone.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise

import numpy as np

from coaxshell.acoustics.sources import PlaneGeometry
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.modes import Modes
from coaxshell.solver.axial.belt_ties import tie_of_broken, ties_of_belts
from coaxshell.solver.axial.sampling import AxialSampling
from coaxshell.solver.passivity import passive_orders
from coaxshell.solver.scaling import Problem
from coaxshell.solver.stability import growth_beyond, nearest_ratio, require_stable
from coaxshell.solver.taking_bands import all_taken_in_waves
from coaxshell.solver.tied import require_resolved
from coaxshell.solver.tied_stability import Tied, growth_of_tie_beyond, nearest_ratio_of_tie, require_stable_tie

ASKED, CHECKED, FIRST = 24, 16, 5
"""Wavenumbers at which passivity is asked, and at which poles are counted: at most, and where no zero can be near at least."""


def waves_asked(problem: Problem, grid: LaplaceGrid, sampling: AxialSampling) -> AxialSampling:
    """Return the waves whose stability a run asks for: its own, or as far as the trace of an inclined wave has them, to k_max at most."""
    slowness = [abs(one.trace_slowness) for one in problem.sources if isinstance(one, PlaneGeometry)]
    highest = min(max(slowness, default=0.0) * grid.nyquist, sampling.highest)
    return up_to(sampling.max_order, highest) if highest and len(sampling.modes) == 1 else sampling


def up_to(max_order: int, highest: float) -> AxialSampling:
    """Return a sample of all waves up to an order and an axial wavenumber above 0."""
    return AxialSampling(2.0 * np.pi * (CHECKED - 1) / highest, max_order, highest)


def require_stable_waves(problem: Problem, sampling: AxialSampling, duration: float) -> None:
    """Raise InputError, naming gain, order and wavenumber of the fastest growth, if the loop is unstable at a wavenumber of a run."""
    if all(wall.gains is None for wall in problem.shells):
        return
    if problem.tied:
        require_resolved(problem, sampling.max_order)
    least = 1.0 / duration
    if problem.tied:
        _require_stable_ties(problem, _ties(problem, sampling), duration)
        return
    waves = sample(doubtful_waves(problem, sample(sampling.modes, ASKED), least))

    def nearest(number: int) -> float:
        return nearest_ratio(problem, waves[number].max_order, least, float(waves[number].wavenumber))

    def growth(number: int, rate: float) -> float:
        return growth_beyond(problem, waves[number].max_order, rate, float(waves[number].wavenumber))

    known = look_closer(nearest, len(waves))
    if 0.0 in known.values():
        worst = waves[worst_wave(growth, known, len(waves), least)]
        require_stable(problem, worst.max_order, duration, wavenumber=float(worst.wavenumber))


def _ties(problem: Problem, sampling: AxialSampling) -> Sequence[Tied]:
    """Return what feedback ties: waves of some of the wavenumbers, or the classes of belts."""
    if problem.belts is not None and problem.belts.broken:
        return [tie_of_broken(problem, sampling)]
    if problem.belts is not None:
        return ties_of_belts(problem, sampling)
    return [Tied(Modes.up_to(modes.max_order, float(modes.wavenumber))) for modes in sample(sampling.modes)]


def _require_stable_ties(problem: Problem, ties: Sequence[Tied], duration: float) -> None:
    """Raise InputError, naming the fastest growth, if something of what is tied is unstable."""
    least = 1.0 / duration
    known = look_closer(lambda number: nearest_ratio_of_tie(problem, ties[number], least), len(ties))
    if 0.0 in known.values():
        worst = worst_wave(lambda number, rate: growth_of_tie_beyond(problem, ties[number], rate), known, len(ties), least)
        require_stable_tie(problem, ties[worst], duration)


def look_closer(nearest: Callable[[int], float], count: int) -> dict[int, float]:
    """Ask how near to growing some of *count* waves in a row are, 0 where one grows, and those between them unless they cannot come to 0.

    Waves between two neighbours are left out where the lesser is more than it changes there, at the rate of this gap or of one beside it.
    Once one is known to grow no further ones are asked. What was asked is returned by its place.
    """
    first = np.unique(np.rint(np.linspace(0.0, count - 1.0, min(count, FIRST))).astype(int))
    known = {int(place): nearest(int(place)) for place in first}
    while 0.0 not in known.values() and (closer := _open_gaps(known)):
        known |= {place: nearest(place) for place in closer}
    return dict(sorted(known.items()))


def worst_wave(growth: Callable[[int, float], float], known: dict[int, float], count: int, least: float) -> int:
    """Return which of *count* waves grows fastest, of some of which it is known how near to growing they are, 0 where one does.

    *growth* of a place and a rate is how fast the wave grows, or the rate where it grows no faster.
    """
    growing = [place for place, ratio in known.items() if ratio == 0.0]
    worst, rate = growing[0], least
    for place in dict.fromkeys([growing[-1], *growing, *(place for place in range(count) if place not in known)]):  # one end, the other
        found = growth(place, rate)
        if found > rate:
            worst, rate = place, found
    return worst


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
    if all_taken_in_waves(problem, waves, least):
        return []
    return [modes for modes in waves if not passive_orders(problem, modes, least).all()]


def sample(waves: Sequence[Modes], most: int = CHECKED) -> list[Modes]:
    """Return some of many wavenumbers, the first and the last among them."""
    places = np.unique(np.rint(np.linspace(0.0, len(waves) - 1.0, min(len(waves), most))).astype(int))
    return [waves[place] for place in places]
