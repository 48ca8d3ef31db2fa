"""Stiffness of a layered wall in its plane, as a wall that changes along its axis needs it.

In a layer sigma_r = 0, so that with 1 along the axis, 2 along the hoop and 6 their shear

    sigma_z = Q11 eps_z + Q12 eps_theta,      sigma_theta = Q12 eps_z + Q22 eps_theta,      tau = Q66 gamma.

Elastic layers have Q11 = Q22 = E/(1 - nu^2), Q12 = nu Q11 and Q66 = E/(2 (1 + nu)); piezoelectric ones, poled along the radius,
c11 - c13^2/c33, c12 - c13 c23/c33, c22 - c23^2/c33 and c66. A plane problem needs Q22 alone (Eq. A.11).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from coaxshell.errors import InputError
from coaxshell.model.layers import Shell
from coaxshell.model.materials import Material, Piezoelectric
from coaxshell.numerics.arrays import FloatArray

AXIAL_CONSTANTS = ("c11", "c12", "c13", "c66", "e31", "permittivity_11")
"""Constants of a piezoelectric material without which a wall can only be computed in two dimensions."""


class PlaneStiffness(NamedTuple):
    """Stiffness in the plane of a wall, of a layer (Pa) or of an integral over layers."""

    q11: float
    q12: float
    q22: float
    q66: float

    @property
    def matrix(self) -> FloatArray:
        """Return it on (eps_z, eps_theta, gamma), shape (3, 3)."""
        return np.array([[self.q11, self.q12, 0.0], [self.q12, self.q22, 0.0], [0.0, 0.0, self.q66]])

    def times(self, factor: float) -> PlaneStiffness:
        """Return it times a factor."""
        return PlaneStiffness(*(factor * q for q in self))


@dataclass(frozen=True)
class Laminate:
    """Stiffness of a wall in its plane, SI or in units of their own (:meth:`in_units`).

    Attributes
    ----------
    moments : tuple of PlaneStiffness
        Integrals of Q (1, z, z^2) dz in N/m, N, N m, z outward from the mid-surface.
    core : PlaneStiffness
        Q of the core, Pa.
    layers : tuple of PlaneStiffness
        Q of every layer, Pa, from the inside out.
    """

    moments: tuple[PlaneStiffness, PlaneStiffness, PlaneStiffness]
    core: PlaneStiffness
    layers: tuple[PlaneStiffness, ...]

    def in_units(self, length: float, pressure: float) -> Laminate:
        """Return the laminate of SI values in units of a length (m) and a pressure (Pa)."""
        membrane, cross, bending = (each.times(1.0 / (pressure * length**n)) for n, each in enumerate(self.moments, start=1))
        layers = tuple(each.times(1.0 / pressure) for each in self.layers)
        return Laminate((membrane, cross, bending), self.core.times(1.0 / pressure), layers)


def missing_constants(material: Material) -> list[str]:
    """Return the names of the constants that a material lacks in three dimensions."""
    return [name for name in AXIAL_CONSTANTS if getattr(material, name) is None] if isinstance(material, Piezoelectric) else []


def require_axial_constants(shell: Shell, where: str) -> None:
    """Raise InputError if a material of a shell lacks constants that three dimensions need, or is unstable with them.

    Parameters
    ----------
    shell : Shell
    where : str
        Its path, such as ``"shells[0]"``.
    """
    for i, layer in enumerate(shell.layers):
        path, missing = f"{where}.layers[{i}].material", missing_constants(layer.material)
        if missing:
            raise InputError(
                f"{path}.{missing[0]}",
                f"{layer.material.name} has no {', '.join(missing)}",
                "give them: a wall in three dimensions needs them",
            )
        if np.linalg.eigvalsh(plane_stiffness(layer.material).matrix)[0] <= 0.0:
            remedy = "Q of c11 - c13^2/c33, c12 - c13 c23/c33, c22 - c23^2/c33 and c66 must be positive definite"
            raise InputError(f"{path}.c11", f"the constants of {layer.material.name} make it unstable along the axis", remedy)


def plane_stiffness(material: Material) -> PlaneStiffness:
    """Return Q of a material, Pa; a piezoelectric one must have its axial constants."""
    if not isinstance(material, Piezoelectric):
        modulus, ratio = material.youngs_modulus, material.poisson_ratio
        plane = modulus / (1.0 - ratio**2)
        return PlaneStiffness(plane, ratio * plane, plane, modulus / (2.0 * (1.0 + ratio)))
    c11, c12, c13, c66 = material.c11, material.c12, material.c13, material.c66
    assert c11 is not None
    assert c12 is not None
    assert c13 is not None
    assert c66 is not None
    return PlaneStiffness(
        c11 - c13**2 / material.c33, c12 - c13 * material.c23 / material.c33, material.c22 - material.c23**2 / material.c33, c66
    )


def laminate(shell: Shell) -> Laminate | None:
    """Return the stiffness of a shell's layup in its plane; None if a material lacks constants for it."""
    if any(missing_constants(layer.material) for layer in shell.layers):
        return None
    bottom, layers = -shell.thickness / 2.0, []
    moments = np.zeros((3, 4))
    for layer in shell.layers:
        top, stiffness = bottom + layer.thickness, plane_stiffness(layer.material)
        moments += np.outer([(top**n - bottom**n) / n for n in (1, 2, 3)], stiffness)
        layers.append(stiffness)
        bottom = top
    moments[1, np.abs(moments[1]) < 1e-12 * np.abs(moments[0]) * shell.thickness] = 0.0  # a symmetric layup, up to rounding
    membrane, cross, bending = (PlaneStiffness(*map(float, row)) for row in moments)
    return Laminate((membrane, cross, bending), plane_stiffness(shell.core.material), tuple(layers))
