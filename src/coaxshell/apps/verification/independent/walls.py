"""A shell's wall by hand: its stiffness on (V, W, U) by integration through the thickness, sensor and actuator, straight from the theory.

At order m and axial wavenumber k a wall moves by w = W cos kz cos m theta (inward), v = V cos kz sin m theta and u = U sin kz cos m theta
(axial). Its strains, z the depth measured outward from the mid-surface, are B (V, W, U) with B = e0 + z e1. At k = 0 the axial motion
is free of the others, and what is left is plane strain.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre

from coaxshell.model.materials import Material
from coaxshell.model.piezoelectric import Piezoelectric
from coaxshell.model.shells import Shell
from coaxshell.numerics.arrays import FloatArray

_GAUSS = legendre.leggauss(3)


def strains(m: int, k: float, radius: float) -> tuple[FloatArray, FloatArray]:
    """Return e0 and e1: rows axial strain, hoop strain, shear; columns V, W, U; k in 1/m."""
    r = radius
    mid = np.array([[0, 0, k], [m / r, -1 / r, 0], [-k, 0, -m / r]])
    slope = np.array([[0, -k * k, 0], [m / r**2, -m * m / r**2, 0], [-k / r, 2 * k * m / r, m / r**2]])
    return mid, slope


def moduli(material: Material) -> FloatArray:
    """Return Q on (axial strain, hoop strain, shear) of a layer free of radial stress, Pa; 0 for axial constants that were not given."""
    if not isinstance(material, Piezoelectric):
        e, nu = material.youngs_modulus, material.poisson_ratio
        q11, q12, q22, q66 = e / (1 - nu**2), nu * e / (1 - nu**2), e / (1 - nu**2), e / (2 + 2 * nu)
    else:
        x, c13 = material, material.c13 or 0.0
        q11, q12 = (x.c11 or 0.0) - c13**2 / x.c33, (x.c12 or 0.0) - c13 * x.c23 / x.c33
        q22, q66 = x.c22 - x.c23**2 / x.c33, x.c66 or 0.0
    return np.array([[q11, q12, 0], [q12, q22, 0], [0, 0, q66]])


class Point(NamedTuple):
    """A point of the integration through the thickness: depth z and weight in m, moduli in Pa."""

    depth: float
    weight: float
    moduli: FloatArray


@dataclass(frozen=True)
class PiezoLayer:
    """One piezoelectric layer: E and zeta of Eq. A.11 per direction, the actuator's coupling (C/m^2) and the voltage it stands (V)."""

    role: str
    axial_coupling: float
    coupling: float
    zeta33: float
    zeta22: float
    zeta11: float
    actuation: float
    limit: float

    @classmethod
    def of(cls, material: Piezoelectric, thickness: float, role: str) -> PiezoLayer:
        """Return the constants of a layer."""
        x, t = material, thickness
        e32 = x.e32 - x.c23 * x.e33 / x.c33
        e31 = (x.e31 or 0.0) - (x.c13 or 0.0) * x.e33 / x.c33
        mu33 = x.permittivity_33 + (1 if x.permittivity_reduction == "standard" else -1) * x.e33**2 / x.c33
        return cls(
            role=role,
            axial_coupling=e31 * 2 * t / np.pi,
            coupling=e32 * 2 * t / np.pi,
            zeta33=mu33 * np.pi**2 / (2 * t),
            zeta22=x.permittivity_22 * t / 2,
            zeta11=(x.permittivity_11 or 0.0) * t / 2,
            actuation=x.e32 if x.actuator_coupling == "printed" else e32,
            limit=x.field_limit * t,
        )

    def charge(self, m: int, k: float, radius: float) -> FloatArray:
        """Return q on (V, W, U): E31 times the axial and E32 times the hoop strain's slope."""
        slope = strains(m, k, radius)[1]
        total: FloatArray = self.axial_coupling * slope[0] + self.coupling * slope[1]
        return total

    def permittivity(self, m: int, k: float, radius: float) -> float:
        """Return zeta33 + m^2 zeta22/R^2 + k^2 zeta11."""
        return self.zeta33 + m * m / radius**2 * self.zeta22 + k * k * self.zeta11


@dataclass
class Wall:
    """One shell in SI: radii of mid-surface and wetted surfaces, mass per area, points through the wall, piezoelectric layers, the core."""

    radius: float
    wetted: tuple[float, float]
    inertia: float = 0.0
    core: float = 0.0
    poisson: float = 0.0
    points: list[Point] = field(default_factory=list)
    piezo: list[PiezoLayer] = field(default_factory=list)

    @classmethod
    def of(cls, shell: Shell) -> Wall:
        """Return the wall of a shell."""
        wall, z = cls(shell.radius, shell.wetted_radii), -shell.thickness / 2
        for layer in shell.layers:
            t, x = layer.thickness, layer.material
            q = moduli(x)
            if isinstance(x, Piezoelectric):
                wall.piezo.append(PiezoLayer.of(x, t, layer.role))
            if layer.role == "core":
                wall.core, wall.poisson = q[1, 1], q[0, 1] / q[1, 1]
            wall.inertia += x.density * t
            wall.points += [Point(z + t * (1 + at) / 2, t * weight / 2, q) for at, weight in zip(*_GAUSS, strict=True)]
            z += t
        return wall

    @property
    def a11(self) -> float:
        """Axial stiffness, the integral of Q11 (N/m)."""
        return float(sum(point.weight * point.moduli[0, 0] for point in self.points))

    @property
    def a22(self) -> float:
        """Hoop stiffness, the integral of Q22 (N/m)."""
        return float(sum(point.weight * point.moduli[1, 1] for point in self.points))

    @property
    def d22(self) -> float:
        """Bending stiffness, the integral of Q22 z^2 (N m)."""
        return float(sum(point.weight * point.depth**2 * point.moduli[1, 1] for point in self.points))

    def stiffness(self, m: int, k: float = 0.0) -> FloatArray:
        """Return K on (V, W, U), N/m^3: the integral of B' Q B, and q q'/(zeta33 + ...) of every open-circuit layer; k in 1/m."""
        mid, slope = strains(m, k, self.radius)
        total = np.zeros((3, 3))
        for point in self.points:
            b = mid + point.depth * slope
            total += point.weight * b.T @ point.moduli @ b
        for layer in self.piezo:
            q = layer.charge(m, k, self.radius)
            total += np.outer(q, q) / layer.permittivity(m, k, self.radius)
        return total

    def sensor(self, m: int, k: float = 0.0) -> FloatArray:
        """Return volts of the sensor per metre of (V, W, U) (Eq. 20)."""
        layer = next(p for p in self.piezo if p.role == "sensor")
        gain: FloatArray = layer.charge(m, k, self.radius) / layer.permittivity(m, k, self.radius)
        return gain

    @property
    def actuator(self) -> PiezoLayer:
        """The actuator."""
        return next(p for p in self.piezo if p.role == "actuator")
