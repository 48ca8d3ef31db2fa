"""Absorbers that hold exact and thin walls over arcs: against a dense solution of its own, limits, balances, refusals."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy import special

import coaxshell as cx
from coaxshell.acoustics.basis import Modes
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.response import load_response
from coaxshell.solver.excitation import SurfaceLoads
from coaxshell.solver.faced_forces import march_weights, surfaces_of
from coaxshell.solver.interface.absorbers import InterfacePoints, absorber_set
from coaxshell.solver.interface.linear import solve_linear
from coaxshell.solver.interface.linked import solve_linked
from coaxshell.solver.scaling import Problem, dimensionless
from coaxshell.solver.solid_spectra import FacedSystem
from coaxshell.solver.steady import Frequencies, LineForce, SteadySystem
from coaxshell.solver.structure_spectra import StructureSpectra

STEEL = cx.Elastic(name="steel", density=7800, youngs_modulus=210e9, poisson_ratio=0.3)
WATER = cx.Fluid(density=1000, sound_speed=1400)
SHOCK = cx.PlaneShock(peak_pressure=25e3, decay_time=0.13e-3)
LINEAR = {"mass": 50.0, "damping": 1e5, "linear_stiffness": 1e9}
CUBIC = {**LINEAR, "cubic_stiffness": 1e20}
EXACT, MIXED = ("elastic", "elastic"), ("elastic", "thin")


def system(theories: tuple[str, ...] = EXACT, absorbers: Any = (), thickness: float = 0.02) -> cx.System:
    radii = np.linspace(0.5, 1.0, len(theories))
    shells = [cx.Shell(radius=r, layers=[cx.Layer(STEEL, thickness)], theory=t) for r, t in zip(radii, theories, strict=True)]
    return cx.System(shells=shells, fluids=[WATER] * (len(shells) + 1), source=SHOCK, absorbers=absorbers)


def structure(problem: Problem, grid: LaplaceGrid, modes: int) -> StructureSpectra:
    return StructureSpectra(problem, grid, Modes.up_to(modes))


def run(described: cx.System, **settings: Any) -> cx.Response:
    return cx.simulate(described, **{"duration": 1.0, "time_step": 1e-2, "modes": 8, **settings})


# A dense solution of its own: every order from -M to M, forces and readings as integrals over the arcs, fluids by SciPy


def fluid_pressures(s: complex, order: int, radii: tuple[float, ...], kind: str) -> np.ndarray:
    """Return the pressures on the faces of a fluid per outward displacement of them; rho = 1, c = 1."""
    m = abs(order)
    functions = {"inside": [(special.iv, special.ivp)], "outside": [(special.kv, special.kvp)]}
    shapes = functions.get(kind, [(special.iv, special.ivp), (special.kv, special.kvp)])
    slopes = np.array([[s * slope(m, s * r) for _, slope in shapes] for r in radii])
    values = np.array([[value(m, s * r) for value, _ in shapes] for r in radii])
    return np.asarray(values @ np.linalg.solve(slopes, -s * s * np.eye(len(radii))))


def dense(problem: Problem, s: complex, outside: np.ndarray, modes: int) -> tuple[np.ndarray, np.ndarray]:
    """Return inward displacements (faces, orders 0 to M) and the forces (N, 2) of absorbers between two elastic walls."""
    orders, listed, a = np.arange(-modes, modes + 1), problem.system.absorber_list, problem.scales
    receptances = [wall.receptance(Modes.up_to(modes), np.array([s])) for wall in problem.shells]
    radii = [r for wall in problem.shells for r in wall.wetted]
    count, face = orders.size, lambda shell, side: 2 * shell + side
    unknowns, matrix = 4 * count, np.eye(4 * count, dtype=complex)
    right = np.zeros(unknowns, complex)
    moved = np.zeros((unknowns, 4 * count), complex)  # displacement per inward pressure on a face
    for place, order in enumerate(orders):
        for shell, h in enumerate(receptances):
            entries = [[h.inner[abs(order), 0], h.across[abs(order), 0]], [h.across[abs(order), 0], h.outer[abs(order), 0]]]
            for i in (0, 1):
                for j in (0, 1):
                    moved[face(shell, i) * count + place, face(shell, j) * count + place] = entries[i][j] * radii[face(shell, j)]
    pressed = np.zeros((4 * count, unknowns), complex)  # inward load of the fluids per inward displacement
    for place, order in enumerate(orders):
        for faces, signs, kind in (((0,), (-1.0,), "inside"), ((1, 2), (1.0, -1.0), "gap"), ((3,), (1.0,), "outside")):
            found = -fluid_pressures(s, order, tuple(radii[f] for f in faces), kind)  # inward displacements are minus outward ones
            for i, sign in enumerate(signs):
                for j in range(len(faces)):
                    pressed[faces[i] * count + place, faces[j] * count + place] = sign * found[i, j]
    for place, order in enumerate(orders):
        share = outside[0, abs(order)] if order == 0 else 0.5 * outside[0, abs(order)]
        right[3 * count + place] = share
    nodes, weights = np.polynomial.legendre.leggauss(40)
    force = np.zeros((4 * count, unknowns), complex)  # inward pressure of the links per inward displacement
    laws = []
    for one in listed:
        z = (one.damping * a.velocity * s / (a.pressure * a.length)) + one.linear_stiffness / a.pressure
        mass = one.mass * a.velocity**2 / (a.pressure * a.length**2) * s * s
        stiffness = z * np.eye(2) - z * z / (mass + 2 * z)
        mean, spread = np.zeros((2, unknowns), complex), np.zeros((2, 4 * count), complex)
        for side, f in ((0, 1), (1, 2)):
            angles = np.radians(one.angle) + 0.5 * one.footprint / (a.length * radii[f]) * nodes
            here = slice(f * count, (f + 1) * count)
            mean[side, here] = 0.5 * weights @ np.exp(1j * np.outer(angles, orders))
            spread[side, here] = 0.5 * weights @ np.exp(-1j * np.outer(angles, orders)) / (2 * np.pi * radii[f])
        force -= spread.T @ stiffness @ mean
        laws.append((stiffness, mean))
    found = np.linalg.solve(matrix - moved @ (pressed + force), moved @ right)
    signed = found.reshape(4, count)
    cosines = signed[:, modes:] + signed[:, modes::-1]
    cosines[:, 0] = signed[:, modes]
    return cosines, np.array([-stiffness @ mean @ found for stiffness, mean in laws])


def test_linear_absorbers_against_a_dense_solution_at_single_nodes() -> None:
    fitted = [cx.Absorber(angle=angle, footprint=arc, **LINEAR) for angle, arc in ((0, 0.03), (60, 0.1), (-60, 0.1), (180, 0.2))]
    problem, grid, modes = dimensionless(system(absorbers=fitted)), LaplaceGrid(2e-2, 40), 7
    structured = structure(problem, grid, modes)
    solved = solve_linked(structured, absorber_set(problem, tuple(fitted), 1))
    assert solved.solid is not None
    assert solved.exact is not None
    loads = SurfaceLoads(problem, grid, Modes.up_to(modes))
    for node in (3, 41, 150):
        system_ = FacedSystem(structured.problem, grid.nodes[node : node + 1], Modes.up_to(modes))
        outside = loads(system_.radial, slice(node, node + 1))[0][:, 0]
        faces, force = dense(structured.problem, complex(grid.nodes[node]), outside[None], modes)
        here = solved.solid.faces[:, :, 0, :, node]
        np.testing.assert_allclose(here.swapaxes(0, 1).reshape(4, -1), faces, rtol=0, atol=1e-9 * np.abs(faces).max())
        carried = solved.exact[0][:, node].reshape(2, -1)[:, solved.absorbers.member]
        np.testing.assert_allclose(carried.T, force, rtol=1e-8)


def test_steady_motion_against_the_dense_solution() -> None:
    fitted = [cx.Absorber(angle=angle, footprint=arc, **LINEAR) for angle, arc in ((0, 0.03), (60, 0.1), (-60, 0.1))]
    problem = dimensionless(system(absorbers=fitted)).resolving(20.0)
    grid, modes = Frequencies.of(np.array([0.7, 4.3, 11.0])), Modes.up_to(7)
    found = SteadySystem(problem, grid, modes).under_force(LineForce(1, 0.0))
    outside = 1.0 / (np.pi * np.where(modes.orders == 0, 2.0, 1.0) * problem.shells[1].wetted[1])
    for node, s in enumerate(grid.nodes):
        faces, force = dense(problem, complex(s), outside[None], 7)
        here = np.stack([found.inner[:, 0, :, node], found.outer[:, 0, :, node]], axis=1)
        np.testing.assert_allclose(here.reshape(4, -1), faces, rtol=0, atol=1e-8 * np.abs(faces).max())
        np.testing.assert_allclose(found.link_force[..., node], force, rtol=0, atol=1e-8 * np.abs(force).max())


def test_a_line_has_no_finite_displacement_on_an_exact_face_but_an_arc_has() -> None:
    """What a face yields under a force grows as the logarithm of M if it stands on a line, and settles if it stands on an arc."""
    given, s = {**LINEAR, "angle": 0.0}, np.array([2.0 + 3.0j])
    arcs = tuple(cx.Absorber(footprint=arc, **given) for arc in (1e-6, 0.1))
    yielded = []
    for modes in (50, 100, 200):
        problem = dimensionless(system(absorbers=arcs, thickness=0.05)).resolving(10.0)
        basis = Modes.up_to(modes)
        walls = FacedSystem(problem, s, basis)
        compliance = np.stack([surfaces_of(problem, walls.under_force(one, 1.0)) for one in problem.surfaces], axis=1)
        points = InterfacePoints(problem, absorber_set(problem, arcs, 2), basis)
        yielded.append(np.abs(points.receptance(compliance)[0].diagonal()))
    line, arc = np.diff(np.array(yielded)[:, :2], axis=0).T / yielded[0][:2, None]
    assert line[1] > 0.95 * line[0] > 0.004  # by as much at every doubling
    assert abs(arc[0]) < 1e-4
    assert abs(arc[1]) < 0.3 * abs(arc[0])


def test_reciprocity_between_all_places_of_a_mixed_system() -> None:
    """Places on thin and exact walls, on arcs of all lengths and a line: w at b under a force at a is w at a under one at b."""
    places = [(0, 0, 0.05), (0, 70, None), (1, 200, 0.1), (1, 10, None)]
    fitted = tuple(cx.Absorber(angle=angle, inner_shell=inner, footprint=arc, **LINEAR) for inner, angle, arc in places)
    problem = dimensionless(system(("elastic", "thin", "elastic"), fitted))
    structured = structure(problem, LaplaceGrid(2e-2, 40), 10)
    points = InterfacePoints(structured.problem, absorber_set(problem, fitted, 2), structured.modes)
    found = points.receptance(structured.compliance[..., ::50])
    np.testing.assert_allclose(found, found.swapaxes(1, 2), rtol=0, atol=1e-10 * np.abs(found).max())


def test_forces_on_several_surfaces_are_read_once() -> None:
    """Walls read of the sum of their faces' motions do what they do under each force, all added."""
    places = [(0, 0, 0.05), (0, 70, None), (1, 10, None)]
    fitted = tuple(cx.Absorber(angle=angle, inner_shell=inner, footprint=arc, **LINEAR) for inner, angle, arc in places)
    problem, s, modes = dimensionless(system(("elastic", "thin", "elastic"), fitted)), np.array([0.3 + 0.2j, 2.0 + 7.0j]), Modes.up_to(3)
    faced = FacedSystem(problem, s, modes)
    loads = [(surface, np.full((4, 2), 1.0 + j)) for j, surface in enumerate(problem.surfaces)]
    assert len(loads) > 2
    each = [faced.under_force(*load) for load in loads]
    for i, together in enumerate(faced.under_forces(loads)):
        for name in ("normal", "tangential", "hoop"):
            parts = [getattr(answers[i], name) for answers in each]
            np.testing.assert_allclose(getattr(together, name), sum(parts), rtol=0, atol=1e-12 * np.abs(parts).max() * len(parts))
        for side, moved in enumerate(together.faces):
            parts = [answers[i].faces[side] for answers in each]
            np.testing.assert_allclose(moved, sum(parts), rtol=0, atol=1e-12 * np.abs(parts).max() * len(parts))


