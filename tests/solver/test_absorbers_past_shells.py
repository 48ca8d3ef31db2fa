"""Absorbers between shells that are no neighbours, past those between them: against a dense solution, limits, reciprocity and energy."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import coaxshell as cx
from coaxshell.acoustics.basis import Modes
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.interface.absorbers import absorber_set
from coaxshell.solver.interface.linked import solve_linked
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.structure_spectra import StructureSpectra

BARE = cx.presets.load("bare")
LINEAR = {"mass": 10, "damping": 2e5, "linear_stiffness": 1e9}
CUBIC = {**LINEAR, "cubic_stiffness": 1e22}
SETTINGS = {"duration": 0.6, "time_step": 0.02, "modes": 6}
PAST = {"outer_shell": 2}


def unequal(**further: object) -> list[cx.Absorber]:
    return [cx.Absorber(angle=angle, **{**LINEAR, "mass": mass}, **further) for angle, mass in ((20.0, 10), (60.0, 5), (140.0, 20))]


LAYOUTS: dict[str, Callable[..., object]] = {
    "ring": lambda **between: cx.absorber_ring(5, **LINEAR, **between),
    "marched ring": lambda **between: cx.absorber_ring(14, **CUBIC, **between),
    "unequal": unequal,
    "cubic": lambda **between: [cx.Absorber(angle=0, **CUBIC, **between), cx.Absorber(angle=50, **CUBIC, **between)],
    "law": lambda **between: [cx.Absorber(angle=30, **LINEAR, law=cx.laws.Gap(1e-6, 1e9), footprint=0.05, **between)],
    "outer alone": lambda **between: [cx.Absorber(angle=30, **LINEAR, links="outer", **between)],
}


def of_three(middle: cx.Shell, absorbers: object) -> cx.System:
    inner, outer = BARE.shells
    return BARE.replace(shells=[inner, middle, outer], fluids=[BARE.exterior] * 4, absorbers=absorbers)


def of_two(absorbers: object) -> cx.System:
    return BARE.replace(fluids=[BARE.exterior] * 3, absorbers=absorbers)


@pytest.fixture(scope="module")
def middle() -> cx.Shell:
    return BARE.shells[0].replace(radius=0.75)


@pytest.fixture
def nothing(ring: Callable[..., cx.Shell]) -> cx.Shell:
    """Return a shell whose material is that of nothing."""
    return ring(0.75, 1e-4, density=1e-6, youngs_modulus=1e-2)


def close(found: object, expected: object, tolerance: float) -> None:
    found, expected = np.asarray(found), np.asarray(expected)
    assert_allclose(found, expected, rtol=0, atol=tolerance * abs(expected).max())


@pytest.mark.parametrize("layout", LAYOUTS)
def test_neighbours_written_out_are_those_of_always_and_a_shell_that_is_nothing_between_is_none(layout: str, nothing: cx.Shell) -> None:
    made = LAYOUTS[layout]
    usual, written, past = (
        cx.simulate(system, **SETTINGS) for system in (of_two(made()), of_two(made(outer_shell=1)), of_three(nothing, made(**PAST)))
    )
    assert written.system.canonical() == usual.system.canonical()
    for name in ("absorber_force", "absorber_displacement", "absorber_stroke"):
        read, two, three = (np.nan_to_num(getattr(one, name)()) for one in (usual, written, past))
        assert_array_equal(two, read)
        close(three, read, 1e-10)
    assert_array_equal(written.solution.normal, usual.solution.normal)
    close(past.solution.normal[[0, 2]], usual.solution.normal, 1e-10)


def test_faces_of_exact_walls_that_look_at_each_other_are_held(ring: Callable[..., cx.Shell]) -> None:
    light = ring(0.75, 1e-3, density=1e-6, youngs_modulus=1e-2)
    walls = [ring(radius, 0.02).replace(theory="elastic") for radius in (0.5, 1.0)]
    settings = {**SETTINGS, "modes": 4}
    two = cx.simulate(of_two(unequal()).replace(shells=walls), **settings)
    three = cx.simulate(of_three(light, unequal(**PAST)).replace(shells=[walls[0], light, walls[1]]), **settings)
    close(three.absorber_force(), two.absorber_force(), 1e-10)
    close(three.solution.normal[[0, 2]], two.solution.normal, 1e-10)


def test_mirror_images_written_in_two_ways_are_images(middle: cx.Shell) -> None:
    problem = dimensionless(of_three(middle, ()))
    pair = (cx.Absorber(angle=40, **LINEAR), cx.Absorber(angle=-40, outer_shell=1, **LINEAR))
    assert absorber_set(problem, pair, 1).count == 1
    assert absorber_set(problem, (pair[0], pair[1].replace(outer_shell=2)), 1).count == 2


def dense(structure: StructureSpectra, absorbers: tuple[cx.Absorber, ...]) -> tuple[np.ndarray, np.ndarray]:
    """Return (forces, (nodes, 2N), modal pressures, (shells, 2, M + 1, nodes)) of linear absorbers by one matrix of all points and masses.

    w_a = w_a0 + sum_b sum_m C_ij f_b cos m(theta_a - theta_b)/(beta_m pi R_j),  m s^2 q = -f_0 - f_1,  f = z (q - w).
    """
    problem, s, n = structure.problem, structure.grid.nodes, len(absorbers)
    shells = np.repeat([[0], [2]], n, axis=1).ravel()
    angles = np.tile(np.radians([one.angle for one in absorbers]), 2)
    orders = np.arange(structure.modes.count)
    share = 1.0 / (np.pi * np.where(orders == 0, 2.0, 1.0))
    radius = np.array([wall.radius for wall in problem.shells])
    compliance = structure.compliance[shells[:, None], shells]
    turned = np.cos(np.multiply.outer(angles[:, None] - angles, orders)) * share / radius[shells][:, None]
    receptance = np.einsum("abmk,abm->kab", compliance, turned)
    around = np.stack([np.cos(np.multiply.outer(angles, orders)), np.sin(np.multiply.outer(angles, orders))])
    free = np.einsum("ahmk,ham->ka", structure.normal[shells], around[: structure.normal.shape[1]])
    scales = problem.scales
    mass = np.array([one.mass for one in absorbers]) / (problem.system.exterior.density * scales.length**2)
    z = (LINEAR["damping"] * s * scales.velocity / scales.length + LINEAR["linear_stiffness"]) / scales.pressure
    to_mass = np.vstack([np.eye(n), np.eye(n)])
    matrix = np.zeros((s.size, 3 * n, 3 * n), np.complex128)  # of the forces, then the masses
    matrix[:, : 2 * n, : 2 * n] = np.eye(2 * n) + z[:, None, None] * receptance
    matrix[:, : 2 * n, 2 * n :] = -z[:, None, None] * to_mass
    matrix[:, 2 * n :, : 2 * n] = to_mass.T
    matrix[:, 2 * n :, 2 * n :] = mass * np.eye(n) * s[:, None, None] ** 2
    right = np.concatenate([-z[:, None] * free, np.zeros((s.size, n))], axis=1)
    force = np.linalg.solve(matrix, right[:, :, None])[:, : 2 * n, 0]
    pressure = np.zeros((3, 2, orders.size, s.size), np.complex128)
    for point, shell in enumerate(shells):
        pressure[shell] += (around[:, point] * share)[:, :, None] * force[:, point] / radius[shell]
    return force, pressure


@pytest.mark.parametrize("layout", ["ring", "unequal"])
def test_linear_ones_are_a_dense_solution_of_all_orders(layout: str, middle: cx.Shell) -> None:
    system = of_three(middle, LAYOUTS[layout](**PAST))
    structure = StructureSpectra(dimensionless(system), LaplaceGrid(0.02, 40), Modes.up_to(9))
    found = solve_linked(structure, absorber_set(structure.problem, system.absorber_list, 2))
    force, pressure = dense(structure, system.absorber_list)
    invert, count = structure.grid.invert, len(system.absorber_list)
    close(found.force, invert(force.T).reshape(2, count, -1).swapaxes(0, 1), 1e-9)
    without = np.zeros_like(pressure)
    without[:, : structure.normal.shape[1]] = structure.normal
    moved = without + np.einsum("ijmk,jhmk->ihmk", structure.compliance, pressure)
    for shell in range(3):  # the one between moves by the fluids alone
        close(invert(found.normal[shell]), invert(moved[shell]), 1e-9)


@pytest.mark.filterwarnings("ignore::coaxshell.PhysicsWarning")
def test_links_leave_the_shells_reciprocal(middle: cx.Shell) -> None:
    system = of_three(middle, unequal(**PAST))
    places = (("inner", 30.0), ("outer", 70.0))
    there, back = (
        np.asarray(cx.frequency_response(system, [300.0, 900.0], "receptance", shell=at[0], angle=at[1], force=force, modes=12))
        for at, force in (places, places[::-1])
    )
    assert_allclose(there, back, rtol=1e-9)
    bare = cx.frequency_response(system.replace(absorbers=[]), 300.0, "receptance", shell="inner", angle=30.0, force=places[1], modes=12)
    assert abs(there[0] / np.asarray(bare) - 1.0).max() > 0.1


def test_energy_closes_where_absorbers_cross(middle: cx.Shell) -> None:
    crossing = [
        cx.Absorber(angle=0, **LINEAR),
        cx.Absorber(angle=50, **LINEAR, inner_shell=1),
        cx.Absorber(angle=100, **CUBIC, **PAST),
        cx.Absorber(angle=200, **LINEAR, links="outer", outer_shell=1),
    ]
    response = cx.simulate(of_three(middle, crossing), duration=0.8, time_step=2.5e-3, modes=6)
    assert abs(response.energy(every=40).closure_relative).max() < 1e-5


def test_strokes_are_to_the_shells_that_are_held(middle: cx.Shell) -> None:
    spring = cx.Absorber(angle=30, mass=10, linear_stiffness=1e9, **PAST)
    response = cx.simulate(of_three(middle, [spring]), **SETTINGS)
    close(1e9 * response.absorber_stroke(), response.absorber_force(), 1e-9)


def test_points_are_past_shells_too(nothing: cx.Shell) -> None:
    source = cx.SphericalWave(distance=4.0, pulse=BARE.source.pulse)
    settings = {"dimensions": 3, "stations": [0.0], "duration": 0.4, "time_step": 0.04, "modes": 3}

    def force(system: Callable[[list], cx.System], **between: int) -> np.ndarray:
        points = [cx.PointAbsorber(angle=angle, z=z, **CUBIC, **between) for angle, z in ((0, 0.0), (40, 0.3))]
        return np.asarray(cx.simulate(system(points).replace(source=source), **settings).absorber_force())

    usual = force(of_two)
    assert_array_equal(force(of_two, outer_shell=1), usual)
    close(force(lambda points: of_three(nothing, points), **PAST), usual, 1e-10)


def test_gradients_hold(middle: cx.Shell) -> None:
    system = of_three(middle, LAYOUTS["cubic"](**PAST))
    path, settings = "absorbers[1].angle", {**SETTINGS, "modes": 4}

    def asked(at: cx.System) -> object:
        return cx.gradient(at, metric="inner.rms_stress", variables=[path], **settings)

    up, down = (float(asked(system.with_overrides({path: 50.0 + step}))["value"]) for step in (1e-2, -1e-2))
    assert_allclose(float(asked(system)["gradient"][0]), (up - down) / 2e-2, rtol=1e-5)
