"""Stresses of a layered wall that changes along its axis: hoop, axial and shear at any depth, per mode and from the fields at a station.

    sigma_theta = Q22 eps_theta + Q12 eps_z - e32~ E_z,    sigma_z = Q12 eps_theta + Q11 eps_z - e31~ E_z,    tau = Q66 gamma,

E_z = -dPhi/dz' with Phi = -cos(pi (z' - z_c)/t) phi_j in the piezoelectric layer j (Eq. A.7; a layer poled along the radius has no shear
by it). Hoop and axial stress go with cos m theta cos kz, shear with sin m theta sin kz; with the other parity of theta, sin m theta and
-cos m theta, with the other along the axis, sin kz and -cos kz.

Sums over wavenumbers at a station z leave no k to multiply with. There the strains are made of fields, amplitudes of each order that
have been summed over k, and their derivatives along the axis:

    eps_z     = u_z + z' w_zz
    eps_theta = (m v - w)/R + z' (m v - m^2 w)/R^2
    gamma     = -m u/R + v_z + z' (m u/R^2 + v_z/R - 2 m w_z/R),

and the potential phi_j, whose gain depends on k, is summed as a field of its own.
"""

from __future__ import annotations

import math

import numpy as np

from coaxshell.errors import InputError
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.modes import Modes
from coaxshell.structure.axial import AXIAL, HOOP, SHEAR, axial_gain, laminate_of, potential, strain
from coaxshell.structure.section import Section
from coaxshell.structure.shell_model import FieldGain, Gain
from coaxshell.structure.stress import WallPoint, wall_point

COMPONENTS = {"hoop": HOOP, "axial": AXIAL, "shear": SHEAR}
"""Components of the stress, and their places."""


def axial_stress_gain(section: Section, modes: Modes, depth: float | None = None, component: str = "hoop") -> Gain:
    """Return a stress per unit (V, W, U): of the core at the mid-surface, or at a depth with the field of a piezoelectric layer.

    Parameters
    ----------
    section : Section
    modes : Modes
    depth : float, optional
        Outward from the mid-surface.
    component : str
        "hoop", "axial" or "shear".

    Raises
    ------
    InputError
        If there is no such component, or a material lacks its axial constants.
    """
    place, at = component_place(component), strain(modes, section.radius)
    if depth is None:
        return axial_gain(np.einsum("i,ia...->a...", laminate_of(section).core.matrix[place], at.membrane))
    where = wall_point(section, depth)
    total = np.einsum("i,ia...->a...", laminate_of(section).layers[where.number].matrix[place], at.at(where.z))
    if where.piezoelectric is not None and place != SHEAR:
        total = total + per_volt(where, component) * potential(where.piezoelectric, modes, section.radius, at)
    return axial_gain(total)


def stress_of_fields(section: Section, orders: FloatArray, depth: float | None = None, component: str = "hoop") -> FieldGain:
    """Return a stress per unit of the fields at a station; parameters and errors are those of :func:`axial_stress_gain`."""
    place = component_place(component)
    where = None if depth is None else wall_point(section, depth)
    z, radius = 0.0 if where is None else where.z, section.radius
    stiffness = laminate_of(section).core if where is None else laminate_of(section).layers[where.number]
    one, m = np.ones_like(orders), orders
    if place == SHEAR:
        shear = stiffness.q66
        return FieldGain(u=shear * (z / radius - 1.0) * m / radius, v_z=shear * (1.0 + z / radius) * one, w_z=-2.0 * shear * z * m / radius)
    along, around = (float(x) for x in stiffness.matrix[place, :2])
    gain = FieldGain(
        w=-around * (1.0 / radius + z * m**2 / radius**2),
        w_zz=along * z * one,
        v=around * (1.0 + z / radius) * m / radius,
        u_z=along * one,
    )
    if where is None or where.piezoelectric is None:
        return gain
    return gain._replace(potential=per_volt(where, component), layer=section.piezoelectric.index(where.piezoelectric))


def component_place(component: str) -> int:
    """Return the place of a component of the stress; InputError if there is none of that name."""
    if component not in COMPONENTS:
        raise InputError("component", f"{component!r} is no component of a wall's stress", "must be hoop, axial or shear")
    return COMPONENTS[component]


def per_volt(where: WallPoint, component: str) -> float:
    """Return the hoop or axial stress at a point per volt of its layer's open-circuit potential, e~ (pi/t) sin(pi (z' - z_c)/t)."""
    layer = where.piezoelectric
    assert layer is not None
    assert layer.axial is not None
    coupling = layer.axial.reduced_coupling if component == "axial" else layer.reduced_coupling
    return coupling * math.pi / layer.thickness * math.sin(math.pi * (where.z - layer.centre) / layer.thickness)
