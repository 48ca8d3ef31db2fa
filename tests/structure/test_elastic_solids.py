"""Walls of solid layers in vacuo against closed forms: frequencies, static fields, impedances, and potentials without elements."""

from __future__ import annotations

import math

import mpmath as mp
import numpy as np
import pytest
from scipy.special import iv, ivp, kv, kvp

import coaxshell as cx
from coaxshell.numerics.modes import Modes
from coaxshell.structure import elastic_mesh
from coaxshell.structure.axial import natural_frequencies
from coaxshell.structure.elastic_basis import OrdersBasis, elastic_basis, orders_basis, strain_rows
from coaxshell.structure.elastic_mesh import wall_mesh
from coaxshell.structure.section import section
from coaxshell.structure.shape_sums import modal_sums
from coaxshell.structure.solid import SolidLayer, require_solid, solid_layers

STEEL = cx.Elastic(name="steel", density=7800, youngs_modulus=210e9, poisson_ratio=0.3)
RUBBER = cx.Elastic(name="rubber", density=1100, youngs_modulus=30e6, poisson_ratio=0.499)
PZT = cx.materials.PZT4_STANDARD


def shell(*layers: tuple[object, float], radius: float = 1.0) -> cx.Shell:
    built = [cx.Layer(m, t, role="passive") if isinstance(m, cx.Piezoelectric) else cx.Layer(m, t) for m, t in layers]
    return cx.Shell(radius=radius, layers=built)


def solids(*layers: tuple[object, float], radius: float = 1.0) -> tuple[SolidLayer, ...]:
    return solid_layers(shell(*layers, radius=radius))


def basis(layers, order: float, wavenumber: float = 0.0, degree: int = 8) -> OrdersBasis:
    """Return the shapes of one mode, SI, at a degree of all layers."""
    return orders_basis(wall_mesh(layers, [degree] * len(layers)), slice(0, 1), np.array([float(order)]), wavenumber)


def moving(found: OrdersBasis, displacement: int) -> np.ndarray:
    """Return omega^2 of the shapes that move in one direction, ascending, without rigid ones."""
    size = np.abs(found.shapes[0]).max(axis=-1)
    return found.squares[0][(size[:, displacement] > 1e-6 * size.max(axis=1)) & (found.squares[0] > 0.0)]


def hertz(square: float) -> float:
    return math.sqrt(square) / (2.0 * math.pi)


# Frequencies in vacuo


def test_breathing_and_thickness_frequencies_of_an_annulus():
    found = moving(basis(solids((STEEL, 0.1)), 0, degree=12), 0)
    np.testing.assert_allclose([hertz(x) for x in found[:2]], [866.66839067, 30114.580584], rtol=1e-10)


@pytest.mark.parametrize(("thickness", "expected"), [(0.05, 33.486124309), (0.1, 66.723769217)])
def test_flexural_frequencies_in_plane_strain(thickness, expected):
    assert hertz(basis(solids((STEEL, thickness)), 2).squares[0, 0]) == pytest.approx(expected, rel=1e-10)


def test_low_frequencies_of_a_very_thin_wall_are_not_lost():
    assert basis(solids((STEEL, 1e-3)), 2).squares[0, 0] == pytest.approx(17.751461, rel=3e-8)


def test_torsion_of_any_wall():
    assert moving(basis(solids((STEEL, 0.1)), 0, 3.0), 1)[0] == pytest.approx(93195266.27, rel=1e-10)


def test_a_pipe_bends_as_a_beam():
    """Exactly k^4 E I/(rho A) as k -> 0: what is left falls with k^2."""
    rest = [basis(solids((STEEL, 0.01)), 1, k).squares[0, 0] / k**4 / 13461875.0 - 1.0 for k in (0.01, 0.005)]
    assert abs(rest[1]) < 1e-4
    assert rest[0] / rest[1] == pytest.approx(4.0, rel=0.02)


