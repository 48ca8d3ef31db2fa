"""An isotropic solid layer by its potentials, with any bulk and shear modulus at every Laplace node.

    u = grad phi + curl (psi z) + curl curl (chi z),
    phi ~ cos m theta cos kz,      psi ~ sin m theta cos kz,      chi ~ cos m theta sin kz,

chi in waves along the axis alone, z the unit vector along it. All solve Helmholtz's equation, phi'' + phi'/r - (m/r)^2 phi = kappa_L^2 phi
with kappa_L^2 = k^2 + q_L^2, q_L^2 = rho s^2/(K + 4 G/3), psi and chi with kappa_S^2 = k^2 + q_S^2, q_S^2 = rho s^2/G:

    u_r = phi' + (m/r) psi + k chi',      u_theta = -(m/r) phi - psi' - k (m/r) chi,      u_z = -k phi - kappa_S^2 chi,
    sigma_r = rho s^2 phi + 2 G (((m/r)^2 + k^2) phi - phi'/r) + 2 G (m/r) (psi' - psi/r) + 2 G k ((kappa_S^2 + (m/r)^2) chi - chi'/r),
    tau_theta = 2 G (m/r) (phi/r - phi') - G ((kappa_S^2 + 2 (m/r)^2) psi - 2 psi'/r) + 2 G k (m/r) (chi/r - chi'),
    tau_z = -2 G k phi' - G k (m/r) psi - G (kappa_S^2 + k^2) chi'.

The waves of chi are taken 1/kappa_S as large, which makes their displacements as large as those of the others.

Each is a sum of I_m, 1 at the outer face, and of K_m, 1 at the inner face, which stay bounded however short the waves are. Moduli may
depend on s as they like: a rubber, whose G relaxes while K does not, needs no mesh, resolves every wave and does not lock as nu nears 1/2.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.modes import Modes
from coaxshell.numerics.radial_functions import RadialFunctions, i_across, k_across
from coaxshell.structure.elastic_depth import Shown
from coaxshell.structure.solid import SolidLayer


class _Wave(NamedTuple):
    """One potential at one radius: its value and slope, each (orders, nodes)."""

    value: ComplexArray
    slope: ComplexArray


def moduli(layer: SolidLayer, s: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
    """Return K and G of an isotropic layer at Laplace nodes, each of their shape."""
    g = np.ones_like(s) if layer.factor is None else layer.factor.at(s)
    return layer.bulk * (np.ones_like(s) if layer.shear_alone else g), layer.shear * g


class Potentials:
    """The fields of an isotropic layer at some modes and a block of nodes: four waves, six along the axis.

    Parameters
    ----------
    layer : SolidLayer
    modes : Modes
        Of a real wavenumber.
    s : ndarray, shape (nodes,)
        Laplace variable.

    Attributes
    ----------
    wavenumber : float
        k.
    count : int
        Number of the waves, and of the forces on the faces.
    """

    def __init__(self, layer: SolidLayer, modes: Modes, s: ComplexArray) -> None:
        assert isinstance(modes.wavenumber, (int, float))
        self.wavenumber = float(modes.wavenumber)
        self.count = 4 if modes.two_dimensional else 6
        self.layer, self.modes, self.s = layer, modes, s
        bulk, self.shear = moduli(layer, s)
        self._stiff = bulk + 4.0 / 3.0 * self.shear
        self._lame_share = (bulk - 2.0 / 3.0 * self.shear) / self._stiff
        self._inertia = layer.density * s * s
        self._wavenumbers = [modes.radial(s * np.sqrt(layer.density / modulus)) for modulus in (self._stiff, self.shear)]
        self._known: dict[float, list[_Wave]] = {}
        self._ends = [(self._functions(q, layer.inner), self._functions(q, layer.outer)) for q in self._wavenumbers]

    def _functions(self, wavenumber: ComplexArray, radius: float) -> RadialFunctions:
        return RadialFunctions(wavenumber, radius, self.modes.orders, self.modes.sparse, left=True)  # natural modes lie there

    def _waves(self, radius: float) -> list[_Wave]:
        """Return phi of I and of K, psi of I and of K and, along the axis, chi of I and of K at a radius."""
        if radius in self._known:
            return self._known[radius]
        found = self._known[radius] = []
        for wavenumber, (inner, outer) in zip(self._wavenumbers, self._ends, strict=True):
            here = inner if radius == inner.radius else outer if radius == outer.radius else self._functions(wavenumber, radius)
            standing = i_across(here, outer)
            evanescent = k_across(inner, here)
            found += [_Wave(standing, standing / here.disc), _Wave(evanescent, evanescent / here.exterior)]
        if self.wavenumber:
            found += [_Wave(wave.value / self._wavenumbers[1], wave.slope / self._wavenumbers[1]) for wave in found[2:]]
        return found

    def rows(self, radius: float, asked: tuple[Shown, ...]) -> ComplexArray:
        """Return quantities at a radius per unit of each of the waves, shape (quantities, waves, orders, nodes).

        Displacements as :data:`coaxshell.structure.elastic_depth.DISPLACEMENTS` signs them.
        """
        waves, m = self._waves(radius), self.modes.column / radius
        found = np.zeros((len(asked), self.count, self.modes.count, self.s.size), np.complex128)
        for row, what in zip(found, asked, strict=True):
            for number, wave in enumerate(waves):
                one = (self._of_phi, self._of_psi, self._of_chi)[number // 2](what, wave, radius, m)
                if one is not None:
                    row[number] = one
        return found

    def _of_phi(self, what: Shown, wave: _Wave, r: float, m: FloatArray) -> ComplexArray | None:
        (y, d), k, twice = wave, self.wavenumber, 2.0 * self.shear
        if what == "normal":
            return -d
        if what == "tangential":
            return -m * y
        if what == "radial":
            return self._inertia * y + twice * ((m * m + k * k) * y - d / r)
        if what == "hoop":
            return self._inertia * self._lame_share * y + twice * (d / r - m * m * y)
        if what == "axial":
            spread = self._inertia * self._lame_share
            return (spread - twice * (k * k) if k else spread) * y
        if what == "radial_hoop":
            return twice * m * (y / r - d)
        return self._of_phi_along(what, wave, m) if k else None

    def _of_phi_along(self, what: Shown, wave: _Wave, m: FloatArray) -> ComplexArray | None:
        (y, d), k = wave, self.wavenumber
        if what == "along_axis":
            return -k * y
        if what == "shear":
            return 2.0 * k * self.shear * (m * y)
        return -2.0 * k * self.shear * d if what == "radial_axial" else None

    def _of_psi(self, what: Shown, wave: _Wave, r: float, m: FloatArray) -> ComplexArray | None:
        (y, d), k = wave, self.wavenumber
        if what == "normal":
            return -m * y
        if what == "tangential":
            return -d
        if what in ("radial", "hoop"):
            around = 2.0 * self.shear * m * (d - y / r)
            return around if what == "radial" else -around
        if what == "radial_hoop":
            across = self._inertia + self.shear * (k * k) if k else self._inertia
            return 2.0 * self.shear * (d / r - m * m * y) - across * y
        if what == "shear" and k:
            return k * self.shear * d
        return -k * self.shear * (m * y) if what == "radial_axial" and k else None

    def _of_chi(self, what: Shown, wave: _Wave, r: float, m: FloatArray) -> ComplexArray | None:
        (y, d), k, squared = wave, self.wavenumber, self._wavenumbers[1] ** 2
        if what == "normal":
            return -k * d
        if what == "tangential":
            return -k * m * y
        if what == "along_axis":
            return -squared * y
        twice = 2.0 * k * self.shear
        if what == "radial":
            return twice * ((squared + m * m) * y - d / r)
        if what == "hoop":
            return twice * (d / r - m * m * y)
        if what == "axial":
            return -twice * squared * y
        if what == "radial_hoop":
            return twice * m * (y / r - d)
        both = self.shear * (squared + k * k)
        if what == "shear":
            return both * (m * y)
        return -both * d if what == "radial_axial" else None

    def motion(self, radius: float) -> ComplexArray:
        """Return displacements and strains at a radius per unit of each wave, shape (5, 4, orders, nodes) or, along the axis, (9, 6, ...).

        u_r, u_theta, eps_r + eps_theta + eps_z, eps_theta, gamma_r_theta; then u_z, eps_z, gamma_theta_z, gamma_rz.
        """
        normal, tangential, shear = self.rows(radius, ("normal", "tangential", "radial_hoop"))
        spread = np.zeros_like(normal)
        for number, wave in enumerate(self._waves(radius)[:2]):
            spread[number] = self._inertia / self._stiff * wave.value
        found = [-normal, tangential, spread, (self.modes.column * tangential - normal) / radius, shear / self.shear]
        if self.wavenumber:
            axial, across, along = self.rows(radius, ("along_axis", "shear", "radial_axial"))
            found += [axial, self.wavenumber * axial, across / self.shear, along / self.shear]
        return np.stack(found)

    def _tractions(self) -> ComplexArray:
        """Return the forces on the faces per unit of each wave, shape (orders, nodes, forces, waves).

        On (u_r, u_theta) and, along the axis, u_z inside and outside: r times the traction on the layer, -(sigma_r, tau) on the inner face,
        (sigma_r, tau) on the outer one.
        """
        names: tuple[Shown, ...] = ("radial", "radial_hoop", "radial_axial")
        matrix = np.empty((self.modes.count, self.s.size, self.count, self.count), np.complex128)
        half = self.count // 2
        for start, radius, sign in ((0, self.layer.inner, -1.0), (half, self.layer.outer, 1.0)):
            rows = self.rows(radius, names[:half])
            matrix[..., start : start + half, :] = np.moveaxis(sign * radius * rows, (0, 1), (2, 3))
        return matrix

    def per_force(self, rows: ComplexArray) -> ComplexArray:
        """Return rows per unit of each wave as rows per force on the faces, both of shape (rows, waves, orders, nodes)."""
        found = np.linalg.solve(np.swapaxes(self._tractions(), 2, 3), np.moveaxis(rows, (0, 1), (3, 2)))
        return np.ascontiguousarray(np.moveaxis(found, (3, 2), (0, 1)))

    def waves(self, forces: ComplexArray) -> ComplexArray:
        """Return the waves under forces on the faces, both of shape (waves, parities, orders, nodes)."""
        found = np.linalg.solve(self._tractions(), np.moveaxis(forces, (0, 1), (2, 3)))
        return np.ascontiguousarray(np.moveaxis(found, (2, 3), (0, 1)))
