"""One implicit step of links of any law.

Linear parts of a step are known: the mean stretch of the links over it is z = z_known + R x, x the force that they add (less a stiffness
kappa z that was lent to the linear problem), D_1 = 2 z - D_0. Each link holds its law, x + kappa z = h(D_1; D_0). Newton's method solves
all of them for x, with one of the slopes where laws have corners, and goes as much of the way as shrinks what is missing.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.solver.interface.newton import ConvergenceError
from coaxshell.solver.links.laws import LawState, LinkLaws

TOLERANCE = 1e-12
"""Of what is missing, relative to the largest force of the step."""
_ROUNDING = 1e-9
"""What is missing below this is rounding where it shrinks no more, or after a few iterations."""
_FEW_ITERATIONS = 8
_EPSILONS = 8.0 * float(np.finfo(np.float64).eps)
_MOST_ITERATIONS = 60
_SHORTEST = 2.0**-12


class LawStep(NamedTuple):
    """What a step found.

    Attributes
    ----------
    added : ndarray, shape (links,)
        x.
    state : LawState
        After the step.
    iterations : int
    stiffest : float
        The largest slope of a spring times the compliance of its link within the step, (omega dt/2)^2 of what swings on it.
    """

    added: FloatArray
    state: LawState
    iterations: int
    stiffest: float


class Missing(NamedTuple):
    """By how much each link misses its law, D_1, dh/dD_1, the springs' share in it, and the first relative to the largest force."""

    value: FloatArray
    stretch: FloatArray
    slope: FloatArray
    elastic: FloatArray
    size: float


class LawSolver:
    """Solves steps; constants only.

    Parameters
    ----------
    response : ndarray, shape (links, links)
        R, whose diagonal is negative: force takes stretch back.
    laws : LinkLaws
    lent : ndarray, shape (links,)
        kappa.
    """

    def __init__(self, response: FloatArray, laws: LinkLaws, lent: FloatArray) -> None:
        self._response, self._laws, self._lent = response, laws, lent
        self._own, self._identity = compliance(response), np.eye(len(response))

    def solve(self, known: FloatArray, guess: FloatArray, state: LawState) -> LawStep:
        """Return one step.

        Parameters
        ----------
        known : ndarray, shape (links,)
            z_known.
        guess : ndarray, shape (links,)
            x to begin with.
        state : LawState
            Before the step.

        Raises
        ------
        ConvergenceError
        """
        added, missing = guess, self._missing(known, guess, state)
        for iteration in range(1, _MOST_ITERATIONS + 1):
            if missing.size <= (TOLERANCE if iteration <= _FEW_ITERATIONS else _ROUNDING):
                return self._done(added, missing, state, iteration)
            jacobian = self._identity + (self._lent - 2.0 * missing.slope)[:, None] * self._response
            try:
                towards = np.linalg.solve(jacobian, -missing.value)
            except np.linalg.LinAlgError:
                raise ConvergenceError from None
            part, tried = 1.0, self._missing(known, added + towards, state)
            while not tried.size < (1.0 - 1e-4 * part) * missing.size and part > _SHORTEST:
                part *= 0.5
                tried = self._missing(known, added + part * towards, state)
            if part <= _SHORTEST:
                if missing.size <= _ROUNDING:
                    return self._done(added, missing, state, iteration)
                part, tried = 1.0, self._missing(known, added + towards, state)  # over a corner: all the way once
            added, missing = added + part * towards, tried
        raise ConvergenceError

    def _missing(self, known: FloatArray, added: FloatArray, state: LawState) -> Missing:
        mean = known + self._response @ added
        after = 2.0 * mean - state.stretch
        value, slope, elastic = self._laws.force(after, state)
        left = added + self._lent * mean - value
        scale = max(float(np.abs(added).max(initial=0.0)), float(np.abs(value).max(initial=0.0)), 1e-300)
        rounded = _EPSILONS * slope * (np.abs(after) + np.abs(state.stretch))  # a law feels the rounding of its stretch
        return Missing(left, after, slope, elastic, float(np.maximum(np.abs(left) - rounded, 0.0).max(initial=0.0)) / scale)

    def _done(self, added: FloatArray, missing: Missing, state: LawState, iterations: int) -> LawStep:
        stiffest = 2.0 * float((missing.elastic * self._own).max(initial=0.0))
        return LawStep(added, self._laws.advance(missing.stretch, state), iterations, stiffest)


def compliance(response: FloatArray) -> FloatArray:
    """Return A of every link, by which a force takes its own mean stretch back within a step, shape (links,)."""
    return np.maximum(-np.diag(response), 1e-300)
