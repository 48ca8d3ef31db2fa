"""Absorbers beside segments and matrices of feedback on exact walls: a dense solution of all orders, marches, thin walls, energy."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy import special

import coaxshell as cx
from coaxshell.numerics.modes import Modes
from coaxshell.solver.excitation import SurfaceLoads
from coaxshell.solver.faced_forces import surface_motion
from coaxshell.solver.interface.linked import solve_linked
from coaxshell.solver.recompute import spectra_of
from coaxshell.solver.solid_spectra import FacedSystem, sensed_place
from coaxshell.solver.solved_spectra import SolvedSpectra
from coaxshell.structure.elastic_wall import ElasticWall

PAIRS = cx.presets.load("electrodes").replace(source=cx.PlaneShock(peak_pressure=25e3, decay_time=1.314e-4))
RUN: dict[str, Any] = {"duration": 0.4, "time_step": 2e-2, "modes": 6}
LINEAR = [cx.Absorber(angle=angle, mass=50.0, damping=1e5, linear_stiffness=1e9, footprint=0.2) for angle in (20.0, 160.0, 250.0)]
CUBIC = [one.replace(cubic_stiffness=1e20) for one in LINEAR]
FEW: dict[str, Any] = {**RUN, "duration": 0.3, "modes": 3}
MIXED = [[1.0, 0.5], [0.3, 0.8]]


def system(theories: tuple[str, str] = ("elastic", "elastic"), absorbers: Any = LINEAR, scale: float = 1.0, **law: Any) -> cx.System:
    """Return pairs of electrodes under a lead, walls of two theories, all layers *scale* times as thick."""
    shells = []
    for shell, theory in zip(PAIRS.shells, theories, strict=True):
        layers = []
        for layer in shell.layers:
            standard = {"permittivity_reduction": "standard"} if isinstance(layer.material, cx.Piezoelectric) else {}
            layers.append(layer.replace(material=layer.material.replace(**standard), thickness=scale * layer.thickness))
        shells.append(shell.replace(layers=layers, theory=theory, **({"wetted": "faces"} if theory == "thin" else {})))
    control = cx.Feedback(numerator=[2 * PAIRS.transit_time, 3], transducers="electrodes", **law)
    return PAIRS.replace(shells=shells, control=control, absorbers=absorbers)


@pytest.fixture(scope="module")
def cut() -> cx.Response:
    return cx.simulate(system(matrix=MIXED, segments=4, segment_gap=0.02, dead=[1]), **RUN)


def fluid_loads(s: complex, order: int, radii: tuple[float, ...], functions: list[Any]) -> np.ndarray:
    """Return the pressures of a fluid on its faces per inward displacement of them; rho = 1, c = 1."""
    slopes = np.array([[s * slope(order, s * r) for _, slope in functions] for r in radii])
    values = np.array([[value(order, s * r) for value, _ in functions] for r in radii])
    return np.asarray(s * s * values @ np.linalg.inv(slopes))


def dense(solved: SolvedSpectra, node: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return displacements of faces (4, orders -M to M), voltages of segments (2, N) and forces (N, 2), all unknowns in one matrix."""
    problem, top, scales = solved.structure.open_loop.problem, solved.modes.max_order, solved.problem.scales
    s, orders = solved.grid.nodes[node : node + 1], np.arange(-top, top + 1)
    walls, count = problem.shells, orders.size
    laws, listed = [complex(np.ravel(wall.gains.at(s, Modes(np.zeros(1))))[0]) for wall in solved.problem.shells], solved.problem.system
    radii, faces = [r for wall in walls for r in wall.wetted], slice(0, 4 * count)
    volts, forces = slice(4 * count, 4 * count + 8), slice(4 * count + 8, 4 * count + 8 + 2 * len(listed.absorber_list))
    loads = np.zeros((4 * count, forces.stop), complex)  # inward, on the faces, per unknown
    i_, k_ = (special.iv, special.ivp), (special.kv, special.kvp)
    for place, order in enumerate(np.abs(orders)):
        for some, signs, kinds in (((0,), (1, 0), [i_]), ((1, 2), (-1, 1), [i_, k_]), ((3,), (-1, 0), [k_])):
            found = fluid_loads(complex(s[0]), int(order), tuple(radii[f] for f in some), kinds)
            for i, sign in zip(range(len(some)), signs, strict=False):
                for j in range(len(some)):
                    loads[some[i] * count + place, some[j] * count + place] = -sign * found[i, j]
    outside = np.zeros(4 * count, complex)
    radial = FacedSystem(problem, s, solved.modes).radial
    plane = SurfaceLoads(problem, solved.grid, solved.modes)(radial, slice(node, node + 1))[0][:, 0]
    outside[3 * count :] = plane[np.abs(orders)] * np.where(orders == 0, 1.0, 0.5)
    x, weights = np.polynomial.legendre.leggauss(40)
    over = lambda middle, half: 0.5 * weights @ np.exp(1j * np.outer(middle + half * x, orders))  # noqa: E731 mean over an arc
    matrix, right = np.eye(forces.stop, dtype=complex), np.zeros(forces.stop, complex)
    ends = np.zeros((6, forces.stop), complex)
    for n, one in enumerate(listed.absorber_list):
        for side, face in ((0, 1), (1, 2)):
            mean = over(np.radians(one.angle), 0.5 * one.footprint / (scales.length * radii[face]))
            here = slice(face * count, (face + 1) * count)
            ends[2 * n + side, here] = mean
            loads[here, forces.start + 2 * n + side] = mean.conj() / (2 * np.pi * radii[face])
        z = one.damping * scales.velocity * s[0] / (scales.pressure * scales.length) + one.linear_stiffness / scales.pressure
        mass = one.mass * scales.velocity**2 / (scales.pressure * scales.length**2) * s[0] ** 2
        law = z * np.eye(2) - z * z / (mass + 2 * z)
        matrix[forces.start + 2 * n : forces.start + 2 * n + 2] += law @ ends[2 * n : 2 * n + 2]
    heard = np.zeros((2, 4, forces.stop), complex)
    for i, wall in enumerate(walls):
        assert isinstance(wall, ElasticWall)
        covered = solved.problem.shells[i].segments.covered
        means = [over(0.5 * np.pi * k, 0.25 * np.pi * covered) for k in range(4)]
        pushed = np.array([0.25 * covered * mean.conj() for mean in means]).T  # orders of the voltages of segments
        faced, shown = wall.two_port(solved.modes, s)
        given, mine = wall.under_voltage(solved.modes, s, wall.asked_of_port), slice(4 * i, 4 * i + 4)
        entries = np.array([[faced.inner, faced.across], [faced.across, faced.outer]])[..., 0]
        for place, order in enumerate(np.abs(orders)):
            both = [2 * i * count + place, (2 * i + 1) * count + place]
            receptance = entries[..., order] * np.array(radii[2 * i : 2 * i + 2])
            matrix[both] -= receptance @ loads[both]
            matrix[both, volts.start + 4 * i : volts.start + 4 * i + 4] -= np.outer(given.faces[:, order, 0], pushed[place])
            right[both] = receptance @ outside[both]
            reads = shown[3 + sensed_place(wall), :, order, 0]
            for k, mean in enumerate(means):
                heard[i, k] += mean[place] * (reads @ loads[both])
                heard[i, k, volts][mine] += mean[place] * given.heard[order, 0] * pushed[place]
                for j in (0, 1):
                    if k != 1:
                        right[volts.start + 4 * j + k] += laws[j] * MIXED[j][i] * mean[place] * (reads @ outside[both])
    for j in (0, 1):
        for k in (0, 2, 3):
            matrix[volts.start + 4 * j + k] -= laws[j] * (MIXED[j][0] * heard[0, k] + MIXED[j][1] * heard[1, k])
    found = np.linalg.solve(matrix, right)
    return found[faces].reshape(4, count), found[volts].reshape(2, 4), found[forces].reshape(-1, 2)


