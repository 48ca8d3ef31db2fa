"""Every slip against something independent of its switch: the ordinary solver on another system, or a closed form."""

from __future__ import annotations

from dataclasses import asdict, replace

import numpy as np
import pytest
from scipy.special import ive

import coaxshell as cx
from coaxshell.acoustics.basis import Modes, RadialBasis
from coaxshell.acoustics.sources import SphericalGeometry
from coaxshell.apps.paper.slips import SLIPS, SWITCHED, effects, growth, simulate, solve_each, table
from coaxshell.apps.paper.slips.actuation import whole_actuation
from coaxshell.apps.paper.slips.switches import slipped
from coaxshell.apps.paper.slips.waves import PrintedPotential
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.response import PreparedSystem
from coaxshell.solver.coupling import ModalSystem
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.settings import Settings
from coaxshell.solver.solve import prepare, solve_prepared
from coaxshell.solver.structure_spectra import StructureSpectra

TINY = Settings(duration=2.5, time_step=1e-2, modes=16)
BARE = cx.presets.load("bare")
ANGLES = [0.0, 40.0, 90.0, 180.0, 250.0]
CUBIC = {"mass": 10.0, "linear_stiffness": 1e9, "cubic_stiffness": 1e20}


def solved(system, resolution=TINY):
    return cx.simulate(system, **asdict(resolution))


def stress(response, shell):
    return np.asarray(response.stress(shell, angle=ANGLES))


def displacement(response, shell):
    return np.asarray(response.displacement(shell, angle=ANGLES))


def same(actual, expected, rtol):
    np.testing.assert_allclose(actual, expected, rtol=0, atol=rtol * np.abs(expected).max())


@pytest.mark.parametrize("preset", ["bare", "hybrid"])
def test_without_slips_nothing_changes(preset):
    system = cx.presets.load(preset)
    response, expected = simulate(system, TINY), solved(system)
    np.testing.assert_array_equal(response.solution.normal, expected.solution.normal)
    np.testing.assert_array_equal(response.solution.tangential, expected.solution.tangential)


def heavier_inside(system, times):
    """Return the system with an inner shell so many times as dense and stiff (and as piezoelectric, so that its sensors agree)."""
    inner, outer = system.shells

    def scaled(material):
        if isinstance(material, cx.Elastic):
            changes = {"density": material.density * times, "youngs_modulus": material.youngs_modulus * times}
        else:
            changes = {name: getattr(material, name) * times for name in ("density", "c22", "c23", "c33")}
            changes |= {name: getattr(material, name) * np.sqrt(times) for name in ("e32", "e33")}
        return material.model_copy(update={**changes, "name": f"heavy {material.name}"})

    layers = [layer.model_copy(update={"material": scaled(layer.material)}) for layer in inner.layers]
    return system.replace(shells=[inner.model_copy(update={"layers": tuple(layers)}), outer])


@pytest.mark.parametrize("radius", [0.5, 0.8])
def test_the_radius_factor_is_a_heavier_shell_that_moves_more(radius):
    system = BARE.replace_path("shells.inner.radius", radius)
    factor = radius**2
    slipped = simulate(system, TINY, frozenset({"radius-factor"}))
    heavy = solved(heavier_inside(system, 1.0 / factor))
    same(displacement(slipped, "inner"), displacement(heavy, "inner") / factor, 1e-9)
    same(displacement(slipped, "outer"), displacement(heavy, "outer"), 1e-9)
    # Motion and stress of the slipped shell are 1/factor times the heavy one's; what its water feels, and so its pressure, is the same.
    where = {"radius": [0.3 * radius, 0.9], "angle": [0.0, 120.0], "time": [0.8, 1.3, 2.1]}
    same(np.asarray(slipped.pressure(**where)), np.asarray(heavy.pressure(**where)), 1e-9)


