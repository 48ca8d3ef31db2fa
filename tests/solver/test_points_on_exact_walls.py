"""Point absorbers on walls of elastic solids in three dimensions: against a dense solution of its own, limits, balances, what is read."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy import special

import coaxshell as cx
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.modes import Modes
from coaxshell.solver.axial import solve as axial_solve
from coaxshell.solver.axial.blocks import node_blocks, on_threads
from coaxshell.solver.axial.faced import FacedWave
from coaxshell.solver.axial.families import outside_loads, wave_sets
from coaxshell.solver.axial.linked import point_structure, solve_points
from coaxshell.solver.axial.points import point_layout
from coaxshell.solver.axial.sampling import AxialSampling
from coaxshell.solver.axial.sums import station_sums
from coaxshell.solver.scaling import Problem, dimensionless
from coaxshell.solver.solid_spectra import band

STEEL = cx.Elastic(name="steel", density=7800, youngs_modulus=210e9, poisson_ratio=0.3)
WATER = cx.Fluid(density=1000, sound_speed=1400)
SPHERE = cx.SphericalShock(distance=3.0, peak_pressure=25e3, decay_time=0.13e-3)
PLANE = cx.PlaneShock(peak_pressure=25e3, decay_time=0.13e-3)
LINKS = {"mass": 20.0, "damping": 1e4, "linear_stiffness": 1e8, "footprint": 0.3}
BENT = {**LINKS, "cubic_stiffness": 1e18}
SHORT = {"modes": 3, "duration": 0.4}
EXACT, MIXED = ("elastic", "elastic"), ("elastic", "thin")


def system(theories: tuple[str, ...] = EXACT, absorbers: Any = (), thickness: float = 0.02, source: Any = SPHERE) -> cx.System:
    radii = np.linspace(0.5, 1.0, len(theories))
    shells = [cx.Shell(radius=r, layers=[cx.Layer(STEEL, thickness)], theory=t) for r, t in zip(radii, theories, strict=True)]
    return cx.System(shells=shells, fluids=[WATER] * (len(shells) + 1), source=source, absorbers=absorbers)


def run(described: cx.System, **settings: Any) -> cx.SpatialResponse:
    return cx.simulate(described, **{"duration": 0.6, "time_step": 2e-2, "modes": 4, "dimensions": 3, **settings})


def off(found: Any, true: Any) -> float:
    found, true = np.asarray(found), np.asarray(true)
    return float(np.linalg.norm(found - true) / np.linalg.norm(true))


# A dense solution of its own: all waves e^{i m theta + i k z} with m and k of both signs, patches as integrals, fluids by SciPy


def fluid_pressures(s: complex, k: float, order: int, radii: tuple[float, ...], kind: str) -> np.ndarray:
    """Return the pressures on the faces of a fluid per outward displacement of them; rho = 1, c = 1."""
    m, kappa = abs(order), np.sqrt(s * s + k * k)
    functions: dict[str, Any] = {"inside": [(special.iv, special.ivp)], "outside": [(special.kv, special.kvp)]}
    shapes = functions.get(kind, [(special.iv, special.ivp), (special.kv, special.kvp)])
    slopes = np.array([[kappa * slope(m, kappa * r) for _, slope in shapes] for r in radii])
    values = np.array([[value(m, kappa * r) for value, _ in shapes] for r in radii])
    return np.asarray(values @ np.linalg.solve(slopes, -s * s * np.eye(len(radii))))


def dense(problem: Problem, sampling: AxialSampling, outside: list[np.ndarray], s: complex) -> tuple[np.ndarray, list[complex]]:
    """Return the forces (N, 2) of the absorbers, and W in the middle of both walls at angle 0.4 and z = 0.7."""
    waves = [
        (m, sign * j) for j, top in enumerate(sampling.tops) for m in range(-int(top), int(top) + 1) for sign in ((1, -1) if j else (1,))
    ]
    count, a, period = len(waves), problem.scales, sampling.period
    radii = [r for wall in problem.shells for r in wall.wetted]
    k = sampling.spacing * np.array([j for _, j in waves])
    m = np.array([order for order, _ in waves])
    moved, pressed = np.zeros((2, 4 * count, 4 * count), complex)
    right, reading = np.zeros(4 * count, complex), np.zeros((2, 4 * count), complex)
    spot = np.exp(1j * (m * 0.4 + k * 0.7))
    for place, (order, j) in enumerate(waves):
        modes = Modes(np.array([float(abs(order))]), float(abs(k[place])))
        for shell, wall in enumerate(problem.shells):
            h, shown = wall.station_port(modes, np.array([s]))  # type: ignore[attr-defined]
            entries = [[h.inner[0, 0], h.across[0, 0]], [h.across[0, 0], h.outer[0, 0]]]
            for b in (0, 1):
                column = (2 * shell + b) * count + place
                reading[shell, column] = shown[0, b, 0, 0] * spot[place]
                for c in (0, 1):
                    moved[(2 * shell + c) * count + place, column] = entries[c][b] * radii[2 * shell + b]
        for faces, signs, kind in (((0,), (-1.0,), "inside"), ((1, 2), (1.0, -1.0), "gap"), ((3,), (1.0,), "outside")):
            found = -fluid_pressures(s, k[place], order, tuple(radii[f] for f in faces), kind)
            for row, sign in enumerate(signs):
                for column, _ in enumerate(faces):
                    pressed[faces[row] * count + place, faces[column] * count + place] = sign * found[row, column]
        share = sampling.weights[abs(j)] * (0.5 if j else 1.0) * (0.5 if order else 1.0)
        right[3 * count + place] = outside[abs(j)][abs(order)] * share
    nodes, weights = np.polynomial.legendre.leggauss(30)
    force, laws = np.zeros((4 * count, 4 * count), complex), []
    for one in problem.system.point_absorbers:
        assert one.footprint is not None
        z = one.damping * a.velocity * s / (a.pressure * a.length**2) + one.linear_stiffness / (a.pressure * a.length)
        mass = one.mass * a.velocity**2 / (a.pressure * a.length**3) * s * s
        stiffness = z * np.eye(2) - z * z / (mass + 2 * z)
        mean, spread = np.zeros((2, 4 * count), complex), np.zeros((2, 4 * count), complex)
        for side, f in ((0, 1), (1, 2)):
            around = np.radians(one.angle) + 0.5 * one.footprint / (a.length * radii[f]) * nodes
            along = (one.z + 0.5 * one.footprint * nodes) / a.length
            shape = (0.5 * weights @ np.exp(1j * np.outer(around, m))) * (0.5 * weights @ np.exp(1j * np.outer(along, k)))
            mean[side, f * count : (f + 1) * count] = shape
            spread[side, f * count : (f + 1) * count] = np.conj(shape) / (2 * np.pi * radii[f] * period)
        force -= spread.T @ stiffness @ mean
        laws.append((stiffness, mean))
    walls = np.linalg.solve(np.eye(4 * count) - moved @ (pressed + force), moved @ right)
    loads = (pressed + force) @ walls + right
    return np.array([-stiffness @ mean @ walls for stiffness, mean in laws]), list(reading @ loads)


def test_linear_absorbers_against_a_dense_solution_at_single_nodes() -> None:
    fitted = [cx.PointAbsorber(angle=angle, z=z, **{**LINKS, "footprint": f}) for angle, z, f in ((0, 0.1, 0.1), (70, -0.3, 0.3))]
    grid, sampling = LaplaceGrid(5e-2, 20), AxialSampling(6.0, 4, 4.0)
    problem = dimensionless(system(absorbers=fitted), 3).resolving(band(grid))
    solved = solve_points(point_structure(problem, grid, sampling, point_layout(problem), node_blocks(grid), on_threads))
    at = station_sums(problem, grid, sampling, np.array([0.7]), solved.forces, slice(0, grid.nodes.size))
    around = np.array([np.cos(0.4 * np.arange(5)), np.sin(0.4 * np.arange(5))])
    for node in (3, 21, 60):
        s = grid.nodes[node : node + 1]
        family = wave_sets(problem, sampling, np.zeros(1), s)[0].families[0]
        outside = []
        for modes in sampling.modes:
            radial = FacedWave(problem, grid.nodes, modes).cascade.radial
            outside.append(outside_loads(family, radial, grid, slice(0, grid.nodes.size))[0][:, node])
        force, moved = dense(problem, sampling, outside, complex(s[0]))
        here = solved.forces.force[:, node].reshape(2, -1).T
        np.testing.assert_allclose(here, force, rtol=1e-8)
        np.testing.assert_allclose(np.einsum("ipm,pm->i", at["w"][0, ..., node], around), moved, rtol=1e-8)


def test_points_of_a_mixed_system_answer_each_other() -> None:
    places = ((0, 0.0, 0.1, 0), (80, 0.37, 0.3, 1), (200, -0.6, None, 1))
    fitted = [cx.PointAbsorber(angle=angle, z=z, mass=1.0, footprint=f, inner_shell=i) for angle, z, f, i in places]
    described = system(("elastic", "thin", "elastic"), fitted).with_overrides({"source.angle": 30.0, "source.z": 0.2})
    problem, grid = dimensionless(described, 3), LaplaceGrid(0.1, 20)
    structure = point_structure(problem, grid, AxialSampling(6.0, 4, 4.0), point_layout(problem), node_blocks(grid), on_threads)
    asymmetry = np.abs(structure.receptance - structure.receptance.swapaxes(0, 1))
    assert asymmetry.max() < 1e-12 * np.abs(structure.receptance).max()


LAWS: list[dict[str, Any]] = [{"cubic_stiffness": 1e20}, {"links": "outer", "grounded": True, "law": "bistable"}]


@pytest.mark.parametrize(("theories", "law"), [(EXACT, LAWS[0]), (MIXED, LAWS[1])], ids=["cubic", "bistable and grounded"])
def test_a_row_of_points_closer_than_any_wave_is_held_over_arcs(theories: tuple[str, ...], law: dict[str, Any], monkeypatch: Any) -> None:
    """The absorbers of two dimensions, which hold arcs; by the same kernels, which are made wave by wave here."""
    per_metre, spacing = {"mass": 20.0, "damping": 1e4, "linear_stiffness": 1e8}, 0.1

    def links(length: float) -> dict[str, Any]:
        found = {**law, **{name: value * length for name, value in {**per_metre, **law}.items() if isinstance(value, float)}}
        return {**found, "law": cx.laws.Bistable(k1=-1e8 * length, k3=1e19 * length)} if "law" in law else found

    flat = run(system(theories, cx.absorber_ring(4, **links(1.0), footprint=0.2), source=PLANE), dimensions=2, duration=0.4)
    monkeypatch.setattr(axial_solve, "require_room", lambda *_, **__: None)  # it asks for the period that causality does
    monkeypatch.setattr(axial_solve, "resolved_sampling", lambda *_: (AxialSampling(spacing, 4, 40.0), []))
    points = cx.absorber_ring(4, z=0.0, **links(spacing), footprint=0.2)
    row = run(system(theories, points, source=PLANE), stations=[spacing / 2], duration=0.4)
    assert off(row.stress("inner", station=spacing / 2), flat.stress("inner")) < 1e-9
    assert off(row.absorber_force() / spacing, flat.absorber_force()) < 1e-9


@lru_cache(maxsize=1)
def bent() -> cx.SpatialResponse:
    """Return a marched run with two absorbers, one of them on a wall of each theory."""
    places = ((0.0, 0.1), (70.0, -0.3))
    return run(system(MIXED, [cx.PointAbsorber(angle=angle, z=z, **BENT) for angle, z in places]), **SHORT, stations=[0.1, 0.4])


def test_marched_forces_are_the_exact_ones_to_second_order() -> None:
    fitted = [cx.PointAbsorber(angle=angle, z=z, **LINKS) for angle, z in ((0, 0.1), (70, -0.3))]
    almost = [one.model_copy(update={"cubic_stiffness": 1e-3}) for one in fitted]
    errors = []
    for step in (2e-2, 1e-2):
        grid, sampling, found = LaplaceGrid(step, round(0.5 / step)), AxialSampling(7.0, 3, 3.0), []
        for absorbers in (fitted, almost):
            problem = dimensionless(system(absorbers=absorbers), 3).resolving(band(grid))
            found.append(solve_points(point_structure(problem, grid, sampling, point_layout(problem), node_blocks(grid), on_threads)))
        errors.append(off(found[1].force, found[0].force))
        assert errors[-1] < found[1].error < 10.0 * errors[-1]
    assert errors[0] < 2e-4
    assert errors[0] / errors[1] > 2.8


def test_the_energy_over_the_whole_length_closes() -> None:
    found = bent().energy(every=10)
    assert float(np.abs(found.closure_relative).max()) < 2e-5
    assert float(found.damper_dissipation[-1]) > 1e-3 * float(found.exterior_work.max())


def test_exact_walls_tend_to_thin_ones_that_are_held_alike() -> None:
    """The forces on thin walls wetted at their faces and held over the same patches differ by O(h)."""
    errors, fitted = [], [cx.PointAbsorber(angle=20.0, z=0.1, **LINKS)]
    for thickness in (0.02, 0.005):
        thin = system(("thin", "thin"), fitted, thickness)
        thin = thin.replace(shells=[one.replace(wetted="faces") for one in thin.shells])
        exact = system(EXACT, fitted, thickness)
        force, limit = (run(one, **SHORT, axial_period=8.0).absorber_force() for one in (exact, thin))
        errors.append(off(force, limit))
    assert errors[1] < 3e-4
    assert errors[0] / errors[1] > 2.8


def test_saved_runs_and_what_is_solved_again_know_the_forces(tmp_path: Path) -> None:
    found = bent()
    again = cx.load_response(found.save(tmp_path / "run.nc"))
    np.testing.assert_array_equal(again.absorber_force(), found.absorber_force())
    skin, field = ([one.stress("inner", depth="outer"), one.pressure(x=[0.7], y=[0.1], z=0.1, time=[0.4])] for one in (again, found))
    for there, here in zip(skin, field, strict=True):
        np.testing.assert_allclose(there, here, rtol=1e-9)
    middle = found.displacement("inner", [0, 60], depth=0.0)
    assert off(middle, found.displacement("inner", [0, 60])) < 1e-10
    bare = run(found.system.replace(absorbers=()), **SHORT, stations=[0.1, 0.4])
    assert off(bare.displacement("inner", [0, 60]), middle) > 1e-3
    peak = found.peak_stress("inner")
    held = found.stress("inner", peak.angle, depth=peak.depth, component="von_mises")
    assert peak.value == pytest.approx(float(np.abs(held).max()), rel=1e-2)


def test_a_mass_may_hang_on_one_wall_alone() -> None:
    """Within an only shell it hangs on the inner face, which then moves as its link says: f = z (q - w)."""
    mass, stiffness = 50.0, 1e8
    one = cx.PointAbsorber(mass=mass, linear_stiffness=stiffness, links="outer", z=0.0, footprint=1e-4)
    found = run(system(("elastic",), [one]), **SHORT)
    wall = found.absorber_displacement()[0] - found.absorber_force()[0, 1] / stiffness
    assert off(found.displacement(0, 0, depth="inner", station=0.0), wall) < 1e-6
