"""What part of a line force each order gets."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

import numpy as np
import numpy.typing as npt

from coaxshell.acoustics.basis import Modes
from coaxshell.numerics.arrays import FloatArray


class PlacedForces(Protocol):
    """Places around a wall where line forces act, as a set of absorbers knows them."""

    @property
    def multiplicity(self) -> FloatArray:
        """2 for a place that stands for itself and its mirror image, else 1: shape (N,)."""
        ...

    def shapes(self, modes: Modes) -> FloatArray:
        """Return cos(m theta_n) and, with two parities, sin(m theta_n): shape (parities, N, M + 1)."""
        ...


def patch(argument: npt.ArrayLike) -> FloatArray:
    """Return sin(x)/x, the mean of cos over a patch of which x is half the phase."""
    return np.asarray(np.sinc(np.asarray(argument) / np.pi))


PointForceShares = Callable[[PlacedForces, Modes], FloatArray]
"""From places and modes to each order's share of a line force on a circle of radius 1, shape (parities, N, M + 1)."""


def point_force_shares(places: PlacedForces, modes: Modes) -> FloatArray:
    """Return cos(m theta_n)/(beta pi), sin for the sines, for a place that stands for two twice as much: (parities, N, M + 1)."""
    beta_pi = np.pi * np.where(modes.orders == 0, 2.0, 1.0)
    shares: FloatArray = places.shapes(modes) * places.multiplicity[:, None] / beta_pi
    return shares
