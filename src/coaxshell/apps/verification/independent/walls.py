"""A shell's wall by hand: section integrals, modal stiffness on (V, W), sensor and actuator, straight from the theory."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from coaxshell.model.elastic import Elastic
from coaxshell.model.piezoelectric import Piezoelectric
from coaxshell.model.shells import Shell
from coaxshell.numerics.arrays import FloatArray


@dataclass(frozen=True)
class PiezoLayer:
    """One piezoelectric layer: E, zeta33 and zeta22 of Eq. A.11, the actuator's coupling (C/m^2) and the voltage it stands (V)."""

    role: str
    coupling: float
    zeta33: float
    zeta22: float
    actuation: float
    limit: float

    @classmethod
    def of(cls, material: Piezoelectric, thickness: float, role: str) -> PiezoLayer:
        """Return the constants of a layer."""
        x, t = material, thickness
        e32 = x.e32 - x.c23 * x.e33 / x.c33
        mu33 = x.permittivity_33 + (1 if x.permittivity_reduction == "standard" else -1) * x.e33**2 / x.c33
        return cls(
            role=role,
            coupling=e32 * 2 * t / np.pi,
            zeta33=mu33 * np.pi**2 / (2 * t),
            zeta22=x.permittivity_22 * t / 2,
            actuation=x.e32 if x.actuator_coupling == "printed" else e32,
            limit=x.field_limit * t,
        )


@dataclass
class Wall:
    """Constants of one shell in SI: integrals of rho, Q, Q z, Q z^2 over the wall (z outward), piezo layers, modulus of the core."""

    radius: float
    inertia: float = 0.0
    a22: float = 0.0
    b22: float = 0.0
    d22: float = 0.0
    core: float = 0.0
    piezo: list[PiezoLayer] = field(default_factory=list)

    @classmethod
    def of(cls, shell: Shell) -> Wall:
        """Return the wall of a shell."""
        wall, z = cls(shell.radius), -shell.thickness / 2
        for layer in shell.layers:
            t, x = layer.thickness, layer.material
            if isinstance(x, Elastic):
                q = x.youngs_modulus / (1 - x.poisson_ratio**2)
            else:
                q = x.c22 - x.c23**2 / x.c33
                wall.piezo.append(PiezoLayer.of(x, t, layer.role))
            if layer.role == "core":
                wall.core = q
            wall.inertia += x.density * t
            wall.a22 += q * t
            wall.b22 += q * ((z + t) ** 2 - z**2) / 2
            wall.d22 += q * ((z + t) ** 3 - z**3) / 3
            z += t
        return wall

    def stiffness(self, m: int) -> FloatArray:
        """Return K on (V, W), N/m^3: a22 ee' + b22 (ek' + ke') + (d22 + kappa) kk', e = (m, -1)/R, k = (-m, m^2)/R^2 (z inward)."""
        e = np.array([m, -1.0]) / self.radius
        k = np.array([-m, m * m]) / self.radius**2
        bending = self.d22 + sum(x.coupling**2 / (x.zeta33 + m * m * x.zeta22 / self.radius**2) for x in self.piezo)
        total: FloatArray = self.a22 * np.outer(e, e) - self.b22 * (np.outer(e, k) + np.outer(k, e)) + bending * np.outer(k, k)
        return total

    def sensor(self, m: int) -> FloatArray:
        """Return volts of the sensor per metre of (V, W) (Eq. 20)."""
        x = next(p for p in self.piezo if p.role == "sensor")
        gain: FloatArray = x.coupling * np.array([m, -m * m]) / (x.zeta33 * self.radius**2 + m * m * x.zeta22)
        return gain

    @property
    def actuator(self) -> PiezoLayer:
        """The actuator."""
        return next(p for p in self.piezo if p.role == "actuator")
