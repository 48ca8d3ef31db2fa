"""The components of the stress of a thin wall, which has none across it."""

from __future__ import annotations

import numpy as np

from coaxshell.numerics.arrays import FloatArray

STRESSES = ("hoop", "axial", "shear")
"""Components of the stress of a thin wall; two dimensions have no shear between hoop and axis."""
SIDES = {"hoop": "normal", "axial": "normal", "shear": "tangential"}
"""What they go with around the shell."""


def von_mises(hoop: FloatArray, axial: FloatArray, shear: FloatArray | float = 0.0) -> FloatArray:
    """Return sqrt(hoop^2 + axial^2 - hoop axial + 3 shear^2), of a wall without stress across it."""
    return np.asarray(np.sqrt(np.maximum(hoop**2 + axial**2 - hoop * axial + 3.0 * shear**2, 0.0)))
