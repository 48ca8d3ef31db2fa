"""Dry friction: smoothed, hysteretic, and exact."""

from __future__ import annotations

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.solver.links.law import LawSlopes, Links, StepForce


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
    swings = False

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

    def slopes(self, after: FloatArray, before: FloatArray, state: FloatArray) -> LawSlopes:
        """Return the slopes of h."""
        rise = self.force(after, before, state).slope
        return LawSlopes.of_stretch(rise, -rise)


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
    swings = True

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

    def slopes(self, after: FloatArray, before: FloatArray, state: FloatArray) -> LawSlopes:
        """Return the slopes of h and F_1: of a spring where the slider holds."""
        held = (np.abs(state[0] + self._stiffness * (after - before)) < self._limit).astype(np.float64)
        rise = self._stiffness * held
        return LawSlopes(0.5 * rise, -0.5 * rise, 0.5 * (1.0 + held)[None], rise[None], -rise[None], held[None, None])


class DryFriction:
    """f = F sign(r) while it slides, |f| <= F_s while it sticks: h = clip(h_0 + (D_1 - D_0)/(2 A), -F, F), h_0 that of the step before.

    The law of the set F Sgn(r) by proximal steps: A is the compliance of the link within a step, by which h takes back 2 A h of D_1, so
    that a sticking end creeps by 2 A F at most, F dt^2/(2 m) of a mass m, of second order in dt. A constraint D_1 = D_0 would be met
    exactly but leave a mass that comes to stick swinging about rest from step to step for ever; so h forgets it within one. Where the
    step before slipped, F bounds h, else F_s. It stores A h^2 and turns all else into heat, never less than none.

    Parameters
    ----------
    links : ndarray of int, shape (n,)
    kinetic, static : ndarray, shape (n,)
        F and F_s >= F.
    compliance : ndarray, shape (n,)
        A.
    """

    variables = 2
    """h of the step before, and 1 where it slipped."""
    swings = False

    def __init__(self, links: Links, kinetic: FloatArray, static: FloatArray, compliance: FloatArray) -> None:
        self.links, self._kinetic, self._static = links, kinetic, static
        self._stiffness = 0.5 / compliance

    def force(self, after: FloatArray, before: FloatArray, state: FloatArray) -> StepForce:
        """Return h and its slope."""
        tried, limit = self._tried(after, before, state)
        return StepForce(np.clip(tried, -limit, limit), np.where(np.abs(tried) < limit, self._stiffness, 0.0))

    def advance(self, after: FloatArray, before: FloatArray, state: FloatArray) -> FloatArray:
        """Return h, and where it slipped."""
        tried, limit = self._tried(after, before, state)
        return np.stack([np.clip(tried, -limit, limit), np.where(np.abs(tried) < limit, 0.0, 1.0)])

    def stored(self, stretch: FloatArray, state: FloatArray) -> FloatArray:
        """Return A h^2."""
        return np.asarray(0.5 * state[0] ** 2 / self._stiffness)

    def slopes(self, after: FloatArray, before: FloatArray, state: FloatArray) -> None:
        """Return None: whether it sticks is no smooth matter, and how it creeps belongs to the step."""
        return

    def _tried(self, after: FloatArray, before: FloatArray, state: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the force that would stick, and the largest there is."""
        limit = np.where(state[1] > 0.0, self._kinetic, self._static)
        return state[0] + self._stiffness * (after - before), limit
