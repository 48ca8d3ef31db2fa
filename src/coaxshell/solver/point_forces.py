"""What part of a line force each order gets."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from coaxshell.acoustics.basis import Modes
from coaxshell.numerics.arrays import FloatArray

if TYPE_CHECKING:
    from coaxshell.solver.interface.absorbers import AbsorberSet

    PointForceShares = Callable[[AbsorberSet, Modes], FloatArray]
    """From absorbers and modes to each order's share of a line force on a circle of radius 1, shape (parities, N, M + 1)."""


def point_force_shares(absorbers: AbsorberSet, modes: Modes) -> FloatArray:
    """Return cos(m theta_n)/(beta pi), sin for the sines, for an absorber that stands for two twice as much: (parities, N, M + 1)."""
    beta_pi = np.pi * np.where(modes.orders == 0, 2.0, 1.0)
    shares: FloatArray = absorbers.shapes(modes) * absorbers.multiplicity[:, None] / beta_pi
    return shares
