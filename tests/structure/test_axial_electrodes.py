"""Layers between electrodes at an axial wavenumber: against work by quadrature, dense systems, determinants and the plane problem."""

from __future__ import annotations

import math

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.numerics.modes import Modes
from coaxshell.solver.scaling import dimensionless
from coaxshell.structure import electrodes
from coaxshell.structure.axial import axial_stiffness
from coaxshell.structure.shell_model import WallMotion

BARE = cx.presets.load("bare")
ORDERS = np.array([0.0, 1.0, 2.0, 9.0])
S = np.array([3.0 + 5.0j, 40.0 + 900.0j])


def wall(inside: str = "sensor", outside: str = "actuator", loss_factor: float = 0.0, shell: int = 0):
    """Return a shell of the paper under PD control by electrodes, its layers in some roles."""
    roles = {f"shells[{i}].layers[{j}].role": role for i in (0, 1) for j, role in ((0, inside), (2, outside))}
    control = cx.PDControl(proportional=30, derivative=2, transducers="electrodes")
    changes = {**roles, "control": control, "materials.aluminium.loss_factor": loss_factor}
    return dimensionless(BARE.with_overrides(changes), dimensions=3).shells[shell]


def on_all(gain, i: int) -> np.ndarray:
    """Return a gain of one order on (U, V, W)."""
    return np.array([gain.u[i], gain.v[i], gain.w[i]])