def test_linear_absorbers_segments_and_a_matrix_against_a_dense_solution(cut: cx.Response) -> None:
    solved = cut.solution.spectra
    assert solved.solid is not None
    assert solved.exact is not None
    top = solved.modes.max_order
    for node in (2, 19):
        faces, volts, force = dense(solved, node)
        signed = faces.reshape(2, 2, -1).swapaxes(0, 1)
        ahead, behind = signed[..., top:], signed[..., top::-1]
        waves = np.stack([ahead + behind, 1j * (ahead - behind)], axis=2) * np.where(np.arange(top + 1) == 0, 0.5, 1.0)
        np.testing.assert_allclose(solved.solid.faces[..., node], waves, rtol=0, atol=1e-8 * np.abs(waves).max())
        np.testing.assert_allclose(solved.exact[0][:, node].reshape(2, -1).T, force, rtol=0, atol=1e-8 * np.abs(force).max())
        found = [w.segments.values(u[..., node]) for w, u in zip(solved.problem.shells, solved.voltage, strict=True)]
        np.testing.assert_allclose(found, volts, rtol=0, atol=1e-8 * np.abs(volts).max())
    assert np.abs(volts).max() > 0


def test_shells_that_read_themselves_are_those_without_a_matrix() -> None:
    own, unit = (cx.simulate(system(matrix=matrix), **FEW).solution.normal for matrix in (None, [[1, 0], [0, 1]]))
    np.testing.assert_allclose(unit, own, rtol=0, atol=1e-12 * np.abs(own).max())


