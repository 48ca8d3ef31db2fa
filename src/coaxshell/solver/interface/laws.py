"""What nonlinear laws add to the linear ones at the interface: cubic springs, and actuators that stop at their limit."""

from __future__ import annotations

import math

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.solver.interface.saturation import LimitedVoltages


class CubicSprings:
    """n(D) = k_nl D^3 - kappa D, kappa the stiffness that was lent to the linear problem.

    Parameters
    ----------
    cubic, auxiliary_stiffness : ndarray, shape (n,)
        k_nl and kappa of every link.
    """

    tolerance = 1e-11
    contraction_limit = 0.1
    most_iterations = 60

    def __init__(self, cubic: FloatArray, auxiliary_stiffness: FloatArray) -> None:
        self._cubic, self._auxiliary_stiffness = cubic, auxiliary_stiffness
        self._offset = auxiliary_stiffness.copy()

    def nonlinear_part(self, z: FloatArray) -> FloatArray:
        """Return n(D)."""
        return np.asarray((self._cubic * z * z - self._auxiliary_stiffness) * z)

    def linearise(self, z: FloatArray, response: FloatArray) -> FloatArray:
        """Keep T = 3 k_nl D^2, without the kappa that makes the tangent of a massless absorber singular at D = 0; return R T."""
        tangent = 3.0 * self._cubic * z * z
        self._offset = tangent + self._auxiliary_stiffness
        return np.asarray(response * tangent)

    def tangent_remainder(self, z: FloatArray) -> FloatArray:
        """Return n(D) - T D."""
        beyond = self._cubic * z
        beyond *= z
        beyond -= self._offset
        beyond *= z
        return beyond

    def relative(self, change: FloatArray, z: FloatArray) -> float:
        """Return |change|/|z|."""
        return relative_size(change, z)


class SpringsAndActuators:
    """Cubic springs first, then the voltages of limited actuators.

    Parameters
    ----------
    springs : CubicSprings
    links : int
        Links, 2N.
    voltages : LimitedVoltages
    """

    tolerance = 1e-10
    contraction_limit = 0.3
    """Renewal costs as much as many iterations here."""
    most_iterations = 12

    def __init__(self, springs: CubicSprings, links: int, voltages: LimitedVoltages) -> None:
        self._springs, self._links, self._voltages = springs, links, voltages

    def nonlinear_part(self, z: FloatArray) -> FloatArray:
        """Return both."""
        return np.concatenate([self._springs.nonlinear_part(z[: self._links]), self._voltages.nonlinear_part(z[self._links :])])

    def linearise(self, z: FloatArray, response: FloatArray) -> FloatArray:
        """Keep both tangents and return R T."""
        n = self._links
        springs = self._springs.linearise(z[:n], response[:, :n])
        return np.concatenate([springs, self._voltages.linearise(z[n:], response[:, n:])], axis=1)

    def tangent_remainder(self, z: FloatArray) -> FloatArray:
        """Return both."""
        return np.concatenate([self._springs.tangent_remainder(z[: self._links]), self._voltages.tangent_remainder(z[self._links :])])

    def relative(self, change: FloatArray, z: FloatArray) -> float:
        """Return the larger of the two relative changes."""
        n = self._links
        return max(relative_size(change[:n], z[:n]), relative_size(change[n:], z[n:]))


def relative_size(change: FloatArray, z: FloatArray) -> float:
    """Return |change|/|z|, 0 if nothing changes."""
    moved = float(change.dot(change))
    return math.sqrt(moved / max(float(z.dot(z)), 1e-300)) if moved > 0.0 else 0.0
