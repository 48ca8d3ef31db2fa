"""The stretches of line absorbers at some steps, D = D_known + R n(D): R acts on each axial wavenumber, n at each point of the period.

Several steps at once are solved by fixed-point iteration where springs are soft on the scale of a step, else fewer. One step alone is
solved by Newton's method: A = -R, the stretch that a force within the step takes back, is positive, and the law's tangent
T >= 0 is too; the linear problem

    (1 + A T) d = r

is solved by GMRES, preconditioned with the same operator for the mean of T along the axis, which each wavenumber inverts by itself.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.solver.axial.series import AxialSeries
from coaxshell.solver.interface.newton import ConvergenceError

_TOLERANCE = 1e-11
_MOST_ITERATIONS = 40
_SLOWEST = 0.3
"""The change of an iteration over that of the one before it, at most."""
_MOST_NEWTON, _SHORTEST = 60, 2.0**-20
_KRYLOV_TOLERANCE = 1e-4
_RETRY = 16
"""Blocks after which more steps are tried again at once."""


class Seed(NamedTuple):
    """What one block hands to the next: last stretches (waves, 2N, axial parities), steps to take at once, blocks since they were cut."""

    last: FloatArray
    steps: int
    since: int


class LineSolver:
    """Solves for the stretches of some steps; constants only.

    Parameters
    ----------
    series : AxialSeries
    rows : ndarray, shape (waves, length * 2N, length * 2N)
        R over the steps of a block.
    cubic, auxiliary_stiffness : ndarray, shape (2N,)
        k_nl, and the stiffness that was lent to the linear problem.
    """

    def __init__(self, series: AxialSeries, rows: FloatArray, cubic: FloatArray, auxiliary_stiffness: FloatArray) -> None:
        self._series, self._rows, self._cubic, self._lent = series, rows, cubic, auxiliary_stiffness
        self._size = cubic.size
        self._present = np.ascontiguousarray(rows[:, : self._size, : self._size])

    def at_rest(self) -> Seed:
        """Return the seed before the first block."""
        return Seed(np.zeros((self._series.waves, self._size, self._series.parities)), self._rows.shape[1] // self._size, 0)

    def solve(self, known: FloatArray, count: int, seed: Seed) -> tuple[FloatArray, Seed]:
        """Return n(D) at the steps of a block, and the seed of the next one.

        Parameters
        ----------
        known : ndarray, shape (waves, count * 2N, axial parities)
            D_known, without n at any step of the block.
        count : int
        seed : Seed

        Raises
        ------
        ConvergenceError
        """
        found, done, last = np.zeros_like(known), 0, seed.last
        together = self._rows.shape[1] // self._size if seed.since >= _RETRY else seed.steps
        since = 0 if seed.since >= _RETRY else seed.since
        while done < count:
            end = min(done + together, count)
            part, before = slice(done * self._size, end * self._size), slice(0, done * self._size)
            here = known[:, part] + self._rows[:, part, before] @ found[:, before]
            solved = self._at_once(here) if end > done + 1 or together > 1 else self._by_newton(here, last)
            if solved is None:
                together, since = max(1, together // 2), 0
                continue
            found[:, part] = self.nonlinear_part(solved)
            last, done = solved[:, -self._size :], end
        return found, Seed(last, together, since + (together < self._rows.shape[1] // self._size))

    def nonlinear_part(self, stretch: FloatArray) -> FloatArray:
        """Return n(D) = k_nl D^3 - kappa D as a sum along the axis, of stretches (waves, steps * 2N, axial parities)."""
        values = self._series.values(stretch)
        cubes = values * values
        cubes *= values
        cubes *= np.tile(self._cubic, values.shape[1] // self._size)
        found = self._series.coefficients(cubes)
        if self._lent.any():
            found = found - np.tile(self._lent, values.shape[1] // self._size)[:, None] * stretch
        return found

    def _at_once(self, known: FloatArray) -> FloatArray | None:
        """Return D of some steps by fixed-point iteration, None if it converges too slowly."""
        rows = self._rows[:, : known.shape[1], : known.shape[1]]
        stretch, last = known, 0.0
        for _ in range(_MOST_ITERATIONS):
            new = known + rows @ self.nonlinear_part(stretch)
            change = _norm(new - stretch) / max(_norm(new), 1e-150)
            stretch = new
            if not np.isfinite(change):
                return None
            if change > _TOLERANCE and last > 0.0:
                rate = change / last
                if rate > _SLOWEST:
                    return None
                change *= rate  # what the next one would change
            if change <= _TOLERANCE:
                return stretch
            last = change
        return None

    def _by_newton(self, known: FloatArray, start: FloatArray) -> FloatArray:
        """Return D of one step; the way to a new D is shortened until the residual falls."""
        stretch, missing = start, self._missing(start, known)
        size = _norm(missing)
        for _ in range(_MOST_NEWTON):
            if size <= _TOLERANCE * max(_norm(known), 1e-150):
                return stretch
            towards = self._correction(stretch, missing)
            part = 1.0
            while True:
                new = stretch + part * towards
                missing = self._missing(new, known)
                left = _norm(missing)
                if left < (1.0 - 1e-4 * part) * size:
                    break
                part *= 0.5
                if part < _SHORTEST:
                    if size <= 1e-13 * (_norm(self._present @ self.nonlinear_part(stretch)) + _norm(known)):
                        return stretch  # rounding
                    raise ConvergenceError
            stretch, size = new, left
        raise ConvergenceError

    def _missing(self, stretch: FloatArray, known: FloatArray) -> FloatArray:
        return np.asarray(known + self._present @ self.nonlinear_part(stretch) - stretch)

    def _correction(self, stretch: FloatArray, missing: FloatArray) -> FloatArray:
        """Return d of (1 - R T) d = r, T = 3 k_nl D^2 - kappa at every point."""
        from scipy.sparse.linalg import LinearOperator, gmres  # takes time, and most runs do without

        series, shape = self._series, missing.shape
        tangent = 3.0 * self._cubic * series.values(stretch) ** 2
        mean = series.weights @ tangent - self._lent
        inverse = np.linalg.inv(np.eye(self._size) - self._present * mean)

        def operator(flat: FloatArray) -> FloatArray:
            d = flat.reshape(shape)
            pressed = series.coefficients(tangent * series.values(d)) - self._lent[:, None] * d
            return np.asarray(inverse @ (d - self._present @ pressed)).ravel()

        right = (inverse @ missing).ravel()
        linear = LinearOperator((right.size, right.size), matvec=operator, dtype=np.float64)
        found, _ = gmres(linear, right, rtol=_KRYLOV_TOLERANCE, atol=0.0, restart=60, maxiter=4)
        return np.asarray(found, dtype=np.float64).reshape(shape)


def _norm(x: FloatArray) -> float:
    return float(np.sqrt(np.vdot(x, x).real))
