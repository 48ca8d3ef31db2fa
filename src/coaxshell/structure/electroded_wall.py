"""A thin wall whose sensors and actuators are layers between electrodes (:mod:`coaxshell.structure.electrodes`).

Feedback u = H(s) phi, phi = S (V, W), loads it by Q = P u on V and W alike: in plane strain its stiffness becomes K - H P S', of which V is
eliminated,

    Z = M s^2 + K_ww - H P_w S_w + (K_vw - H P_w S_v) V/W,      V/W = -(K_vw - H P_v S_w)/(M s^2 + K_vv - H P_v S_v).

With an axial wavenumber U and V are eliminated together (:mod:`coaxshell.structure.axial_feedback`).

Where sensor and actuator are one layer P is -S times a positive number, so that positive gains stiffen and damp, at any frequency.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coaxshell.model.layers import serves
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.modes import Modes, kept_with_modes
from coaxshell.structure import electrodes
from coaxshell.structure.axial import AxialStiffness, U, V, entries_of
from coaxshell.structure.axial_energy import energy_of_stiffness
from coaxshell.structure.axial_feedback import FedBack
from coaxshell.structure.losses import Relaxation
from coaxshell.structure.lossy_wall import LossyWall
from coaxshell.structure.section import PiezoelectricLayer
from coaxshell.structure.shell_model import (
    FieldGain,
    Gain,
    Leading,
    ShellModel,
    WallEnergy,
    WallMotion,
    WallOperator,
    WallStiffness,
    square,
)
from coaxshell.structure.stress import strain_gain, wall_point
from coaxshell.structure.thin_wall import ThinWall


@dataclass(frozen=True, kw_only=True)
class ElectrodedWall(ThinWall):
    """A wall of thin layers, piezoelectric ones between electrodes."""

    def stiffness(self, modes: Modes) -> WallStiffness:
        """Return K with the stiffening of sensors, whose circuits are open."""
        return _plus(super().stiffness(modes), electrodes.open_circuit_stiffness(self.section, modes.orders))

    def operator(self, modes: Modes, s: ComplexArray) -> WallOperator:
        """Return impedance and V/W with feedback."""
        if self.gains is None:
            return self.passive(modes, s)
        if not modes.two_dimensional:
            return self._fed_back(modes, s, self.gains.at(s, modes)).eliminated()
        k, inertia, law = self.dynamic_stiffness(modes, s), self.mass * s * s, self.gains.at(s, modes)
        push, read = self.drive(modes).columns, self.sensor_gain(modes).columns
        along = inertia + np.where(modes.column == 0, 1.0, k.vv - law * (push.v * read.v))  # V_0 does not couple
        tangential = -(k.vw - law * (push.v * read.w)) / along
        normal = inertia + k.ww - law * (push.w * read.w)
        return WallOperator(normal + (k.vw - law * (push.w * read.v)) * tangential, tangential)

    def dynamic_axial_stiffness(self, modes: Modes, s: ComplexArray) -> AxialStiffness:
        """Return K(s) on (U, V, W) with the stiffening of sensors."""
        opened = entries_of(electrodes.axial_open_circuit_stiffness(self.section, modes))
        return AxialStiffness(*(a + b for a, b in zip(super().dynamic_axial_stiffness(modes, s), opened, strict=True)))

    def _fed_back(self, modes: Modes, s: ComplexArray, law: ComplexArray | float) -> FedBack:
        """Return the whole matrix on (U, V, W) at an axial wavenumber, with feedback by a law."""
        push, read = self.drive(modes).columns, self.sensor_gain(modes).columns
        return FedBack.of(self.dynamic_axial_stiffness(modes, s), self.mass * s * s, modes, push, read, law)

    def resistance(self, modes: Modes, s: ComplexArray) -> FloatArray:
        """Return the lesser of Re A_vv/s (of U and V together) and Re Z/s with feedback: where V alone gives energy, Z tells nothing."""
        if self.gains is not None and not modes.two_dimensional:
            matrix = self._fed_back(modes, s, self.gains.at(s, modes))
            return np.minimum((matrix.eliminated().impedance / s).real, matrix.along_resistance(s))
        whole = super().resistance(modes, s)
        if self.gains is None:
            return whole
        push, read = self.drive(modes).columns, self.sensor_gain(modes).columns
        along = self.mass * s * s + self.dynamic_stiffness(modes, s).vv - self.gains.at(s, modes) * (push.v * read.v)
        return np.minimum(whole, np.where(modes.column == 0, np.inf, (along / s).real))

    def leading(self, modes: Modes) -> Leading:
        """Return mass and damping at once, that of derivative feedback on W included."""
        if self.gains is None:
            return Leading(self.mass, self.damping)
        fed_back = self.drive(modes).columns.w * self.sensor_gain(modes).columns.w
        return Leading(self.mass, self.damping - self.gains.at_once(modes) * fed_back)

    def highest_frequency(self, modes: Modes) -> FloatArray:
        """Return the membrane frequency of each order, with open sensors and what feedback stiffens it by."""
        alone = super().highest_frequency(modes)
        if not modes.two_dimensional:
            return np.asarray(np.sqrt(alone**2 + self._stiffened(modes, alone) / self.mass))
        proportional = 0.0 if self.gains is None else self.gains.stiffening(modes.orders, alone)
        added = -proportional * self.drive(modes).v * self.sensor_gain(modes).v
        return np.asarray(np.sqrt(alone**2 + np.maximum(added, 0.0) / self.mass))

    def _stiffened(self, modes: Modes, frequency: FloatArray) -> FloatArray:
        """Return the most that open sensors and proportional feedback add to K at an axial wavenumber, shape (orders,)."""
        opened = np.einsum("aam->m", electrodes.axial_open_circuit_stiffness(self.section, modes))
        if self.gains is None:
            return np.asarray(opened)
        law, push, read = self.gains.stiffening(modes.orders, frequency), self.drive(modes), self.sensor_gain(modes)
        products = sum(a * b for a, b in zip(_parts(push), _parts(read), strict=True))
        return np.asarray(
            opened + 0.5 * (np.abs(law) * length_of(push) * length_of(read) - law * products)
        )  # of the symmetric part of -H P S'

    def _stiffness_along(self, modes: Modes) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return K_uu, K_uv and K_vv at an axial wavenumber with open sensors and the symmetric part of proportional feedback."""
        opened = electrodes.axial_open_circuit_stiffness(self.section, modes)
        uu, uv, vv = (a + b for a, b in zip(super()._stiffness_along(modes), (opened[U, U], opened[U, V], opened[V, V]), strict=True))
        if self.gains is None:
            return uu, uv, vv
        law = self.gains.stiffening(modes.orders, np.sqrt(np.maximum(uu, vv) / self.mass))
        push, read = self.drive(modes), self.sensor_gain(modes)
        assert push.u is not None
        assert read.u is not None
        return uu - law * push.u * read.u, uv - 0.5 * law * (push.u * read.v + push.v * read.u), vv - law * push.v * read.v

    # Transducers

    @kept_with_modes
    def drive(self, modes: Modes) -> Gain:
        """Return the load on (V, W, U) per volt on all actuators together."""
        return electrodes.drive(self.section, modes)

    def sensor_gain(self, modes: Modes, role: str = "sensor") -> Gain:
        """Return the mean of the readings of all sensors per unit (V, W, U), V."""
        return self._readings(modes) if role == "sensor" else super().sensor_gain(modes, role)

    @kept_with_modes
    def _readings(self, modes: Modes) -> Gain:
        return electrodes.reading(self.section, modes)

    @property
    def shows_control(self) -> bool:
        """Whether it is under control: neither what it reads nor what it gives is the potential within a layer."""
        return self.gains is not None

    def charges(self, modes: Modes) -> tuple[tuple[Gain, float], ...]:
        """Return e32~ B(z_a) and mu33~/t of each actuator."""
        actuators = electrodes.serving(self.section, "actuator")
        return tuple((electrodes.push(self.section, modes, one), one.permittivity / one.thickness) for one in actuators)

    def charges_of_fields(self, orders: FloatArray) -> tuple[tuple[FieldGain, float], ...]:
        """Return the charge of each actuator per unit of the fields at a station along the axis, and mu33~/t."""
        actuators = electrodes.serving(self.section, "actuator")
        return tuple((electrodes.push_of_fields(self.section, orders, one), one.permittivity / one.thickness) for one in actuators)

    def voltage_limit(self, field: float | None = None) -> float:
        """Return the least of field limit times thickness of all actuators."""
        actuators = electrodes.serving(self.section, "actuator")
        return min(((one.field_limit if field is None else field) * one.thickness for one in actuators), default=float("inf"))

    def fed_back(self, modes: Modes, moving: WallOperator) -> ComplexArray:
        """Return (P_w + P_v V/W + P_u U/W)(S_w + S_v V/W + S_u U/W), V/W and U/W without feedback."""
        push, read = (gain.columns.recovered(moving.tangential, moving.axial) for gain in (self.drive(modes), self.sensor_gain(modes)))
        return np.asarray(push * read)

    def fed_back_along(self, modes: Modes, s: ComplexArray) -> ComplexArray | float:
        """Return P_v S_v/(M s^2 + K_vv): what a unit gain takes off the relative stiffness along the hoop, or along the wall."""
        read = self.sensor_gain(modes).columns
        if not modes.two_dimensional:
            return self._fed_back(modes, s, 0.0).answered_along(self.drive(modes).columns, read)
        return np.asarray(read.v * self.driven_along(modes, s))

    def driven_along(self, modes: Modes, s: ComplexArray) -> ComplexArray:
        """Return P_v/(M s^2 + K_vv), V per volt while W is held; V_0, which is nothing, has any stiffness."""
        along = self.mass * s * s + np.where(modes.column == 0, 1.0, self.dynamic_stiffness(modes, s).vv)
        return np.asarray(self.drive(modes).columns.v / along)

    def driven_along_both(self, modes: Modes, s: ComplexArray) -> tuple[ComplexArray, ComplexArray | None]:
        """Return V and U per volt while W is held; None for U where nothing moves along the axis."""
        if modes.two_dimensional:
            return self.driven_along(modes, s), None
        return self._fed_back(modes, s, 0.0).driven_along(self.drive(modes).columns)

    def _feedback_size(self, modes: Modes) -> FloatArray:
        """Return |P||S|/M of each order, times the weight that the law gives it; 0 without feedback."""
        if self.gains is None:
            return np.zeros_like(modes.orders)
        size = length_of(self.drive(modes)) * length_of(self.sensor_gain(modes)) / self.mass
        return np.asarray(size * np.abs(self.gains.weight(modes.orders)))

    def feedback_frequency(self, modes: Modes) -> float:
        """Return a frequency above which feedback is less than half of its inertia, and no order resonates; 0 without feedback.

        Where an order resonates the least feedback counts: traction moves the membrane, which hardly radiates.
        """
        fades = 0.0 if self.gains is None else self.gains.fades(self._feedback_size(modes))
        return max(fades, 1.2 * float(self.highest_frequency(modes).max())) if fades > 0.0 else 0.0

    def fastest_rate(self, modes: Modes) -> FloatArray:
        """Return the highest frequency of each order, or how fast feedback damps it, if that is more."""
        highest = self.highest_frequency(modes)
        return highest if self.gains is None else np.maximum(highest, self.gains.rate(self._feedback_size(modes)))

    # Stress and energy

    def stress_gain(self, modes: Modes, depth: float | None = None, component: str = "hoop") -> Gain:
        """Return a stress per unit (V, W) without that of the control voltage; in a sensor with that of its uniform field."""
        return _sum(super().stress_gain(modes, depth, component), self.open_circuit_stress(modes, depth, component))

    def open_circuit_stress(self, modes: Modes, depth: float | None, component: str) -> Gain | None:
        """Return what the uniform field of a sensor adds to a stress at a depth, per unit (V, W); None where there is no sensor."""
        layer = self._sensor_at(depth)
        if layer is None:
            return None
        if not modes.two_dimensional:
            return electrodes.open_reading(self.section, modes, layer).times(electrodes.stress_per_volt(layer, component))
        factor = electrodes.stress_per_volt(layer, component) * electrodes.open_circuit_voltage(layer)
        v, w = strain_gain(modes.orders, self.radius, layer.centre)
        return Gain(factor * v, factor * w)

    def _sensor_at(self, depth: float | None) -> PiezoelectricLayer | None:
        """Return the layer at a depth if its circuit is open."""
        layer = None if depth is None else wall_point(self.section, depth).piezoelectric
        return layer if layer in electrodes.opened(self.section) else None

    def field_gain(self, orders: FloatArray, depth: float | None = None, component: str = "hoop") -> FieldGain:
        """Return a stress per unit of the fields at a station, in a sensor with that of its uniform field."""
        return self._with_open_field(super().field_gain(orders, depth, component), orders, depth, component)

    def _with_open_field(self, gain: FieldGain, orders: FloatArray, depth: float | None, component: str) -> FieldGain:
        layer = self._sensor_at(depth)
        if layer is None or component == "shear":
            return gain
        field = electrodes.open_reading_of_fields(self.section, orders, layer).times(electrodes.stress_per_volt(layer, component))
        return gain.plus(field)

    def control_stress(self, depth: float, component: str = "hoop") -> float:
        """Return -e32~/t (axial -e31~/t) within each actuator, 0 elsewhere."""
        layer = wall_point(self.section, depth).piezoelectric
        return electrodes.stress_per_volt(layer, component) if layer is not None and serves(layer.role, "actuator") else 0.0

    def energy(self, motion: WallMotion) -> WallEnergy:
        """Return the energies of a motion, the fields of open sensors with the piezoelectric one."""
        found, weight = super().energy(motion), 0.5 * self.radius * motion.circle
        if motion.wavenumber != 0.0:
            opened = electrodes.axial_open_circuit_stiffness(self.section, Modes(motion.orders, motion.wavenumber))
            return found._replace(piezoelectric=found.piezoelectric + energy_of_stiffness(weight, opened, motion))
        k, (w, v) = electrodes.open_circuit_stiffness(self.section, motion.orders), (motion.w, motion.v)
        held = square(weight * k.vv, v, v) + 2.0 * square(weight * k.vw, v, w) + square(weight * k.ww, w, w)
        return found._replace(piezoelectric=found.piezoelectric + held)