def test_the_immediate_answer_of_a_face_is_the_impedance_of_its_layer() -> None:
    """At steps shorter than the transit through the thickness 1/(rho c_L + rho_f c_f), at longer ones dt/2 over the mass, both found."""
    problem = dimensionless(system(thickness=0.1))
    modes, scales = Modes.up_to(2), problem.scales
    pressure_speed = np.sqrt(210e9 * 0.7 / (1.3 * 0.4 * 7800))
    faces = 1.0 / ((7800 * pressure_speed + 1000 * 1400) / (1000 * 1400))
    first = march_weights(problem.resolving(1.0), LaplaceGrid(4e-3, 3), modes)[..., 0]
    np.testing.assert_allclose(first[0, 0], faces, rtol=0.02)
    np.testing.assert_allclose(first[0, 1], 0.0, atol=1e-3 * faces)
    light = dimensionless(system(thickness=1e-3))
    mass = 7800 * 1e-3 / (1000 * scales.length)
    step = 4e-3
    late = march_weights(light.resolving(1.0), LaplaceGrid(step, 3), modes)[..., 0]
    slowed = 2.0 * step / mass  # water on both faces
    expected = step / mass * (0.5 - slowed / 6.0 + slowed**2 / 24.0 - slowed**3 / 120.0)
    np.testing.assert_allclose(late[0, 0], expected, rtol=0.05)


