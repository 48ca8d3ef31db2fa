"""A thin wall whose sensors and actuators are layers between electrodes, in plane strain (:mod:`coaxshell.structure.electrodes`).

Feedback u = H(s) phi, phi = S (V, W), loads it by Q = P u on V and W alike: its stiffness becomes K - H P S', of which V is eliminated,

    Z = M s^2 + K_ww - H P_w S_w + (K_vw - H P_w S_v) V/W,      V/W = -(K_vw - H P_v S_w)/(M s^2 + K_vv - H P_v S_v).

Where sensor and actuator are one layer P is -S times a positive number, so that positive gains stiffen and damp, at any frequency.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coaxshell.model.layers import serves
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.modes import Modes
from coaxshell.structure import electrodes
from coaxshell.structure.losses import Relaxation
from coaxshell.structure.lossy_wall import LossyWall
from coaxshell.structure.shell_model import Gain, Leading, WallEnergy, WallMotion, WallOperator, WallStiffness, square
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
        k, inertia, law = self.dynamic_stiffness(modes, s), self.mass * s * s, self.gains.at(s, modes)
        push, read = self.drive(modes).columns, self.sensor_gain(modes).columns
        along = inertia + np.where(modes.column == 0, 1.0, k.vv - law * (push.v * read.v))  # V_0 does not couple
        tangential = -(k.vw - law * (push.v * read.w)) / along
        normal = inertia + k.ww - law * (push.w * read.w)
        return WallOperator(normal + (k.vw - law * (push.w * read.v)) * tangential, tangential)

    def resistance(self, modes: Modes, s: ComplexArray) -> FloatArray:
        """Return the lesser of Re A_vv/s and Re Z/s with feedback: where V alone gives energy, Z tells nothing."""
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
        proportional = 0.0 if self.gains is None else self.gains.stiffening(modes.orders, alone)
        added = -proportional * self.drive(modes).v * self.sensor_gain(modes).v
        return np.asarray(np.sqrt(alone**2 + np.maximum(added, 0.0) / self.mass))

    # Transducers

    def drive(self, modes: Modes) -> Gain:
        """Return the load on (V, W) per volt on all actuators together."""
        return electrodes.drive(self.section, modes.orders)

    def sensor_gain(self, modes: Modes, role: str = "sensor") -> Gain:
        """Return the mean of the readings of all sensors per unit (V, W), V."""
        return electrodes.reading(self.section, modes.orders) if role == "sensor" else super().sensor_gain(modes, role)

    def charges(self, modes: Modes) -> tuple[tuple[Gain, float], ...]:
        """Return e32~ B(z_a) and mu33~/t of each actuator."""
        actuators = electrodes.serving(self.section, "actuator")
        return tuple((electrodes.push(self.section, modes.orders, one), one.permittivity / one.thickness) for one in actuators)

    def voltage_limit(self, field: float | None = None) -> float:
        """Return the least of field limit times thickness of all actuators."""
        actuators = electrodes.serving(self.section, "actuator")
        return min(((one.field_limit if field is None else field) * one.thickness for one in actuators), default=float("inf"))

    def fed_back(self, modes: Modes, moving: WallOperator) -> ComplexArray:
        """Return (P_w + P_v V/W)(S_w + S_v V/W), V/W without feedback."""
        push, read = (gain.columns.recovered(moving.tangential) for gain in (self.drive(modes), self.sensor_gain(modes)))
        return np.asarray(push * read)

    def fed_back_along(self, modes: Modes, s: ComplexArray) -> ComplexArray | float:
        """Return P_v S_v/(M s^2 + K_vv): what a unit gain takes off the relative stiffness along the hoop."""
        return np.asarray(self.sensor_gain(modes).columns.v * self.driven_along(modes, s))

    def driven_along(self, modes: Modes, s: ComplexArray) -> ComplexArray:
        """Return P_v/(M s^2 + K_vv), V per volt while W is held; V_0, which is nothing, has any stiffness."""
        along = self.mass * s * s + np.where(modes.column == 0, 1.0, self.dynamic_stiffness(modes, s).vv)
        return np.asarray(self.drive(modes).columns.v / along)

    def _feedback_size(self, modes: Modes) -> FloatArray:
        """Return |P||S|/M of each order, times the weight that the law gives it; 0 without feedback."""
        if self.gains is None:
            return np.zeros_like(modes.orders)
        size = np.hypot(*self.drive(modes)[:2]) * np.hypot(*self.sensor_gain(modes)[:2]) / self.mass
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
        layer = None if depth is None else wall_point(self.section, depth).piezoelectric
        if layer is None or layer.role != "sensor":
            return None
        factor = electrodes.stress_per_volt(layer, component) * electrodes.open_circuit_voltage(layer)
        v, w = strain_gain(modes.orders, self.radius, layer.centre)
        return Gain(factor * v, factor * w)

    def control_stress(self, depth: float, component: str = "hoop") -> float:
        """Return -e32~/t (axial -e31~/t) within each actuator, 0 elsewhere."""
        layer = wall_point(self.section, depth).piezoelectric
        return electrodes.stress_per_volt(layer, component) if layer is not None and serves(layer.role, "actuator") else 0.0

    def energy(self, motion: WallMotion) -> WallEnergy:
        """Return the energies of a motion, the fields of open sensors with the piezoelectric one."""
        found, weight = super().energy(motion), 0.5 * self.radius * motion.circle
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
        stiffening = electrodes.open_circuit_stiffness(self.section, modes.orders)
        return np.asarray(np.sqrt(super().highest_frequency(modes) ** 2 + stiffening.vv / self.mass))

    def stress_parts(self, modes: Modes, depth: float | None = None, component: str = "hoop") -> tuple[tuple[Relaxation | None, Gain], ...]:
        """Return the stress of each part, with its factor; the field of a sensor has none."""
        parts = LossyWall.stress_parts(self, modes, depth, component)
        field = self.open_circuit_stress(modes, depth, component)
        if field is None:
            return parts
        elastic = [gain for factor, gain in parts if factor is None]
        return ((None, _sum(elastic[0], field) if elastic else field), *(part for part in parts if part[0] is not None))


def _plus(one: WallStiffness, other: WallStiffness) -> WallStiffness:
    return WallStiffness(*(a + b for a, b in zip(one, other, strict=True)))


def _sum(one: Gain, other: Gain | None) -> Gain:
    return one if other is None else Gain(one.v + other.v, one.w + other.w)