def test_rigid_motions_strain_nothing():
    mesh = wall_mesh(solids((STEEL, 0.03), (RUBBER, 0.02)), [6, 9])
    rows = strain_rows(mesh, np.array([0.0, 1.0]), 0.0) / np.sqrt(mesh.mass)
    values = np.linalg.svd(rows.reshape(2, rows.shape[1], -1), compute_uv=False)
    assert np.all(values[:, -1] < 1e-14 * values[:, 0])
    assert np.all(values[:, -2] > 1e-8 * values[:, 0])
    found = elastic_basis(solids((STEEL, 0.03), (RUBBER, 0.02)), Modes.up_to(2), 0.0)
    squares = np.concatenate([each.squares[:, 0] for each in found])
    assert list(squares[:2]) == [0.0, 0.0]
    assert squares[2] > 0.0


def test_shapes_of_the_plane_problem_are_kept_by_all_that_they_depend_on():
    """Layers of equal values, orders and the highest frequency; not along the axis, nor on the mesh of other layers."""
    layers, again, modes = solids((STEEL, 0.03)), solids((STEEL, 0.03)), Modes.up_to(2)
    found = elastic_basis(layers, modes, 50.0)
    assert elastic_basis(again, Modes.up_to(2), 50.0) is found
    others = [
        elastic_basis(layers, Modes.up_to(3), 50.0),
        elastic_basis(layers, modes, 5000.0),
        elastic_basis(solids((STEEL, 0.04)), modes, 50.0),
        elastic_basis(layers, modes, 50.0, solids((STEEL, 0.04))),
    ]
    assert all(other is not found for other in others)
    along = Modes.up_to(2, 1.0)
    assert elastic_basis(layers, along, 50.0) is not elastic_basis(layers, along, 50.0)


@pytest.mark.parametrize(("order", "wavenumber"), [(2, 0.0), (2, 1.0), (0, 2.0), (5, 1.0)])
def test_thin_walls_are_their_limit(order, wavenumber):
    """The lowest frequency differs from Kirchhoff's by O(h), h^2 without a first-order term: halving h halves it at least."""
    errors = []
    for h in (8e-3, 4e-3, 2e-3):
        thin = natural_frequencies(section(shell((STEEL, h))), Modes(np.array([float(order)]), wavenumber))[0]
        solid = np.sqrt(basis(solids((STEEL, h)), order, wavenumber).squares[0])
        errors.append(np.abs(solid[: thin.size][0] / thin[thin > 1e-6 * thin.max()][0] - 1.0))
    assert errors[2] < 2e-3
    assert errors[0] / errors[1] > 1.8
    assert errors[1] / errors[2] > 1.8


# Loads


def static_displacement(found: OrdersBasis, inner: float, outer: float) -> np.ndarray:
    """Return u_r at all points under pressures on the faces, SI."""
    stiff = found.squares[0] > 0.0
    load = found.faces[0, 0] * inner * found.mesh.radius[0] - found.faces[0, 1] * outer * found.mesh.radius[-1]
    return np.asarray((load[stiff] / found.squares[0][stiff]) @ found.shapes[0][stiff][:, 0])


def test_lame():
    radial = static_displacement(basis(solids((STEEL, 0.1)), 0, degree=10), 0.0, 1e6)
    np.testing.assert_allclose(radial[[0, -1]], [-4.538625e-5, -4.366375e-5], rtol=1e-10)


def test_lame_of_layers():
    """Two layers: A r + B/r in each, continuous displacement and radial stress."""
    layers = solids((STEEL, 0.03), (RUBBER, 0.05))
    moduli = [(x.stiffness[0][0], x.stiffness[0][1]) for x in layers]
    a, b, c = layers[0].inner, layers[0].outer, layers[1].outer

    def stress(layer: int, r: float) -> list[float]:
        c11, c12 = moduli[layer]
        return [c11 + c12, -(c11 - c12) / r**2]

    matrix = np.zeros((4, 4))
    matrix[0, :2], matrix[3, 2:] = stress(0, a), stress(1, c)
    matrix[1] = [b, 1 / b, -b, -1 / b]
    matrix[2, :2], matrix[2, 2:] = stress(0, b), [-x for x in stress(1, b)]
    scale = np.abs(matrix).max(axis=1)
    constants = np.linalg.solve(matrix / scale[:, None], np.array([-2e6, 0.0, 0.0, -1e6]) / scale)
    expected = [constants[0] * a + constants[1] / a, constants[2] * c + constants[3] / c]
    radial = static_displacement(basis(layers, 0, degree=14), 2e6, 1e6)
    np.testing.assert_allclose(radial[[0, -1]], expected, rtol=1e-8)


