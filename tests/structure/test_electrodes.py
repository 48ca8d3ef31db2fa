"""Layers between electrodes: what they read and drive, against closed forms of the Table 1 wall."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.numerics.modes import Modes
from coaxshell.structure import electrodes
from coaxshell.structure.control_law import ControlGains
from coaxshell.structure.electroded_wall import ElectrodedWall
from coaxshell.structure.section import Section, section
from coaxshell.structure.thin import potential_gain

INNER = electrodes.with_plane_stress(cx.presets.load("bare").shells[0])
BREATHING = np.array([0.0])


def wall(gains: ControlGains | None = None, **roles: str) -> ElectrodedWall:
    """Return the Table 1 wall in SI, with other roles of its layers by name: sensor, actuator."""
    layers = [layer.replace(role=roles.get(layer.role, layer.role)) for layer in INNER.layers]
    return ElectrodedWall.of(section(INNER.replace(layers=layers)), gains)


def test_breathing_under_a_voltage_with_the_sensor_open():
    # 100 V on the actuator: eps = 100 e32~/(a22 + t e32~^2/mu33~), phi = -(t/mu33~) e32~ eps.
    one = wall()
    strain = 100.0 * one.drive(Modes(BREATHING)).w / one.stiffness(Modes(BREATHING)).ww / -one.radius
    assert float(strain[0]) == pytest.approx(-1.239604380e-6, rel=1e-9)
    volts = one.sensor_gain(Modes(BREATHING)).w * strain * -one.radius
    assert float(volts[0]) == pytest.approx(-6.411297506, rel=1e-9)


def test_an_open_circuit_stiffens_its_layer():
    plain, open_circuit = section(INNER), electrodes.open_circuit_stiffness(section(INNER), BREATHING)
    assert float(open_circuit.ww[0]) * plain.radius**2 / plain.membrane == pytest.approx(0.06850503677, rel=1e-9)
    none = electrodes.open_circuit_stiffness(wall(sensor="self-sensing").section, BREATHING)
    np.testing.assert_array_equal(none.ww, 0.0)  # a voltage is given there


def test_a_layer_by_itself_is_orthogonal_to_its_inner_potential():
    # A layer of nothing but its couplings: uniform field and half cosine together hold nearly all of t^3 e~^2/(12 mu~) of bending.
    layer = section(INNER).piezoelectric[0]
    whole = layer.thickness**3 * layer.reduced_coupling**2 / (12.0 * layer.permittivity)
    assert whole == pytest.approx(50.62313911, rel=1e-9)
    assert layer.coupling**2 / layer.zeta33 == pytest.approx(49.89083979, rel=1e-9)


def test_rigid_motions_are_not_read():
    translation = Modes(np.array([1.0]))
    read, push = wall().sensor_gain(translation), wall().drive(translation)
    assert float((read.v + read.w)[0]) == pytest.approx(0.0, abs=1e-9 * float(abs(read.v[0])))
    assert float((push.v + push.w)[0]) == pytest.approx(0.0, abs=1e-12 * float(abs(push.v[0])))  # nor driven


def test_readings_are_means_and_loads_sums():
    both = wall(sensor="self-sensing", actuator="self-sensing")
    inside, outside = wall(sensor="self-sensing", actuator="passive"), wall(sensor="passive", actuator="self-sensing")
    modes = Modes(np.arange(6.0))
    for name in ("v", "w"):
        each = [getattr(x.sensor_gain(modes), name) for x in (inside, outside)]
        np.testing.assert_allclose(getattr(both.sensor_gain(modes), name), np.mean(each, axis=0), rtol=1e-12, atol=1e-3)
        each = [getattr(x.drive(modes), name) for x in (inside, outside)]
        np.testing.assert_allclose(getattr(both.drive(modes), name), np.sum(each, axis=0), rtol=1e-12, atol=1e-12)


def test_feedback_within_one_layer_adds_a_positive_stiffness():
    # u = k phi with Q = P u, phi = S x: -P S' is symmetric and positive semidefinite.
    one, modes = wall(sensor="passive", actuator="self-sensing"), Modes(np.arange(20.0))
    push, read = one.drive(modes), one.sensor_gain(modes)
    np.testing.assert_allclose(push.v * read.w, push.w * read.v, rtol=1e-12)
    assert np.all(-push.v * read.v >= 0.0)
    assert np.all(-push.w * read.w > 0.0)


@pytest.mark.parametrize("roles", [{}, {"sensor": "self-sensing"}, {"sensor": "self-sensing", "actuator": "self-sensing"}])
def test_the_operator_solves_both_equations(roles):
    one, modes, s = wall(ControlGains(30.0, 2.0), **roles), Modes(np.array([0.0, 1.0, 2.0, 17.0])), np.array([3.0 + 5.0j, 40.0 + 900.0j])
    found, k, law = one.operator(modes, s), one.stiffness(modes), one.gains.at(s)
    push, read = one.drive(modes), one.sensor_gain(modes)
    for i in range(modes.count):
        for j, node in enumerate(s):
            matrix = np.array([[k.vv[i], k.vw[i]], [k.vw[i], k.ww[i]]]) + one.mass * node**2 * np.eye(2)
            matrix = matrix - law[j] * np.outer([push.v[i], push.w[i]], [read.v[i], read.w[i]])
            moved = np.linalg.solve(matrix, [0.0, 1.0])
            np.testing.assert_allclose(found.impedance[i, j], 1.0 / moved[1], rtol=1e-9)
            np.testing.assert_allclose(found.tangential[i, j], moved[0] / moved[1], rtol=1e-9, atol=1e-15)


def test_bending_between_opposite_faces_is_softened():
    # Sensor within, actuator outside: bending stiffness D - 1367 (k_p + k_d s) N m.
    one = wall()
    modes = Modes(np.array([1e4]))  # of which curvature rules
    push, read = one.drive(modes), one.sensor_gain(modes)
    assert float(-(push.w * read.w)[0]) * one.radius**4 / 1e16 == pytest.approx(-1367.0, rel=2e-3)


class TestStress:
    def test_an_open_sensor_holds_its_uniform_field(self):
        # D = e32~ eps + mu33~ E = 0 gives sigma = (Q + e32~^2/mu33~) eps in breathing.
        layer, one = section(INNER).piezoelectric[0], wall()
        gain = one.stress_gain(Modes(BREATHING), layer.centre)
        modulus = section(INNER).layers[0][2] + layer.reduced_coupling**2 / layer.permittivity
        assert float(gain.w[0]) == pytest.approx(-modulus / one.radius, rel=1e-12)
        axial = one.stress_gain(Modes(BREATHING), layer.centre, "axial")
        without = wall(sensor="passive").stress_gain(Modes(BREATHING), layer.centre, "axial")
        added = layer.axial.reduced_coupling * layer.reduced_coupling / layer.permittivity
        assert float((axial.w - without.w)[0]) == pytest.approx(-added / one.radius, rel=1e-12)

    def test_a_driven_layer_has_the_field_of_its_voltage(self):
        one = wall(sensor="passive", actuator="self-sensing")
        layer = one.section.piezoelectric[1]
        assert one.control_stress(layer.centre) == pytest.approx(-layer.reduced_coupling / layer.thickness, rel=1e-12)
        assert one.control_stress(0.0) == one.control_stress(one.section.piezoelectric[0].centre) == 0.0
        assert one.control_stress(layer.centre, "axial") == pytest.approx(-layer.axial.reduced_coupling / layer.thickness, rel=1e-12)
        plain = potential_gain(layer, BREATHING, one.radius)
        assert float(plain.w[0]) == 0.0  # the inner potential reads curvature alone


def test_the_least_voltage_rules():
    thin = INNER.replace(
        layers=[layer.replace(role="self-sensing", thickness=t) for layer, t in zip(INNER.layers[::2], (1e-3, 4e-3), strict=True)]
    )
    one = ElectrodedWall.of(section(thin))
    assert one.voltage_limit() == pytest.approx(590e3 * 1e-3)
    assert one.voltage_limit(1e5) == pytest.approx(1e5 * 1e-3)


def at_the_middle(one: Section) -> Section:
    """Return a section whose layers read and drive as if at z = 0."""
    return replace(one, piezoelectric=tuple(replace(layer, centre=0.0) for layer in one.piezoelectric))
