"""Stress through the wall: against the geometry of a straight normal, a hand-made layup, and the ring's modal stiffness."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from coaxshell.errors import InputError
from coaxshell.model import VACUUM, Fluid, Layer, Shell, SphericalShock, System, materials
from coaxshell.response import Response
from coaxshell.solver.solution import ModalSolution
from coaxshell.structure.section import Section, section
from coaxshell.structure.stress import control_stress, strain_gain, stress_gain, wall_point
from coaxshell.structure.thin import open_circuit_stiffness, wall_stiffness

ORDERS = np.array([0.0, 1.0, 2.0, 5.0, 40.0])
THICKNESS = 13e-3
PER_DEGREE = math.pi / 180
WATER = Fluid(density=1000, sound_speed=1400)
SOURCE = SphericalShock(distance=5.0, peak_pressure=2.5e4, decay_time=1.314e-4)


def stretched(radius: float, z: float, m: int, v: float, w: float, theta: np.ndarray) -> np.ndarray:
    """Return the strain of the fibre at z outward, by bending a circle with its normals and measuring lengths."""
    h = 1e-4

    def fibre(t: np.ndarray) -> np.ndarray:
        def middle(u: np.ndarray) -> np.ndarray:
            # w counts inward, v towards increasing angle
            return (radius - w * np.cos(m * u)) * np.exp(1j * u) + 1j * v * np.sin(m * u) * np.exp(1j * u)

        tangent = middle(t + h) - middle(t - h)
        return middle(t) + z * tangent / abs(tangent) / 1j  # a quarter turn back from the tangent points outward

    relaxed = 2 * (radius + z) * math.sin(h)
    return abs(fibre(theta + h) - fibre(theta - h)) / relaxed - 1


@pytest.mark.parametrize("z", [0.004, -0.004])
@pytest.mark.parametrize("m", [2, 5])
def test_strain_is_that_of_a_bent_ring(z: float, m: int) -> None:
    # v = w/m stretches nothing at the mid-surface, so the bending part stands alone; thin-wall theory drops (z/R)^2.
    w = 1e-6
    theta = np.linspace(0.1, 6.0, 7)
    gain_v, gain_w = strain_gain(m, 1.0, z)
    expected = (gain_v * w / m + gain_w * w) * np.cos(m * theta)
    found = stretched(1.0, z, m, w / m, w, theta)
    np.testing.assert_allclose(found, expected, rtol=0, atol=0.006 * abs(expected).max())


def test_mid_surface_strain_is_that_of_a_stretched_ring() -> None:
    theta = np.linspace(0.1, 6.0, 7)
    gain_v, gain_w = strain_gain(3, 1.0, 0.0)
    found = stretched(1.0, 0.0, 3, 2e-6, -1e-6, theta)
    np.testing.assert_allclose(found, (2e-6 * gain_v - 1e-6 * gain_w) * np.cos(3 * theta), rtol=0, atol=1e-10)


def resultants(wall: Section, component: int) -> tuple[np.ndarray, np.ndarray]:
    """Integrate stress and stress times z through the wall by Gauss points in every layer."""
    points, weights = np.polynomial.legendre.leggauss(12)
    force, moment = np.zeros_like(ORDERS), np.zeros_like(ORDERS)
    for bottom, top, _ in wall.layers:
        for x, weight in zip(points, weights, strict=True):
            z = (bottom + top) / 2 + x * (top - bottom) / 2
            sigma = stress_gain(wall, ORDERS, wall_point(wall, z))[component]
            force += weight * (top - bottom) / 2 * sigma
            moment += weight * (top - bottom) / 2 * sigma * z
    return force, moment


@pytest.mark.parametrize("component", [0, 1])
def test_resultants_are_the_section_times_strain_and_curvature(lopsided_section: Section, component: int) -> None:
    # The open-circuit layers must stiffen the bending by kappa, in agreement with the ring's modal stiffness.
    wall = lopsided_section
    strain = strain_gain(ORDERS, wall.radius, 0.0)[component]
    curvature = strain_gain(ORDERS, wall.radius, 1.0)[component] - strain
    stiffening = sum(open_circuit_stiffness(layer, ORDERS, wall.radius) for layer in wall.piezoelectric)
    force, moment = resultants(wall, component)
    assert abs(wall.cross) > 1e-3 * wall.membrane * THICKNESS  # the layup is lopsided indeed
    assert (stiffening > 1e-3 * wall.bending).all()  # and the potentials count
    np.testing.assert_allclose(force, wall.membrane * strain + wall.cross * curvature, rtol=1e-12, atol=1e-6)
    np.testing.assert_allclose(moment, wall.cross * strain + (wall.bending + stiffening) * curvature, rtol=1e-10, atol=1e-6)


def test_resultants_do_the_work_of_the_modal_stiffness(lopsided_section: Section) -> None:
    wall = lopsided_section
    stiffness = wall_stiffness(wall, ORDERS)
    work = {}
    for i in (0, 1):
        force, moment = resultants(wall, i)
        for j in (0, 1):
            strain = strain_gain(ORDERS, wall.radius, 0.0)[j]
            curvature = strain_gain(ORDERS, wall.radius, 1.0)[j] - strain
            work[i, j] = force * strain + moment * curvature
    scale = abs(np.array([stiffness.vv, stiffness.vw, stiffness.ww])).max()
    for found, expected in ((work[0, 0], stiffness.vv), (work[0, 1], stiffness.vw), (work[1, 0], stiffness.vw), (work[1, 1], stiffness.ww)):
        np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-13 * scale)


def test_by_hand_in_every_layer(make: Callable[..., ModalSolution]) -> None:
    """Compare a response of order 2 alone with strain, modulus and potential written out with the materials' own constants."""
    solution = make(System(shells=[Shell(radius=0.5, layers=_layers())], fluids=[VACUUM, WATER], source=SOURCE), parities=1)
    for part in (solution.normal, solution.tangential):
        part[:, :, :2] = part[:, :, 3:] = 0.0
    w, v = 0.5 * solution.normal[0, 0, 2], 0.5 * solution.tangential[0, 0, 2]  # metres: a = 0.5 m
    angle, r = 20.0, 0.5
    cos = math.cos(2 * angle * PER_DEGREE)
    pzt = materials.PZT4_STANDARD

    def strain(z: float) -> np.ndarray:
        return ((2 * v - w) / r + z * (2 * v - 4 * w) / r**2) * cos

    t, centre = 2e-3, -5.5e-3
    e = pzt.e32 - pzt.c23 * pzt.e33 / pzt.c33
    zeta33, zeta22 = (pzt.permittivity_33 + pzt.e33**2 / pzt.c33) * math.pi**2 / (2 * t), pzt.permittivity_22 * t / 2
    phi = e * 2 * t / math.pi * (2 * v - 4 * w) / (zeta33 * r**2 + 4 * zeta22) * cos
    z = -6e-3
    field = -math.pi / t * math.sin(math.pi * (z - centre) / t) * phi  # -dPhi/dz, Phi = -cos(pi (z - centre)/t) phi
    sensor = (pzt.c22 - pzt.c23**2 / pzt.c33) * strain(z) - e * field
    found = Response(solution)
    np.testing.assert_allclose(found.stress(0, angle, depth=z), sensor, rtol=1e-10, atol=1e-3)
    aluminium, steel = 70e9 / (1 - 0.33**2), 210e9 / (1 - 0.3**2)
    np.testing.assert_allclose(found.stress(0, angle, depth=-4e-3), aluminium * strain(-4e-3), rtol=1e-10, atol=1e-3)
    np.testing.assert_allclose(found.stress(0, angle, depth=2e-3), steel * strain(2e-3), rtol=1e-10, atol=1e-3)
    np.testing.assert_allclose(found.stress(0, angle, depth=0.0), found.stress(0, angle), rtol=1e-12)


