"""Fluids at the true faces of walls: loads by similarity, Lamé's static solution, exact elastic walls, energy, three dimensions."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.special import ivp

import coaxshell as cx
from coaxshell.acoustics.basis import Modes, RadialBasis
from coaxshell.acoustics.sources import LineGeometry, PlaneGeometry, SourceGeometry, SphericalFrontGeometry, SphericalGeometry
from coaxshell.apps.verification.bench import elastic_thick
from coaxshell.apps.verification.independent import RadialElements
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.cascade import CascadeSystem
from coaxshell.solver.coupling import ModalSystem
from coaxshell.solver.excitation import SurfaceLoads
from coaxshell.solver.kernels import initial_decay
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.tension import wall_pressures
from coaxshell.solver.wetted_surfaces import remarks
from coaxshell.structure.rigid import RigidWall

WATER = cx.Fluid(density=1000, sound_speed=1400)
STEEL = cx.Elastic(name="steel", density=7800, youngs_modulus=210e9, poisson_ratio=0.3)
TRANSIT = 1.0 / 1400.0
PULSE = cx.Gaussian(peak_pressure=2.5e4, width=0.1 * TRANSIT, centre=0.6 * TRANSIT)
SHOCK = cx.PlaneShock(peak_pressure=2.5e4, decay_time=1.314e-4)


def double(wetted: str, thickness: tuple[float, float] = (0.03, 0.05), source: cx.Source | None = None) -> cx.System:
    shells = [cx.Shell(radius=r, layers=[cx.Layer(STEEL, h)], wetted=wetted) for r, h in zip((0.5, 1.0), thickness, strict=True)]
    return cx.System(shells=shells, fluids=[WATER] * 3, source=source or cx.PlaneWave(pulse=PULSE))


@pytest.mark.parametrize("geometry", [PlaneGeometry(0.0), LineGeometry(4.0), SphericalGeometry(4.0)])
def test_loads_on_a_face_are_those_of_a_surface_in_units_of_its_own(geometry: SourceGeometry) -> None:
    # Lengths and times in units of the face's radius: the same load at s b, from a source at R0/b.
    face, modes = 1.3, Modes(np.arange(9.0))
    grid = LaplaceGrid(0.1, 40)
    scaled = LaplaceGrid(0.1 / face, 40)
    own = replace(geometry) if geometry.distance is None else replace(geometry, distance=geometry.distance / face)
    here = replace(geometry, head=face).prepare(grid, modes)(RadialBasis(modes, grid.nodes), slice(None))
    np.testing.assert_allclose(scaled.nodes, face * grid.nodes, rtol=1e-12)
    there = own.prepare(scaled, modes)(RadialBasis(modes, scaled.nodes), slice(None))
    np.testing.assert_allclose(here, there, rtol=1e-9, atol=1e-12)


def test_a_spherical_wave_along_the_axis_loads_a_face_alike() -> None:
    face, s, k = 1.3, np.array([1.0 + 2.0j, 0.3 + 9.0j]), 2.0
    grid = LaplaceGrid(0.1, 40)
    here, there = Modes(np.arange(9.0), k), Modes(np.arange(9.0), k * face)
    load = SphericalFrontGeometry(4.0, face).prepare(grid, here)(RadialBasis(here, s), slice(None))
    own = SphericalFrontGeometry(4.0 / face).prepare(grid, there)(RadialBasis(there, face * s), slice(None))
    np.testing.assert_allclose(load, face * own, rtol=1e-12)  # an integral along z, in units of the face's radius there


@pytest.mark.parametrize("geometry", [PlaneGeometry(), LineGeometry(4.0), SphericalGeometry(4.0)])
def test_the_pulse_is_the_free_field_at_the_head_of_the_face(geometry: SourceGeometry) -> None:
    from coaxshell.acoustics.sources import TimeFunction
    from coaxshell.numerics.arrays import FloatArray

    decay = TimeFunction(lambda t: np.where(t >= 0, np.exp(-t), 0.0), lambda t: -np.expm1(-np.maximum(t, 0.0)), lambda s: 1.0 / (s + 1.0))
    head, aside = np.array([1.3]), np.zeros(1)
    field = replace(geometry, head=1.3).free_field(decay, head, aside, 2.0)
    values: list[FloatArray] = [field.pressure(t) for t in (-1e-9, 1e-9, 0.7)]
    np.testing.assert_allclose(np.concatenate(values), [0.0, 1.0, np.exp(-0.7)], rtol=1e-3, atol=1e-12)


def lame(at: float, inner: float, outer: float, within: float, outside: float) -> float:
    """Return the hoop stress at a radius of a thick ring under pressures on both faces (plane strain)."""
    square = outer**2 - inner**2
    mean = (within * inner**2 - outside * outer**2) / square
    return mean + (within - outside) * (inner * outer / at) ** 2 / square


@pytest.mark.parametrize("side", [0, 1])
def test_static_stress_against_the_exact_thick_ring(side: int) -> None:
    # Thin theory: N = -p_o r_o + p_i r_i, exact for the mean over the thickness; at the mid-surface Lame's differs by (t/2R)^2/2.
    thickness, s, modes = 0.1, np.array([1e-5 + 0j]), Modes(np.zeros(1))
    shell = cx.Shell(radius=1.0, layers=[cx.Layer(STEEL, thickness)], wetted="faces")
    system = cx.System(shells=[shell], fluids=[cx.VACUUM, WATER], source=cx.PlaneWave(pulse=PULSE))
    problem = dimensionless(system)
    moved = CascadeSystem(problem, s, modes).solve(0, np.ones((1, 1), complex), side)[0].outer[0, 0].real
    gain = problem.shells[0].stress_gain(modes)
    stress = gain.w[0] * moved * (1 if side == 1 else -1)  # a load on the inner face is inward, its pressure outward
    inner, outer = shell.wetted_radii
    exact = lame(1.0, inner, outer, *((1.0, 0.0) if side == 0 else (0.0, 1.0)))
    assert stress == pytest.approx((inner if side == 0 else -outer) / thickness, rel=1e-4)
    assert abs(stress / exact - 1.0) < 0.0016
    assert (inner, outer) == pytest.approx((0.95, 1.05))
    thin = (1.0 if side == 0 else -1.0) / thickness
    assert abs(thin / exact - 1.0) > 0.045


def test_a_wall_that_hardly_moves_is_a_rigid_cylinder_of_the_face_s_radius() -> None:
    heavy = STEEL.replace(density=7.8e9, youngs_modulus=2.1e17)
    system = double("faces").replace(
        shells=[cx.Shell(radius=1.0, layers=[cx.Layer(heavy, 0.2)], wetted="faces")], fluids=[cx.VACUUM, WATER]
    )
    problem, grid, modes = dimensionless(system), LaplaceGrid(0.1, 40), Modes(np.arange(5.0))
    modal = ModalSystem(problem, grid.nodes, modes)
    load = problem.sources[0].prepare(grid, modes)(modal.radial, slice(None))
    force = modal.solve_outside(load)[0] * modal.shells[0].impedance  # p r_o/R of a wall that does not give way
    rigid = replace(problem, shells=(RigidWall(radius=1.1),))
    expected = rigid.sources[0].prepare(grid, modes)(RadialBasis(modes, grid.nodes), slice(None))
    np.testing.assert_allclose(force, 1.1 * expected, rtol=1e-5)


def test_faces_tend_to_the_mid_surface_as_the_thickness() -> None:
    s, modes = np.array([0.5 + 1.5j, 0.5 + 6.0j]), Modes(np.arange(5.0))
    differences = []
    for h in (0.004, 0.002, 0.001):
        light = STEEL.replace(density=7800 * 0.01 / h, youngs_modulus=2.1e9 / h)  # the same mass and membrane stiffness
        systems = [
            double(w).replace(shells=[cx.Shell(radius=1.0, layers=[cx.Layer(light, h)], wetted=w)], fluids=[WATER, WATER])
            for w in ("faces", "mid-surface")
        ]
        there, here = (ModalSystem(dimensionless(one), s, modes).solve_outside(np.ones((5, 2), complex))[0] for one in systems)
        differences.append(np.abs(there / here - 1.0).max())
    assert differences[0] < 0.05
    np.testing.assert_allclose(np.divide(differences[:-1], differences[1:]), 2.0, rtol=0.03)


def test_maxwell_betti_between_faces() -> None:
    problem, s, modes = dimensionless(double("faces")), np.array([0.3 + 0.2j, 1.0 + 25.0j]), Modes(np.arange(6.0))
    system = ModalSystem(problem, s, modes)
    inner, outer = (system.solve(j, np.ones((6, 2), complex)) for j in (0, 1))
    np.testing.assert_allclose(problem.shells[0].radius * outer[0], problem.shells[1].radius * inner[1], rtol=1e-12)


def test_energy_closes_at_true_faces() -> None:
    response = cx.simulate(double("faces", source=SHOCK), modes=6, duration=1.0, time_step=5e-3)
    energy = response.energy(every=20)
    assert float(np.abs(energy["closure_relative"]).max()) < 1e-6
    assert float(energy["exterior_work"].max()) > 0.0


def test_against_an_independent_solution_in_time() -> None:
    system = double("faces", (0.06, 0.1))
    response = cx.simulate(system, modes=5, duration=1.5, time_step=2e-3)
    other = RadialElements(system, 5, 1.5).solve(1e-2, 150)
    for shell in (0, 1):
        expected = other.stress(shell, 60.0)
        np.testing.assert_allclose(response.stress(shell, angle=60.0)[::5], expected, atol=3e-5 * np.abs(expected).max(), rtol=0)


@pytest.mark.parametrize("source", [cx.LineWave(distance=4.0, pulse=PULSE), cx.PlaneWave(pulse=PULSE)])
def test_three_dimensions_without_an_axial_wavenumber_are_two(source: cx.Source) -> None:
    settings = {"modes": 8, "duration": 1.0, "time_step": 1e-2}
    plane = cx.simulate(double("faces", source=source), **settings)
    space = cx.simulate(double("faces", source=source), dimensions=3, stations=[0.0, 1.0], **settings)
    for shell in (0, 1):
        expected = plane.stress(shell, angle=60.0)
        found = space.at(1.0).stress(shell, angle=60.0)[:, 0]
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-9 * np.abs(expected).max())


def test_small_axial_wavenumbers_tend_to_two_dimensions() -> None:
    problem, s, orders = dimensionless(double("faces")), np.array([0.3 + 0.2j, 1.0 + 25.0j]), np.arange(6.0)
    plane, along = (ModalSystem(problem, s, Modes(orders, k)).solve_outside(np.ones((6, 2), complex)) for k in (0.0, 1e-5))
    for w, expected in zip(along, plane, strict=True):
        np.testing.assert_allclose(w, expected, rtol=1e-8)


def test_the_direct_engine_refuses_faces() -> None:
    with pytest.raises(cx.InputError, match=r"shells\[0\].wetted.*spectral"):
        cx.simulate(double("faces"), modes=4, duration=0.2, engine="direct")


def errors(wetted: str) -> np.ndarray:
    """Return the L2 errors of hoop stress and displacement against exact elastic walls, (2, shells, angles)."""
    stored = elastic_thick()
    response = cx.simulate(double(wetted), modes=40, duration=3.0, time_step=1e-2)
    found = np.empty((2, 2, 3))
    for shell in (0, 1):
        for place, angle in enumerate((0.0, 60.0, 180.0)):
            for row, (name, history) in enumerate((("hoop", response.stress), ("w", response.displacement))):
                exact = stored[name][shell, 0, place]
                found[row, shell, place] = np.linalg.norm(np.ravel(history(shell, angle=angle))[::2] - exact) / np.linalg.norm(exact)
    return found


def test_true_faces_come_near_exact_elastic_walls() -> None:
    # Steel of 30 and 50 mm, smooth pulse (elastic_thick_plane.npz). The L2 errors of the hoop stress, inner and outer shell.
    faces, middle = errors("faces"), errors("mid-surface")
    assert faces[0, 0].max() < 0.025
    assert faces[0, 1].max() < 0.045
    assert middle[0, 0].min() > 0.30
    assert middle[0, 1].max() > 0.12
    assert faces[1].max() < 0.045
    assert middle[1].max() > 0.1


def test_thick_walls_at_their_mid_surfaces_are_remarked_with_both_numbers() -> None:
    def told(wetted: str, *thickness: float) -> list[str]:
        return remarks(dimensionless(double(wetted, thickness)))

    load, gap = told("mid-surface", 0.01, 0.12)
    assert "outer shell: fluids at its mid-surface" in load
    assert "about 6.0% off, more than 5%" in load
    assert 'use wetted = "faces"' in load
    thin, exact = -1.0 / 0.12, lame(1.0, 0.94, 1.06, 0.0, 1.0)
    assert abs(thin / exact - 1.0) == pytest.approx(0.06, rel=0.1)
    assert f"{0.5 / (0.94 - 0.505) - 1.0:.1%} wider" in gap
    (alone,) = told("mid-surface", 0.03, 0.05)  # of which the inner shell's history is a third off
    assert "gap: from mid-surface to mid-surface it is 8.7% wider" in alone
    assert not told("faces", 0.01, 0.12)
    assert not told("mid-surface", 0.012, 0.012)


def test_a_run_at_mid_surfaces_warns() -> None:
    run = {"modes": 4, "duration": 0.2, "time_step": 2e-2}
    assert any("wetted" in one for one in cx.simulate(double("mid-surface"), **run).warnings)
    assert not any("wetted" in one for one in cx.simulate(double("faces"), **run).warnings)


def test_fluids_on_faces_slow_a_wall_at_once_by_their_resistance_there() -> None:
    # s C_ii = (1/M)/(s + b) + O(s^-3), b with rho c r/R of both fluids.
    problem, s, modes = dimensionless(double("faces", (0.1, 0.2))), np.array([2e4, 4e4]) + 0j, Modes(np.zeros(1))
    for shell, wall in enumerate(problem.shells):
        compliance = ModalSystem(problem, s, modes).solve(shell, np.ones((1, 2), complex))[shell][0]
        rest = s * compliance - 1.0 / (wall.mass * (s + initial_decay(problem, shell, modes)[0, 0]))
        assert np.abs(rest * s**3)[1] == pytest.approx(np.abs(rest * s**3)[0], rel=0.05)


def test_walls_that_are_not_there_let_a_wave_pass_as_their_thickness_vanishes() -> None:
    # Without mass and stiffness, but with faces: what is missing is the fluid between them.
    nothing = STEEL.replace(density=1e-6, youngs_modulus=1e-3)
    grid, modes = LaplaceGrid(0.1, 30), Modes(np.arange(6.0))
    errors = []
    for h in (0.02, 0.01, 1e-6):
        shells = [cx.Shell(radius=r, layers=[cx.Layer(nothing, h)], wetted="faces") for r in (0.5, 1.0)]
        problem = dimensionless(double("faces").replace(shells=shells))
        modal = ModalSystem(problem, grid.nodes, modes)
        moved = modal.solve_outside(problem.sources[0].prepare(grid, modes)(modal.radial, slice(None)))
        s, front = grid.nodes, modes.neumann * np.exp(-grid.nodes * problem.head)
        free = [front * ivp(modes.column, s * wall.radius) / s for wall in problem.shells]  # dp/dr = s^2 w of e^{-s(b - r cos theta)}
        errors.append(max(np.abs(w - p).max() / np.abs(p).max() for w, p in zip(moved, free, strict=True)))
    assert errors[0] / errors[1] == pytest.approx(2.0, rel=0.05)
    assert errors[2] < 1e-5


def test_energy_over_the_whole_length_closes_at_true_faces() -> None:
    sphere = cx.SphericalShock(peak_pressure=2.5e4, decay_time=1.314e-4, distance=4.0)
    response = cx.simulate(double("faces", source=sphere), dimensions=3, stations=[0.0], modes=5, duration=1.0, time_step=2e-2)
    energy = response.energy(every=25)
    assert float(np.abs(energy["closure_relative"]).max()) < 5e-6
    assert float(energy["exterior_work"].max()) > 0.0


def test_pressures_on_the_faces_are_what_moves_the_walls() -> None:
    # What the warning of cavitation reads: Z W = p_out r_out/R - p_in r_in/R of every wall, at every order and node.
    problem, grid, modes = dimensionless(double("faces")), LaplaceGrid(0.1, 30), Modes(np.arange(6.0))
    modal = ModalSystem(problem, grid.nodes, modes)
    moved = modal.solve_outside(SurfaceLoads(problem, grid, modes)(modal.radial, slice(None))[0])
    net = [np.zeros((6, grid.nodes.size), complex) for _ in moved]
    for region, shell, pressure in wall_pressures(problem, grid, np.stack(moved)[:, None]):
        inside = region == shell
        net[shell] += (-1 if inside else 1) * problem.shells[shell].leverage[0 if inside else 1] * pressure[0]
    for wall, w, load in zip(modal.shells, moved, net, strict=True):
        np.testing.assert_allclose(wall.impedance * w, load, rtol=0, atol=1e-9 * np.abs(load).max())