@pytest.mark.parametrize(("s", "expected"), [(60.0, 1.6577786), (200.0, 1.0205976)])
def test_a_face_answers_at_once_with_the_impedance_of_its_layer(s, expected):
    """rho c_L s H_oo r_o tends to 1."""
    layer = solids((STEEL, 0.05))[0].in_units(1.0, 1000.0 * 1400.0**2, 1000.0)
    (found,) = elastic_basis([layer], Modes.up_to(0), 1000.0)
    outer = found.faces[:, 1]
    receptance = modal_sums((outer * outer)[:, None], found.squares, np.array([s + 0j]))[0, 0, 0]
    assert layer.density * layer.pressure_speed * s * receptance.real * layer.outer == pytest.approx(expected, rel=5e-8)


def by_potentials(material: cx.Elastic, inner: float, outer: float, order: int, s: complex) -> np.ndarray:
    """Return H_ii, H_io, H_oo of one layer, SI: separation of variables with I_m and K_m, no elements; w inward, loads r q."""
    with mp.workdps(30):
        m, s = mp.mpf(order), mp.mpc(s)
        shear = mp.mpf(material.youngs_modulus) / (2 * (1 + mp.mpf(material.poisson_ratio)))
        lame = 2 * shear * material.poisson_ratio / (1 - 2 * mp.mpf(material.poisson_ratio))
        slow = [s * mp.sqrt(material.density / x) for x in (lame + 2 * shear, shear)]

        def fields(r: float) -> list[tuple]:
            """Return u_r, sigma_rr and sigma_rtheta of phi = I, K and of psi = I, K."""
            found = []
            for kind, q in enumerate(slow):
                for f, sign in ((mp.besseli, 1), (mp.besselk, -1)):
                    y, d = f(m, q * r), m / r * f(m, q * r) + sign * q * f(m + 1, q * r)
                    d2 = (q**2 + (m / r) ** 2) * y - d / r
                    if kind == 0:
                        u, v, du, dv, spread = d, -m / r * y, d2, -m / r * d + m / r**2 * y, q**2 * y
                    else:
                        u, v, du, dv, spread = m / r * y, -d, m / r * d - m / r**2 * y, -d2, 0
                    found.append((u, lame * spread + 2 * shear * du, shear * (dv - v / r - m * u / r)))
            return found

        at = fields(mp.mpf(inner)), fields(mp.mpf(outer))
        matrix = mp.matrix([[x[j] for x in side] for side in at for j in (1, 2)])
        result = []
        for load in (mp.matrix([1 / mp.mpf(inner), 0, 0, 0]), mp.matrix([0, 0, -1 / mp.mpf(outer), 0])):
            # An inward load q_i = -p_i pulls at the inner face: sigma_rr = q_i; q_o = p_o pushes at the outer one: sigma_rr = -q_o.
            scales = [max(abs(matrix[i, j]) for i in range(4)) for j in range(4)]
            scaled = mp.matrix([[matrix[i, j] / scales[j] for j in range(4)] for i in range(4)])
            part = mp.lu_solve(scaled, load)
            result.append([-sum(part[j] / scales[j] * side[j][0] for j in range(4)) for side in at])
        return np.array([complex(result[0][0]), complex(result[1][0]), complex(result[1][1])])


@pytest.mark.parametrize("order", [0, 1, 2, 7])
def test_receptances_agree_with_separated_potentials(order):
    layers = solids((STEEL, 0.1))
    s = np.array([300.0 + 3e4j])
    (found,) = elastic_basis(layers, Modes(np.array([float(order)])), 5e4)
    inner, outer = found.faces[:, 0], found.faces[:, 1]
    sums = modal_sums(np.stack([inner * inner, inner * outer, outer * outer], axis=1), found.squares, s)[:, 0]
    for j, one in enumerate(s):
        np.testing.assert_allclose(sums[:, j], by_potentials(STEEL, 0.95, 1.05, order, one), rtol=2e-6)


