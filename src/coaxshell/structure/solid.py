"""Layers as three-dimensional elastic solids: their constants, SI or in units of their own.

Strains stand in the order (rr, theta theta, zz, theta z, r z, r theta), shears as angles. Elastic layers are isotropic; piezoelectric ones
are poled along the radius, with 3 the radius, 2 the hoop and 1 the axis of the material's constants:

    sigma = C eps - e' E,      D = e eps + mu E,      C = [[c33, c23, c13], [c23, c22, c12], [c13, c12, c11]] and (c66, c44, c44),

    e = [[e33, e32, e31, 0, 0, 0], [0, 0, 0, 0, 0, e15], [0, 0, 0, 0, e15, 0]] for (D_r, D_theta, D_z).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from coaxshell.errors import InputError
from coaxshell.model.layers import Shell
from coaxshell.model.materials import Elastic, Piezoelectric, Viscoelastic
from coaxshell.numerics.arrays import FloatArray
from coaxshell.structure.constituents import relaxation_of, shear_relaxation
from coaxshell.structure.losses import USUAL_BAND, Band, Relaxation

STRAINS = 6
RADIAL, HOOP, AXIAL, HOOP_AXIAL, RADIAL_AXIAL, RADIAL_HOOP = range(STRAINS)
"""Places of the strains and stresses."""

PLANE = (RADIAL, HOOP, RADIAL_HOOP)
"""Strains of a plane problem, where nothing moves or changes along the axis."""

SOLID_CONSTANTS = ("c11", "c12", "c13", "c66", "c44", "e31", "e15", "permittivity_11")
"""Constants of a piezoelectric material that a solid layer needs beside those that every wall needs."""

THINNEST = 1e-9
"""Thickness over radius below which a layer is none."""


@dataclass(frozen=True)
class SolidLayer:
    """One layer of a wall as a solid.

    Attributes
    ----------
    inner, outer : float
        Radii of its faces.
    density : float
    stiffness : tuple of tuple of float
        C at constant field, 6 x 6.
    coupling : tuple of tuple of float, or None
        e, 3 x 6, rows (D_r, D_theta, D_z); None for what is not piezoelectric.
    permittivity : tuple of float, or None
        mu of (r, theta, z) at constant strain.
    role : str
    factor : Relaxation or None
        g(s) on all of C but never on the potentials; None without losses.
    shear_alone : bool
        Whether it is on G alone, and the bulk modulus stays elastic: a rubber.
    """

    inner: float
    outer: float
    density: float
    stiffness: tuple[tuple[float, ...], ...]
    coupling: tuple[tuple[float, ...], ...] | None = None
    permittivity: tuple[float, float, float] | None = None
    role: str = "core"
    factor: Relaxation | None = None
    shear_alone: bool = False

    @property
    def thickness(self) -> float:
        """Distance of its faces."""
        return self.outer - self.inner

    @property
    def matrix(self) -> FloatArray:
        """C, shape (6, 6)."""
        return np.array(self.stiffness)

    @property
    def shear_speed(self) -> float:
        """Speed of the slower shear wave, sqrt(min(c44, c66)/rho)."""
        return float(np.sqrt(min(self.stiffness[i][i] for i in (HOOP_AXIAL, RADIAL_AXIAL, RADIAL_HOOP)) / self.density))

    @property
    def pressure_speed(self) -> float:
        """Speed of pressure waves along the radius, sqrt(c33/rho), with the field that stiffens them."""
        stiff = self.stiffness[RADIAL][RADIAL]
        if self.coupling is not None and self.permittivity is not None:
            stiff += self.coupling[0][RADIAL] ** 2 / self.permittivity[0]
        return float(np.sqrt(stiff / self.density))

    @property
    def isotropic(self) -> bool:
        """Whether it has no poling."""
        return self.coupling is None

    @property
    def shear(self) -> float:
        """G of an isotropic layer, at rest or where its factor is 1."""
        return self.stiffness[RADIAL_HOOP][RADIAL_HOOP]

    @property
    def bulk(self) -> float:
        """Bulk modulus of an isotropic layer."""
        return self.stiffness[RADIAL][HOOP] + 2.0 / 3.0 * self.shear

    @property
    def kept_and_relaxing(self) -> tuple[FloatArray, FloatArray]:
        """C_0 and C_1 of C(s) = C_0 + g(s) C_1: of a rubber its bulk modulus and its shear."""
        if self.factor is None:
            return self.matrix, np.zeros((STRAINS, STRAINS))
        if self.shear_alone:
            return _of_moduli(self.bulk, 0.0), _of_moduli(0.0, self.shear)
        return np.zeros((STRAINS, STRAINS)), self.matrix

    @property
    def stiffest(self) -> SolidLayer:
        """The layer without losses, as stiff as it ever is within the run."""
        if self.factor is None:
            return self
        g = self.factor.stiffest
        matrix = _of_moduli(self.bulk, g * self.shear) if self.shear_alone else g * self.matrix
        return replace(self, stiffness=_rows(matrix), factor=None, shear_alone=False)

    def in_units(self, length: float, pressure: float, density: float) -> SolidLayer:
        """Return the layer of SI values in units of a length (m), a pressure (Pa), a density (kg/m^3), and volts."""
        charge, field = pressure * length, pressure * length**2
        return SolidLayer(
            self.inner / length,
            self.outer / length,
            self.density / density,
            tuple(tuple(c / pressure for c in row) for row in self.stiffness),
            None if self.coupling is None else tuple(tuple(e / charge for e in row) for row in self.coupling),
            None
            if self.permittivity is None
            else (self.permittivity[0] / field, self.permittivity[1] / field, self.permittivity[2] / field),
            self.role,
            self.factor,
            self.shear_alone,
        )


def isotropic(material: Elastic | Viscoelastic) -> FloatArray:
    """Return C of an isotropic material, Pa: lambda + 2 G and lambda of the stretches, G of the shears; of a rubber that at rest."""
    shear = material.youngs_modulus / (2.0 * (1.0 + material.poisson_ratio))
    lame = 2.0 * shear * material.poisson_ratio / (1.0 - 2.0 * material.poisson_ratio)
    matrix = np.diag([2.0 * shear] * 3 + [shear] * 3)
    matrix[:3, :3] += lame
    return matrix


def _of_moduli(bulk: float, shear: float) -> FloatArray:
    """Return C of a bulk and a shear modulus."""
    matrix = np.diag([2.0 * shear] * 3 + [shear] * 3)
    matrix[:3, :3] += bulk - 2.0 / 3.0 * shear
    return matrix


def poled(material: Piezoelectric) -> tuple[FloatArray, FloatArray]:
    """Return C (6, 6) at constant field, Pa, and e (3, 6), C/m^2, of a ceramic poled along the radius that has all constants."""
    c11, c12, c13, c44, c66 = (_known(material, name) for name in ("c11", "c12", "c13", "c44", "c66"))
    stiffness = np.diag([0.0] * 3 + [c66, c44, c44])
    stiffness[:3, :3] = [[material.c33, material.c23, c13], [material.c23, material.c22, c12], [c13, c12, c11]]
    coupling = np.zeros((3, STRAINS))
    coupling[0, :3] = material.e33, material.e32, _known(material, "e31")
    coupling[1, RADIAL_HOOP] = coupling[2, RADIAL_AXIAL] = _known(material, "e15")
    return stiffness, coupling


def _known(material: Piezoelectric, name: str) -> float:
    value = getattr(material, name)
    assert value is not None  # require_solid has seen to it
    return float(value)


def require_solid(shell: Shell, where: str) -> None:
    """Raise InputError if a layer of a shell cannot be taken as a solid.

    Parameters
    ----------
    shell : Shell
    where : str
        Its path, such as ``"shells[0]"``.
    """
    if shell.inner_radius <= 0.0:
        raise InputError(f"{where}.radius", f"{shell.radius:g} m leaves no bore", f"must be more than {shell.thickness / 2:g} m")
    for i, layer in enumerate(shell.layers):
        path, material = f"{where}.layers[{i}]", layer.material
        if layer.thickness < THINNEST * shell.radius:
            least = f"must be {THINNEST:g} of the radius, {THINNEST * shell.radius:g} m, or more"
            raise InputError(f"{path}.thickness", f"{layer.thickness:g} m is too thin for an elastic solid", least)
        if not isinstance(material, Piezoelectric):
            continue
        missing = [name for name in SOLID_CONSTANTS if getattr(material, name) is None]
        if missing:
            remedy = 'give them, or use theory = "thin"'
            raise InputError(f"{path}.material.{missing[0]}", f"{material.name} has no {', '.join(missing)}", remedy)
        if np.linalg.eigvalsh(poled(material)[0])[0] <= 0.0:
            raise InputError(f"{path}.material.c11", f"the constants of {material.name} make it unstable", "C must be positive definite")


def solid_layers(shell: Shell, transit_time: float = 1.0, band: Band = USUAL_BAND) -> tuple[SolidLayer, ...]:
    """Return the layers of a shell as solids, SI, from the inside out; they have passed :func:`require_solid`.

    Parameters
    ----------
    shell : Shell
    transit_time : float
        Seconds in a transit, the unit of time of the factors of losses.
    band : Band
        Of the run, over which loss factors are fitted.
    """
    inner, found = shell.inner_radius, []
    for layer in shell.layers:
        outer, material = inner + layer.thickness, layer.material
        if isinstance(material, Viscoelastic):
            rubber = shear_relaxation(material, transit_time)
            found.append(SolidLayer(inner, outer, material.density, _rows(isotropic(material)), None, None, layer.role, rubber, True))
        elif isinstance(material, Elastic):
            factor = relaxation_of(material, transit_time, band)
            found.append(SolidLayer(inner, outer, material.density, _rows(isotropic(material)), role=layer.role, factor=factor))
        else:
            stiffness, coupling = poled(material)
            mu = material.permittivity_33, material.permittivity_22, _known(material, "permittivity_11")
            factor = relaxation_of(material, transit_time, band)
            found.append(SolidLayer(inner, outer, material.density, _rows(stiffness), _rows(coupling), mu, layer.role, factor))
        inner = outer
    return tuple(found)


def _rows(matrix: FloatArray) -> tuple[tuple[float, ...], ...]:
    return tuple(tuple(float(x) for x in row) for row in matrix)