@dataclass(frozen=True, kw_only=True)
class LossyElectrodedWall(ElectrodedWall, LossyWall):
    """A wall of thin layers between electrodes, of which some have losses; fields lose nothing."""

    def dynamic_stiffness(self, modes: Modes, s: ComplexArray) -> WallStiffness:
        """Return K(s) with the stiffening of sensors."""
        stiffening = electrodes.open_circuit_stiffness(self.section, modes.orders)
        return _plus(super().dynamic_stiffness(modes, s), WallStiffness(*(entry[:, None] for entry in stiffening)))

    def highest_frequency(self, modes: Modes) -> FloatArray:
        """Return the membrane frequency of each order at its stiffest, with open sensors and proportional feedback."""
        found = super().highest_frequency(modes)
        if not modes.two_dimensional:
            return found
        stiffening = electrodes.open_circuit_stiffness(self.section, modes.orders)
        return np.asarray(np.sqrt(found**2 + stiffening.vv / self.mass))

    def stress_parts(self, modes: Modes, depth: float | None = None, component: str = "hoop") -> tuple[tuple[Relaxation | None, Gain], ...]:
        """Return the stress of each part, with its factor; the field of a sensor has none."""
        parts = LossyWall.stress_parts(self, modes, depth, component)
        field = self.open_circuit_stress(modes, depth, component)
        if field is None:
            return parts
        elastic = [gain for factor, gain in parts if factor is None]
        return ((None, _sum(elastic[0], field) if elastic else field), *(part for part in parts if part[0] is not None))

    def field_parts(
        self, orders: FloatArray, depth: float | None = None, component: str = "hoop"
    ) -> tuple[tuple[Relaxation | None, FieldGain], ...]:
        """Return the stress of each part at a station, with its factor."""
        parts = dict(LossyWall.field_parts(self, orders, depth, component))
        if self._sensor_at(depth) is not None and component != "shear":
            parts = {None: self._with_open_field(parts.pop(None, FieldGain()), orders, depth, component), **parts}
        return tuple(parts.items())


def _plus(one: WallStiffness, other: WallStiffness) -> WallStiffness:
    return WallStiffness(*(a + b for a, b in zip(one, other, strict=True)))


def _sum(one: Gain, other: Gain | None) -> Gain:
    if other is None:
        return one
    return Gain(one.v + other.v, one.w + other.w, None if one.u is None or other.u is None else one.u + other.u)


def slid_of(wall: ShellModel, modes: Modes, s: ComplexArray) -> tuple[ComplexArray | float, ComplexArray | None]:
    """Return V and U per volt of a wall of one W, which is held."""
    return wall.driven_along_both(modes, s) if isinstance(wall, ElectrodedWall) else (wall.driven_along(modes, s), None)


def length_of(gain: Gain) -> FloatArray:
    """Return the length of a gain as a vector."""
    return np.hypot(gain.v, gain.w) if gain.u is None else np.hypot(np.hypot(gain.v, gain.w), gain.u)


def _parts(gain: Gain) -> list[FloatArray]:
    """Return the parts of a gain that there are."""
    return [part for part in gain if part is not None]