def test_an_absorber_without_projection_is_one_whose_force_is_larger():
    # One linear absorber at the head: w = w_bare + g pi (2 pi at order 0) f, f the same law of w. Checked node by node.

    system = BARE.replace(absorbers=[cx.Absorber(angle=0, mass=10, linear_stiffness=1e9, damping=1e4)])
    response = simulate(system, TINY, frozenset({"missing-projection"}))
    problem, grid = dimensionless(system), LaplaceGrid(TINY.time_step, 250)
    structure = StructureSpectra(problem, grid, Modes.up_to(TINY.modes))
    scales, s = problem.scales, grid.nodes
    law = (1e9 + 1e4 * s / scales.time) / scales.pressure
    mass = 10.0 * scales.velocity**2 / (scales.pressure * scales.length**2) * s**2
    share = law / (mass + 2 * law)
    own, other = law - law * share, -law * share
    bare = structure.normal[:, 0]
    at = bare.sum(axis=1)  # cos(m 0) = 1
    receptance = structure.compliance.sum(axis=2) / np.array([shell.radius for shell in problem.shells])[None, :, None]
    forces = np.empty((2, s.size), np.complex128)
    for k in range(s.size):
        admittance = np.array([[own[k], other[k]], [other[k], own[k]]])
        forces[:, k] = -admittance @ np.linalg.solve(np.eye(2) + receptance[..., k] @ admittance, at[:, k])
    pressure = forces / np.array([[shell.radius] for shell in problem.shells])
    normal = bare + np.einsum("ijmk,jk->imk", structure.compliance, pressure)
    same(response.solution.normal[:, 0], grid.invert(normal), 1e-9)


@pytest.mark.parametrize("slips", [{"missing-projection"}, {"outside-sum"}, {"radius-factor", "missing-projection"}])
def test_exact_and_marched_rings_agree(slips):
    # A negligible cubic stiffness sends the ring through the interface march; without it the Laplace domain solves it exactly.
    resolution = Settings(duration=1.2, time_step=2e-3, modes=16)
    law = {"mass": 10.0, "damping": 1e5, "linear_stiffness": 1e9}
    exact, marched = (
        simulate(BARE.replace(absorbers=cx.absorber_ring(5, **law, cubic_stiffness=cubic)), resolution, frozenset(slips))
        for cubic in (0.0, 1.0)
    )
    for shell in ("inner", "outer"):
        same(stress(marched, shell), stress(exact, shell), 2e-4)


@pytest.mark.parametrize("cubic", [0.0, 1e20])
def test_cosines_only_are_two_halves_of_an_absorber(cubic):
    law = {"mass": 10.0, "damping": 1e4, "linear_stiffness": 1e9, "cubic_stiffness": cubic}
    alone = BARE.replace(absorbers=[cx.Absorber(angle=25, **law)])
    parities = BARE.replace(absorbers=[cx.Absorber(angle=a, **{name: value / 2 for name, value in law.items()}) for a in (25, -25)])
    slipped, pair = simulate(alone, TINY, frozenset({"cosine-only"})), solved(parities)
    for shell in ("inner", "outer"):
        same(stress(slipped, shell), stress(pair, shell), 1e-7)
        assert np.abs(stress(slipped, shell) - stress(solved(alone), shell)).max() > 1e-3 * np.abs(stress(pair, shell)).max()


def test_cosines_only_do_not_touch_a_symmetric_ring():
    ring = BARE.replace(absorbers=cx.absorber_ring(5, **CUBIC))
    same(stress(simulate(ring, TINY, frozenset({"cosine-only"})), "inner"), stress(solved(ring), "inner"), 1e-12)


def test_outside_the_sum_of_one_absorber_is_inside():
    one = BARE.replace(absorbers=[cx.Absorber(angle=0, **CUBIC)])
    for key in ("outside-sum", "outside-sum-first"):
        same(stress(simulate(one, TINY, frozenset({key})), "inner"), stress(solved(one), "inner"), 1e-9)


