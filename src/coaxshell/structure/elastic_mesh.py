"""Points through the thickness of a wall of solid layers, and what displacements at them make of the strains there.

Each layer is one spectral element of Gauss-Lobatto points, whose degree p resolves the waves of a run to 1e-6 (checked in the tests):

    p >= 4 + 0.6 t sqrt((omega/c_S)^2 + (m/r)^2 + k^2).

With (u_r, u_theta, u_z) of (cos m theta cos kz, sin m theta cos kz, cos m theta sin kz) the strains are

    eps_r = u_r',      eps_theta = (u_r + m u_theta)/r,      eps_z = k u_z,      gamma_theta_z = -k u_theta - m u_z/r,
    gamma_rz = u_z' - k u_r,      gamma_r_theta = u_theta' - u_theta/r - m u_r/r.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.lobatto import lobatto
from coaxshell.structure.solid import AXIAL, HOOP, HOOP_AXIAL, RADIAL, RADIAL_AXIAL, RADIAL_HOOP, STRAINS, SolidLayer

LEAST, PER_PHASE = 4, 0.6


def degree(layer: SolidLayer, order: float, wavenumber: float, frequency: float) -> int:
    """Return the degree of a layer up to an order, an axial wavenumber and a frequency (radians per unit of time)."""
    steepest = math.sqrt((frequency / layer.shear_speed) ** 2 + (order / layer.inner) ** 2 + wavenumber**2)
    return LEAST + math.ceil(PER_PHASE * layer.thickness * steepest)


def degrees(layer: SolidLayer, orders: FloatArray, wavenumber: float, frequency: float) -> npt.NDArray[np.int64]:
    """Return the degrees of a layer for some orders; see :func:`degree`."""
    steepest = np.sqrt((frequency / layer.shear_speed) ** 2 + (orders / layer.inner) ** 2 + wavenumber**2)
    return LEAST + np.ceil(PER_PHASE * layer.thickness * steepest).astype(np.int64)


@dataclass(frozen=True, eq=False)
class LayerMesh:
    """The points of one layer.

    Attributes
    ----------
    layer : SolidLayer
    nodes : slice
        Places of its points among those of the wall; neighbours share one.
    radius, weights : ndarray, shape (p + 1,)
        r and the weights of the integral over r dr.
    derivative : ndarray, shape (p + 1, p + 1)
        From values at the points to d/dr there.
    """

    layer: SolidLayer
    nodes: slice
    radius: FloatArray
    weights: FloatArray
    derivative: FloatArray

    @property
    def degree(self) -> int:
        """p."""
        return self.radius.size - 1


@dataclass(frozen=True, eq=False)
class WallMesh:
    """The points of a wall.

    Attributes
    ----------
    layers : tuple of LayerMesh
    radius : ndarray, shape (points,)
    mass : ndarray, shape (points,)
        Integrals of rho r dr that belong to each point.
    """

    layers: tuple[LayerMesh, ...]
    radius: FloatArray
    mass: FloatArray


def wall_mesh(layers: Sequence[SolidLayer], degrees: Sequence[int]) -> WallMesh:
    """Return the points of a wall whose layers have some degrees."""
    count = sum(degrees) + 1
    radius, mass, found, start = np.empty(count), np.zeros(count), [], 0
    for layer, p in zip(layers, degrees, strict=True):
        rule, half, nodes = lobatto(p), layer.thickness / 2.0, slice(start, start + p + 1)
        radius[nodes] = layer.inner + half * (1.0 + rule.points)
        radius[nodes.stop - 1] = layer.outer
        weights = half * rule.weights * radius[nodes]
        mass[nodes] += layer.density * weights
        found.append(LayerMesh(layer, nodes, radius[nodes].copy(), weights, rule.derivative / half))
        start += p
    return WallMesh(tuple(found), radius, mass)


def strains(orders: FloatArray, wavenumber: float, radius: FloatArray, derivative: FloatArray, at: FloatArray) -> FloatArray:
    """Return the strains at some places per displacement at the points of a layer, shape (orders, 6, places, 3, points).

    Parameters
    ----------
    orders : ndarray, shape (orders,)
    wavenumber : float
    radius : ndarray, shape (places,)
        Of the places.
    derivative, at : ndarray, shape (places, points)
        From values at the points to d/dr and to the value at the places.
    """
    m, k, r = orders[:, None, None], wavenumber, radius[:, None]
    found = np.zeros((orders.size, STRAINS, radius.size, 3, at.shape[1]))
    u_r, u_theta, u_z = 0, 1, 2
    found[:, RADIAL, :, u_r] = derivative
    found[:, HOOP, :, u_r] = at / r
    found[:, HOOP, :, u_theta] = m * at / r
    found[:, AXIAL, :, u_z] = k * at
    found[:, HOOP_AXIAL, :, u_theta] = -k * at
    found[:, HOOP_AXIAL, :, u_z] = -m * at / r
    found[:, RADIAL_AXIAL, :, u_z] = derivative
    found[:, RADIAL_AXIAL, :, u_r] = -k * at
    found[:, RADIAL_HOOP, :, u_theta] = derivative - at / r
    found[:, RADIAL_HOOP, :, u_r] = -m * at / r
    return found
