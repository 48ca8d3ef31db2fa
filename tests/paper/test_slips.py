"""Every slip against something independent of its switch: the ordinary solver on another system, or a closed form."""

from __future__ import annotations

from dataclasses import asdict

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.acoustics.laplace_grid import LaplaceGrid
from coaxshell.paper import Resolution
from coaxshell.paper.slips import SLIPS, SWITCHED, simulate, solve_each
from coaxshell.solver.prepared import PreparedStructure
from coaxshell.solver.scaling import dimensionless

TINY = Resolution(duration=2.5, time_step=1e-2, modes=16)
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
    structure = PreparedStructure(problem, grid, TINY.modes)
    scales, s = problem.scales, grid.nodes
    law = (1e9 + 1e4 * s / scales.time) / scales.pressure
    mass = 10.0 * scales.velocity**2 / (scales.pressure * scales.length**2) * s**2
    share = law / (mass + 2 * law)
    own, other = law - law * share, -law * share
    bare = structure.linear.normal[:, 0]
    at = bare.sum(axis=1)  # cos(m 0) = 1
    receptance = structure.compliance.sum(axis=2) / np.array([shell.radius for shell in problem.shells])[None, :, None]
    forces = np.empty((2, s.size), np.complex128)
    for k in range(s.size):
        admittance = np.array([[own[k], other[k]], [other[k], own[k]]])
        forces[:, k] = -admittance @ np.linalg.solve(np.eye(2) + receptance[..., k] @ admittance, at[:, k])
    pressure = forces / np.array([[shell.radius] for shell in problem.shells])
    normal = bare + np.einsum("ijmk,jk->imk", structure.compliance, pressure)
    same(response.solution.normal[:, 0], grid.invert(normal), 1e-9)


@pytest.mark.parametrize("cubic", [0.0, 1e20])
def test_cosines_only_are_two_halves_of_an_absorber(cubic):
    law = {"mass": 10.0, "damping": 1e4, "linear_stiffness": 1e9, "cubic_stiffness": cubic}
    alone = BARE.replace(absorbers=[cx.Absorber(angle=25, **law)])
    halves = BARE.replace(absorbers=[cx.Absorber(angle=a, **{name: value / 2 for name, value in law.items()}) for a in (25, -25)])
    slipped, pair = simulate(alone, TINY, frozenset({"cosine-only"})), solved(halves)
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
    for name, response in solve_each(systems, TINY, slips):
        np.testing.assert_array_equal(stress(response, "inner"), stress(simulate(systems[name], TINY, slips), "inner"))


def test_every_switch_has_words():
    assert set(SLIPS) >= SWITCHED
    assert all(key == slip.key for key, slip in SLIPS.items())


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
    ],
)
def test_bad_input_is_refused(slips, system, where):
    with pytest.raises(cx.InputError, match=where):
        simulate(system, TINY, frozenset(slips))