def test_neighbours_share_a_structure_and_agree_with_single_runs():
    slips = frozenset({"radius-factor", "missing-projection"})
    systems = {str(n): BARE.replace(absorbers=cx.absorber_ring(n, **CUBIC) if n else ()) for n in (0, 3)}
    found = dict(solve_each(systems, TINY, slips))
    assert list(found) == list(systems)
    for name, response in found.items():
        np.testing.assert_array_equal(stress(response, "inner"), stress(simulate(systems[name], TINY, slips), "inner"))


def test_every_switch_has_words():
    assert set(SLIPS) >= SWITCHED
    assert all(key == slip.key for key, slip in SLIPS.items())


def test_massless_shells_move_as_the_wave_but_for_the_radius_factor():
    # The proof that the factor is a slip: one fluid, shells without mass and stiffness, a plane wave. The wave's own motion is exact.
    def ghost(radius):
        nothing = cx.Elastic(name="nothing", density=1e-9, youngs_modulus=1e-3, poisson_ratio=0.3)
        return cx.Shell(radius=radius, layers=[cx.Layer(nothing, 1e-3)])

    water = cx.Fluid(density=1000, sound_speed=1400)
    source = cx.PlaneShock(peak_pressure=2.5e4, decay_time=1.314e-4)
    system = cx.System(shells=[ghost(0.5), ghost(1.0)], fluids=[water] * 3, source=source)
    grid, orders = LaplaceGrid(5e-2, 60), np.arange(13)[:, None]
    s = grid.nodes
    inner, outer = (_plane_wave_motion(orders, s, radius) for radius in (0.5, 1.0))
    for slips, factor in ((frozenset(), 1.0), (frozenset({"radius-factor"}), 4.0)):
        problem = slipped(system, slips)
        pulse = 2.5e4 / problem.scales.pressure / (s + problem.scales.time / 1.314e-4)
        moved = StructureSpectra(problem, grid, Modes.up_to(12)).normal[:, 0] / pulse
        np.testing.assert_allclose(moved[0], factor * inner, rtol=0, atol=1e-12 * abs(inner).max())
        np.testing.assert_allclose(moved[1], outer, rtol=0, atol=1e-12 * abs(outer).max())


def _plane_wave_motion(orders, s, radius):
    """Return w of a plane wave's own motion at a radius per unit pulse, dp/dr/s^2 with p = eps_m e^{-s} I_m(s r)."""
    slope = (ive(abs(orders - 1), s * radius) + ive(orders + 1, s * radius)) / 2 * np.exp(s.real * radius - s)
    return np.where(orders == 0, 1, 2) * slope / s


def test_the_printed_potential_gives_the_velocity_of_its_derivative():
    # v0 at r = 1 by finite differences of the printed potential behind the front, projected by brute force at one Laplace node.
    distance, decay, s, order = 5.0, 0.18, 1.3 + 2.1j, 3
    theta, when = 2 * np.pi * (np.arange(400) + 0.5) / 400, np.linspace(0.0, 14.0, 28001)[:, None]

    def potential(r, since):
        reach = np.sqrt(distance**2 + r * r - 2 * r * distance * np.cos(theta))
        return -decay * (distance - 1) / reach * np.exp(-(since - (reach - at)) / decay)

    at = np.sqrt(distance**2 + 1 - 2 * distance * np.cos(theta))
    velocity = (potential(1 + 1e-5, when) - potential(1 - 1e-5, when)) / 2e-5
    transform = np.trapezoid(velocity * np.exp(-s * when), when[:, 0], axis=0) * np.exp(-s * (at - distance + 1))
    expected = 2 / 400 * np.sum(transform * np.cos(order * theta))
    front = (distance - 1) / at * (1 - distance * np.cos(theta)) / at * np.exp(-s * (at - distance + 1))
    front, afterflow = (2 / 400 * np.sum(shape * np.cos(order * theta)) for shape in (front, front / at))
    found = PrintedPotential(distance, decay=decay, impulse=False).acceleration(front, afterflow, s) / s / (s + 1 / decay)
    np.testing.assert_allclose(found, expected, rtol=1e-5)
    whole = PrintedPotential(distance, decay=decay, impulse=True).acceleration(front, afterflow, s)
    np.testing.assert_allclose(whole, decay * s * SphericalGeometry(distance).acceleration(front, afterflow, s), rtol=1e-14)


