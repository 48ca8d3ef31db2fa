"""Elastic laws, f = dV/dD: polynomials, and broken lines that stand for tables and for elastic stops.

Over a step h = (V(D_1) - V(D_0))/(D_1 - D_0), written so that nothing cancels where the step is short.
"""

from __future__ import annotations

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.solver.links.law import LawSlopes, Links, StepForce


class Polynomials:
    """f = sum_k a_k D^k, k = 1, 2, ...; h = sum_k a_k/(k + 1) sum_j D_1^j D_0^(k - j).

    Parameters
    ----------
    links : ndarray of int, shape (n,)
    coefficients : ndarray, shape (degree, n)
        a_k from k = 1 on.
    """

    variables = 0
    swings = True

    def __init__(self, links: Links, coefficients: FloatArray) -> None:
        self.links, self._coefficients = links, coefficients

    def force(self, after: FloatArray, before: FloatArray, state: FloatArray) -> StepForce:
        """Return h and its slope."""
        mixed, slope, power = np.ones_like(after), np.zeros_like(after), np.ones_like(before)
        value, rise = np.zeros_like(after), np.zeros_like(after)
        for k, coefficient in enumerate(self._coefficients, start=1):
            power = power * before
            mixed, slope = after * mixed + power, mixed + after * slope
            value = value + coefficient / (k + 1) * mixed
            rise = rise + coefficient / (k + 1) * slope
        return StepForce(value, rise)

    def advance(self, after: FloatArray, before: FloatArray, state: FloatArray) -> FloatArray:
        """Return the state: there is none."""
        return state

    def stored(self, stretch: FloatArray, state: FloatArray) -> FloatArray:
        """Return V."""
        total, power = np.zeros_like(stretch), stretch
        for k, coefficient in enumerate(self._coefficients, start=1):
            power = power * stretch
            total = total + coefficient / (k + 1) * power
        return total

    def slopes(self, after: FloatArray, before: FloatArray, state: FloatArray) -> LawSlopes:
        """Return the slopes of h, which is the same if D_1 and D_0 change places."""
        return LawSlopes.of_stretch(self.force(after, before, state).slope, self.force(before, after, state).slope)


class BrokenLines:
    """f = k_0 D + sum_i k_i sigma_i x_i, x_i = max(sigma_i (D - d_i), 0): a slope at rest that changes by k_i beyond each corner d_i.

    Parameters
    ----------
    links : ndarray of int, shape (n,)
    slope : ndarray, shape (n,)
        k_0.
    corners, changes, signs : ndarray, shape (corners, n)
        d_i, k_i and sigma_i, 1 for a corner outwards of rest in positive, -1 in negative direction.
    """

    variables = 0
    swings = True

    def __init__(self, links: Links, slope: FloatArray, corners: FloatArray, changes: FloatArray, signs: FloatArray) -> None:
        self.links, self._slope, self._corners, self._changes, self._signs = links, slope, corners, changes, signs

    def force(self, after: FloatArray, before: FloatArray, state: FloatArray) -> StepForce:
        """Return h = k_0 (D_1 + D_0)/2 + sum_i k_i sigma_i <x_i>, <x> the mean of x over the step, and its slope."""
        mean, slope = mean_beyond(self._beyond(after), self._beyond(before), self._signs * (after - before))
        value = 0.5 * self._slope * (after + before) + (self._changes * self._signs * mean).sum(axis=0)
        return StepForce(value, 0.5 * self._slope + (self._changes * slope).sum(axis=0))

    def advance(self, after: FloatArray, before: FloatArray, state: FloatArray) -> FloatArray:
        """Return the state: there is none."""
        return state

    def stored(self, stretch: FloatArray, state: FloatArray) -> FloatArray:
        """Return V = k_0 D^2/2 + sum_i k_i x_i^2/2."""
        beyond = np.maximum(self._beyond(stretch), 0.0)
        return np.asarray(0.5 * (self._slope * stretch**2 + (self._changes * beyond**2).sum(axis=0)))

    def slopes(self, after: FloatArray, before: FloatArray, state: FloatArray) -> LawSlopes:
        """Return the slopes of h, which is the same if D_1 and D_0 change places."""
        return LawSlopes.of_stretch(self.force(after, before, state).slope, self.force(before, after, state).slope)

    def _beyond(self, stretch: FloatArray) -> FloatArray:
        return np.asarray(self._signs * (stretch - self._corners))


def mean_beyond(after: FloatArray, before: FloatArray, change: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the mean of max(y, 0) while y goes from *before* to *after* at an even rate, and its slope in *after*.

    (y_1+^2 - y_0+^2)/(2 (y_1 - y_0)), ``change`` being y_1 - y_0 without the rounding of large y.
    """
    end, start = np.maximum(after, 0.0), np.maximum(before, 0.0)
    inside = np.minimum(after, before) >= 0.0
    crossing = ~inside & (np.maximum(after, before) > 0.0) & (change != 0.0)
    through = np.where(crossing, change, 1.0)
    mean = 0.5 * (end + start) * np.where(crossing, (end - start) / through, 1.0)
    turning = (end - mean) / through
    return mean, np.where(crossing, turning, np.where(inside, 0.5, 0.0))
