"""Hoop stress of a layered wall per unit modal displacement: the design stress (Eq. 22) and the stress at any depth (Eqs. A.4, A.5).

z runs outward from the mid-surface and w is positive inward, so a straight normal moves tangentially by v + (z/R)(v + dw/dtheta) and

    strain(z) = (dv/dtheta - w)/R + z (d2w/dtheta2 + dv/dtheta)/R^2.

With this sign Eqs. A.5, A.7 and 20 agree with each other: the moment of the stress below is (d22 + sum_j kappa_j) times the curvature.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from coaxshell.model.layers import serves
from coaxshell.numerics.arrays import FloatArray
from coaxshell.structure.section import PiezoelectricLayer, Section
from coaxshell.structure.shell_model import Gain
from coaxshell.structure.thin import potential_gain


class WallPoint(NamedTuple):
    """A point of the wall: its z (m, outward), the plane-strain modulus there (Pa), the piezoelectric layer it lies in, if any, and the
    number of its layer from the inside out.
    """

    z: float
    modulus: float
    piezoelectric: PiezoelectricLayer | None
    number: int = 0


def design_stress_gain(section: Section, m: npt.ArrayLike) -> Gain:
    """Return the mid-surface hoop stress of the core per unit (V, W): E_h/(1 - nu^2) (m, -1)/R (Eq. 22).

    Parameters
    ----------
    section : Section
        Section integrals, SI.
    m : array_like
        Circumferential orders.

    Returns
    -------
    Gain
        Pa per metre of displacement.
    """
    m = np.asarray(m, dtype=np.float64)
    scale = section.core_modulus / section.radius
    return Gain(scale * m, np.full_like(m, -scale))


def strain_gain(m: npt.ArrayLike, radius: float, z: float) -> tuple[FloatArray, FloatArray]:
    """Return the hoop strain at z (m, outward) per unit (V, W), 1/m: (m, -1)/R + z (m, -m^2)/R^2."""
    m = np.asarray(m, dtype=np.float64)
    return m / radius + z * m / radius**2, -1.0 / radius - z * m**2 / radius**2


def wall_point(section: Section, z: float) -> WallPoint:
    """Return what the wall is made of at z (positive outward) or its nearest face; between two layers the outer one is meant."""
    inner, outer = section.layers[0][0], section.layers[-1][1]
    slack = 1e-9 * (outer - inner)  # forgives the rounding of sums of thicknesses
    z = min(max(z, inner), outer)
    number = next((i for i, layer in enumerate(section.layers) if z < layer[1] - slack), len(section.layers) - 1)
    bottom, top, modulus = section.layers[number]
    middle = (bottom + top) / 2.0
    piezoelectric = next((layer for layer in section.piezoelectric if abs(layer.centre - middle) <= slack), None)
    return WallPoint(z, modulus, piezoelectric, number)


def stress_gain(section: Section, m: npt.ArrayLike, where: WallPoint) -> Gain:
    """Return the hoop stress at a point of the wall per unit (V, W), bending and open-circuit potential included (Eqs. A.4, A.5).

    sigma = Q strain(z) - e32~ E_z, E_z = -dPhi/dz with Phi = -cos(pi (z - z_c)/t) phi_j (Eq. A.7) and phi_j of Eq. 20. The voltage
    that a controller puts on an actuator is not in it.

    Parameters
    ----------
    section : Section
        Section integrals, SI.
    m : array_like
        Circumferential orders.
    where : WallPoint
        From :func:`wall_point`.

    Returns
    -------
    Gain
        Pa per metre of displacement.
    """
    strain_v, strain_w = strain_gain(m, section.radius, where.z)
    gain_v, gain_w = where.modulus * strain_v, where.modulus * strain_w
    layer = where.piezoelectric
    if layer is not None:
        per_volt = layer.reduced_coupling * math.pi / layer.thickness * math.sin(math.pi * (where.z - layer.centre) / layer.thickness)
        phi = potential_gain(layer, m, section.radius)
        gain_v, gain_w = gain_v + per_volt * phi.v, gain_w + per_volt * phi.w
    return Gain(gain_v, gain_w)


def control_stress(where: WallPoint, component: str = "hoop") -> float:
    """Return a stress per volt of control at a point, Pa/V: in the actuator -e32/t (hoop; Eqs. 4, A.10) or -e31/t (axial), else 0."""
    layer = where.piezoelectric
    if layer is None or not serves(layer.role, "actuator") or component == "shear":
        return 0.0
    if component == "hoop":
        return -layer.actuator_coupling / layer.thickness
    return 0.0 if layer.axial is None else -layer.axial.actuator_coupling / layer.thickness
