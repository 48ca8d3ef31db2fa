"""Line absorbers of any law in three dimensions: one implicit step of links that are free at every z.

As in two dimensions (:mod:`coaxshell.solver.links.march`) the march goes in the means over the steps, and a law exerts one force h over a
step at every z. Walls and masses know sums along the axis up to the highest wavenumber: with V the values of a sum at the points of a
period, and P what values have of a sum (:mod:`coaxshell.solver.axial.series`), the forces x that laws add are

    x + kappa z = P h(V D_1; V D_0),    D_1 = 2 z - D_0,    z = z_known + R x        (R of each wavenumber by itself).

The mean along the period of (P h)(D_1 - D_0) is that of h (D_1 - D_0) at the points, whatever the law: what h keeps and loses at every z,
the sums keep and lose together. Friction and stops have corners along the axis too, of which sums know as much as of any other force.

Newton's method takes the slopes 2 dh/dD_1 at every point; its equations are solved by GMRES, preconditioned with the mean slope along the
axis, which each wavenumber inverts by itself.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.solver.axial.series import AxialSeries
from coaxshell.solver.interface.absorbers import AbsorberSet
from coaxshell.solver.interface.newton import ConvergenceError
from coaxshell.solver.links.described import assembled
from coaxshell.solver.links.histories import best_springs
from coaxshell.solver.links.laws import LawState, LinkLaws
from coaxshell.solver.links.step import Missing

_TOLERANCE = 1e-11
"""Of what is missing, relative to the forces of the step."""
_ROUNDING = 1e-9
"""What is missing below this is rounding where it shrinks no more, or after a few iterations."""
_FEW, _MOST, _SHORTEST = 8, 60, 2.0**-12
_KRYLOV_TOLERANCE = 1e-3


class LawSeed(NamedTuple):
    """What one block hands to the next.

    Attributes
    ----------
    stretch : ndarray, shape (waves, 2N, axial parities)
        D at the end of the last step.
    added : ndarray, of the same shape
        x of the last step.
    state : LawState
        Of all links at all points of the period.
    stiffest : float
        The largest slope of a spring times the compliance of its link within a step so far.
    """

    stretch: FloatArray
    added: FloatArray
    state: LawState
    stiffest: float


def laws_along(series: AxialSeries, absorbers: AbsorberSet, time_step: float, compliance: FloatArray | None = None) -> LinkLaws:
    """Return the laws of all links at all points of a period, those of one point together.

    Parameters
    ----------
    series : AxialSeries
    absorbers : AbsorberSet
    time_step : float
    compliance : ndarray, shape (2N,), optional
        A of the links within a step; dry friction needs it.
    """
    assert absorbers.elements is not None
    points, cubic = series.points, np.tile(absorbers.cubic, 2) * absorbers.elements.present
    own = None if compliance is None else np.tile(compliance, points)
    return assembled(absorbers.elements.elements * points, time_step, np.tile(cubic, points), own)


class LineLaws:
    """Solves for the forces of laws at some steps; constants only.

    Parameters
    ----------
    series : AxialSeries
    rows : ndarray, shape (waves, length * 2N, length * 2N)
        R over the steps of a block.
    absorbers : AbsorberSet
    lent : ndarray, shape (2N,)
        kappa.
    time_step : float
    """

    def __init__(self, series: AxialSeries, rows: FloatArray, absorbers: AbsorberSet, lent: FloatArray, time_step: float) -> None:
        self._series, self._rows, self._lent, self._size = series, rows, lent, lent.size
        self._present = np.ascontiguousarray(rows[:, : lent.size, : lent.size])
        self.compliance = np.maximum(-np.diagonal(self._present, axis1=1, axis2=2), 1e-300).max(axis=0)
        """A of every link: what a force along the line takes back of its own mean stretch within a step, the most of all waves."""
        self._laws = laws_along(series, absorbers, time_step, self.compliance)

    def at_rest(self) -> LawSeed:
        """Return the seed before the first block."""
        nothing = np.zeros((self._series.waves, self._size, self._series.parities))
        return LawSeed(nothing, nothing, self._laws.at_rest(), 0.0)

    def solve(self, known: FloatArray, count: int, seed: LawSeed) -> tuple[FloatArray, LawSeed]:
        """Return x at the steps of a block, and the seed of the next one.

        Parameters
        ----------
        known : ndarray, shape (waves, count * 2N, axial parities)
            z_known, without x at any step of the block.
        count : int
        seed : LawSeed

        Raises
        ------
        ConvergenceError
        """
        found = np.zeros_like(known)
        for step in range(count):
            part, before = slice(step * self._size, (step + 1) * self._size), slice(0, step * self._size)
            here = known[:, part] + self._rows[:, part, before] @ found[:, before] if step else known[:, part]
            seed = self._step(here, seed)
            found[:, part] = seed.added
        return found, seed

    def _step(self, known: FloatArray, seed: LawSeed) -> LawSeed:
        added, missing = seed.added, self._missing(known, seed.added, seed)
        for iteration in range(1, _MOST + 1):
            if missing.size <= (_TOLERANCE if iteration <= _FEW else _ROUNDING):
                return self._done(added, missing, seed)
            towards = self._correction(missing)
            part, tried = 1.0, self._missing(known, added + towards, seed)
            while not tried.size < (1.0 - 1e-4 * part) * missing.size and part > _SHORTEST:
                part *= 0.5
                tried = self._missing(known, added + part * towards, seed)
            if part <= _SHORTEST:
                if missing.size <= _ROUNDING:
                    return self._done(added, missing, seed)
                part, tried = 1.0, self._missing(known, added + towards, seed)  # over a corner: all the way once
            added, missing = added + part * towards, tried
        raise ConvergenceError

    def _missing(self, known: FloatArray, added: FloatArray, seed: LawSeed) -> Missing:
        mean = known + self._present @ added
        after = 2.0 * mean - seed.stretch
        forces = self._laws.force(self._series.values(after).ravel(), seed.state)
        at_points = (forces.value.reshape(-1, self._size), forces.slope.reshape(-1, self._size), forces.elastic)
        exerted = self._series.coefficients(at_points[0])
        left = added + self._lent[:, None] * mean - exerted
        scale = max(_largest(added), _largest(exerted), 1e-300)
        return Missing(left, after, at_points[1], at_points[2], _largest(left) / scale)

    def _correction(self, missing: Missing) -> FloatArray:
        """Return d of (1 + kappa R - 2 P h' V R) d = -missing."""
        from scipy.sparse.linalg import LinearOperator, gmres  # takes time, and most runs do without

        series, shape = self._series, missing.value.shape
        mean = series.weights @ missing.slope
        inverse = np.linalg.inv(np.eye(self._size) + (self._lent - 2.0 * mean)[:, None] * self._present)
        beside = 2.0 * (missing.slope - mean)
        right = -(inverse @ missing.value)
        if not np.any(beside):
            return np.asarray(right)

        def operator(flat: FloatArray) -> FloatArray:
            d = flat.reshape(shape)
            return np.asarray(d - inverse @ series.coefficients(beside * series.values(self._present @ d))).ravel()

        linear = LinearOperator((right.size, right.size), matvec=operator, dtype=np.float64)
        found, _ = gmres(linear, right.ravel(), rtol=_KRYLOV_TOLERANCE, atol=0.0, restart=60, maxiter=4)
        return np.asarray(found, dtype=np.float64).reshape(shape)

    def _done(self, added: FloatArray, missing: Missing, seed: LawSeed) -> LawSeed:
        own = np.tile(self.compliance, self._series.points)
        stiffest = max(seed.stiffest, 2.0 * float((missing.elastic * own).max(initial=0.0)))
        state = self._laws.advance(self._series.values(missing.stretch).ravel(), seed.state)
        return LawSeed(missing.stretch, added, state, stiffest)


class LineLawHistories(NamedTuple):
    """What links of any law did in a march.

    Attributes
    ----------
    force, stretch : ndarray, shape (waves, 2N, axial parities, T)
        Amplitudes of the forces over the steps that end at the instants, and of D at the instants.
    angle : float
        The largest angle by which anything swings on a law within a step (radians).
    compliance : ndarray, shape (2N,)
        A of the links within a step, by which dry friction was told.
    """

    force: FloatArray
    stretch: FloatArray
    angle: float
    compliance: FloatArray

    def best_springs(self, absorbers: AbsorberSet, time_step: float) -> AbsorberSet:
        """Return the absorbers with the springs and dampers that fit their laws best, over all times and the whole axis."""
        assert absorbers.elements is not None
        before = np.concatenate([np.zeros_like(self.stretch[..., :1]), self.stretch[..., :-1]], axis=-1)
        middle, rate = 0.5 * (self.stretch + before), (self.stretch - before) / time_step
        damping, linear = (np.tile(x, 2) * absorbers.elements.present for x in (absorbers.damping, absorbers.linear))
        by_laws = self.force - damping[:, None, None] * rate - linear[:, None, None] * middle
        share = np.where(np.arange(len(middle)) == 0, 1.0, np.sqrt(0.5))[:, None, None, None]  # means of squares along the period
        each = (np.moveaxis(share * x, 1, 0).reshape(x.shape[1], -1) for x in (middle, rate, by_laws))
        return best_springs(absorbers, *each)


def means_of(displacement: FloatArray, time_step: float) -> tuple[FloatArray, FloatArray]:
    """Return the means over the steps of displacements at the instants, (..., T), all at rest at t = 0, and of their velocities."""
    moved = displacement.copy()
    moved[..., 0] = 0.0
    before = np.concatenate([np.zeros_like(moved[..., :1]), moved[..., :-1]], axis=-1)
    return 0.5 * (moved + before), (moved - before) / time_step


def of_means(means: FloatArray) -> FloatArray:
    """Return x at the instants, x_n = 2 x~_n - x_{n-1}, from means over the steps before them, (..., T), 0 at t = 0."""
    turns = np.where(np.arange(means.shape[-1]) % 2 == 0, 1.0, -1.0)
    return np.asarray(turns * np.cumsum(2.0 * turns * means, axis=-1))


def _largest(x: FloatArray) -> float:
    return float(np.abs(x).max(initial=0.0))
