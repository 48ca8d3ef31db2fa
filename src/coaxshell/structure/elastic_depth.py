"""What the shapes of a wall of solid layers show at a depth: displacements, stresses, the potential of a ceramic, per unit of each shape.

Displacements have the signs of all walls, W = -u_r inward, V = u_theta, U = u_z. Stresses are C eps - e'E with the field
E = (-Phi', (m/r) Phi, k Phi) of the layer's condensed potential; the layer is that which the caller names, as stresses along a wall jump
from one to the next.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby
from typing import Literal

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.lobatto import interpolation
from coaxshell.structure.elastic_basis import OrdersBasis, displacements
from coaxshell.structure.elastic_mesh import LayerMesh, strains
from coaxshell.structure.solid import AXIAL, HOOP, HOOP_AXIAL, RADIAL, RADIAL_AXIAL, RADIAL_HOOP

Shown = Literal[
    "normal", "tangential", "along_axis", "radial", "hoop", "axial", "shear", "radial_axial", "radial_hoop", "potential"
]  # fmt: skip
"""Displacements, stresses (``shear`` is that between hoop and axis, as of thin walls) and the potential."""

DISPLACEMENTS: dict[str, tuple[int, float]] = {"normal": (0, -1.0), "tangential": (1, 1.0), "along_axis": (2, 1.0)}
"""Place among (u_r, u_theta, u_z), and sign."""

STRESSES = {
    "radial": RADIAL,
    "hoop": HOOP,
    "axial": AXIAL,
    "shear": HOOP_AXIAL,
    "radial_axial": RADIAL_AXIAL,
    "radial_hoop": RADIAL_HOOP,
}  # fmt: skip
"""Components of the stress by their names."""

ALL_SHOWN = (*DISPLACEMENTS, *STRESSES)
"""What :func:`all_by_shapes` gives, in its order."""

SIDES: dict[str, str] = {
    name: "tangential" if name in ("tangential", "shear", "radial_hoop") else "normal" for name in (*DISPLACEMENTS, *STRESSES, "potential")
}
"""Whether a quantity goes around as w does or as v."""


def shown_by_shapes(basis: OrdersBasis, number: int, radius: float, what: Shown) -> FloatArray:
    """Return a quantity at a radius of a layer per unit of each shape, shape (orders, shapes).

    Parameters
    ----------
    basis : OrdersBasis
    number : int
        Of the layer, from the inside out.
    radius : float
    what : str
        The potential only of a piezoelectric layer.
    """
    part, at = place_in_layer(basis, number, radius)
    shapes = basis.shapes[..., part.nodes]
    if what in DISPLACEMENTS:
        which, sign = DISPLACEMENTS[what]
        if which >= shapes.shape[2]:
            return np.zeros(shapes.shape[:2])
        return np.asarray(sign * (shapes[:, :, which] @ at))
    rows = potential_rows(basis, part, at) if what == "potential" else stress_rows(basis, part, radius, at, (STRESSES[what],))[:, 0]
    return np.asarray(np.einsum("mcp,mncp->mn", rows, shapes))


def all_by_shapes(basis: OrdersBasis, number: int, radius: float) -> FloatArray:
    """Return the three displacements and the six stresses at a radius of a layer per unit of each shape, shape (orders, 9, shapes).

    In the order of :data:`ALL_SHOWN`.
    """
    part, at = place_in_layer(basis, number, radius)
    shapes = basis.shapes[..., part.nodes]
    flat = shapes.reshape(*shapes.shape[:2], -1).swapaxes(1, 2)
    stresses = stress_rows(basis, part, radius, at, tuple(STRESSES.values()))
    found = np.zeros((shapes.shape[0], len(DISPLACEMENTS) + len(STRESSES), shapes.shape[1]))
    for row, (which, sign) in enumerate(DISPLACEMENTS.values()):
        if which < shapes.shape[2]:
            found[:, row] = sign * (shapes[:, :, which] @ at)
    found[:, len(DISPLACEMENTS) :] = stresses.reshape(*stresses.shape[:2], -1) @ flat
    return found


def several_by_shapes(basis: OrdersBasis, asked: Sequence[tuple[Shown, int, float]]) -> FloatArray:
    """Return quantities, each at a layer and a radius of it, per unit of each shape, shape (orders, quantities, shapes)."""
    if basis.wavenumber == 0.0 or any(what == "potential" for what, _, _ in asked):
        return np.stack([shown_by_shapes(basis, number, radius, what) for what, number, radius in asked], axis=1)
    found = []
    for (number, radius), some in groupby(asked, key=lambda one: one[1:]):  # along the axis all of a depth at once
        rows = all_by_shapes(basis, number, radius)
        found.append(rows[:, [ALL_SHOWN.index(what) for what, _, _ in some]])
    return np.concatenate(found, axis=1)


def place_in_layer(basis: OrdersBasis, number: int, radius: float) -> tuple[LayerMesh, FloatArray]:
    """Return the points of a layer, and what makes of values at them the value at a radius."""
    part = basis.mesh.layers[number]
    place = 2.0 * (radius - part.layer.inner) / part.layer.thickness - 1.0
    return part, interpolation(part.degree, min(max(place, -1.0), 1.0))


def potential_rows(basis: OrdersBasis, part: LayerMesh, at: FloatArray) -> FloatArray:
    """Return the potential at a place per displacement at the points of a layer, shape (orders, displacements, points)."""
    values = basis.potentials[part]
    return np.asarray(np.einsum("q,mqcp->mcp", at, values))


def stress_rows(basis: OrdersBasis, part: LayerMesh, radius: float, at: FloatArray, components: tuple[int, ...]) -> FloatArray:
    """Return stresses at a place per displacement at the points of a layer, shape (orders, components, displacements, points).

    Parameters
    ----------
    basis : OrdersBasis
    part : LayerMesh
    radius : float
    at : ndarray, shape (points,)
        From values at the points to the value there.
    components : tuple of int
        Places among the stresses.
    """
    slope = at @ part.derivative
    local = strains(basis.orders, basis.wavenumber, np.array([radius]), slope[None], at[None])[:, :, 0, : displacements(basis.wavenumber)]
    found = np.stack([np.einsum("j,mjcp->mcp", part.layer.matrix[component], local) for component in components], axis=1)
    if part.layer.coupling is None:
        return found
    values = basis.potentials[part]
    phi, phi_slope = (np.einsum("q,mqcp->mcp", row, values) for row in (at, slope))
    per_radius = (basis.orders / radius)[:, None, None]
    for row, component in enumerate(components):
        e = np.array(part.layer.coupling)[:, component]
        found[:, row] = found[:, row] + e[0] * phi_slope - (e[1] * per_radius + e[2] * basis.wavenumber) * phi
    return found


def field_stress(basis: OrdersBasis, number: int, radius: float, what: Shown) -> FloatArray:
    """Return what the field of a piezoelectric layer adds to a stress per row of its potential, shape (orders, p - 1).

    Parameters
    ----------
    basis : OrdersBasis
    number : int
        Of the layer, from the inside out.
    radius : float
    what : str
        A stress.
    """
    part, at = place_in_layer(basis, number, radius)
    per_row = basis.ceramics[part].per_row
    phi, slope = (np.einsum("q,mqi->mi", row, per_row) for row in (at, at @ part.derivative))
    e = np.array(part.layer.coupling)[:, STRESSES[what]]
    along = (e[1] * basis.orders / radius + e[2] * basis.wavenumber)[:, None]
    return np.asarray(e[0] * slope - along * phi)
