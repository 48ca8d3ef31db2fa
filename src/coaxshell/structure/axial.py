"""A thin layered wall at an axial wavenumber k: strains and stiffness on the amplitudes (U, V, W), U and V eliminated from the motion.

With w = W cos kz cos m theta (inward), v = V cos kz sin m theta and u = U sin kz cos m theta (axial), Kirchhoff's kinematics to first
order in z', the distance outward from the mid-surface, are free of strain in every rigid motion and equal to those of the plane problem
at k = 0. The strains are (e0 + z' e1) (U, V, W) with

    eps_z     :  e0 = (k, 0, 0)           e1 = (0, 0, -k^2)                    of cos m theta cos kz
    eps_theta :  e0 = (0, m, -1)/R        e1 = (0, m, -m^2)/R^2                of cos m theta cos kz
    gamma     :  e0 = (-m/R, -k, 0)       e1 = (m/R^2, -k/R, 2 k m/R)          of sin m theta sin kz

and K = sum_ij integral of Q_ij (e0 + z' e1)_i (e0 + z' e1)_j dz', with what open-circuit piezoelectric layers add. The other parities
(sin kz with u = -U cos kz, sin m theta with v = -V cos m theta) share all of it. Everything is analytic in k, so that a complex k for
each Laplace node serves as well: arrays then have a further axis of nodes.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from coaxshell.errors import InputError
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.modes import Modes, kept_with_modes
from coaxshell.structure.laminate import Laminate
from coaxshell.structure.section import AxialCoupling, PiezoelectricLayer, Section
from coaxshell.structure.shell_model import Gain, WallOperator

U, V, W = range(3)
"""Places of the displacements."""
AXIAL, HOOP, SHEAR = range(3)
"""Places of the strains."""


class Strain(NamedTuple):
    """Strains (eps_z, eps_theta, gamma) = (e0 + z' e1) (U, V, W), shape (3 strains, 3 displacements, orders) or (..., orders, nodes)."""

    membrane: FloatArray
    bending: FloatArray

    def at(self, depth: float) -> FloatArray:
        """Return e0 + z' e1 at a depth (outward of the mid-surface)."""
        return self.membrane + depth * self.bending


def strain(modes: Modes, radius: float) -> Strain:
    """Return e0 and e1 of some modes of a wall."""
    k: Any = modes.wavenumber
    m = modes.orders if np.ndim(k) == 0 else modes.column
    zero = 0.0 * m * k
    membrane = [
        [zero + k, zero, zero],
        [zero, zero + m / radius, zero - 1.0 / radius],
        [zero - m / radius, zero - k, zero],
    ]
    bending = [
        [zero, zero, zero - k**2],
        [zero, zero + m / radius**2, zero - (m / radius) ** 2],
        [zero + m / radius**2, zero - k / radius, 2.0 * k * m / radius],
    ]
    return Strain(np.array(membrane), np.array(bending))


def laminate_of(section: Section) -> Laminate:
    """Return the stiffness of a wall in its plane; InputError if a material lacks constants for it."""
    if section.laminate is None:
        raise InputError(
            "shells",
            "a piezoelectric material has no axial constants",
            "give it c11, c12, c13, c66, e31 and permittivity_11 in three dimensions",
        )
    return section.laminate


def layer_stiffness(section: Section, at: Strain) -> FloatArray:
    """Return K of the layers' own stiffness on (U, V, W), shape (3, 3, orders) or (3, 3, orders, nodes), symmetric."""
    membrane, cross, bending = (each.matrix for each in laminate_of(section).moments)
    mixed = _form(cross, at.membrane, at.bending)
    return _form(membrane, at.membrane, at.membrane) + mixed + np.swapaxes(mixed, 0, 1) + _form(bending, at.bending, at.bending)


def _form(stiffness: FloatArray, left: FloatArray, right: FloatArray) -> FloatArray:
    return np.asarray(np.einsum("ij,ia...,jb...->ab...", stiffness, left, right))


def potential(layer: PiezoelectricLayer, modes: Modes, radius: float, at: Strain) -> FloatArray:
    """Return the potential of an open-circuit layer per unit (U, V, W), shape (3, orders) or (3, orders, nodes).

    phi = q (U, V, W)/(zeta33 + (m/R)^2 zeta22 + k^2 zeta11) with q = E_31 e1(eps_z) + E_32 e1(eps_theta): the sensor equation
    (Eq. 20) with the curvature along the axis.
    """
    return curvature(layer, at) / permittivity(layer, modes, radius)


def curvature(layer: PiezoelectricLayer, at: Strain) -> FloatArray:
    """Return q = E_31 e1(eps_z) + E_32 e1(eps_theta): charge per unit (U, V, W) that the bending of a layer calls for."""
    return np.asarray(_axial(layer).coupling * at.bending[AXIAL] + layer.coupling * at.bending[HOOP])


def permittivity(layer: PiezoelectricLayer, modes: Modes, radius: float) -> FloatArray:
    """Return zeta33 + (m/R)^2 zeta22 + k^2 zeta11, shape (orders,) or (orders, nodes)."""
    k: Any = modes.wavenumber
    m = modes.orders if np.ndim(k) == 0 else modes.column
    return np.asarray(layer.zeta33 + (m / radius) ** 2 * layer.zeta22 + k**2 * _axial(layer).zeta11)


def _axial(layer: PiezoelectricLayer) -> AxialCoupling:
    assert layer.axial is not None  # a laminate has been asked for before
    return layer.axial


def open_circuit_stiffness(section: Section, modes: Modes, at: Strain) -> FloatArray:
    """Return sum_j q q'/(zeta33 + (m/R)^2 zeta22 + k^2 zeta11), what open-circuit layers add to K."""
    total = np.zeros_like(at.membrane)
    for layer in section.piezoelectric:
        total = total + np.einsum("a...,b...->ab...", curvature(layer, at), potential(layer, modes, section.radius, at))
    return total


@kept_with_modes
def axial_stiffness(section: Section, modes: Modes) -> FloatArray:
    """Return K on (U, V, W), shape (3, 3, orders) or (3, 3, orders, nodes): layers and open-circuit stiffening together.

    I d2(u, v, w)/dtau2 + K (u, v, w) is the load per unit area.
    """
    at = strain(modes, section.radius)
    return layer_stiffness(section, at) + open_circuit_stiffness(section, modes, at)


ENTRIES = ((U, U), (U, V), (U, W), (V, V), (V, W), (W, W))
"""Places of the six entries of a symmetric stiffness on (U, V, W)."""


class AxialStiffness(NamedTuple):
    """Entries of K on (U, V, W), each of shape (orders, 1) or (orders, nodes), real or, with losses, complex."""

    uu: npt.NDArray[Any]
    uv: npt.NDArray[Any]
    uw: npt.NDArray[Any]
    vv: npt.NDArray[Any]
    vw: npt.NDArray[Any]
    ww: npt.NDArray[Any]


def entries_of(stiffness: npt.NDArray[Any]) -> AxialStiffness:
    """Return the entries of a stiffness of shape (3, 3, orders) or (3, 3, orders, nodes)."""
    columns = stiffness[..., None] if stiffness.ndim == 3 else stiffness
    return AxialStiffness(*(columns[a, b] for a, b in ENTRIES))


def eliminated(k: AxialStiffness, inertia: ComplexArray, modes: Modes) -> WallOperator:
    """Return impedance, V/W and U/W of a wall of a stiffness K and an inertia I s^2, whose load is normal to it.

    K + I s^2 is symmetric; U and V are eliminated by the 2 x 2 of their own. V drops out of order 0 and U at k = 0, where they do not
    couple to W: their rows, which may be singular by themselves, become copies of the other's.
    """
    uv, uw, vw = k.uv, k.uw, k.vw
    uu = inertia + np.where(np.equal(modes.wavenumber, 0.0), k.vv, k.uu)
    vv = inertia + np.where(modes.column == 0, k.uu, k.vv)
    inverse = np.reciprocal(uu * vv - uv * uv)
    axial = (uv * vw - vv * uw) * inverse
    tangential = (uv * uw - uu * vw) * inverse
    impedance = (inertia + k.ww) + (uw * axial + vw * tangential)
    return WallOperator(impedance, tangential, axial)


def axial_gain(per_displacement: npt.NDArray[Any]) -> Gain:
    """Return a row on (U, V, W) as a gain."""
    return Gain(v=per_displacement[V], w=per_displacement[W], u=per_displacement[U])


def natural_frequencies(section: Section, modes: Modes) -> FloatArray:
    """Return the three natural frequencies of each mode of a wall in vacuo, ascending, shape (orders, 3), radians per unit of time.

    Singular values of B/sqrt(I), where K = B'B: the rows of B are the strains at two Gauss points through each layer, which integrate
    K exactly, times the square root of its stiffness, and the potentials of open-circuit layers. Eigenvalues of K would lose the low
    frequencies of thin walls; singular values keep them, and rigid motions are zero to rounding.

    Parameters
    ----------
    section : Section
    modes : Modes
        Of a real wavenumber, k = j pi/L for a shell of length L between shear diaphragms.
    """
    at, laminate, rows = strain(modes, section.radius), laminate_of(section), []
    for (bottom, top, _), layer in zip(section.layers, laminate.layers, strict=True):
        root = np.sqrt(0.5 * (top - bottom)) * np.linalg.cholesky(layer.matrix).T
        for point in (-1.0, 1.0):
            depth = 0.5 * (bottom + top) + point * (top - bottom) / np.sqrt(12.0)
            rows.append(np.einsum("ij,ja...->ia...", root, at.at(depth)))
    charges = [curvature(layer, at) / np.sqrt(permittivity(layer, modes, section.radius)) for layer in section.piezoelectric]
    rows.extend(each[None] for each in charges)
    stacked = np.moveaxis(np.concatenate(rows), -1, 0)
    return np.asarray(np.linalg.svd(stacked, compute_uv=False)[:, ::-1] / np.sqrt(section.mass))
