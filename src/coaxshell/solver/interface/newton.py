"""One implicit step of the interface, z = z_known + R n(z), by Newton's method with a tangent that is kept as long as it serves.

z are the stretches of the links (and the voltages asked for), n(z) what the nonlinear laws add to the linear ones, R the answer of
everything linear within the same step. With the tangent n' = T frozen,

    z <- (1 - R T)^{-1} [z_known + R (n(z) - T z)],

one product an iteration; z is extrapolated from earlier steps to begin with. Laws with corners (a voltage that stops at its limit) can
make that cycle where a step moves z far: then the tangent is taken anew at every iteration and as much of the way to the new z is gone
as reduces the residual.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np

from coaxshell.numerics.arrays import FloatArray

_MAX_DESCENTS = 200
_SHORTEST = 2.0**-30
"""Part of the way to a new z, at least."""
_FEW_ITERATIONS = 4
_ROUNDING = 4e-15


class InterfaceLaw(Protocol):
    """What nonlinear laws add to linear ones, n(z)."""

    tolerance: float
    """Error of z, relative."""
    contraction_limit: float
    """The tangent is renewed when an iteration gains less than this factor."""
    most_iterations: int
    """Before the residual is watched."""

    def nonlinear_part(self, z: FloatArray) -> FloatArray:
        """Return n(z)."""
        ...

    def linearise(self, z: FloatArray, response: FloatArray) -> FloatArray:
        """Keep the tangent T at z and return R T."""
        ...

    def tangent_remainder(self, z: FloatArray) -> FloatArray:
        """Return n(z) - T z with the tangent last kept."""
        ...

    def relative(self, change: FloatArray, z: FloatArray) -> float:
        """Return the size of a change of z relative to z."""
        ...


class ConvergenceError(Exception):
    """Raised when a step does not converge."""


class ImplicitStep:
    """Newton's method for one step after another.

    Parameters
    ----------
    response : ndarray, shape (n, n)
        R.
    law : InterfaceLaw
    """

    def __init__(self, response: FloatArray, law: InterfaceLaw) -> None:
        self._response, self._law = response, law
        self._identity = np.eye(response.shape[0])
        self._last, self._before, self._oldest = np.zeros((3, response.shape[0]))
        self._inverse: FloatArray | None = None  # None: the tangent at rest is 0
        self._renew(self._last)
        self.iterations = 0

    def _renew(self, z: FloatArray) -> None:
        tangent = self._law.linearise(z, self._response)
        self._inverse, self._gain = None, self._response
        if tangent.any():
            inverse = np.asarray(np.linalg.inv(self._identity - tangent), dtype=np.float64)
            self._inverse, self._gain = inverse, inverse @ self._response
        self._rate = 0.0

    def _target(self, known: FloatArray) -> FloatArray:
        return known if self._inverse is None else self._inverse @ known

    def seed(self, last: FloatArray) -> None:
        """Begin as if the last steps had been solved here; ``last`` is their z, shape (steps, n)."""
        for z in last:
            self._oldest, self._before, self._last = self._before, self._last, z

    def solve(self, known: FloatArray) -> FloatArray:
        """Return z of the next step.

        Raises
        ------
        ConvergenceError
        """
        law, tolerance = self._law, self._law.tolerance
        z = 3.0 * (self._last - self._before) + self._oldest
        target = self._target(known)
        last = 0.0  # 0: not measured with the present tangent
        for iteration in range(1, law.most_iterations + 1):
            new = self._gain @ law.tangent_remainder(z)
            new += target
            change = new - z
            z = new
            size = law.relative(change, z)
            if size <= tolerance:
                break
            if last > 0.0:
                self._rate = max(self._rate, size / last)
                if size * self._rate <= tolerance and self._rate < 1.0:
                    break
                if iteration > _FEW_ITERATIONS and float(np.abs(change).max()) <= _ROUNDING * float(np.abs(target).max()):
                    break  # terms far larger than their sum
                if self._rate > law.contraction_limit:
                    self._renew(z)
                    target = self._target(known)
                    size = 0.0
            last = size
        else:
            z = self._by_descent(known)
        self.iterations += iteration
        self._oldest, self._before, self._last = self._before, self._last, z
        return z

    def _by_descent(self, known: FloatArray) -> FloatArray:
        """Return z of the next step by Newton's method with a new tangent at every iteration, shortened until the residual falls."""
        law, z = self._law, self._last
        missing, size = self._residual(z, known)
        for _ in range(_MAX_DESCENTS):
            try:
                towards = np.asarray(np.linalg.solve(self._identity - law.linearise(z, self._response), missing), dtype=np.float64)
            except np.linalg.LinAlgError:
                raise ConvergenceError from None
            self.iterations += 1
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
                self._renew(z)
                return z
        raise ConvergenceError

    def _residual(self, z: FloatArray, known: FloatArray) -> tuple[FloatArray, float]:
        """Return z_known + R n(z) - z and its size relative to z_known."""
        missing = known + self._response @ self._law.nonlinear_part(z) - z
        return missing, self._law.relative(missing, known)
