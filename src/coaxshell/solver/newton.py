"""One implicit step of the absorbers' force law, by Newton's method on all interface forces at once.

With the trapezoidal rule everything at the new instant is linear in the forces f and mass velocities u, but the law itself:

    v = v_excited + K f,   w = w_known + (dt/2) v_f,   q = q_known + (dt/2) u,   (2 m/dt)(u - u_old) + S + S_old = 0,
    r = f - law(q - w, u - v) = 0,                                     S = f_0 + f_1 (the force on the mass is -S).

The Jacobian changes little from step to step where damping and linear stiffness dominate, so its inverse is kept until the
iteration slows down. A massless absorber has S = 0 at every instant instead of the balance between two.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from coaxshell.acoustics.operators import FloatArray
from coaxshell.errors import InputError
from coaxshell.solver.absorbers import AbsorberSet

_TOLERANCE = 1e-11
_MAX_ITERATIONS = 60
_FEW_ITERATIONS = 3
_EPSILON = 1e-15
_REFRESH_RATE = 0.1
"""The Jacobian is renewed when an iteration gains less than a factor of ten."""


@dataclass
class StepState:
    """All that one step hands to the next; forces and velocities at the points have shape (2, N): side, absorber."""

    force: FloatArray
    previous_force: FloatArray
    forced_displacement: FloatArray
    forced_velocity: FloatArray
    mass_displacement: FloatArray
    mass_velocity: FloatArray

    @classmethod
    def at_rest(cls, count: int) -> StepState:
        """Return the state before the shock."""
        pair = (2, count)
        return cls(np.zeros(pair), np.zeros(pair), np.zeros(pair), np.zeros(pair), np.zeros(count), np.zeros(count))

    def copy(self) -> StepState:
        """Return a state that a step may change without changing this one; steps replace arrays, so sharing them is safe."""
        return replace(self)


class InterfaceNewton:
    """Newton's method for the interface forces of one step.

    Parameters
    ----------
    absorbers : AbsorberSet
    compliance : ndarray, shape (2N, 2N)
        K: velocities at the interface points per force there within the same step.
    time_step : float
    """

    def __init__(self, absorbers: AbsorberSet, compliance: FloatArray, time_step: float) -> None:
        self._compliance, self._half_step = compliance, 0.5 * time_step
        self._count = absorbers.count
        self._inertia = 2.0 * absorbers.mass / time_step
        heavy = self._inertia > 0
        self._carry = np.where(heavy, 1.0, 0.0)
        self._mobility = np.where(heavy, 1.0 / np.where(heavy, self._inertia, 1.0), 0.0)
        self._keep_massless = np.where(heavy, 0.0, 1.0)
        self._damping, self._linear, self._cubic = absorbers.damping, absorbers.linear, absorbers.cubic
        self._rate = 0.0
        self._renew(np.tile(self._damping + self._half_step * self._linear, 2))

    def _renew(self, tangent: FloatArray) -> None:
        """Invert the Jacobian of (r, mass balance) in (f, u) for tangents d law/d(u - v)."""
        n = self._count
        pairs = np.tile(np.eye(n), (2, 1))
        jacobian = np.zeros((3 * n, 3 * n))
        jacobian[: 2 * n, : 2 * n] = np.eye(2 * n) + tangent[:, None] * self._compliance
        jacobian[: 2 * n, 2 * n :] = -tangent[:, None] * pairs
        jacobian[2 * n :, : 2 * n] = pairs.T
        jacobian[2 * n :, 2 * n :] = np.diag(self._inertia)
        self._inverse = np.linalg.inv(jacobian)[:, : 2 * n].copy()
        self._rate = 0.0

    def step(self, state: StepState, excited: FloatArray, linear_displacement: FloatArray, linear_velocity: FloatArray) -> int:
        """Advance the state by one step in place and return the iterations used.

        Parameters
        ----------
        state : StepState
        excited : ndarray, shape (2, N)
            Velocities at the points from all earlier forces.
        linear_displacement, linear_velocity : ndarray, shape (2, N)
            w and dw/dt at the points without absorbers, at the new instant.

        Raises
        ------
        InputError
            If the iteration does not converge at this time step.
        """
        n, half = self._count, self._half_step
        known_w = linear_displacement + state.forced_displacement + half * state.forced_velocity
        known_q = state.mass_displacement + half * state.mass_velocity
        force = 2.0 * state.force - state.previous_force
        balance = self._inertia * state.mass_velocity - self._carry * state.force.sum(axis=0)
        velocity = self._mobility * (balance - force.sum(axis=0)) + self._keep_massless * state.mass_velocity
        forced = excited + (self._compliance @ force.ravel()).reshape(2, n)
        last = np.inf
        for iteration in range(1, _MAX_ITERATIONS + 1):
            stretch = (known_q + half * velocity) - (known_w + half * forced)
            square = self._cubic * stretch * stretch
            residual = force - (self._damping * (velocity - linear_velocity - forced) + (self._linear + square) * stretch)
            size = float(np.abs(residual).max())
            renewed = False
            if last < np.inf:
                self._rate = max(self._rate, size / last) if size < last else 1.0
                if self._rate > _REFRESH_RATE:
                    self._renew((self._damping + half * (self._linear + 3.0 * square)).ravel())
                    renewed = True
            last = size
            change = self._inverse @ residual.ravel()
            force = force - change[: 2 * n].reshape(2, n)
            velocity = velocity - change[2 * n :]
            forced = excited + (self._compliance @ force.ravel()).reshape(2, n)
            # The error left after this correction is at most the measured rate times the residual it removed.
            if iteration > 1 and not renewed and size * self._rate <= _TOLERANCE * float(np.abs(force).max()):
                break
            if iteration > _FEW_ITERATIONS and size <= self._rounding(force, velocity, known_q, known_w, linear_velocity, forced):
                break
        else:
            raise InputError(
                "time_step",
                f"{2 * half:g} is too coarse for the absorbers: their forces did not converge in {_MAX_ITERATIONS} iterations",
                f"use time_step = {half / 2:g} or refinement = 4",
            )
        state.forced_displacement = state.forced_displacement + half * (state.forced_velocity + forced)
        state.forced_velocity = forced
        state.mass_displacement, state.mass_velocity = known_q + half * velocity, velocity
        state.previous_force, state.force = state.force, force
        return iteration

    def _rounding(
        self,
        force: FloatArray,
        velocity: FloatArray,
        known_q: FloatArray,
        known_w: FloatArray,
        linear_velocity: FloatArray,
        forced: FloatArray,
    ) -> float:
        """Return the residual that rounding alone leaves: terms of the law may be far larger than their sum."""
        half = self._half_step
        reach = np.abs(known_q + half * velocity) + np.abs(known_w + half * forced)
        rates = self._damping * (np.abs(velocity) + np.abs(linear_velocity) + np.abs(forced))
        springs = (self._linear + 3.0 * self._cubic * reach**2) * reach
        return _EPSILON * float((rates + springs + np.abs(force)).max())
