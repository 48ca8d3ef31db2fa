"""What a force law tells the march of the links; dimensionless throughout.

A step of length dt takes the stretch of a link from D_0 to D_1. A law exerts one force h over the step, such that

    h (D_1 - D_0) = E_1 - E_0 + Q,        Q >= 0,

E what it stores and Q what it turns into heat: a discrete gradient (Gonzalez 1996, J. Nonlinear Sci. 6, 449-467). Walls and masses are
stepped by the midpoint rule, for which h is the force and (D_1 - D_0)/dt the rate: the energy of the whole is kept at any step.
"""

from __future__ import annotations

from typing import NamedTuple, Protocol

import numpy as np
import numpy.typing as npt

from coaxshell.numerics.arrays import ComplexArray, FloatArray

Links = npt.NDArray[np.int64]
Truths = npt.NDArray[np.bool_]


class StepForce(NamedTuple):
    """Force h of every link over a step, and its slope dh/dD_1; both of shape (n,)."""

    value: FloatArray
    slope: FloatArray


class LawSlopes(NamedTuple):
    """What a law does with small changes of D_1, D_0 and of its v internal variables: of h, and of the variables after the step.

    Attributes
    ----------
    after, before : ndarray, shape (n,)
        dh/dD_1 and dh/dD_0.
    state : ndarray, shape (v, n)
        dh by each internal variable.
    state_after, state_before : ndarray, shape (v, n)
        Of the variables after the step, by D_1 and D_0.
    state_state : ndarray, shape (v, v, n)
        The same by the variables before it.
    """

    after: FloatArray
    before: FloatArray
    state: FloatArray
    state_after: FloatArray
    state_before: FloatArray
    state_state: FloatArray

    @classmethod
    def of_stretch(cls, after: FloatArray, before: FloatArray) -> LawSlopes:
        """Return those of a law that remembers nothing."""
        nothing = np.zeros((0, *after.shape))
        return cls(after, before, nothing, nothing, nothing, np.zeros((0, 0, *after.shape)))


class LinkLaw(Protocol):
    """One kind of law of n links; constants only, what it remembers is handed to it."""

    links: Links
    """Numbers of the links that have it, shape (n,)."""
    variables: int
    """How many internal variables it remembers of each link."""
    swings: bool
    """Whether its slope is that of a spring, on which something swings that steps must resolve."""

    def force(self, after: FloatArray, before: FloatArray, state: FloatArray) -> StepForce:
        """Return h over a step.

        Parameters
        ----------
        after, before : ndarray, shape (n,)
            D_1 and D_0.
        state : ndarray, shape (variables, n)
            Internal variables before the step; 0 at rest.
        """
        ...

    def advance(self, after: FloatArray, before: FloatArray, state: FloatArray) -> FloatArray:
        """Return the internal variables after a step, of the shape of ``state``."""
        ...

    def stored(self, stretch: FloatArray, state: FloatArray) -> FloatArray:
        """Return the energy E of every link, shape (n,), of a stretch (n,) and internal variables."""
        ...

    def slopes(self, after: FloatArray, before: FloatArray, state: FloatArray) -> LawSlopes | None:
        """Return what small changes do, for runs backwards; None where a law has no slopes. Arguments as of :meth:`force`."""
        ...


class LinearLaw(LinkLaw, Protocol):
    """A law that is linear, and so known at every Laplace node."""

    def impedance(self, s: ComplexArray) -> ComplexArray:
        """Return force per stretch, shape (nodes, n), at nodes s (nodes,)."""
        ...
