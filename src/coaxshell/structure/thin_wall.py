"""A thin layered wall (Kirchhoff and Love), V eliminated from the motion of each order in plane strain:

    Z = M s^2 + K_ww - K_vw^2/(M s^2 + K_vv),      V/W = -K_vw/(M s^2 + K_vv),

with the modal stiffness K of :mod:`coaxshell.structure.thin`. With an axial wavenumber :mod:`coaxshell.structure.axial` gives the same on
(U, V, W).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from coaxshell.model.layers import serves
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.modes import Modes, kept_with_modes
from coaxshell.structure.axial import (
    AxialStiffness,
    U,
    V,
    axial_gain,
    axial_stiffness,
    eliminated,
    entries_of,
    laminate_of,
    natural_frequencies,
    potential,
    strain,
)
from coaxshell.structure.axial_energy import axial_energy, axial_strain_energy
from coaxshell.structure.axial_stress import axial_stress_gain, stress_of_fields
from coaxshell.structure.control_law import ControlGains, ControlLaw
from coaxshell.structure.section import PiezoelectricLayer, Section
from coaxshell.structure.shell_model import (
    FieldGain,
    Gain,
    ShellModel,
    WallEnergy,
    WallMotion,
    WallOperator,
    WallStiffness,
    square,
)
from coaxshell.structure.stress import control_stress, design_stress_gain, stress_gain, wall_point
from coaxshell.structure.thin import bending_strain, open_circuit_stiffness, potential_gain, wall_stiffness

THIN_SHELL_LIMIT = 0.1
"""Thickness over radius up to which thin-shell theory is taken without a remark."""


def strain_energy(section: Section, motion: WallMotion) -> FloatArray:
    """Return what the layers of a wall hold by their own stiffness, shape (T,): (V, W) K (V, W) or, along the axis too, that of U."""
    if motion.wavenumber != 0.0:
        return axial_strain_energy(section, motion)
    weight, (w, v) = 0.5 * section.radius * motion.circle, (motion.w, motion.v)
    k = wall_stiffness(replace(section, piezoelectric=()), motion.orders)
    return square(weight * k.vv, v, v) + 2.0 * square(weight * k.vw, v, w) + square(weight * k.ww, w, w)


def tangent_eliminated(stiffness: WallStiffness, inertia: ComplexArray, modes: Modes) -> WallOperator:
    """Return impedance and V/W of a wall in plane strain, K and I s^2 given, each of shape (orders, 1) or (orders, nodes)."""
    tangential = -stiffness.vw / (inertia + np.where(modes.column == 0, 1.0, stiffness.vv))  # V_0 does not couple: K_vw = 0 there
    return WallOperator(inertia + stiffness.ww + stiffness.vw * tangential, tangential)


@dataclass(frozen=True, kw_only=True)
class ThinWall(ShellModel):
    """A wall of thin layers.

    Attributes
    ----------
    section : Section
        Its section integrals, dimensionless but for volts.
    wetted_faces : bool
        Whether the fluids wet its true faces instead of its mid-surface.
    """

    section: Section
    wetted_faces: bool = False

    @classmethod
    def of(cls, section: Section, gains: ControlLaw | None = None, *, wetted_faces: bool = False) -> Self:
        """Return the wall of a dimensionless section."""
        return cls(radius=section.radius, mass=section.mass, gains=gains, section=section, wetted_faces=wetted_faces)

    @property
    def wetted(self) -> tuple[float, float]:
        """Radii of the mid-surface, twice, or of the true faces."""
        if not self.wetted_faces:
            return self.radius, self.radius
        inner, outer = self.faces
        return self.radius + inner, self.radius + outer

    def stiffness(self, modes: Modes) -> WallStiffness:
        """Return K, membrane, cross, bending and open-circuit stiffness together."""
        return wall_stiffness(self.section, modes.orders)

    def dynamic_stiffness(self, modes: Modes, s: ComplexArray) -> WallStiffness:
        """Return K(s) in two dimensions, each entry of shape (orders, 1), or (orders, nodes) where it depends on s."""
        return WallStiffness(*(entry[:, None] for entry in self.stiffness(modes)))

    def dynamic_axial_stiffness(self, modes: Modes, s: ComplexArray) -> AxialStiffness:
        """Return K(s) on (U, V, W) at an axial wavenumber, each entry of shape (orders, 1) or (orders, nodes)."""
        return entries_of(axial_stiffness(self.section, modes))

    def passive(self, modes: Modes, s: ComplexArray) -> WallOperator:
        """Return impedance, V/W and U/W without feedback."""
        if not modes.two_dimensional:
            return eliminated(self.dynamic_axial_stiffness(modes, s), self.mass * s * s, modes)
        return tangent_eliminated(self.dynamic_stiffness(modes, s), self.mass * s * s, modes)

    def highest_frequency(self, modes: Modes) -> FloatArray:
        """Return the membrane frequency of each order, sqrt(K_vv/M); with an axial wavenumber the highest of the three frequencies."""
        if not modes.two_dimensional:
            return natural_frequencies(self.section, modes)[:, -1]
        return np.asarray(np.sqrt(self.stiffness(modes).vv / self.mass))

    def along_frequencies(self, modes: Modes) -> FloatArray:
        """Return the frequencies of V, or of U and V, where W is held, shape (orders, 1) or (orders, 2)."""
        if modes.two_dimensional:
            return super().along_frequencies(modes)
        uu, uv, vv = self._stiffness_along(modes)
        middle, half = 0.5 * (uu + vv), np.hypot(0.5 * (uu - vv), uv)
        return np.sqrt(np.maximum(np.stack([middle - half, middle + half], axis=1), 0.0) / self.mass)

    def _stiffness_along(self, modes: Modes) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return K_uu, K_uv and K_vv at an axial wavenumber, each (orders,)."""
        k = axial_stiffness(self.section, modes)
        return k[U, U], k[U, V], k[V, V]

    def fastest_wave(self, max_wavenumber: float) -> float:
        """Return the faster of stretching (or shear) waves, sqrt(a11/M), and bending waves of the largest wavenumber, 2 k sqrt(d11/M)."""
        membrane, _, bending = laminate_of(self.section).moments
        stiffening = sum(layer.axial.coupling**2 / layer.zeta33 for layer in self.section.piezoelectric if layer.axial is not None)
        stretching = math.sqrt(max(membrane.q11, membrane.q66) / self.mass)
        return max(stretching, 2.0 * max_wavenumber * math.sqrt((bending.q11 + stiffening) / self.mass))

    @property
    def crossing_order(self) -> float:
        """R sqrt(a22/d22), where membrane and bending frequencies cross."""
        section = self.section
        return self.radius * math.sqrt(section.membrane / section.bending) if section.bending > 0 else 0.0

    def has(self, role: str) -> bool:
        """Return whether it has a piezoelectric layer of a role."""
        return self.section.layer(role) is not None

    def sensor_gain(self, modes: Modes, role: str = "sensor") -> Gain:
        """Return volts of an open-circuit layer per unit (V, W, U) (Eq. 20)."""
        layer = self.section.layer(role)
        if layer is None:
            return super().sensor_gain(modes, role)
        return self._potential_gain(layer, modes)

    @property
    def shows_control(self) -> bool:
        """Whether stations show what the law reads and gives: where it is no sum of a potential and its rate."""
        return self.gains is not None and not isinstance(self.gains, ControlGains)

    @property
    def shown_potentials(self) -> int:
        """How many voltages stations show: of its piezoelectric layers, and under such control what the law reads and gives."""
        return len(self.section.piezoelectric) + (2 if self.shows_control else 0)

    def shown_voltages(self, modes: Modes, s: ComplexArray) -> tuple[Gain, ...]:
        """Return them per unit (V, W, U), each of shape (orders, 1) or (orders, nodes)."""
        found = tuple(gain.columns for gain in self.potential_gains(modes))
        if not self.shows_control:
            return found
        assert self.gains is not None
        law, read = self.gains.at(s, modes), self.sensor_gain(modes).columns
        return (*found, read, read.times(law))

    def layer_number(self, role: str) -> int | None:
        """Return the number of the layer of a role among the voltages shown; what the law reads stands for a sensor where it is shown."""
        if role == "sensor" and self.shows_control:
            return len(self.section.piezoelectric)
        return next((number for number, layer in enumerate(self.section.piezoelectric) if serves(layer.role, role)), None)

    @kept_with_modes
    def potential_gains(self, modes: Modes) -> tuple[Gain, ...]:
        """Return volts per unit (V, W, U) of every open-circuit layer, from the inside out (Eq. 20)."""
        return tuple(self._potential_gain(layer, modes) for layer in self.section.piezoelectric)

    def _potential_gain(self, layer: PiezoelectricLayer, modes: Modes) -> Gain:
        if modes.two_dimensional:
            return potential_gain(layer, modes.orders, self.radius)
        return axial_gain(potential(layer, modes, self.radius, strain(modes, self.radius)))

    @property
    def actuator_pressure(self) -> float:
        """-e32/R (Eqs. 4, 13)."""
        actuator = self.section.layer("actuator")
        return 0.0 if actuator is None else -actuator.actuator_coupling / self.radius

    def voltage_limit(self, field: float | None = None) -> float:
        """Return field limit times thickness of the actuator."""
        actuator = self.section.layer("actuator")
        if actuator is None:
            return super().voltage_limit(field)
        return (actuator.field_limit if field is None else field) * actuator.thickness

    def stress_gain(self, modes: Modes, depth: float | None = None, component: str = "hoop") -> Gain:
        """Return a stress of the core at the mid-surface (Eq. 22), or at a depth (Eqs. A.4, A.5)."""
        section, orders = self.section, modes.orders
        if component != "hoop" or not modes.two_dimensional:
            return axial_stress_gain(section, modes, depth, component)
        return design_stress_gain(section, orders) if depth is None else stress_gain(section, orders, wall_point(section, depth))

    def field_gain(self, orders: FloatArray, depth: float | None = None, component: str = "hoop") -> FieldGain:
        """Return a stress per unit of the fields at a station."""
        return stress_of_fields(self.section, orders, depth, component)

    def control_stress(self, depth: float, component: str = "hoop") -> float:
        """Return -e32/t (axial -e31/t) within the actuator, 0 elsewhere."""
        return control_stress(wall_point(self.section, depth), component)

    @property
    def faces(self) -> tuple[float, float]:
        """Depths of its inner and its outer face."""
        return self.section.layers[0][0], self.section.layers[-1][1]

    @property
    def sampled_depths(self) -> tuple[tuple[float, ...], ...]:
        """Faces of each layer, between which its strain is linear."""
        inner, outer = self.faces
        inside = 1e-8 * (outer - inner)  # on its outer face a layer gives way to the next one
        return tuple((bottom, top if top == outer else top - inside) for bottom, top, _ in self.section.layers)

    def energy(self, motion: WallMotion) -> WallEnergy:
        """Return the energies of a motion, sums over the orders with weights (R/2) beta pi.

        Kinetic M (dW/dt^2 + dV/dt^2); strain (V, W) K (V, W) with the layers' own membrane, cross and bending stiffness; piezoelectric
        the same with sum_j kappa_j k k', the open-circuit stiffening.
        """
        if motion.wavenumber != 0.0:
            return axial_energy(self.section, motion)
        orders, section, (w, v) = motion.orders, self.section, (motion.w, motion.v)
        weight = 0.5 * self.radius * motion.circle
        electric = sum((open_circuit_stiffness(x, orders, self.radius) for x in section.piezoelectric), 0.0 * weight)
        bend_v, bend_w = bending_strain(orders, self.radius)
        bending = bend_v[:, None] * v + bend_w[:, None] * w
        return WallEnergy(
            kinetic=self.mass * (square(weight, motion.w_rate, motion.w_rate) + square(weight, motion.v_rate, motion.v_rate)),
            strain=strain_energy(section, motion),
            piezoelectric=square(weight * electric, bending, bending),
        )

    def remarks(self) -> list[str]:
        """Return a sentence if it is too thick for its theory."""
        inner, outer = self.faces
        ratio = (outer - inner) / self.radius
        if ratio <= THIN_SHELL_LIMIT:
            return []
        return [
            f"thickness/radius = {ratio:.3g} is above {THIN_SHELL_LIMIT:g}, where thin-shell theory loses accuracy; use a thinner "
            'shell, or theory = "elastic"'
        ]
