"""Linear laws: springs with dampers, viscoelastic branches and inerters; marched beside others, or known at every Laplace node."""

from __future__ import annotations

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.solver.links.law import LawSlopes, Links, StepForce


class SpringDampers:
    """f = k D + c dD/dt.

    Parameters
    ----------
    links : ndarray of int, shape (n,)
    stiffness, damping : ndarray, shape (n,)
        k and c.
    time_step : float
    """

    variables = 0
    swings = False

    def __init__(self, links: Links, stiffness: FloatArray, damping: FloatArray, time_step: float) -> None:
        self.links, self._stiffness, self._damping, self._step = links, stiffness, damping, time_step

    def force(self, after: FloatArray, before: FloatArray, state: FloatArray) -> StepForce:
        """Return h = k (D_1 + D_0)/2 + c (D_1 - D_0)/dt and its slope."""
        viscous = self._damping / self._step
        return StepForce(0.5 * self._stiffness * (after + before) + viscous * (after - before), 0.5 * self._stiffness + viscous)

    def advance(self, after: FloatArray, before: FloatArray, state: FloatArray) -> FloatArray:
        """Return the state: there is none."""
        return state

    def stored(self, stretch: FloatArray, state: FloatArray) -> FloatArray:
        """Return k D^2/2."""
        return np.asarray(0.5 * self._stiffness * stretch**2)

    def slopes(self, after: FloatArray, before: FloatArray, state: FloatArray) -> LawSlopes:
        """Return the slopes of h."""
        elastic, viscous = 0.5 * self._stiffness + np.zeros_like(after), self._damping / self._step
        return LawSlopes.of_stretch(elastic + viscous, elastic - viscous)

    def impedance(self, s: ComplexArray) -> ComplexArray:
        """Return k + c s."""
        return np.asarray(self._stiffness + self._damping * s[:, None])


class MaxwellBranches:
    """A spring k in series with a damper k tau: dF/dt + F/tau = k dD/dt.

    With theta = dt/(2 tau), F_1 = [(1 - theta) F_0 + k (D_1 - D_0)]/(1 + theta) and h = (F_1 + F_0)/2, for which

        h (D_1 - D_0) = (F_1^2 - F_0^2)/(2 k) + dt h^2/(k tau).

    Parameters
    ----------
    links : ndarray of int, shape (n,)
    stiffness, relaxation_time : ndarray, shape (n,)
        k and tau.
    time_step : float
    """

    variables = 1
    """F, the force of the branch."""
    swings = True

    def __init__(self, links: Links, stiffness: FloatArray, relaxation_time: FloatArray, time_step: float) -> None:
        self.links, self._stiffness, self._time = links, stiffness, relaxation_time
        self._theta = 0.5 * time_step / relaxation_time

    def force(self, after: FloatArray, before: FloatArray, state: FloatArray) -> StepForce:
        """Return h and its slope, k/(2 (1 + theta))."""
        slope = 0.5 * self._stiffness / (1.0 + self._theta)
        return StepForce(0.5 * (self.advance(after, before, state)[0] + state[0]), slope)

    def advance(self, after: FloatArray, before: FloatArray, state: FloatArray) -> FloatArray:
        """Return F_1."""
        return ((1.0 - self._theta) * state + self._stiffness * (after - before)) / (1.0 + self._theta)

    def stored(self, stretch: FloatArray, state: FloatArray) -> FloatArray:
        """Return F^2/(2 k)."""
        return np.asarray(0.5 * state[0] ** 2 / self._stiffness)

    def slopes(self, after: FloatArray, before: FloatArray, state: FloatArray) -> LawSlopes:
        """Return the slopes of h and F_1, both linear."""
        rise = self._stiffness / (1.0 + self._theta) + np.zeros_like(after)
        kept = (1.0 - self._theta) / (1.0 + self._theta) + np.zeros_like(after)
        return LawSlopes(0.5 * rise, -0.5 * rise, 0.5 * (1.0 + kept)[None], rise[None], -rise[None], kept[None, None])

    def impedance(self, s: ComplexArray) -> ComplexArray:
        """Return k s tau/(1 + s tau)."""
        turns = self._time * s[:, None]
        return np.asarray(self._stiffness * turns / (1.0 + turns))


class Inerters:
    """f = b d^2D/dt^2: h = b (3 r_2 - 4 r_1 + r_0)/(2 dt), r the rates (D_1 - D_0)/dt over this step and the two before it.

    It stores b [r_2^2 + (2 r_2 - r_1)^2]/4, b r^2/2 at the end of the step, and loses b (r_2 - 2 r_1 + r_0)^2/4 to the step. A rule that
    loses nothing would leave the force swinging from step to step after each jump of a wall's velocity.

    Parameters
    ----------
    links : ndarray of int, shape (n,)
    inertance : ndarray, shape (n,)
        b.
    time_step : float
    """

    variables = 2
    """r of the last two steps."""
    swings = False

    def __init__(self, links: Links, inertance: FloatArray, time_step: float) -> None:
        self.links, self._inertance, self._step = links, inertance, time_step

    def force(self, after: FloatArray, before: FloatArray, state: FloatArray) -> StepForce:
        """Return h and its slope, 3 b/(2 dt^2)."""
        rate = (after - before) / self._step
        share = 0.5 * self._inertance / self._step
        return StepForce(share * (3.0 * rate - 4.0 * state[0] + state[1]), 3.0 * share / self._step)

    def advance(self, after: FloatArray, before: FloatArray, state: FloatArray) -> FloatArray:
        """Return the rates of this step and the one before."""
        return np.stack([(after - before) / self._step, state[0]])

    def stored(self, stretch: FloatArray, state: FloatArray) -> FloatArray:
        """Return b [r_2^2 + (2 r_2 - r_1)^2]/4."""
        return np.asarray(0.25 * self._inertance * (state[0] ** 2 + (2.0 * state[0] - state[1]) ** 2))

    def slopes(self, after: FloatArray, before: FloatArray, state: FloatArray) -> LawSlopes:
        """Return the slopes of h and of the rates, all linear."""
        share = 0.5 * self._inertance / self._step + np.zeros_like(after)
        rate, nothing = np.full_like(after, 1.0 / self._step), np.zeros_like(after)
        of_rates = np.stack([[nothing, nothing], [nothing + 1.0, nothing]])
        moved = np.stack([rate, nothing])
        rise = 3.0 * share / self._step
        return LawSlopes(rise, -rise, np.stack([-4.0 * share, share]), moved, -moved, of_rates)

    def impedance(self, s: ComplexArray) -> ComplexArray:
        """Return b s^2."""
        return np.asarray(self._inertance * s[:, None] ** 2)