def _layers() -> list[Layer]:
    return [
        Layer(materials.PZT4_STANDARD, 2e-3, role="sensor"),
        Layer(materials.ALUMINIUM, 6e-3),
        Layer(materials.STRUCTURAL_STEEL, 1e-3, role="passive"),
        Layer(materials.PZT4, 4e-3, role="actuator"),
    ]


def test_faces_and_boundaries(response: Response, lopsided_section: Section) -> None:
    half = THICKNESS / 2
    for face, z in (("inner", -half), ("outer", half)):
        np.testing.assert_allclose(response.stress(0, 10, depth=face), response.stress(0, 10, depth=z), rtol=1e-12)
    assert not np.allclose(response.stress(0, 10, depth="inner"), response.stress(0, 10, depth="outer"))
    assert response.stress(0, 10, depth="outer").attrs["depth"] == pytest.approx(half)
    boundary = lopsided_section.layers[1][1]
    assert wall_point(lopsided_section, boundary).modulus == lopsided_section.layers[2][2]  # the outer layer of the two
    assert wall_point(lopsided_section, -half).piezoelectric.role == "sensor"
    assert wall_point(lopsided_section, half).piezoelectric.role == "actuator"
    assert wall_point(lopsided_section, 0.0).piezoelectric is None


def test_control_adds_its_field_to_the_actuator_only(make: Callable[..., ModalSolution], response: Response) -> None:
    free = Response(make(response.system.replace(control=None)))
    z = 4e-3
    added = response.stress(0, 10, depth=z) - free.stress(0, 10, depth=z)
    expected = -materials.PZT4.e32 / 4e-3 * response.actuator_voltage(0, 10)
    np.testing.assert_allclose(added, expected, rtol=0, atol=1e-12 * float(abs(expected).max()))
    np.testing.assert_array_equal(response.stress(0, 10, depth=-6e-3), free.stress(0, 10, depth=-6e-3))


def test_control_stress_uses_the_material_s_own_choice(lopsided_section: Section) -> None:
    assert control_stress(wall_point(lopsided_section, 4e-3)) == pytest.approx(-materials.PZT4.e32 / 4e-3)
    standard = section(Shell(radius=1.0, layers=[Layer(materials.ALUMINIUM, 1e-2), Layer(materials.PZT4_STANDARD, 1e-3, role="actuator")]))
    reduced = materials.PZT4.e32 - materials.PZT4.c23 * materials.PZT4.e33 / materials.PZT4.c33
    assert control_stress(wall_point(standard, 5e-3)) == pytest.approx(-reduced / 1e-3)


@pytest.mark.parametrize("depth", [7e-3, -7e-3, math.inf, "middle", True, [0.0]])
def test_bad_depths(response: Response, depth: object) -> None:
    with pytest.raises(InputError, match="depth"):
        response.stress("inner", 0, depth=depth)


def test_the_range_is_named(response: Response) -> None:
    with pytest.raises(InputError, match=r"depth: 0.007 m is outside the wall; give z from -0.0065 to 0.0065 m"):
        response.stress("inner", 0, depth=7e-3)
