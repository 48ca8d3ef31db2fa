"""An isotropic solid layer in the plane by its two potentials, with any bulk and shear modulus at every Laplace node.

    u = grad phi + curl psi,      phi ~ cos m theta,      psi ~ sin m theta,

both solve Helmholtz's equation, phi'' + phi'/r - (m/r)^2 phi = q_L^2 phi with q_L^2 = rho s^2/(K + 4 G/3), and psi with q_S^2 = rho s^2/G:

    u_r = phi' + (m/r) psi,      u_theta = -(m/r) phi - psi',
    sigma_r = rho s^2 phi + 2 G ((m/r)^2 phi - phi'/r) + 2 G (m/r) (psi' - psi/r),
    tau = 2 G (m/r) (phi/r - phi') - G ((q_S^2 + 2 (m/r)^2) psi - 2 psi'/r).

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
    """The fields of an isotropic layer at some modes of the plane and a block of nodes.

    Parameters
    ----------
    layer : SolidLayer
    modes : Modes
    s : ndarray, shape (nodes,)
        Laplace variable.
    """

    def __init__(self, layer: SolidLayer, modes: Modes, s: ComplexArray) -> None:
        assert modes.two_dimensional
        self.layer, self.modes, self.s = layer, modes, s
        bulk, self.shear = moduli(layer, s)
        self._stiff = bulk + 4.0 / 3.0 * self.shear
        self._lame_share = (bulk - 2.0 / 3.0 * self.shear) / self._stiff
        self._inertia = layer.density * s * s
        self._wavenumbers = s * np.sqrt(layer.density / self._stiff), s * np.sqrt(layer.density / self.shear)
        self._known: dict[float, list[_Wave]] = {}
        self._ends = [(self._functions(q, layer.inner), self._functions(q, layer.outer)) for q in self._wavenumbers]

    def _functions(self, wavenumber: ComplexArray, radius: float) -> RadialFunctions:
        return RadialFunctions(wavenumber, radius, self.modes.orders, self.modes.sparse, left=True)  # natural modes lie there

    def _waves(self, radius: float) -> list[_Wave]:
        """Return phi of I and of K and psi of I and of K at a radius."""
        if radius in self._known:
            return self._known[radius]
        found = self._known[radius] = []
        for wavenumber, (inner, outer) in zip(self._wavenumbers, self._ends, strict=True):
            here = inner if radius == inner.radius else outer if radius == outer.radius else self._functions(wavenumber, radius)
            standing = i_across(here, outer)
            evanescent = k_across(inner, here)
            found += [_Wave(standing, standing / here.disc), _Wave(evanescent, evanescent / here.exterior)]
        return found

    def rows(self, radius: float, asked: tuple[Shown, ...]) -> ComplexArray:
        """Return quantities at a radius per unit of each of the four waves, shape (quantities, 4, orders, nodes).

        Displacements as :data:`coaxshell.structure.elastic_depth.DISPLACEMENTS` signs them.
        """
        waves, m = self._waves(radius), self.modes.column / radius
        found = np.zeros((len(asked), 4, self.modes.count, self.s.size), np.complex128)
        for row, what in zip(found, asked, strict=True):
            for number, wave in enumerate(waves):
                one = self._of_phi(what, wave, radius, m) if number < 2 else self._of_psi(what, wave, radius, m)
                if one is not None:
                    row[number] = one
        return found

    def _of_phi(self, what: Shown, wave: _Wave, r: float, m: FloatArray) -> ComplexArray | None:
        y, d = wave
        twice = 2.0 * self.shear
        if what == "normal":
            return -d
        if what == "tangential":
            return -m * y
        if what == "radial":
            return self._inertia * y + twice * (m * m * y - d / r)
        if what == "hoop":
            return self._inertia * self._lame_share * y + twice * (d / r - m * m * y)
        if what == "axial":
            return self._inertia * self._lame_share * y
        return twice * m * (y / r - d) if what == "radial_hoop" else None

    def _of_psi(self, what: Shown, wave: _Wave, r: float, m: FloatArray) -> ComplexArray | None:
        y, d = wave
        if what == "normal":
            return -m * y
        if what == "tangential":
            return -d
        if what in ("radial", "hoop"):
            around = 2.0 * self.shear * m * (d - y / r)
            return around if what == "radial" else -around
        if what == "radial_hoop":
            return 2.0 * self.shear * (d / r - m * m * y) - self._inertia * y
        return None

    def motion(self, radius: float) -> ComplexArray:
        """Return u_r, u_theta, eps_r + eps_theta, eps_theta and gamma at a radius per unit of each wave, shape (5, 4, orders, nodes)."""
        normal, tangential, shear = self.rows(radius, ("normal", "tangential", "radial_hoop"))
        spread = np.zeros_like(normal)
        for number, wave in enumerate(self._waves(radius)[:2]):
            spread[number] = self._inertia / self._stiff * wave.value
        return np.stack([-normal, tangential, spread, (self.modes.column * tangential - normal) / radius, shear / self.shear])

    def _tractions(self) -> ComplexArray:
        """Return the forces on the faces per unit of each wave, shape (orders, nodes, 4 forces, 4 waves).

        On (u_r, u_theta) inside and outside: r times the traction on the layer, -(sigma_r, tau) on the inner face, (sigma_r, tau) on the
        outer one.
        """
        matrix = np.empty((self.modes.count, self.s.size, 4, 4), np.complex128)
        for start, radius, sign in ((0, self.layer.inner, -1.0), (2, self.layer.outer, 1.0)):
            rows = self.rows(radius, ("radial", "radial_hoop"))
            matrix[..., start : start + 2, :] = np.moveaxis(sign * radius * rows, (0, 1), (2, 3))
        return matrix

    def per_force(self, rows: ComplexArray) -> ComplexArray:
        """Return rows per unit of each wave as rows per force on the faces, both of shape (rows, 4, orders, nodes)."""
        found = np.linalg.solve(np.swapaxes(self._tractions(), 2, 3), np.moveaxis(rows, (0, 1), (3, 2)))
        return np.ascontiguousarray(np.moveaxis(found, (3, 2), (0, 1)))

    def waves(self, forces: ComplexArray) -> ComplexArray:
        """Return the four waves under forces on the faces, both of shape (4, parities, orders, nodes)."""
        found = np.linalg.solve(self._tractions(), np.moveaxis(forces, (0, 1), (2, 3)))
        return np.ascontiguousarray(np.moveaxis(found, (2, 3), (0, 1)))
