"""Stresses, energies and waves of a thin wall at an axial wavenumber: against its stiffness, the plane problem, beams and each other."""

from __future__ import annotations

import math

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.numerics.modes import Modes
from coaxshell.structure.axial import axial_stiffness, natural_frequencies, strain
from coaxshell.structure.section import Section, section
from coaxshell.structure.shell_model import WallMotion
from coaxshell.structure.thin_wall import ThinWall

STEEL = cx.Elastic(name="steel", density=7800, youngs_modulus=210e9, poisson_ratio=0.3)
PZT = cx.materials.PZT4_STANDARD
ORDERS = np.array([0.0, 1.0, 2.0, 9.0])
COMPONENTS = ("axial", "hoop", "shear")


def lopsided() -> Section:
    sensor, actuator = cx.Layer(PZT, 3e-3, role="sensor"), cx.Layer(PZT, 2e-3, role="actuator")
    soft = STEEL.replace(youngs_modulus=2e9, poisson_ratio=0.1)
    return section(cx.Shell(radius=0.3, layers=[actuator, cx.Layer(soft, 2e-2), cx.Layer(STEEL, 1e-2), sensor]))


def tube(thickness: float = 0.01) -> ThinWall:
    return ThinWall.of(section(cx.Shell(radius=1.0, layers=[cx.Layer(STEEL, thickness)])))


def row(gain, i: int) -> np.ndarray:
    """Return a gain of one order on (U, V, W)."""
    return np.array([gain.u[i], gain.v[i], gain.w[i]])


@pytest.mark.parametrize("k", [0.3, 11.0])
def test_stresses_work_on_strains_as_the_stiffness_says(k):
    # K = integral of B' sigma through the wall, fields of open-circuit layers included.
    wall, modes = lopsided(), Modes(ORDERS, k)
    model, at, (x, weights) = ThinWall.of(wall), strain(modes, wall.radius), np.polynomial.legendre.leggauss(12)
    total = np.zeros((3, 3, ORDERS.size))
    for bottom, top, _ in wall.layers:
        for point, weight in zip(x, weights, strict=True):
            depth = (bottom + top + point * (top - bottom)) / 2
            stresses = [model.stress_gain(modes, depth, component) for component in COMPONENTS]
            for i in range(ORDERS.size):
                total[..., i] += weight * (top - bottom) / 2 * at.at(depth)[..., i].T @ np.array([row(s, i) for s in stresses])
    expected = axial_stiffness(wall, modes)
    scale = np.abs(expected).max(axis=(0, 1))
    np.testing.assert_allclose(total / scale, expected / scale, rtol=0, atol=1e-12)


@pytest.mark.parametrize("depth", [None, -17e-3, -12e-3, 0.0, 5e-3, 17e-3])
def test_hoop_stress_of_a_vanishing_wavenumber_is_that_of_the_plane_problem(depth):
    model = ThinWall.of(lopsided())
    plane, near = (model.stress_gain(Modes(ORDERS, k), depth) for k in (0.0, 1e-8))
    np.testing.assert_allclose([near.v, near.w], [plane.v, plane.w], rtol=1e-12, atol=1e-12 * np.abs(plane.w).max())
    axial = model.stress_gain(Modes(ORDERS), None, "axial")  # in plane strain the wall is held along its axis: nu times the hoop stress
    np.testing.assert_allclose([axial.v, axial.w], 0.1 * np.array(model.stress_gain(Modes(ORDERS))[:2]), rtol=1e-13)


@pytest.mark.parametrize("depth", [None, -16.7e-3, -5e-3, 3e-3, 15e-3])
@pytest.mark.parametrize("component", COMPONENTS)
def test_stresses_from_the_fields_at_a_station(component, depth):
    # Where cos kz = 1 the sines vanish, and the other way round; with d/dz written out, fields give what the modes give.
    k, model = 4.0, ThinWall.of(lopsided())
    modes, rng = Modes(ORDERS, k), np.random.default_rng(3)
    u, v, w = rng.standard_normal((3, ORDERS.size, 5))
    fields = {"w": w, "w_z": -k * w, "w_zz": -(k**2) * w, "v": v, "v_z": -k * v, "u": u, "u_z": k * u}
    gain, per_mode = model.field_gain(ORDERS, depth, component), model.stress_gain(modes, depth, component).columns
    potential = None
    if gain.layer is not None:
        layer = model.potential_gains(modes)[gain.layer].columns
        potential = layer.v * v + layer.w * w + layer.u * u
        assert gain.potential != 0.0
        with pytest.raises(ValueError, match="potential"):
            gain.recovered(fields)
    expected = per_mode.v * v + per_mode.w * w + per_mode.u * u
    np.testing.assert_allclose(gain.recovered(fields, potential), expected, rtol=0, atol=1e-12 * np.abs(expected).max())
    np.testing.assert_allclose(gain.times(2.0).recovered(fields, potential), 2.0 * expected, rtol=0, atol=1e-11 * np.abs(expected).max())
    assert set(gain.fields) == ({"u", "v_z", "w_z"} if component == "shear" else {"w", "w_zz", "v", "u_z"})