def test_form_function_of_a_submerged_cylinder():
    """A hollow steel cylinder in water: the scattered wave of every order from receptances and from potentials."""
    rho, c, radius = 1000.0, 1480.0, 1.05
    s = 2.0 + 1j * 4.0 * c / radius
    for order in (0, 1, 3):
        (found,) = elastic_basis(solids((STEEL, 0.1)), Modes(np.array([float(order)])), abs(s) * 3)
        outer = found.faces[:, 1]
        ours = modal_sums((outer * outer)[:, None], found.squares, np.array([s]))[0, 0, 0]
        exact = by_potentials(STEEL, 0.95, radius, order, s)[2]
        z = complex(s * radius / c)
        i, k = iv(order, z), kv(order, z)
        di, dk = ivp(order, z), kvp(order, z)
        # p = I + B K outside; rho s^2 w = dp/dr, w = H r p at the face.
        scattered = [-(rho * s**2 * h * radius * i - s / c * di) / (rho * s**2 * h * radius * k - s / c * dk) for h in (ours, exact)]
        assert abs(scattered[0] - scattered[1]) < 1e-6 * abs(scattered[1])


# Degrees


def test_degrees_converge_spectrally():
    """A 30 mm coat of rubber on steel, up to 8 kHz: each two degrees more take a factor off; the rule gives 1e-6."""
    layers = solids((STEEL, 0.02), (RUBBER, 0.03))
    top = 2.0 * math.pi * 8e3
    s = np.array([0.1 * top + 1j * top])

    def outer(degrees: list[int]) -> complex:
        found = orders_basis(wall_mesh(layers, degrees), slice(0, 1), np.array([6.0]), 0.0)
        face = found.faces[:, 1]
        return complex(modal_sums((face * face)[:, None], found.squares, s)[0, 0, 0])

    rule = [elastic_mesh.degree(x, 6.0, 0.0, top) for x in layers]
    exact = outer([rule[0] + 12, rule[1] + 16])
    errors = [abs(outer([rule[0], p]) / exact - 1.0) for p in (rule[1] - 6, rule[1] - 3, rule[1])]
    assert errors[2] < 1e-6
    assert errors[0] > 10.0 * errors[1] > 100.0 * errors[2]


def test_soft_layers_get_higher_degrees():
    steel, rubber = solids((STEEL, 0.02), (RUBBER, 0.03))
    assert elastic_mesh.degree(steel, 0.0, 0.0, 2e4) == 4 + math.ceil(0.6 * 0.02 * 2e4 / steel.shear_speed)
    assert elastic_mesh.degree(rubber, 0.0, 0.0, 5e4) > 4 + elastic_mesh.degree(steel, 0.0, 0.0, 5e4)
    assert elastic_mesh.degree(steel, 500.0, 0.0, 0.0) > elastic_mesh.degree(steel, 5.0, 0.0, 0.0)


# Piezoelectric layers


def test_a_grounded_layer_stiffens_its_bending_by_the_exact_potential():
    """e~^2 t^3/(12 mu~), of which a half cosine holds 96/pi^4; the rest of D is c~22 t^3/12, up to t/R."""
    for t in (1e-3, 5e-4):
        stiff = basis(solids((PZT, t)), 2).squares[0, 0]
        soft = basis(solids((PZT.replace(e31=1e-9, e32=1e-9, e33=1e-9, e15=1e-9), t)), 2).squares[0, 0]
        reduced, permittivity = -13.050435, 7.5697826e-9
        expected = 1.0 + reduced**2 / permittivity / (PZT.c22 - PZT.c23**2 / PZT.c33)
        assert stiff / soft == pytest.approx(expected, rel=2.0 * t)


# What cannot be a solid


def test_a_ceramic_without_shear_constants_is_refused_by_name():
    lacking = shell((STEEL, 0.01), (PZT.replace(c44=None, e15=None), 2e-3))
    with pytest.raises(cx.InputError, match=r"shells\[0\]\.layers\[1\]\.material\.c44.*has no c44, e15"):
        require_solid(lacking, "shells[0]")


def test_a_layer_that_is_none_is_refused():
    with pytest.raises(cx.InputError, match=r"layers\[1\]\.thickness"):
        require_solid(shell((STEEL, 0.01), (STEEL, 1e-10)), "shells[0]")