@pytest.mark.parametrize("theories", [EXACT, MIXED])
def test_the_march_converges_to_the_exact_solution_at_second_order(theories: tuple[str, ...]) -> None:
    fitted = tuple(cx.absorber_ring(3, footprint=0.1, offset=20, **LINEAR).absorbers)
    errors = []
    for step in (1.6e-2, 8e-3):
        problem = dimensionless(system(theories, fitted))
        structured = structure(problem, LaplaceGrid(step, round(0.8 / step)), 8)
        links = absorber_set(problem, fitted, 1)
        exact, marched = (solve_linked(structured, links, exact=one) for one in (True, False))
        histories = [structured.grid.invert(one.normal.copy()) for one in (exact, marched)]
        errors.append(np.linalg.norm(histories[1] - histories[0]) / np.linalg.norm(histories[0]))
    assert errors[1] < 2e-5
    assert errors[0] / errors[1] > 2.8


def test_rings_by_their_symmetry_agree_with_any_layout() -> None:
    ring = cx.absorber_ring(5, footprint=0.08, **LINEAR)
    problem = dimensionless(system(MIXED, ring))
    structured = structure(problem, LaplaceGrid(2e-2, 40), 12)
    links = absorber_set(problem, ring.absorbers, 1)
    symmetric = solve_linked(structured, links)
    assert symmetric.exact is not None
    general = solve_linear(structured, links, InterfacePoints(structured.problem, links, structured.modes))
    np.testing.assert_allclose(symmetric.exact[0], general.force, rtol=0, atol=1e-11 * np.abs(general.force).max())


