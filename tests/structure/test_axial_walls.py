"""A thin wall at an axial wavenumber against geometry, closed forms and the plane problem: strains, stiffness, frequencies, elimination."""

from __future__ import annotations

import math

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.numerics.modes import Modes
from coaxshell.structure.axial import axial_stiffness, layer_stiffness, natural_frequencies, strain
from coaxshell.structure.laminate import plane_stiffness, require_axial_constants
from coaxshell.structure.section import Section, section
from coaxshell.structure.thin_wall import ThinWall

STEEL = cx.Elastic(name="steel", density=7800, youngs_modulus=210e9, poisson_ratio=0.3)
PZT = cx.materials.PZT4_STANDARD
ORDERS = np.array([0.0, 1.0, 2.0, 7.0, 40.0])
S = np.array([20.0 + 1e3j, 20.0 + 3e4j, 200.0 + 2e6j])


def steel(thickness: float, radius: float = 1.0) -> Section:
    return section(cx.Shell(radius=radius, layers=[cx.Layer(STEEL, thickness)]))


def paper() -> Section:
    return section(cx.presets.load("active").shells[0])


def lopsided() -> Section:
    layers = [
        cx.Layer(STEEL.replace(youngs_modulus=2e9, poisson_ratio=0.1), 2e-2),
        cx.Layer(STEEL, 1e-2),
        cx.Layer(PZT, 3e-3, role="sensor"),
    ]
    return section(cx.Shell(radius=0.3, layers=layers))


# Strains


