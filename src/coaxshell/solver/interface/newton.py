"""One implicit step of the interface, z = z_known + R n(z), by Newton's method with a tangent that is kept as long as it serves.

z are the stretches of the links (and the voltages asked for), n(z) what the nonlinear laws add to the linear ones, R the answer of
everything linear within the same step. With the tangent n' = T kept,

    z <- (1 - R T)^{-1} [z_known + R (n(z) - T z)],

one product an iteration; z is extrapolated from earlier steps to begin with. Laws with corners (a voltage that stops at its limit) can
make that cycle where a step moves z far: then the tangent is taken anew at every iteration and as much of the way to the new z is gone
as reduces the residual.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.solver.interface.laws import InterfaceLaw

_MAX_DESCENTS = 200
_SHORTEST = 2.0**-30
"""Part of the way to a new z, at least."""
_FEW_ITERATIONS = 4
_ROUNDING = 4e-15


class ConvergenceError(Exception):
    """Raised when a step does not converge."""


class KeptTangent(NamedTuple):
    """A tangent of the law and what follows from it.

    Attributes
    ----------
    at : ndarray, shape (n,)
        z where it was taken.
    tangent
        The law's own.
    inverse : ndarray, shape (n, n), or None
        (1 - R T)^{-1}; None where T is 0.
    gain : ndarray, shape (n, n)
        (1 - R T)^{-1} R.
    """

    at: FloatArray
    tangent: Any
    inverse: FloatArray | None
    gain: FloatArray


class NewtonState(NamedTuple):
    """What one step hands to the next.

    Attributes
    ----------
    last, before, oldest : ndarray, shape (n,)
        z of the three steps before.
    kept : KeptTangent
    rate : float
        The slowest contraction seen with this tangent, 0 before any.
    """

    last: FloatArray
    before: FloatArray
    oldest: FloatArray
    kept: KeptTangent
    rate: float

    def seeded(self, solved: FloatArray) -> NewtonState:
        """Return the state as if some steps had been solved here; ``solved`` is their z, shape (steps, n)."""
        last, before, oldest = self.last, self.before, self.oldest
        for z in solved:
            oldest, before, last = before, last, z
        return NewtonState(last, before, oldest, self.kept, self.rate)


class Solved(NamedTuple):
    """z of one step, the iterations it took, and the state after it."""

    z: FloatArray
    iterations: int
    state: NewtonState


class ImplicitStep:
    """Newton's method for one step; constants only.

    Parameters
    ----------
    response : ndarray, shape (n, n)
        R.
    law : InterfaceLaw
    """

    def __init__(self, response: FloatArray, law: InterfaceLaw[Any]) -> None:
        self._response, self._law = response, law
        self._identity = np.eye(response.shape[0])

    def at_rest(self) -> NewtonState:
        """Return the state before the first step."""
        last, before, oldest = np.zeros((3, self._response.shape[0]))
        return NewtonState(last, before, oldest, self.tangent_at(last), 0.0)

    def tangent_at(self, z: FloatArray) -> KeptTangent:
        """Return the tangent at z, ready for use."""
        tangent = self._law.linearise(z)
        product = self._law.times_tangent(self._response, tangent)
        if not product.any():
            return KeptTangent(z, tangent, None, self._response)
        inverse = np.asarray(np.linalg.inv(self._identity - product), dtype=np.float64)
        return KeptTangent(z, tangent, inverse, inverse @ self._response)

    def solve(self, state: NewtonState, known: FloatArray) -> Solved:
        """Return z of the next step.

        Raises
        ------
        ConvergenceError
        """
        law, tolerance, kept, rate = self._law, self._law.tolerance, state.kept, state.rate
        z = 3.0 * (state.last - state.before) + state.oldest
        target = _target(kept, known)
        descents = 0
        last = 0.0  # 0: not measured with the present tangent
        for iteration in range(1, law.most_iterations + 1):
            new = kept.gain @ law.tangent_remainder(z, kept.tangent)
            new += target
            change = new - z
            z = new
            size = law.relative(change, z)
            if size <= tolerance:
                break
            if last > 0.0:
                rate = max(rate, size / last)
                if size * rate <= tolerance and rate < 1.0:
                    break
                if iteration > _FEW_ITERATIONS and float(np.abs(change).max()) <= _ROUNDING * float(np.abs(target).max()):
                    break  # terms far larger than their sum
                if rate > law.contraction_limit:
                    kept, rate = self.tangent_at(z), 0.0
                    target = _target(kept, known)
                    size = 0.0
            last = size
        else:
            z, descents = self._by_descent(state.last, known)
            kept, rate = self.tangent_at(z), 0.0
        return Solved(z, iteration + descents, NewtonState(z, state.last, state.before, kept, rate))

    def _by_descent(self, z: FloatArray, known: FloatArray) -> tuple[FloatArray, int]:
        """Return z of the next step, and the iterations, by Newton's method with a new tangent at each, shortened until the residual falls.

        ``z`` is where it begins.
        """
        law = self._law
        missing, size = self._residual(z, known)
        for iteration in range(1, _MAX_DESCENTS + 1):
            try:
                system = self._identity - law.times_tangent(self._response, law.linearise(z))
                towards = np.asarray(np.linalg.solve(system, missing), dtype=np.float64)
            except np.linalg.LinAlgError:
                raise ConvergenceError from None
            part = 1.0
            new = z + towards
            missing, left = self._residual(new, known)
            while not left < (1.0 - 1e-4 * part) * size:
                part *= 0.5
                if part < _SHORTEST:
                    raise ConvergenceError
                new = z + part * towards
                missing, left = self._residual(new, known)
            z, size = new, left
            if size <= law.tolerance or law.relative(part * towards, z) <= law.tolerance:
                return z, iteration
        raise ConvergenceError

    def _residual(self, z: FloatArray, known: FloatArray) -> tuple[FloatArray, float]:
        """Return z_known + R n(z) - z and its size relative to z_known."""
        missing = known + self._response @ self._law.nonlinear_part(z) - z
        return missing, self._law.relative(missing, known)


def _target(kept: KeptTangent, known: FloatArray) -> FloatArray:
    return known if kept.inverse is None else kept.inverse @ known