def test_reversed_diffraction_takes_the_load_from_a_rigid_head():
    grid, modes = LaplaceGrid(1e-2, 50), Modes.up_to(80)
    radial = RadialBasis(modes, grid.nodes)

    def load(slips):
        (wave,) = slipped(BARE, slips).sources
        return grid.invert(wave.prepare(grid, modes)(radial, slice(None)) / (grid.nodes + 1.0), grid.lanczos()).sum(axis=0)

    doubled, cancelled = load(frozenset()), load(frozenset({"diffraction-sign"}))
    incident = SphericalGeometry(5.0).projections(grid, modes)[0] / (grid.nodes + 1.0)
    np.testing.assert_allclose(doubled + cancelled, 2 * grid.invert(incident, grid.lanczos()).sum(axis=0), rtol=0, atol=1e-11)
    assert abs(doubled[5] - 2.0) < 0.2
    assert abs(cancelled[5]) < 0.2


@pytest.mark.slow_for("bare-radiation-sign-12")
@pytest.mark.parametrize(("preset", "key", "modes"), [("active", "control-sign", 40), ("bare", "radiation-sign", 12)])
def test_growth_is_that_of_a_root(preset, key, modes):
    system = cx.presets.load(preset)
    found = growth(system, frozenset({key}), modes)
    problem, order = slipped(system.replace(absorbers=()), frozenset({key})), np.array([float(found.order)])

    def determinant(s):
        return complex(ModalSystem(problem, np.array([s]), Modes(order)).determinant()[0, 0])

    # Newton's method from the fastest of many starts on the line Re s = rate.
    best = None
    for start in found.rate + 1j * np.concatenate([[0.0], np.geomspace(0.1, 60.0, 60)]):
        s = start
        for _ in range(60):
            step = 1e-6 * max(abs(s), 1.0)
            slope = (determinant(s + step) - determinant(s - step)) / (2 * step)
            change = determinant(s) / slope
            s = s - change
            if s.real <= 0.01 or abs(change) < 1e-10 * abs(s):
                break
        if s.real > 0.01 and abs(change) < 1e-8 * abs(s) and (best is None or s.real > best.real):
            best = s
    np.testing.assert_allclose(found.rate, best.real, rtol=1e-12)


def test_what_is_stable_does_not_grow():
    assert growth(BARE, frozenset({"radius-factor"}), 12) is None
    assert growth(cx.presets.load("active"), frozenset({"permittivity"}), 12) is None


def test_effects_are_those_of_the_runs():
    studies = ((("radius-factor",), ("bare",)), (("control-sign",), ("active",)), (("permittivity",), ("active, standard permittivity",)))
    shell, sign, permittivity = effects(TINY, studies)
    plain, other = solved(BARE), simulate(BARE, TINY, frozenset({"radius-factor"}))
    assert shell.corrected.inner == plain.summary().shells[0].stress.value
    assert shell.slipped.outer_tail == other.summary().shells[-1].stress_tail.value
    around = np.arange(0.0, 360.0, 360.0 / 40)  # exact for 16 orders
    before, after = (np.asarray(r.stress("inner", angle=around)) for r in (plain, other))
    np.testing.assert_allclose(shell.inner_change, np.linalg.norm(after - before) / np.linalg.norm(before), rtol=1e-10)
    assert shell.change("inner") == pytest.approx(shell.slipped.inner / shell.corrected.inner - 1)
    assert sign.slipped is None
    assert sign.growth.rate > 1.0
    assert permittivity.slipped.inner == pytest.approx(solved(cx.presets.load("active")).summary().shells[0].stress.value, rel=1e-12)
    assert permittivity.corrected.inner != permittivity.slipped.inner
    text = table([shell, sign])
    assert f"{shell.slipped.inner / 1e6:.3f}" in text
    assert "grows" in text
    assert len({line.count("|") for line in text.splitlines()}) == 1