@pytest.mark.parametrize(("theories", "law"), [(EXACT, LINEAR), (MIXED, CUBIC), (("thin", "thin"), CUBIC)])
def test_the_energy_closes(theories: tuple[str, ...], law: dict[str, float]) -> None:
    found = run(system(theories, cx.absorber_ring(3, footprint=0.1, **law)), duration=0.6).energy()
    assert float(np.abs(found.closure_relative).max()) < 5e-5
    assert float(found.damper_dissipation[-1]) > 1e-3 * float(found.exterior_work.max())


def test_exact_walls_tend_to_thin_ones_that_are_held_alike() -> None:
    """The forces on thin walls wetted at their faces and held over the same arcs differ by O(h)."""
    errors = []
    for thickness in (0.01, 0.0025):
        ring = cx.absorber_ring(3, footprint=0.2, **LINEAR)
        thin = system(("thin", "thin"), ring, thickness)
        thin = thin.replace(shells=[one.replace(wetted="faces") for one in thin.shells])
        force, limit = (np.asarray(run(one).absorber_force()) for one in (system(absorbers=ring, thickness=thickness), thin))
        errors.append(np.linalg.norm(force - limit) / np.linalg.norm(force))
    assert errors[1] < 3e-3
    assert errors[0] / errors[1] > 2.8


