"""Stability of feedback in three dimensions: of every order at every axial wavenumber, by passivity where that proves it, else by counting.

A wave (m, k) is a system by itself. Walls that stay passive with their feedback cannot make one grow (:mod:`coaxshell.solver.passivity`),
which is asked at a sample of wavenumbers; poles of those in doubt are counted at fewer, as they move with k as smoothly as with the order.
Where feedback ties walls or orders a wavenumber is a system of all that is tied (:mod:`coaxshell.solver.tied_stability`).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from coaxshell.numerics.modes import Modes
from coaxshell.solver.axial.sampling import AxialSampling
from coaxshell.solver.passivity import passive_orders
from coaxshell.solver.scaling import Problem
from coaxshell.solver.stability import require_stable
from coaxshell.solver.tied_stability import require_stable_ties

ASKED, CHECKED = 24, 16
"""Wavenumbers at which passivity is asked, and at which poles are counted, at most: a tenth of what a run takes."""


def require_stable_waves(problem: Problem, sampling: AxialSampling, duration: float) -> None:
    """Raise InputError, naming gain, order and wavenumber, if the closed loop is unstable at a wavenumber of a run."""
    if all(wall.gains is None for wall in problem.shells):
        return
    if problem.tied:
        for modes in sample(sampling.modes):
            require_stable_ties(problem, modes.max_order, duration, float(modes.wavenumber))
        return
    for modes in sample(doubtful_waves(problem, sample(sampling.modes, ASKED), 1.0 / duration)):
        require_stable(problem, modes.max_order, duration, wavenumber=float(modes.wavenumber))


def doubtful_waves(problem: Problem, waves: Sequence[Modes], least: float) -> list[Modes]:
    """Return the wavenumbers at which some order is not proven to grow by no more than a rate per transit."""
    if problem.two_faced:
        return list(waves)
    return [modes for modes in waves if not passive_orders(problem, modes, least).all()]


def sample(waves: Sequence[Modes], most: int = CHECKED) -> list[Modes]:
    """Return some of many wavenumbers, the first and the last among them."""
    places = np.unique(np.rint(np.linspace(0.0, len(waves) - 1.0, min(len(waves), most))).astype(int))
    return [waves[place] for place in places]
