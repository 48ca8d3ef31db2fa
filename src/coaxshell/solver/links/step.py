"""One implicit step of links of any law.

Linear parts of a step are known: the mean stretch of the links over it is z = z_known + R x, x the force that they add (less a stiffness
kappa z that was lent to the linear problem), D_1 = 2 z - D_0. Each link holds its law,

    x + kappa z = h(D_1; D_0) + y,        y in F Sgn(D_1 - D_0) where it has a slider, else 0,

the second as y = y + rho (D_1 - D_0) cut at -F and F (P. Alart, A. Curnier, Comput. Methods Appl. Mech. Engrg. 92 (1991) 353-375).
Newton's method solves all of them for x, with one of the slopes where laws have corners, and goes as much of the way as shrinks what is
missing.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.solver.interface.newton import ConvergenceError
from coaxshell.solver.links.law import Truths
from coaxshell.solver.links.laws import LawState, LinkLaws

TOLERANCE = 1e-12
"""Of what is missing, relative to the largest force of the step."""
_MOST_ITERATIONS = 60
_SHORTEST = 2.0**-12


class LawStep(NamedTuple):
    """What a step found.

    Attributes
    ----------
    added : ndarray, shape (links,)
        x.
    stretch : ndarray, shape (links,)
        D_1.
    state : LawState
        After the step.
    iterations : int
    stiffest : float
        The largest slope of a law times the compliance of its link within the step, (omega dt/2)^2 of what swings on it.
    """

    added: FloatArray
    stretch: FloatArray
    state: LawState
    iterations: int
    stiffest: float


class _Missing(NamedTuple):
    value: FloatArray
    by_added: FloatArray
    by_mean: FloatArray
    stretch: FloatArray
    slips: Truths
    slope: FloatArray
    friction: FloatArray
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
        self._own = np.maximum(-np.diag(response), 1e-300)

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
        bounds = self._laws.bounds(state)
        added = guess
        missing = self._missing(known, added, state, bounds)
        if not np.isfinite(missing.size):
            added = np.zeros_like(guess)
            missing = self._missing(known, added, state, bounds)
        for iteration in range(1, _MOST_ITERATIONS + 1):
            if missing.size <= TOLERANCE:
                return self._done(added, missing, state, iteration)
            jacobian = missing.by_mean[:, None] * self._response
            jacobian[np.diag_indices_from(jacobian)] += missing.by_added
            try:
                towards = np.linalg.solve(jacobian, -missing.value)
            except np.linalg.LinAlgError:
                raise ConvergenceError from None
            part, tried = 1.0, self._missing(known, added + towards, state, bounds)
            while not tried.size < (1.0 - 1e-4 * part) * missing.size and part > _SHORTEST:
                part *= 0.5
                tried = self._missing(known, added + part * towards, state, bounds)
            if part <= _SHORTEST:
                if missing.size <= 1e3 * TOLERANCE:  # rounding
                    return self._done(added, missing, state, iteration)
                part, tried = 1.0, self._missing(known, added + towards, state, bounds)  # over a corner: all the way once
            added, missing = added + part * towards, tried
        raise ConvergenceError

    def _missing(self, known: FloatArray, added: FloatArray, state: LawState, bounds: tuple[FloatArray, FloatArray]) -> _Missing:
        """Return by how much each link misses its law, and how that depends on x and z."""
        mean = known + self._response @ added
        after = 2.0 * mean - state.stretch
        value, slope = self._laws.force(after, state)
        friction = added + self._lent * mean - value
        moved = (after - state.stretch) / (2.0 * self._own)  # rho = 1/(2 A)
        tried = friction + moved
        low, high = bounds
        slips = (tried <= low) | (tried >= high)
        left = np.where(slips, friction - np.clip(tried, low, high), -moved)
        by_mean = np.where(slips, self._lent - 2.0 * slope, -1.0 / self._own)
        scale = max(float(np.abs(added).max(initial=0.0)), float(np.abs(value).max(initial=0.0)), float(high.max(initial=0.0)))
        scale = max(scale, 1e-300)
        return _Missing(
            left, np.where(slips, 1.0, 0.0), by_mean, after, slips, slope, friction, float(np.abs(left).max(initial=0.0)) / scale
        )

    def _done(self, added: FloatArray, missing: _Missing, state: LawState, iterations: int) -> LawStep:
        after = missing.stretch
        if self._laws.sliders is not None:
            after = np.where(missing.slips, after, state.stretch)
        stiffest = float((missing.slope * self._own).max(initial=0.0))
        return LawStep(added, after, self._laws.advance(after, missing.slips, missing.friction, state), iterations, 2.0 * stiffest)