@pytest.mark.parametrize("depth", [-0.005, 0.0, 0.003])
def test_a_long_tube_bends_as_a_beam(depth):
    # sigma_z = E times the curvature k^2 W and the distance R + z' from the axis, no hoop stress; w inward stretches where it is 0 degrees.
    k, wall = 1e-3, tube()
    modes = Modes(np.array([1.0]), k)
    frequency = natural_frequencies(wall.section, modes)[0, 0]
    moving = wall.passive(modes, np.array([1j * frequency]))
    axial, hoop = (
        wall.stress_gain(modes, depth, component).columns.recovered(moving.tangential, moving.axial) for component in ("axial", "hoop")
    )
    expected = -210e9 * k**2 * (1.0 + depth)
    np.testing.assert_allclose(axial[0, 0], expected, rtol=1e-5)
    assert abs(hoop[0, 0]) < 0.01 * abs(expected)


def test_energies_are_those_of_stress_and_strain():
    # Integrals over the mid-surface, one wavelength along, of sigma epsilon/2 through the layers: elastic layers alone.
    soft = STEEL.replace(youngs_modulus=2e9, poisson_ratio=0.1)
    wall = section(cx.Shell(radius=0.3, layers=[cx.Layer(soft, 2e-2), cx.Layer(STEEL, 1e-2)]))
    model, m, k, (u, v, w) = ThinWall.of(wall), 2, 4.0, (0.3, -0.8, 0.5)
    modes, angles = Modes(np.array([float(m)]), k), 2 * np.pi * np.arange(16) / 16
    even = np.cos(m * angles)[:, None] * np.cos(angles)
    odd = np.sin(m * angles)[:, None] * np.sin(angles)
    area = 0.3 * (2 * np.pi / 16) * (2 * np.pi / k / 16)
    x, weights = np.polynomial.legendre.leggauss(4)
    total = 0.0
    for bottom, top, _ in wall.layers:
        for point, weight in zip(x, weights, strict=True):
            depth = (bottom + top + point * (top - bottom)) / 2
            strains = strain(modes, 0.3).at(depth)[..., 0] @ [u, v, w]
            for eps, component, wave in zip(strains, COMPONENTS, (even, even, odd), strict=True):
                sigma = row(model.stress_gain(modes, depth, component), 0) @ [u, v, w]
                total += weight * (top - bottom) / 2 * 0.5 * sigma * eps * (wave**2).sum() * area
    histories = (np.full((1, 1, 1), value) for value in (w, v, 2.0, 3.0, u, 5.0))
    found = model.energy(WallMotion(modes.orders, np.array([math.pi]), *histories, wavenumber=k))
    along = math.pi / k  # integral of cos^2 kz over a wavelength
    np.testing.assert_allclose(found.strain[0] * along, total, rtol=1e-12)
    np.testing.assert_allclose(found.kinetic[0], 0.5 * wall.mass * 0.3 * math.pi * (4 + 9 + 25), rtol=1e-13)
    assert found.piezoelectric[0] == 0.0


def test_a_free_vibration_keeps_its_energy():
    # Kinetic energy of the rates equals strain and piezoelectric energy of the shape, omega apart; both halves of K count.
    wall, modes = lopsided(), Modes(np.array([3.0]), 5.0)
    model = ThinWall.of(wall)
    for omega in natural_frequencies(wall, modes)[0]:
        moving = model.passive(modes, np.array([1j * omega * (1 + 1e-9)]))
        shape = [np.real(x).reshape(1, 1, 1) for x in (np.ones(1), moving.tangential, moving.axial)]
        w, v, u = (x / max(np.abs(each).max() for each in shape) for x in shape)
        found = model.energy(WallMotion(modes.orders, np.array([math.pi]), w, v, omega * w, omega * v, u, omega * u, 5.0))
        np.testing.assert_allclose(found.strain + found.piezoelectric, found.kinetic, rtol=1e-6)
        assert found.piezoelectric[0] > 0.0


@pytest.mark.slow_for("0.01")
@pytest.mark.parametrize("thickness", [0.01, 0.05])
def test_nothing_runs_faster_than_the_fastest_wave(thickness):
    # Group velocities d omega/dk of all branches; stretching waves and the shortest bending waves come near the bound.
    wall, k = tube(thickness), np.linspace(1e-3, 80.0, 4001)
    found = np.stack([natural_frequencies(wall.section, Modes(ORDERS, float(x))) for x in k])
    group = np.diff(found, axis=0).max() / (k[1] - k[0])
    bound = wall.fastest_wave(80.0)
    assert 0.97 * bound < group < bound * (1 + 1e-6)
    stretching = math.sqrt(210e9 / 0.91 / 7800)
    bending = 2 * 80.0 * thickness * stretching / math.sqrt(12)
    np.testing.assert_allclose(bound, max(stretching, bending), rtol=1e-13)


def test_control_stress_along_the_axis():
    model = ThinWall.of(lopsided())
    within, outside = -16.7e-3, 0.0
    reduced = -4.1 - 73 / 115 * 14.1  # e31 and e32 of PZT-4 are alike
    np.testing.assert_allclose([model.control_stress(within, "axial"), model.control_stress(within)], -reduced / 2e-3, rtol=1e-13)
    assert model.control_stress(within, "shear") == model.control_stress(outside, "axial") == 0.0


@pytest.mark.parametrize("gain", ["stress_gain", "field_gain"])
def test_an_unknown_component_is_told(gain):
    model = ThinWall.of(lopsided())
    with pytest.raises(cx.InputError, match=r"radial.*hoop, axial or shear"):
        getattr(model, gain)(Modes(ORDERS, 1.0) if gain == "stress_gain" else ORDERS, 0.0, "radial")
