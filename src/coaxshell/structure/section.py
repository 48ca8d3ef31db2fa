"""Section integrals of a layered wall (paper's Eq. A.11) and what its piezoelectric layers add.

The through-thickness coordinate z runs outward from the mid-surface; strain is positive in tension:

    strain(z) = (dv/dtheta - w)/R + z (d2w/dtheta2 + dv/dtheta)/R^2,      w positive inward.

(With z counted inward the second sign is minus. Only layups that are not symmetric about the mid-surface can tell.)
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from coaxshell.model.layers import Layer, Shell, serves
from coaxshell.model.materials import Material, Piezoelectric
from coaxshell.structure.laminate import Laminate, laminate


class AxialCoupling(NamedTuple):
    """What a piezoelectric layer does along the axis, beside what it does along the hoop.

    Attributes
    ----------
    coupling : float
        E_31 = e31~ 2 t/pi, C/m: potential per axial curvature.
    zeta11 : float
        mu11 t/2, F.
    reduced_coupling : float
        e31~ = e31 - c13 e33/c33, C/m^2.
    actuator_coupling : float
        The e31 that multiplies the control voltage, C/m^2, reduced as that of the hoop is.
    """

    coupling: float
    zeta11: float
    reduced_coupling: float
    actuator_coupling: float

    def in_units(self, length: float, charge: float) -> AxialCoupling:
        """Return it in units of a length (m) and a charge per area (C/m^2)."""
        return AxialCoupling(
            self.coupling / (charge * length),
            self.zeta11 / (charge * length**2),
            self.reduced_coupling / charge,
            self.actuator_coupling / charge,
        )


@dataclass(frozen=True)
class PiezoelectricLayer:
    """Electromechanical constants of one piezoelectric layer (Eq. A.11), SI or in units of their own (:meth:`Section.in_units`).

    Attributes
    ----------
    role : str
        "sensor", "charge-sensor", "actuator", "self-sensing" or "passive".
    thickness, centre : float
        t_j and the z of the layer's middle, m.
    coupling : float
        E_32 = e32~ 2 t/pi, C/m: potential per curvature.
    zeta33, zeta22 : float
        mu33~ pi^2/(2 t), F/m^2, and mu22 t/2, F (the factor 1/R^2 is applied once, where it is used).
    reduced_coupling : float
        e32~ = e32 - c23 e33/c33, C/m^2.
    actuator_coupling : float
        The e32 that multiplies the control voltage, C/m^2: e32 as printed, or e32~ (plane stress).
    field_limit : float
        Largest field strength, V/m.
    axial : AxialCoupling or None
        None if its material lacks the constants.
    """

    role: str
    thickness: float
    centre: float
    coupling: float
    zeta33: float
    zeta22: float
    reduced_coupling: float
    actuator_coupling: float
    field_limit: float
    axial: AxialCoupling | None = None

    @property
    def permittivity(self) -> float:
        """mu33~, F/m."""
        return self.zeta33 * 2.0 * self.thickness / math.pi**2


@dataclass(frozen=True)
class Section:
    """Section integrals of one shell (Eq. A.11), per unit axial length, SI or in units of their own (:meth:`in_units`).

    Attributes
    ----------
    radius : float
        Mid-surface radius R, m.
    mass : float
        I = integral of rho dz, kg/m^2.
    membrane, cross, bending : float
        (a22, b22, d22) = integrals of Q (1, z, z^2) dz in N/m, N, N m; b22 vanishes for a layup symmetric about the mid-surface.
    core_modulus : float
        E_h/(1 - nu^2) of the core, Pa: the modulus of the design stress (Eq. 22).
    layers : tuple of (float, float, float)
        Bottom z, top z (m) and plane-strain modulus (Pa) of every layer, from the inside out.
    piezoelectric : tuple of PiezoelectricLayer
    laminate : Laminate or None
        Stiffness in both directions of the wall, for an axial wavenumber; None if a material lacks the constants.
    """

    radius: float
    mass: float
    membrane: float
    cross: float
    bending: float
    core_modulus: float
    layers: tuple[tuple[float, float, float], ...]
    piezoelectric: tuple[PiezoelectricLayer, ...]
    laminate: Laminate | None = None

    def layer(self, role: str) -> PiezoelectricLayer | None:
        """Return the first piezoelectric layer that serves in the given role, or None."""
        return next((layer for layer in self.piezoelectric if serves(layer.role, role)), None)

    def in_units(self, length: float, pressure: float, mass: float) -> Section:
        """Return the section of SI values in units of a length (m), a pressure (Pa), a mass per area (kg/m^2), and volts."""
        charge = pressure * length  # per area, C/m^2: a volt times it is a pressure times a length
        return Section(
            radius=self.radius / length,
            mass=self.mass / mass,
            membrane=self.membrane / (pressure * length),
            cross=self.cross / (pressure * length**2),
            bending=self.bending / (pressure * length**3),
            core_modulus=self.core_modulus / pressure,
            layers=tuple((bottom / length, top / length, modulus / pressure) for bottom, top, modulus in self.layers),
            piezoelectric=tuple(
                PiezoelectricLayer(
                    role=layer.role,
                    thickness=layer.thickness / length,
                    centre=layer.centre / length,
                    coupling=layer.coupling / (charge * length),
                    zeta33=layer.zeta33 / charge,
                    zeta22=layer.zeta22 / (charge * length**2),
                    reduced_coupling=layer.reduced_coupling / charge,
                    actuator_coupling=layer.actuator_coupling / charge,
                    field_limit=layer.field_limit * length,
                    axial=None if layer.axial is None else layer.axial.in_units(length, charge),
                )
                for layer in self.piezoelectric
            ),
            laminate=None if self.laminate is None else self.laminate.in_units(length, pressure),
        )


def plane_modulus(material: Material) -> float:
    """Return the plane-strain modulus Q, Pa: E/(1 - nu^2), or c22 - c23^2/c33 for a piezoelectric layer (Eq. A.11)."""
    if isinstance(material, Piezoelectric):
        return material.c22 - material.c23**2 / material.c33
    return material.youngs_modulus / (1.0 - material.poisson_ratio**2)


def reduced_permittivity(material: Piezoelectric) -> float:
    """Return mu33~, F/m: mu33 + e33^2/c33 (plane stress) or mu33 - e33^2/c33 (as printed in Eq. A.11)."""
    sign = 1.0 if material.permittivity_reduction == "standard" else -1.0
    return material.permittivity_33 + sign * material.e33**2 / material.c33


def reduced_coupling(material: Piezoelectric) -> float:
    """Return e32~ = e32 - c23 e33/c33, C/m^2 (Eq. A.11)."""
    return material.e32 - material.c23 * material.e33 / material.c33


def piezoelectric_layer(layer: Layer, material: Piezoelectric, centre: float) -> PiezoelectricLayer:
    """Return the electromechanical constants of a layer whose potential varies as a half cosine through its thickness (Eq. A.7)."""
    reduced = reduced_coupling(material)
    return PiezoelectricLayer(
        role=layer.role or "passive",
        thickness=layer.thickness,
        centre=centre,
        coupling=reduced * 2.0 * layer.thickness / math.pi,
        zeta33=reduced_permittivity(material) * math.pi**2 / (2.0 * layer.thickness),
        zeta22=material.permittivity_22 * layer.thickness / 2.0,
        reduced_coupling=reduced,
        actuator_coupling=material.e32 if material.actuator_coupling == "printed" else reduced,
        field_limit=material.field_limit,
        axial=axial_coupling(layer.thickness, material),
    )


def axial_coupling(thickness: float, material: Piezoelectric) -> AxialCoupling | None:
    """Return what a layer does along the axis; None if its material lacks c13, e31 or permittivity_11."""
    if material.c13 is None or material.e31 is None or material.permittivity_11 is None:
        return None
    reduced = material.e31 - material.c13 * material.e33 / material.c33
    return AxialCoupling(
        coupling=reduced * 2.0 * thickness / math.pi,
        zeta11=material.permittivity_11 * thickness / 2.0,
        reduced_coupling=reduced,
        actuator_coupling=material.e31 if material.actuator_coupling == "printed" else reduced,
    )


def section(shell: Shell) -> Section:
    """Return the section integrals of a shell's layup (Eq. A.11)."""
    bottom = -shell.thickness / 2.0
    mass = membrane = cross = bending = 0.0
    layers: list[tuple[float, float, float]] = []
    piezoelectric: list[PiezoelectricLayer] = []
    for layer in shell.layers:
        top = bottom + layer.thickness
        modulus = plane_modulus(layer.material)
        mass += layer.material.density * layer.thickness
        membrane += modulus * layer.thickness
        cross += modulus * (top**2 - bottom**2) / 2.0
        bending += modulus * (top**3 - bottom**3) / 3.0
        layers.append((bottom, top, modulus))
        if isinstance(layer.material, Piezoelectric):
            piezoelectric.append(piezoelectric_layer(layer, layer.material, (bottom + top) / 2.0))
        bottom = top
    if abs(cross) < 1e-12 * membrane * shell.thickness:
        cross = 0.0  # a symmetric layup, up to rounding of the layer boundaries
    core, along = plane_modulus(shell.core.material), laminate(shell)
    return Section(shell.radius, mass, membrane, cross, bending, core, tuple(layers), tuple(piezoelectric), along)