def test_with_the_radius_factor_the_inner_tail_follows_the_papers_text():
    # Extrema at t = 1.2, 1.7 and 3.1, and the inner shell stressed over twice as much as the outer; neither without it.
    resolution = Settings(duration=3.5, time_step=4e-3, modes=48)
    ratios, instants = [], []
    for slips in (frozenset(), frozenset({"radius-factor"})):
        response = simulate(BARE, resolution, slips)
        inner, outer = response.summary().shells
        ratios.append(inner.stress.value / outer.stress.value)
        tail = np.asarray(response.stress("inner", angle=[180.0]))[:, 0]
        turns = 1 + np.flatnonzero(np.diff(np.sign(np.diff(tail))))
        instants.append(response.time[turns[np.abs(tail[turns]) > 0.28 * np.abs(tail).max()]])
    assert ratios[0] < 1.2
    assert ratios[1] > 2.0
    for expected in (1.21, 1.73, 3.10):
        assert np.abs(instants[1] - expected).min() < 0.015
    assert np.abs(instants[0] - 1.73).min() > 0.05
    assert np.abs(instants[0] - 3.10).min() > 0.05


def test_a_response_with_slips_is_not_saved(tmp_path):
    with pytest.raises(cx.InputError, match="other formulas"):
        simulate(BARE, TINY, frozenset({"control-sign"})).save(tmp_path / "run.nc")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("slips", "system", "where"),
    [
        ({"radius-facter"}, BARE, "slips"),
        ({"scattering-delay"}, BARE, "slips"),
        ({"radius-factor"}, cx.presets.load("iakovlev-filled"), "slips"),
        ({"incident-potential"}, BARE.replace(source=cx.PlaneShock(peak_pressure=1e4, decay_time=1e-4)), "source"),
        ({"control-sign"}, cx.presets.load("active"), "control"),
        ({"radiation-sign"}, BARE, "order"),
    ],
)
def test_bad_input_is_refused(slips, system, where):
    with pytest.raises(cx.InputError, match=where):
        simulate(system, TINY, frozenset(slips))


def test_three_dimensions_know_no_slips():
    with pytest.raises(cx.InputError, match=r"^dimensions: 3 knows no slips"):
        simulate(BARE, replace(TINY, dimensions=3), frozenset({"printed-strain"}))


@pytest.mark.parametrize("slip", ["diffraction-sign", "radius-factor", "printed-strain"])
def test_what_is_prepared_without_a_slip_is_not_taken_for_it(slip):
    prepared = PreparedSystem(dimensionless(BARE), TINY)
    other = PreparedSystem(slipped(BARE, {slip}), TINY, like=prepared.structure)
    np.testing.assert_array_equal(other.simulate().solution.normal, simulate(BARE, TINY, frozenset({slip})).solution.normal)


def test_the_papers_actuator_cannot_push_by_a_pressure_alone():
    # Plane wave, the paper's gains: 0.189 MPa by the pressure alone, 1.06 by all that the actuator exerts (150 orders: 1.06).
    shock = cx.PlaneShock(peak_pressure=BARE.source.peak_pressure, decay_time=BARE.source.decay_time)
    problem = dimensionless(cx.presets.load("active").replace(source=shock))
    settings = Settings(duration=1.8, time_step=1e-2, modes=30)
    found = []
    for one in (problem, whole_actuation(problem)):
        response = cx.Response(solve_prepared(prepare(one, settings), one, settings))
        found.append(response.summary().shells[0].stress.value / 1e6)
    assert found == pytest.approx([0.189, 1.06], rel=5e-3)
