"""Dry friction: smoothed, hysteretic, and exact."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.solver.links.law import Links, StepForce


class SmoothedFriction:
    """f = F tanh(r/v), r = dD/dt: creeps instead of sticking, at speeds small beside v.

    Parameters
    ----------
    links : ndarray of int, shape (n,)
    limit, speed : ndarray, shape (n,)
        F and v.
    time_step : float
    """

    variables = 0

    def __init__(self, links: Links, limit: FloatArray, speed: FloatArray, time_step: float) -> None:
        self.links, self._limit, self._travel = links, limit, speed * time_step

    def force(self, after: FloatArray, before: FloatArray, state: FloatArray) -> StepForce:
        """Return h and its slope."""
        share = np.tanh((after - before) / self._travel)
        return StepForce(self._limit * share, self._limit * (1.0 - share**2) / self._travel)

    def advance(self, after: FloatArray, before: FloatArray, state: FloatArray) -> FloatArray:
        """Return the state: there is none."""
        return state

    def stored(self, stretch: FloatArray, state: FloatArray) -> FloatArray:
        """Return 0."""
        return np.zeros_like(stretch)


class HystereticFriction:
    """A spring k in series with a slider that yields at F (Jenkins element): F_1 = clip(F_0 + k (D_1 - D_0), -F, F), h = (F_1 + F_0)/2.

    It stores F_1^2/(2 k); the slider moves by D_1 - D_0 - (F_1 - F_0)/k and turns h times that into heat, which is never negative.

    Parameters
    ----------
    links : ndarray of int, shape (n,)
    limit, stiffness : ndarray, shape (n,)
        F and k.
    """

    variables = 1
    """The force of the spring."""

    def __init__(self, links: Links, limit: FloatArray, stiffness: FloatArray) -> None:
        self.links, self._limit, self._stiffness = links, limit, stiffness

    def force(self, after: FloatArray, before: FloatArray, state: FloatArray) -> StepForce:
        """Return h and its slope, k/2 where the slider holds."""
        tried = state[0] + self._stiffness * (after - before)
        holds = np.abs(tried) < self._limit
        held = np.clip(tried, -self._limit, self._limit)
        return StepForce(0.5 * (held + state[0]), np.where(holds, 0.5 * self._stiffness, 0.0))

    def advance(self, after: FloatArray, before: FloatArray, state: FloatArray) -> FloatArray:
        """Return F_1."""
        return np.clip(state + self._stiffness * (after - before), -self._limit, self._limit)

    def stored(self, stretch: FloatArray, state: FloatArray) -> FloatArray:
        """Return F_1^2/(2 k)."""
        return np.asarray(0.5 * state[0] ** 2 / self._stiffness)


class Sliders(NamedTuple):
    """Exact dry friction, a force that is a set while nothing slips: y = F sign(r) while it slips, |y| <= F_s while it sticks.

    There is no function from the motion to y: the implicit step finds both (:mod:`coaxshell.solver.links.step`). Over a step the rate
    is D_1 - D_0, so that y (D_1 - D_0) = F |D_1 - D_0| is heat. A mass that comes to stick within a step swings about rest from step to
    step, by F dt/(2 m) at most: F_s > F bounds the mean of y over two steps, from which that falls out.

    Attributes
    ----------
    links : ndarray of int, shape (n,)
        At most one slider a link.
    kinetic, static : ndarray, shape (n,)
        F and F_s >= F; F_s holds over a step before which the slider stuck.
    """

    links: Links
    kinetic: FloatArray
    static: FloatArray

    def bounds(self, stuck: FloatArray, last: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the smallest and the largest friction over a step.

        Parameters
        ----------
        stuck : ndarray, shape (n,)
            1 where nothing slipped over the step before, else 0.
        last : ndarray, shape (n,)
            The friction over the step before.
        """
        held = (stuck > 0.0) & (self.static > self.kinetic)
        low = np.where(held, np.minimum(-2.0 * self.static - last, 0.0), -self.kinetic)
        return low, np.where(held, np.maximum(2.0 * self.static - last, 0.0), self.kinetic)
