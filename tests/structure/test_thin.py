"""The modal stiffness of a ring against closed forms: natural frequencies, rigid motion, energy, and the sign of bending."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.structure.section import Section, section
from coaxshell.structure.thin import bending_strain, membrane_strain, open_circuit_stiffness, potential_gain, wall_stiffness

ORDERS = np.arange(0.0, 13.0)
STEEL = cx.Elastic(name="steel", density=7800, youngs_modulus=200e9, poisson_ratio=0.3)


def thin(thickness: float) -> Section:
    return section(cx.Shell(radius=0.7, layers=[cx.Layer(STEEL, thickness)]))


def frequencies(wall: Section) -> np.ndarray:
    """Return the squared natural frequencies in vacuo, shape (orders, 2), ascending."""
    k = wall_stiffness(wall, ORDERS)
    matrices = np.array([[k.vv, k.vw], [k.vw, k.ww]]).transpose(2, 0, 1) / wall.mass
    return np.linalg.eigvalsh(matrices)


def test_flexural_frequencies_of_a_thin_ring() -> None:
    # D/(rho h R^4) m^2 (m^2 - 1)^2/(m^2 + 1), up to the stretching, (h/R)^2 times m^2.
    wall = thin(7e-5)
    m2 = ORDERS[2:] ** 2
    expected = wall.bending / (wall.mass * 0.7**4) * m2 * (m2 - 1) ** 2 / (m2 + 1)
    np.testing.assert_allclose(frequencies(wall)[2:, 0], expected, rtol=5e-8)


def test_breathing_and_membrane_frequencies() -> None:
    wall = thin(7e-5)
    membrane = wall.membrane / (wall.mass * 0.7**2) * (ORDERS**2 + 1)
    np.testing.assert_allclose(frequencies(wall)[:, 1], membrane, rtol=3e-8)


@pytest.mark.parametrize("name", ["bare", "iakovlev-evacuated"])
def test_rigid_translation_is_free(name: str) -> None:
    for shell in cx.presets.load(name).shells:
        wall = section(shell)
        k = wall_stiffness(wall, 1.0)
        scale = abs(k.vv)
        np.testing.assert_allclose([k.vv + k.vw, k.vw + k.ww], 0.0, rtol=0, atol=1e-12 * scale)
        for parts in (membrane_strain(np.array([1.0]), 0.5), bending_strain(np.array([1.0]), 0.5)):
            assert parts[0] + parts[1] == 0.0
        for layer in wall.piezoelectric:
            gain_v, gain_w, _ = potential_gain(layer, 1.0, wall.radius)
            assert gain_v != 0.0
            assert gain_v + gain_w == 0.0


def test_static_compliance_of_a_ring_under_uniform_pressure() -> None:
    # Hoop force p R, strain p R/a22, inward displacement p R^2/a22.
    wall = thin(5e-3)
    np.testing.assert_allclose(1 / wall_stiffness(wall, 0.0).ww, 0.7**2 / wall.membrane, rtol=1e-13)


def bent_energy(wall: Section, m: int, v: float, w: float) -> float:
    """Return the strain energy over V, W squared by quadrature over the angle and through the layers, from the geometry of a normal.

    A normal at a mid-surface point that moves by (-w cos m theta) outward and (v sin m theta) along turns by
    (v + dw/dtheta)/R, so the fibre at z (outward) moves along by v + z/R (v + dw/dtheta) and outward by -w.
    """
    theta = np.arange(64) * (2 * math.pi / 64)
    x, weights = np.polynomial.legendre.leggauss(8)
    energy = 0.0
    for bottom, top, modulus in wall.layers:
        for z, weight in zip((top + bottom + x * (top - bottom)) / 2, weights * (top - bottom) / 2, strict=True):
            along = m * v + z / wall.radius * (m * v - m * m * w)  # derivative of the amplitude of sin m theta
            strain = (along - w) / wall.radius * np.cos(m * theta)
            energy += modulus * weight * np.sum(strain**2) / 64
    return energy * (1 if m == 0 else 2)


@pytest.mark.parametrize("m", [0, 1, 2, 7])
@pytest.mark.parametrize(("v", "w"), [(1.0, 0.0), (0.0, 1.0), (0.3, 0.9), (0.5, -0.2)])
def test_energy_of_an_unsymmetric_layup(m: int, v: float, w: float) -> None:
    # The sign of z decides here: the layup is far from symmetric, b22 matters.
    soft = STEEL.replace(youngs_modulus=2e9)
    wall = section(cx.Shell(radius=0.3, layers=[cx.Layer(soft, 2e-2), cx.Layer(STEEL, 1e-2)]))
    k = wall_stiffness(wall, float(m))
    energy = k.vv * v * v + 2 * k.vw * v * w + k.ww * w * w
    np.testing.assert_allclose(energy, bent_energy(wall, m, v, w), rtol=1e-11, atol=1e-9 * wall.membrane)


def test_open_circuit_layers_stiffen_bending_alone() -> None:
    wall = section(cx.presets.load("bare").shells[0])
    with_layers, without = wall_stiffness(wall, ORDERS), wall_stiffness(dataclasses.replace(wall, piezoelectric=()), ORDERS)
    kappa = sum(open_circuit_stiffness(layer, ORDERS, wall.radius) for layer in wall.piezoelectric)
    assert (kappa > 0).all()
    curvature_v, curvature_w = bending_strain(ORDERS, wall.radius)
    np.testing.assert_allclose(with_layers.vv - without.vv, kappa * curvature_v**2, rtol=1e-8, atol=1e-8)
    np.testing.assert_allclose(with_layers.ww - without.ww, kappa * curvature_w**2, rtol=1e-8, atol=1e-8)
    assert (with_layers.ww - without.ww)[:1] == 0.0  # breathing does not bend


@pytest.mark.parametrize("radius", [0.5, 2.0])
def test_open_circuit_stiffness_by_hand(radius: float) -> None:
    # kappa = E^2/(zeta33 + m^2 zeta22/R^2), R once; at m = 150 the second term is no small one.
    layers = cx.presets.load("bare").shells[0].layers
    layer = section(cx.Shell(radius=radius, layers=layers)).layer("sensor")
    t, e = 3e-3, -4.1 - 73 / 115 * 14.1
    zeta33, zeta22 = (5.841e-9 - 14.1**2 / 115e9) * math.pi**2 / (2 * t), 7.124e-9 * t / 2
    m = np.array([0.0, 3.0, 150.0])
    expected = (e * 2 * t / math.pi) ** 2 / (zeta33 + m**2 * zeta22 / radius**2)
    np.testing.assert_allclose(open_circuit_stiffness(layer, m, radius), expected, rtol=1e-13)


def test_sensor_equation_by_hand() -> None:
    # phi = E (m V - m^2 W)/(zeta33 R^2 + m^2 zeta22), R once (Eq. 20 prints it twice).
    layer = section(cx.presets.load("bare").shells[0]).layer("sensor")
    t, e = 3e-3, -4.1 - 73 / 115 * 14.1
    zeta33, zeta22 = (5.841e-9 - 14.1**2 / 115e9) * math.pi**2 / (2 * t), 7.124e-9 * t / 2
    gain_v, gain_w, _ = potential_gain(layer, 3.0, 0.5)
    expected = e * 2 * t / math.pi * np.array([3.0, -9.0]) / (zeta33 * 0.25 + 9 * zeta22)
    np.testing.assert_allclose([gain_v, gain_w], expected, rtol=1e-13)
