"""What nonlinear laws add to the linear ones at the interface: cubic springs, and actuators that stop at their limit.

A law is a set of constants. Its tangent is a value that it makes at some z and that is handed back to it.
"""

from __future__ import annotations

import math
from typing import Generic, NamedTuple, Protocol, TypeVar

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.solver.interface.saturation import LimitedVoltages

Tangent = TypeVar("Tangent")


class InterfaceLaw(Protocol, Generic[Tangent]):
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

    def linearise(self, z: FloatArray) -> Tangent:
        """Return the tangent T at z."""
        ...

    def times_tangent(self, response: FloatArray, tangent: Tangent) -> FloatArray:
        """Return R T."""
        ...

    def tangent_remainder(self, z: FloatArray, tangent: Tangent) -> FloatArray:
        """Return n(z) - T z."""
        ...

    def relative(self, change: FloatArray, z: FloatArray) -> float:
        """Return the size of a change of z relative to z."""
        ...


class SpringTangent(NamedTuple):
    """T = 3 k_nl D^2 of every link, and T + kappa, both of shape (n,)."""

    slope: FloatArray
    offset: FloatArray


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

    def nonlinear_part(self, z: FloatArray) -> FloatArray:
        """Return n(D)."""
        return np.asarray((self._cubic * z * z - self._auxiliary_stiffness) * z)

    def linearise(self, z: FloatArray) -> SpringTangent:
        """Return T = 3 k_nl D^2, without the kappa that makes the tangent of a massless absorber singular at D = 0."""
        slope = 3.0 * self._cubic * z * z
        return SpringTangent(slope, slope + self._auxiliary_stiffness)

    def times_tangent(self, response: FloatArray, tangent: SpringTangent) -> FloatArray:
        """Return R T."""
        return np.asarray(response * tangent.slope)

    def tangent_remainder(self, z: FloatArray, tangent: SpringTangent) -> FloatArray:
        """Return n(D) - T D."""
        beyond = self._cubic * z
        beyond *= z
        beyond -= tangent.offset
        beyond *= z
        return beyond

    def relative(self, change: FloatArray, z: FloatArray) -> float:
        """Return |change|/|z|."""
        return relative_size(change, z)


class SpringsAndActuators:
    """Cubic springs first, then the voltages of limited actuators; the tangent is that of the springs and where voltages are held.

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
        """Return n(D), then the voltages given."""
        return np.concatenate([self._springs.nonlinear_part(z[: self._links]), self._voltages.nonlinear_part(z[self._links :])])

    def linearise(self, z: FloatArray) -> tuple[SpringTangent, FloatArray]:
        """Return the tangents of springs and voltages."""
        return self._springs.linearise(z[: self._links]), self._voltages.linearise(z[self._links :])

    def times_tangent(self, response: FloatArray, tangent: tuple[SpringTangent, FloatArray]) -> FloatArray:
        """Return R T."""
        n = self._links
        springs = self._springs.times_tangent(response[:, :n], tangent[0])
        return np.concatenate([springs, self._voltages.times_tangent(response[:, n:], tangent[1])], axis=1)

    def tangent_remainder(self, z: FloatArray, tangent: tuple[SpringTangent, FloatArray]) -> FloatArray:
        """Return n(z) - T z."""
        springs = self._springs.tangent_remainder(z[: self._links], tangent[0])
        return np.concatenate([springs, self._voltages.tangent_remainder(z[self._links :], tangent[1])])

    def relative(self, change: FloatArray, z: FloatArray) -> float:
        """Return the larger of the two relative changes."""
        n = self._links
        return max(relative_size(change[:n], z[:n]), relative_size(change[n:], z[n:]))


def relative_size(change: FloatArray, z: FloatArray) -> float:
    """Return |change|/|z|, 0 if nothing changes."""
    moved = float(change.dot(change))
    return math.sqrt(moved / max(float(z.dot(z)), 1e-300)) if moved > 0.0 else 0.0