def test_a_saved_run_and_estimates_know_what_forces_moved(tmp_path: Any) -> None:
    """Faces, stresses and the error by the orders left out, of a marched run and of the same run read back."""
    first = run(system(absorbers=cx.absorber_ring(3, footprint=0.2, **CUBIC)), modes=16)
    first.save(tmp_path / "run.nc")
    again = load_response(tmp_path / "run.nc")
    for depth in ("inner", "outer"):
        here, there = (np.asarray(one.stress("inner", angle=[0, 60], depth=depth)) for one in (first, again))
        np.testing.assert_allclose(there, here, rtol=0, atol=1e-9 * np.abs(here).max())
    finer = run(system(absorbers=cx.absorber_ring(3, footprint=0.2, **CUBIC)), modes=32)
    change = np.asarray(finer.displacement("inner", range(0, 181, 5))) - np.asarray(first.displacement("inner", range(0, 181, 5)))
    true = float(np.linalg.norm(change) / np.linalg.norm(finer.displacement("inner", range(0, 181, 5))))
    assert 0.5 * true < float(first.estimates.orders[0, 0]) < 20.0 * true


def test_arcs_on_thin_walls_agree_between_both_engines() -> None:
    ring = cx.absorber_ring(3, footprint=0.3, **CUBIC)
    spectral, direct = (
        run(system(("thin", "thin"), ring), time_step=5e-3, duration=0.4, modes=5, engine=engine) for engine in ("spectral", "direct")
    )
    here, there = (np.asarray(one.stress("inner", [0, 60, 180])) for one in (spectral, direct))
    assert np.linalg.norm(here - there) < 0.02 * np.linalg.norm(here)
    line = run(system(("thin", "thin"), cx.absorber_ring(3, **CUBIC)), time_step=5e-3, duration=0.4, modes=5)
    assert np.linalg.norm(here - np.asarray(line.stress("inner", [0, 60, 180]))) > 0.01 * np.linalg.norm(here)


def test_an_arc_is_part_of_a_circle() -> None:
    with pytest.raises(cx.InputError, match=r"absorbers\[0\]\.footprint: 4 m is more than the circumference of shells\[0\]"):
        system(absorbers=[cx.Absorber(footprint=4.0, **LINEAR)])
    assert system(absorbers=[cx.Absorber(footprint="12 mm", **LINEAR)]).absorber_list[0].footprint == pytest.approx(0.012)
    assert cx.absorber_ring(3, footprint="12 mm", **LINEAR).absorbers[2].footprint == pytest.approx(0.012)