def derivative(values: np.ndarray, axis: int, wavenumber: float) -> np.ndarray:
    """Return the derivative of a periodic function along the last two axes, (theta, z), by Fourier series."""
    count = values.shape[axis]
    waves = 1j * wavenumber * np.fft.fftfreq(count, 1.0 / count)
    waves[count // 2] = 0.0
    shape = [1] * values.ndim
    shape[axis] = count
    return np.fft.ifft(np.fft.fft(values, axis=axis) * waves.reshape(shape), axis=axis).real


def drawn_strain(m: int, k: float, radius: float, depth: float, moved: tuple[float, float, float]) -> np.ndarray:
    """Return the amplitudes of (eps_z, eps_theta, gamma) at a depth from the geometry of a moved surface and its normal.

    Points x = X + depth n on the deformed mid-surface X, n its unit normal; changes of the metric by central differences of the
    amplitude, hoop strain per length at the mid-surface as in the plane problem.
    """
    count = 32
    theta, z = np.meshgrid(2 * np.pi * np.arange(count) / count, 2 * np.pi / k * np.arange(count) / count, indexing="ij")
    u0, v0, w0 = moved
    outward = np.stack([np.cos(theta), np.sin(theta), np.zeros_like(theta)])
    along = np.stack([-np.sin(theta), np.cos(theta), np.zeros_like(theta)])
    axis = np.stack([np.zeros_like(theta), np.zeros_like(theta), np.ones_like(theta)])

    def metric(size: float) -> np.ndarray:
        w = size * w0 * np.cos(m * theta) * np.cos(k * z)
        v = size * v0 * np.sin(m * theta) * np.cos(k * z)
        u = size * u0 * np.cos(m * theta) * np.sin(k * z)
        surface = (radius - w) * outward + v * along + u * axis  # less the straight part z of the axis
        normal = np.cross(derivative(surface, 1, 1.0), derivative(surface, 2, k) + axis, axis=0)
        point = surface + depth * normal / np.linalg.norm(normal, axis=0)
        across, up = derivative(point, 1, 1.0), derivative(point, 2, k) + axis
        return np.stack([(up * up).sum(0) / 2, (across * across).sum(0) / 2, (across * up).sum(0)])

    size = 1e-4
    change = (metric(size) - metric(-size)) / (2 * size) / np.array([1.0, radius * (radius + depth), radius + depth])[:, None, None]
    even, odd = np.cos(m * theta) * np.cos(k * z), np.sin(m * theta) * np.sin(k * z)
    return np.array([(each * wave).sum() / (wave**2).sum() for each, wave in zip(change, (even, even, odd), strict=True)])


@pytest.mark.parametrize(("m", "k", "radius"), [(1, 0.4, 1.0), (2, 1.3, 0.7), (5, 3.0, 0.5)])
@pytest.mark.parametrize("moved", [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (0.4, -0.3, 0.8)])
def test_strains_are_those_of_a_surface_and_its_normals(m, k, radius, moved):
    at = strain(Modes(np.array([float(m)]), k), radius)
    half = 2e-3  # strains are exact to first order in the depth: even and odd parts of two points
    above, below = (drawn_strain(m, k, radius, depth, moved) for depth in (half, -half))
    scale = np.abs(at.bending).max()
    np.testing.assert_allclose((above + below) / 2, at.membrane[..., 0] @ moved, rtol=0, atol=2 * half**2 * scale)
    np.testing.assert_allclose((above - below) / (2 * half), at.bending[..., 0] @ moved, rtol=0, atol=1e-4 * scale)


@pytest.mark.parametrize("radius", [0.5, 1.0])
def test_rigid_motions_are_free_of_strain(radius):
    k = 1e-3
    still, slow = strain(Modes(np.array([0.0, 1.0])), radius), strain(Modes(np.array([0.0, 1.0]), k), radius)
    for part in still:
        assert not (part[..., 1] @ [0.0, 1.0, 1.0]).any()  # across the axis
        assert not (part[..., 0] @ [1.0, 0.0, 0.0]).any()  # along it
        assert not (part[..., 0] @ [0.0, 1.0, 0.0]).any()  # turned about it
    # Tilted: w = v = z, u = -R, which is what (U, V, W) = (-k R, 1, 1) sin kz/k tends to; what is left is a beam's curvature k^2 (R + z').
    for depth in (-0.01, 0.0, 0.02):
        left = slow.at(depth)[..., 1] @ [-k * radius, 1.0, 1.0]
        np.testing.assert_allclose(left, [-(k**2) * (radius + depth), 0.0, 0.0], rtol=0, atol=1e-18)


# Stiffness


@pytest.mark.parametrize("wall", [paper(), lopsided()])
@pytest.mark.parametrize("k", [0.0, 0.2, 5.0, 60.0])
def test_stiffness_is_symmetric_and_positive_semidefinite(wall, k):
    stiffness = np.moveaxis(axial_stiffness(wall, Modes(ORDERS, k)), -1, 0)
    np.testing.assert_allclose(stiffness, np.swapaxes(stiffness, 1, 2), rtol=1e-14)
    values = np.linalg.eigvalsh(stiffness)
    assert (values[:, 0] >= -1e-14 * values[:, -1]).all()


@pytest.mark.parametrize("k", [0.4, 7.0])
def test_stiffness_of_an_unsymmetric_layup_by_quadrature(k):
    # By layers, with the moduli written out: K = sum of integrals of B' Q B.
    wall, modes = lopsided(), Modes(np.array([3.0]), k)
    at, x, weights = strain(modes, 0.3), *np.polynomial.legendre.leggauss(6)
    e1, e2 = 2e9 / (1 - 0.1**2), 210e9 / (1 - 0.3**2)
    c11, c12, c22 = 132e9 - 73e9**2 / 115e9, 71e9 - 73e9**2 / 115e9, 132e9 - 73e9**2 / 115e9
    moduli = [(e1, 0.1 * e1, e1, 1e9 / 1.1), (e2, 0.3 * e2, e2, 105e9 / 1.3), (c11, c12, c22, 30.5e9)]
    total = np.zeros((3, 3))
    for (bottom, top), (q11, q12, q22, q66) in zip([(-16.5e-3, 3.5e-3), (3.5e-3, 13.5e-3), (13.5e-3, 16.5e-3)], moduli, strict=True):
        for point, weight in zip(x, weights, strict=True):
            rows = at.at((bottom + top + point * (top - bottom)) / 2)[..., 0]
            q = np.array([[q11, q12, 0], [q12, q22, 0], [0, 0, q66]])
            total += weight * (top - bottom) / 2 * rows.T @ q @ rows
    np.testing.assert_allclose(layer_stiffness(wall, at)[..., 0], total, rtol=1e-12, atol=1e-13 * abs(total).max())


def test_open_circuit_stiffness_with_axial_curvature_by_hand():
    # q q'/(zeta33 + m^2 zeta22/R^2 + k^2 zeta11), q = E_31 (0, 0, -k^2) + E_32 (0, m, -m^2)/R^2.
    wall, m, k, radius, t = lopsided(), 3.0, 7.0, 0.3, 3e-3
    modes = Modes(np.array([m]), k)
    coupling = (-4.1 - 73 / 115 * 14.1) * 2 * t / math.pi
    q = coupling * np.array([0.0, m / radius**2, -(k**2) - m**2 / radius**2])
    stored = (5.841e-9 + 14.1**2 / 115e9) * math.pi**2 / (2 * t) + 7.124e-9 * t / 2 * (m**2 / radius**2 + k**2)
    added = axial_stiffness(wall, modes) - layer_stiffness(wall, strain(modes, radius))
    np.testing.assert_allclose(added[..., 0], np.outer(q, q) / stored, rtol=0, atol=1e-9 * q[2] ** 2 / stored)
    gain = ThinWall.of(wall).sensor_gain(modes)
    np.testing.assert_allclose([gain.u[0], gain.v[0], gain.w[0]], q / stored, rtol=1e-13)


# Natural frequencies


@pytest.mark.parametrize(
    ("m", "k", "expected"), [(2, 1.0, [147.06160744, 1203.7362975, 2082.8206866]), (1, 0.1, [5.7596941819, None, None])]
)
def test_frequencies_of_a_steel_shell(m, k, expected):
    # From a second derivation and program; E = 210 GPa, R = 1 m, h = 20 mm.
    found = natural_frequencies(steel(0.02), Modes(np.array([float(m)]), k))[0] / (2 * math.pi)
    for value, wanted in zip(found, expected, strict=True):
        if wanted is not None:
            np.testing.assert_allclose(value, wanted, rtol=2e-10)


def test_torsion():
    # G k^2/rho, times the mean of (1 + z'/R)^2 that first-order strains give: 1 + h^2/(12 R^2).
    h, k = 0.02, 3.0
    squares = natural_frequencies(steel(h), Modes(np.array([0.0]), k))[0] ** 2
    np.testing.assert_allclose(np.abs(squares / 93195266.27 / (1 + h**2 / 12) - 1).min(), 0.0, atol=1e-9)


@pytest.mark.parametrize("thickness", [1e-3, 1e-2])
def test_beam_limit(thickness):
    # A long tube bends as a beam, E J/(rho A) k^4 = E R^2/(2 rho) k^4, times 1 + h^2/(12 R^2) for its first-order strains.
    k = 1e-4
    squares = natural_frequencies(steel(thickness), Modes(np.array([1.0]), k))[0] ** 2
    np.testing.assert_allclose(squares[0] / k**4, 210e9 / (2 * 7800) * (1 + thickness**2 / 12), rtol=2e-6)


def test_a_thin_tube_hardly_resists_a_tilt():
    # k R = 0.01, h/R = 0.05: a twist of the normals that a tilt left strained would raise this by 82 %.
    square = natural_frequencies(steel(0.05), Modes(np.array([1.0]), 0.01))[0, 0] ** 2
    np.testing.assert_allclose(square, 210e9 / (2 * 7800) * 0.01**4, rtol=0.01)


def test_low_frequencies_of_very_thin_walls_are_kept():
    # 1 mm, m = 2 in the plane: D/(I R^4) m^2 (m^2 - 1)^2/(m^2 + 1) = 17.7515, which eigenvalues of K would lose; rigid motions rest.
    found = natural_frequencies(steel(1e-3), Modes(np.array([1.0, 2.0])))
    np.testing.assert_allclose(found[1, 0] ** 2, 17.751461, rtol=2e-6)
    assert found[0, 0] < 1e-9 * found[0, -1]


@pytest.mark.parametrize("m", [8, 12])
def test_simply_supported_shell_by_soedels_formula(m):
    # Shear diaphragms at both ends, k = pi/L; Donnell, Mushtari and Vlasov as given by Soedel, Vibrations of
    # Shells and Plates: it lacks -2/m^2 of the bending and -1/m^2 by the inertia along the wall.
    h, k = 2e-3, math.pi / 2.0
    wave = k**2 + m**2
    expected = 210e9 / 7800 * (k**4 / wave**2 + h**2 / (12 * (1 - 0.3**2)) * wave**2)
    found = natural_frequencies(steel(h), Modes(np.array([float(m)]), k))[0, 0] ** 2
    assert (1 - 3 / m**2) * expected < found < expected


def test_frequencies_are_where_the_impedance_vanishes():
    wall, modes = lopsided(), Modes(np.array([2.0, 5.0]), 1.7)
    for i, roots in enumerate(natural_frequencies(wall, modes)):
        found = ThinWall.of(wall).passive(modes, 1j * roots)
        terms = np.abs(wall.mass * roots**2) + np.abs(axial_stiffness(wall, modes)[2, 2, i])
        assert (np.abs(found.impedance[i]) < 1e-8 * terms * (1 + np.abs(found.axial[i]) + np.abs(found.tangential[i])) ** 2).all()


# The wall as the solver asks it


@pytest.mark.parametrize("wall", [paper(), lopsided()])
def test_elimination_is_the_whole_system_solved(wall):
    k = 1.3
    modes = Modes(ORDERS[1:], k)
    found = ThinWall.of(wall).passive(modes, S)
    for i in range(modes.count):
        for j, s in enumerate(S):
            matrix = axial_stiffness(wall, modes)[..., i] + wall.mass * s * s * np.eye(3)
            u, v, w = np.linalg.solve(matrix, [0.0, 0.0, 1.0])
            np.testing.assert_allclose([found.impedance[i, j], found.tangential[i, j], found.axial[i, j]], [1 / w, v / w, u / w], rtol=1e-9)


@pytest.mark.parametrize("wall", [paper(), lopsided()])
def test_a_vanishing_wavenumber_gives_the_plane_problem(wall):
    model = ThinWall.of(wall)
    plane, near = (model.passive(Modes(ORDERS, k), S) for k in (0.0, 1e-7))
    assert plane.axial is None
    np.testing.assert_allclose(near.impedance, plane.impedance, rtol=1e-12)
    np.testing.assert_allclose(near.tangential, plane.tangential, rtol=1e-12, atol=1e-15)
    sensors = [model.sensor_gain(Modes(ORDERS, k)) for k in (0.0, 1e-7)]
    np.testing.assert_allclose(sensors[1][:2], sensors[0][:2], rtol=1e-12, atol=1e-12 * sensors[0].w[2])


def test_breathing_and_torsion_do_not_couple():
    # On the torsional frequency itself the row of V is singular; the normal motion of order 0 does not feel it.
    wall, k = steel(0.02), 3.0
    torsion = math.sqrt(93195266.27 * (1 + 0.02**2 / 12))
    found = ThinWall.of(wall).passive(Modes(np.array([0.0]), k), np.array([1j * torsion]))
    assert np.isfinite(found.impedance).all()
    assert not found.tangential.any()
    a11, a12 = 210e9 * 0.02 / 0.91, 0.3 * 210e9 * 0.02 / 0.91
    inertia, bending = -wall.mass * torsion**2, 210e9 * 0.02**3 / 12 / 0.91
    expected = inertia + a11 + bending * k**4 - (a12 * k) ** 2 / (inertia + a11 * k**2)
    np.testing.assert_allclose(found.impedance[0, 0], expected, rtol=1e-7)


def test_a_wavenumber_for_each_node():
    model, k = ThinWall.of(lopsided()), np.array([0.7 + 0j, 3.0 + 0j, -1e-4j * S[2]])
    together = model.passive(Modes(ORDERS, k), S)
    gain = model.sensor_gain(Modes(ORDERS, k))
    for j in range(2):
        alone, alone_gain = model.passive(Modes(ORDERS, float(k[j].real)), S[j : j + 1]), model.sensor_gain(Modes(ORDERS, float(k[j].real)))
        for one, all_of_them in (
            (alone.impedance, together.impedance),
            (alone.tangential, together.tangential),
            (alone.axial, together.axial),
        ):
            np.testing.assert_allclose(all_of_them[:, j], one[:, 0], rtol=1e-12)
        np.testing.assert_allclose([x[:, j] for x in gain], alone_gain, rtol=1e-13)
    matrix = axial_stiffness(lopsided(), Modes(ORDERS, k))[:, :, 2, 2] + lopsided().mass * S[2] ** 2 * np.eye(3)
    np.testing.assert_allclose(together.impedance[2, 2], 1 / np.linalg.inv(matrix)[2, 2], rtol=1e-9)


def test_units_do_not_matter():
    a, pressure, density = 0.7, 2e9, 1000.0
    wall = lopsided()
    scaled = wall.in_units(a, pressure, density * a)
    time = a * math.sqrt(density / pressure)
    expected = natural_frequencies(wall, Modes(ORDERS, 3.0)) * time
    np.testing.assert_allclose(natural_frequencies(scaled, Modes(ORDERS, 3.0 * a)), expected, rtol=1e-11)
    gains = [ThinWall.of(each).sensor_gain(Modes(ORDERS, k)) for each, k in ((wall, 3.0), (scaled, 3.0 * a))]
    np.testing.assert_allclose(gains[1], np.array(gains[0]) * a, rtol=1e-12)
    np.testing.assert_allclose(ThinWall.of(wall).highest_frequency(Modes(ORDERS, 3.0)) * time, expected[:, -1], rtol=1e-11)


# What it needs


def test_a_material_without_axial_constants_is_named():
    bare = PZT.replace(e31=None, c66=None)
    shell = cx.Shell(radius=0.3, layers=[cx.Layer(STEEL, 1e-2), cx.Layer(bare, 3e-3, role="sensor")])
    with pytest.raises(cx.InputError, match=r"shells\[1\]\.layers\[1\]\.material\.c66.*c66, e31"):
        require_axial_constants(shell, "shells[1]")
    with pytest.raises(cx.InputError, match="c66"):
        ThinWall.of(section(shell)).passive(Modes(ORDERS, 1.0), S)
    ThinWall.of(section(shell)).passive(Modes(ORDERS), S)  # two dimensions need none of them
    require_axial_constants(cx.presets.load("active").shells[0], "shells[0]")


def test_an_unstable_material_is_refused():
    shell = cx.Shell(radius=0.3, layers=[cx.Layer(STEEL, 1e-2), cx.Layer(PZT.replace(c12=500e9), 3e-3, role="passive")])
    with pytest.raises(cx.InputError, match="unstable along the axis"):
        require_axial_constants(shell, "shells[0]")


def test_elastic_stiffness():
    assert plane_stiffness(STEEL) == pytest.approx((210e9 / 0.91, 63e9 / 0.91, 210e9 / 0.91, 210e9 / 2.6), rel=1e-14)


def test_a_node_at_which_nothing_changes_along_the_axis():
    # k = 0 at one node of several: the row of U, singular at order 0, leaves V and W as in the plane problem.
    model = ThinWall.of(lopsided())
    mixed, plane = model.passive(Modes(ORDERS, np.array([0j, 1.0 + 0j, 0j])), S), model.passive(Modes(ORDERS), S)
    np.testing.assert_allclose(mixed.impedance[:, ::2], plane.impedance[:, ::2], rtol=1e-12)
    np.testing.assert_allclose(mixed.tangential[:, ::2], plane.tangential[:, ::2], rtol=1e-12, atol=1e-15)
    assert not mixed.axial[:, ::2].any()