def strains(m: float, k: float, radius: float, depth: float, moved: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return hoop and axial strain on a grid of theta and z, from a displacement and its derivatives written out."""
    theta, z = 2 * np.pi * np.arange(24)[:, None] / 24, 2 * np.pi / k * np.arange(8) / 8
    u, v, w = moved
    even = np.cos(m * theta) * np.cos(k * z)
    hoop = (v * m - w) / radius * even + depth * (v * m - w * m**2) / radius**2 * even
    return hoop, (u * k - depth * k**2 * w) * even


@pytest.mark.parametrize("k", [0.4, 7.0])
def test_forces_of_a_voltage_work_on_the_strains_of_its_layer(k):
    # int (N_theta eps_theta + N_z eps_z), N = -e~ u, is minus the work of the load; D = 0 gives the reading.
    one, rng = wall(), np.random.default_rng(1)
    modes = Modes(ORDERS, k)
    sensor, actuator = one.section.piezoelectric
    for i, m in enumerate(ORDERS):
        moved = rng.standard_normal(3) * (1.0, m > 0.0, 1.0)
        wave = np.cos(m * 2 * np.pi * np.arange(24)[:, None] / 24) * np.cos(2 * np.pi * np.arange(8) / 8)
        hoop, axial = strains(m, k, one.radius, actuator.centre, moved)
        work = -((actuator.reduced_coupling * hoop + actuator.axial.reduced_coupling * axial) * wave).sum() / (wave**2).sum()
        assert -on_all(one.drive(modes), i) @ moved == pytest.approx(work, rel=1e-10)
        hoop, axial = strains(m, k, one.radius, sensor.centre, moved)
        field = -(sensor.reduced_coupling * hoop + sensor.axial.reduced_coupling * axial) / sensor.permittivity
        read = sensor.thickness * (field * wave).sum() / (wave**2).sum()
        assert on_all(one.sensor_gain(modes), i) @ moved == pytest.approx(read, rel=1e-10)


@pytest.mark.parametrize("roles", [("sensor", "actuator"), ("self-sensing", "self-sensing")], ids=str)
@pytest.mark.parametrize("loss_factor", [0.0, 0.1])
@pytest.mark.parametrize("k", [2.5, -1j * S * math.sin(0.4)], ids=["real", "inclined"])
def test_the_operator_solves_all_three_equations(roles, loss_factor, k):
    one, modes = wall(*roles, loss_factor), Modes(ORDERS, k)
    found, law, plain = one.operator(modes, S), one.gains.at(S), one.with_gains(None)
    push, read = (gain.columns for gain in (one.drive(modes), one.sensor_gain(modes)))
    stiffness = plain.dynamic_axial_stiffness(modes, S)
    assert not np.allclose(stiffness.ww, type(one).__mro__[-4].dynamic_axial_stiffness(one, modes, S).ww, rtol=1e-9) or roles[0] != "sensor"
    for i, m in enumerate(ORDERS):
        for j, s in enumerate(S):
            at = [x[i, min(j, x.shape[1] - 1)] for x in stiffness]
            matrix = np.array([[at[0], at[1], at[2]], [at[1], at[3], at[4]], [at[2], at[4], at[5]]]) + one.mass * s**2 * np.eye(3)
            column, row = (np.array([x[i, min(j, x.shape[1] - 1)] for x in (gain.u, gain.v, gain.w)]) for gain in (push, read))
            closed = matrix - law[j] * np.outer(column, row)
            some = [0, 2] if m == 0.0 else [0, 1, 2]
            moved = np.linalg.solve(closed[np.ix_(some, some)], np.eye(len(some))[-1])
            np.testing.assert_allclose(found.impedance[i, j], 1.0 / moved[-1], rtol=1e-9)
            np.testing.assert_allclose(found.axial[i, j], moved[0] / moved[-1], rtol=1e-9)
            if m > 0.0:
                np.testing.assert_allclose(found.tangential[i, j], moved[1] / moved[-1], rtol=1e-9)
            ratio = np.linalg.det(closed[np.ix_(some, some)]) / np.linalg.det(matrix[np.ix_(some, some)])
            open_loop = plain.passive(modes, S)
            fed, along = one.fed_back(modes, open_loop)[i, j], one.fed_back_along(modes, S)[i, j]
            np.testing.assert_allclose(1.0 - law[j] * (fed / open_loop.impedance[i, j] + along), ratio, rtol=1e-8)


@pytest.mark.parametrize("roles", [("sensor", "actuator"), ("self-sensing", "self-sensing")], ids=str)
def test_a_vanishing_wavenumber_is_the_plane_problem(roles):
    one, modes, plane = wall(*roles), Modes(ORDERS, 1e-7), Modes(ORDERS)
    found, expected = one.operator(modes, S), one.operator(plane, S)
    np.testing.assert_allclose(found.impedance, expected.impedance, rtol=1e-10)
    np.testing.assert_allclose(found.tangential[1:], expected.tangential[1:], rtol=1e-10)
    depth = one.section.piezoelectric[0].centre
    near, there = one.stress_gain(modes, depth), one.stress_gain(plane, depth)
    np.testing.assert_allclose([near.v, near.w], [there.v, there.w], rtol=1e-10, atol=1e-12 * np.abs(there.w).max())


def test_open_sensors_stiffen_and_hold_energy():
    # K gains (t/mu~) b b'; a motion holds half of mu~ E^2 t in each open field, E = b'x/mu~.
    one, m, k = wall(), 3.0, 5.0
    modes, (u, v, w) = Modes(np.array([m]), k), (0.3, -0.8, 0.5)
    sensor = one.section.piezoelectric[0]
    opened = electrodes.axial_open_circuit_stiffness(one.section, modes)[..., 0]
    volts = on_all(one.sensor_gain(modes), 0) @ [u, v, w]
    moved = np.array([u, v, w])
    assert moved @ opened @ moved == pytest.approx(sensor.permittivity / sensor.thickness * volts**2, rel=1e-12)
    none = one.with_gains(None)
    plain = axial_stiffness(one.section, modes)[..., 0]
    np.testing.assert_allclose(none.dynamic_axial_stiffness(modes, S).uw[0, 0], (plain + opened)[0, 2], rtol=1e-12)
    histories = [np.full((1, 1, 1), value) for value in (w, v, 2.0, 3.0)]
    along = [np.full((1, 1, 1), value) for value in (u, 5.0)]
    motion = WallMotion(modes.orders, np.array([math.pi]), *histories, *along, wavenumber=k)
    plain = type(one).__mro__[1].energy(one, motion)
    added = one.energy(motion).piezoelectric - plain.piezoelectric
    assert float(added[0]) == pytest.approx(0.5 * one.radius * math.pi * sensor.permittivity / sensor.thickness * volts**2, rel=1e-12)


@pytest.mark.parametrize("component", ["hoop", "axial", "shear"])
@pytest.mark.parametrize("loss_factor", [0.0, 0.1])
def test_the_field_of_a_sensor_at_a_station(component, loss_factor):
    k, one = 4.0, wall(loss_factor=loss_factor)
    depth = one.section.piezoelectric[0].centre
    modes, rng = Modes(ORDERS, k), np.random.default_rng(3)
    u, v, w = rng.standard_normal((3, ORDERS.size, 5))
    fields = {"w": w, "w_z": -k * w, "w_zz": -(k**2) * w, "v": v, "v_z": -k * v, "u": u, "u_z": k * u}
    inner = one.potential_gains(modes)[0].columns
    potential = inner.v * v + inner.w * w + inner.u * u
    of_modes, of_fields = dict(one.stress_parts(modes, depth, component)), dict(one.field_parts(ORDERS, depth, component))
    assert set(of_modes) == set(of_fields)
    for factor, gain in of_modes.items():
        per = gain.columns
        expected = per.v * v + per.w * w + per.u * u
        np.testing.assert_allclose(of_fields[factor].recovered(fields, potential), expected, rtol=0, atol=1e-11 * np.abs(expected).max())
    if component != "shear":
        closed = wall("passive", "self-sensing", loss_factor)
        without = sum(on_all(gain, 2) for _, gain in closed.stress_parts(modes, depth, component))
        volts = on_all(one.sensor_gain(modes), 2)
        per_volt = electrodes.stress_per_volt(one.section.piezoelectric[0], component)
        found = sum(on_all(gain, 2) for gain in of_modes.values()) - without
        np.testing.assert_allclose(found, per_volt * volts, rtol=1e-9, atol=1e-9 * np.abs(without).max())


@pytest.mark.parametrize("roles", [("sensor", "actuator"), ("self-sensing", "self-sensing")], ids=str)
def test_frequencies_bound_what_the_wall_does(roles):
    one, modes = wall(*roles), Modes(ORDERS[1:], 3.0)
    stiffness = one.dynamic_axial_stiffness(modes, S)
    for alone in (one, one.with_gains(None)):
        top, along = alone.highest_frequency(modes), alone.along_frequencies(modes)
        law = 0.0 if alone.gains is None else alone.gains.proportional
        push, read = one.drive(modes), one.sensor_gain(modes)
        for i in range(modes.count):
            at = [x[i, 0] for x in stiffness]
            matrix = np.array([[at[0], at[1], at[2]], [at[1], at[3], at[4]], [at[2], at[4], at[5]]])
            matrix = matrix - law * np.outer(on_all(push, i), on_all(read, i))
            symmetric = 0.5 * (matrix + matrix.T)
            assert top[i] ** 2 * one.mass >= np.linalg.eigvalsh(symmetric)[-1] * (1.0 - 1e-12)
            np.testing.assert_allclose(along[i] ** 2 * one.mass, np.linalg.eigvalsh(symmetric[:2, :2]), rtol=1e-9)
