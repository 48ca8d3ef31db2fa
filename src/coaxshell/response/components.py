"""The components of the stress of walls: of a thin one, which has none across it, and of solids in a plane problem."""

from __future__ import annotations

import numpy as np

from coaxshell.numerics.arrays import FloatArray

STRESSES = ("hoop", "axial", "shear")
"""Components of the stress of a thin wall; two dimensions have no shear between hoop and axis."""
SOLID = ("radial", "hoop", "axial", "radial_hoop")
"""Components of the stress of a solid where nothing changes along the axis: the shears with it vanish."""
SIDES = {
    "hoop": "normal",
    "axial": "normal",
    "shear": "tangential",
    "radial": "normal",
    "radial_axial": "normal",
    "radial_hoop": "tangential",
}
"""What all stresses of walls go with around the shell."""
WORDS = {"von_mises": "von Mises", "radial_hoop": "radial-hoop shear", "radial_axial": "radial-axial shear"}
"""Names of components as a text says them, where that is another word."""


def component_words(component: str) -> str:
    """Return the name of a component of the stress as a text says it: "von Mises" for "von_mises"."""
    return WORDS.get(component, component)


def von_mises(hoop: FloatArray, axial: FloatArray, shear: FloatArray | float = 0.0) -> FloatArray:
    """Return sqrt(hoop^2 + axial^2 - hoop axial + 3 shear^2), of a wall without stress across it."""
    return np.asarray(np.sqrt(np.maximum(hoop**2 + axial**2 - hoop * axial + 3.0 * shear**2, 0.0)))


def solid_von_mises(
    radial: FloatArray,
    hoop: FloatArray,
    axial: FloatArray,
    radial_hoop: FloatArray,
    shear: FloatArray | float = 0.0,
    radial_axial: FloatArray | float = 0.0,
) -> FloatArray:
    """Return sqrt(((s_r - s_t)^2 + (s_t - s_z)^2 + (s_z - s_r)^2)/2 + 3 (shears squared)) of a solid; a plane problem has one shear."""
    squares = (radial - hoop) ** 2 + (hoop - axial) ** 2 + (axial - radial) ** 2
    return np.asarray(np.sqrt(0.5 * squares + 3.0 * (radial_hoop**2 + shear**2 + radial_axial**2)))