def test_the_march_tends_to_the_exact_answer(cut: cx.Response) -> None:
    errors = []
    for step in (0.02, 0.01):
        solved = (cut if step == 0.02 else cx.simulate(cut.system, **{**RUN, "time_step": step})).solution.spectra
        marched = solve_linked(solved.structure, solved.absorbers, exact=False)
        exact, other = (solved.grid.invert(surface_motion(solved.problem, one.normal, one.solid.faces)) for one in (solved, marched))
        errors.append(np.abs(other - exact).max() / np.abs(exact).max())
    assert errors[0] < 2e-4
    assert errors[0] / errors[1] > 3.0


def test_it_tends_to_thin_walls_as_the_thickness() -> None:
    errors = []
    for scale in (1.0, 0.25):
        exact, thin = (cx.simulate(system((each, each), scale=scale, matrix=MIXED), **FEW).solution.normal for each in ("elastic", "thin"))
        errors.append(np.linalg.norm(exact - thin) / np.linalg.norm(thin))
    assert errors[1] < 5e-3
    assert errors[1] < 0.3 * errors[0]


@pytest.mark.slow_for("friction")
@pytest.mark.parametrize(
    ("theories", "law"),
    [(("elastic", "elastic"), None), (("thin", "elastic"), cx.laws.Friction(force=2e3))],
    ids=["cubic", "friction"],
)
def test_energy_closes_and_a_kept_run_knows_its_voltages(theories: tuple[str, str], law: Any, tmp_path: Any) -> None:
    absorbers = CUBIC if law is None else [one.replace(law=law) for one in LINEAR]
    run = cx.simulate(system(theories, absorbers, matrix=MIXED, segments=3), **FEW)
    energy = run.energy()
    assert float(np.abs(energy.closure_relative).max()) < (1e-4 if law is None else 2e-3)
    electrical = energy.amplifier_work - (energy.actuator_field - energy.actuator_work)
    assert float(np.abs(electrical).max()) < 1e-9 * float(np.abs(energy.actuator_work).max())
    assert 0.0 < run.solution.estimates.march.max() < 0.2
    again = spectra_of(cx.load_response(run.save(tmp_path / "run.nc")).solution)
    np.testing.assert_allclose(again.segments, run.solution.segment_voltage, rtol=0, atol=1e-9 * np.abs(again.segments).max())
