"""Absorbers on the shells: symmetry, limits, layouts."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.acoustics.basis import Modes
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.interface.absorbers import InterfacePoints, absorber_set
from coaxshell.solver.interface.linked import solve_linked
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.structure_spectra import StructureSpectra

SETTINGS = {"duration": 1.5, "time_step": 5e-3, "modes": 20}
CUBIC = {"mass": 10, "damping": 2e5, "linear_stiffness": 1e9, "cubic_stiffness": 1e22}
LINEAR = {**CUBIC, "cubic_stiffness": 0}
ANGLES = np.array([0.0, 33.0, 90.0, 180.0, 251.0])
BARE = cx.presets.load("bare")


def run(absorbers: object, system: cx.System = BARE, **changes: object) -> cx.Response:
    return cx.simulate(system.replace(absorbers=absorbers), **{**SETTINGS, **changes})


def close(found: object, expected: object, tolerance: float) -> None:
    found, expected = np.asarray(found), np.asarray(expected)
    np.testing.assert_allclose(found, expected, rtol=0, atol=tolerance * abs(expected).max())


# --- description to problem ------------------------------------------------------------------------------------------------


def test_dimensionless_constants() -> None:
    system = BARE.replace(shells=[BARE.shells[0], BARE.shells[1].replace(radius=2.0)])
    links = absorber_set(dimensionless(system), (cx.Absorber(angle=30, **CUBIC), cx.Absorber(angle=40, **CUBIC)), 1)
    rho, c, a = 1000.0, 1400.0, 2.0
    np.testing.assert_allclose(links.mass, 10 / (rho * a**2), rtol=1e-14)
    np.testing.assert_allclose(links.damping, 2e5 / (rho * c * a), rtol=1e-14)
    np.testing.assert_allclose(links.linear, 1e9 / (rho * c**2), rtol=1e-14)
    np.testing.assert_allclose(links.cubic, 1e22 * a**2 / (rho * c**2), rtol=1e-14)


@pytest.mark.parametrize(
    ("angles", "carried", "parities"),
    [
        ([0], 1, 1), ([180], 1, 1), ([0, 180], 2, 1), ([30, -30], 1, 1), ([30, 330], 1, 1), ([30], 1, 2), ([30, -31], 2, 2),
        ([90, 270, 0], 2, 1), ([0, 0], 2, 1), ([], 0, 1),
    ],
)  # fmt: skip
def test_mirror_images_are_carried_once(angles: list[float], carried: int, parities: int) -> None:
    absorbers = tuple(cx.Absorber(angle=angle, **CUBIC) for angle in angles)
    links = absorber_set(dimensionless(BARE), absorbers, 1)
    assert (links.count, links.parities) == (carried, parities)
    assert links.multiplicity.sum() == len(angles)
    assert len(links.member) == len(angles)
    off_axis = absorber_set(dimensionless(BARE), absorbers, 2)
    assert (off_axis.count, off_axis.parities) == (len(angles), 2)


def test_evaluation_and_projection_are_adjoint() -> None:
    # The power of the forces at the points is that of their modal pressures: sum f w = sum over modes of beta pi R p W.
    problem = dimensionless(BARE)
    links = absorber_set(problem, tuple(cx.Absorber(angle=angle, **CUBIC) for angle in (10, 70, 200)), 1)
    points = InterfacePoints(problem, links, Modes.up_to(7))
    random = np.random.default_rng(0)
    force, modal = random.normal(size=6), random.normal(size=(2, 2, 8))
    weight = np.pi * np.array([0.5, 1.0])[:, None, None] * np.where(np.arange(8) == 0, 2.0, 1.0)
    np.testing.assert_allclose(force @ points.evaluate(modal), (weight * points.project(force) * modal).sum(), rtol=1e-12)
    present = random.normal(size=(2, 2, 8))
    through_modes = points.evaluate(np.einsum("ijm,jhm->ihm", present, points.project(force)))
    np.testing.assert_allclose(points.immediate(present) @ force, through_modes, rtol=1e-12)
    close(points.receptance(present[..., None] + 0j)[0] @ force, through_modes + 0j, 1e-12)


# --- symmetry --------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("law", [LINEAR, CUBIC], ids=["linear", "cubic"])
@pytest.mark.parametrize("count", [2, 6, 7])
def test_a_ring_keeps_mirror_symmetry(count: int, law: dict[str, float]) -> None:
    ring = cx.absorber_ring(count, **law)
    as_ring, as_list = run(ring), run(list(ring.absorbers))
    assert as_ring.solution.normal.shape[1] == 1
    np.testing.assert_array_equal(as_list.solution.normal, as_ring.solution.normal)
    forces = np.asarray(as_ring.absorber_force())
    np.testing.assert_array_equal(forces[1:], forces[:0:-1])  # k and N - k are mirror images
    tilted = ring.replace(offset=1e-4)  # solved with both halves
    both = run(tilted)
    assert both.solution.normal.shape[1] == 2
    for shell in ("inner", "outer"):
        close(both.displacement(shell, ANGLES), as_ring.displacement(shell, ANGLES), 1e-4)


@pytest.mark.parametrize("law", [LINEAR, CUBIC], ids=["linear", "cubic"])
def test_both_halves_give_the_same_to_rounding(law: dict[str, float]) -> None:
    problem = dimensionless(BARE)
    structure = StructureSpectra(problem, LaplaceGrid(5e-3, 200), Modes.up_to(20))
    absorbers = cx.absorber_ring(6, **law).absorbers
    folded = solve_linked(structure, absorber_set(problem, absorbers, 1))
    whole = solve_linked(structure, absorber_set(problem, absorbers, 2))
    close(whole.force, folded.force, 1e-10)
    cosine, sine = structure.grid.invert(whole.normal).swapaxes(0, 1)
    close(cosine, structure.grid.invert(folded.normal)[:, 0], 1e-10)
    assert abs(sine).max() < 1e-11 * abs(cosine).max()
    np.testing.assert_allclose(whole.force[1:], whole.force[:0:-1], rtol=0, atol=1e-10 * abs(whole.force).max())


@pytest.mark.parametrize("turn", [90.0, 137.0, -60.0])
def test_turning_everything_turns_the_answer(turn: float) -> None:
    absorbers = [cx.Absorber(angle=20, **CUBIC), cx.Absorber(angle=-110, **{**LINEAR, "mass": 3})]
    straight = run(absorbers)
    turned_system = BARE.with_overrides({"source.angle": turn})
    turned = run([a.replace(angle=a.angle + turn) for a in absorbers], turned_system)
    for shell in ("inner", "outer"):
        close(turned.displacement(shell, ANGLES + turn), straight.displacement(shell, ANGLES), 1e-9)
        close(turned.stress(shell, ANGLES + turn), straight.stress(shell, ANGLES), 1e-9)
    close(turned.absorber_force(), straight.absorber_force(), 1e-9)


@pytest.mark.parametrize("law", [LINEAR, CUBIC], ids=["linear", "cubic"])
def test_one_absorber_in_a_cosine_series_stands_for_two_of_half_strength(law: dict[str, float]) -> None:
    # The paper's Fig. 8 (theory manual, slips): one absorber off the axis in a cosine-only series.
    problem = dimensionless(BARE)
    structure = StructureSpectra(problem, LaplaceGrid(5e-3, 200), Modes.up_to(20))
    full = absorber_set(problem, (cx.Absorber(angle=40, **law),), 1)
    cosine_only = replace(full, parities=1)
    half = {name: value / 2 for name, value in law.items()}
    pair = absorber_set(problem, (cx.Absorber(angle=40, **half), cx.Absorber(angle=-40, **half)), 1)
    one, two = (solve_linked(structure, links, exact=False) for links in (cosine_only, pair))
    close(structure.grid.invert(one.normal), structure.grid.invert(two.normal), 1e-9)
    close(one.force, two.force.sum(axis=0, keepdims=True), 1e-9)
    physical = solve_linked(structure, full, exact=False)  # and that is not one absorber
    difference = structure.grid.invert(physical.normal)[:, 0] - structure.grid.invert(one.normal)[:, 0]
    assert abs(difference).max() > 1e-3 * abs(structure.grid.invert(one.normal)).max()


# --- limits ----------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("law", [LINEAR, CUBIC, {**CUBIC, "damping": 0}], ids=["linear", "cubic", "undamped"])
def test_without_mass_two_springs_in_series(law: dict[str, float]) -> None:
    massless = run(cx.absorber_ring(5, **{**law, "mass": 0}))
    force, q = massless.absorber_force(), massless.absorber_displacement()
    close(force.sel(side="inner"), -force.sel(side="outer"), 1e-9)
    angles = q["angle"].values
    mean = 0.5 * (np.asarray(massless.displacement("inner", angles)) + np.asarray(massless.displacement("outer", angles)))
    close(q.transpose("time", "absorber"), mean, 2e-3)  # equal springs: the middle moves as the mean
    errors = []
    for mass in (1e-2, 1e-3, 1e-4):
        light = run(cx.absorber_ring(5, **{**law, "mass": mass}))
        errors.append(float(abs(light.displacement("inner", ANGLES) - massless.displacement("inner", ANGLES)).max()))
    scale = float(abs(massless.displacement("inner", ANGLES)).max())
    assert errors[0] < 1e-3 * scale
    assert errors[2] < 1e-5 * scale


@pytest.mark.parametrize("law", [LINEAR, CUBIC], ids=["linear", "cubic"])
def test_a_heavy_mass_is_an_anchor(law: dict[str, float]) -> None:
    heavy, heavier = (run(cx.absorber_ring(5, **{**law, "mass": mass})) for mass in (1e7, 1e8))
    assert float(abs(heavy.absorber_displacement()).max()) < 1e-4 * float(abs(heavy.displacement("outer", ANGLES)).max())
    close(heavy.displacement("inner", ANGLES), heavier.displacement("inner", ANGLES), 1e-4)


def test_many_on_the_same_angle_are_one_of_their_sum() -> None:
    several = run([cx.Absorber(angle=35, **CUBIC) for _ in range(4)])
    one = run([cx.Absorber(angle=35, **{name: 4 * value for name, value in CUBIC.items()})])
    for shell in ("inner", "outer"):
        close(several.displacement(shell, ANGLES), one.displacement(shell, ANGLES), 1e-9)
    close(several.absorber_force().sum("absorber"), one.absorber_force().sum("absorber"), 1e-9)


def test_unequal_ones_keep_their_order() -> None:
    absorbers = [cx.Absorber(angle=angle, **{**CUBIC, "mass": mass}) for angle, mass in ((170, 5), (-20, 30), (80, 1))]
    straight, reverse = run(absorbers), run(absorbers[::-1])
    close(straight.absorber_force(), np.asarray(reverse.absorber_force())[::-1], 1e-9)
    np.testing.assert_array_equal(straight.absorber_force()["angle"], [170, -20, 80])


def test_absorbers_link_any_two_neighbours_of_three_shells() -> None:
    inner, outer = BARE.shells
    system = BARE.replace(shells=[inner.replace(radius=0.4), inner.replace(radius=0.7), outer], fluids=[*BARE.fluids, BARE.fluids[0]])
    fitted = [cx.Absorber(angle=0, inner_shell=0, **CUBIC), cx.Absorber(angle=0, inner_shell=1, **CUBIC)]
    none, first, second, both = (run(some, system) for some in ([], fitted[:1], fitted[1:], fitted))
    for response in (first, second, both):
        assert float(abs(response.displacement("outer", ANGLES) - none.displacement("outer", ANGLES)).max()) > 0
    # Before a wave can cross a gap, a shell without an absorber on it moves as if there were none.
    early = none.time < 0.25
    untouched = np.asarray(none.displacement("outer", ANGLES))[early]
    np.testing.assert_allclose(np.asarray(first.displacement("outer", ANGLES))[early], untouched, rtol=0, atol=1e-6 * abs(untouched).max())
    assert abs(np.asarray(second.displacement("outer", ANGLES))[early] - untouched).max() > 1e-3 * abs(untouched).max()
    # A rigid link between the middle and the outer shell makes them move alike there, and leaves the inner one alone.
    rigid = run([cx.Absorber(angle=0, inner_shell=1, mass=0, linear_stiffness=1e13)], system)
    gap = np.asarray(rigid.displacement(2, [0.0]) - rigid.displacement(1, [0.0]))
    assert abs(gap).max() < 2e-3 * float(abs(rigid.displacement(2, [0.0])).max())


def test_the_two_shells_are_not_confused() -> None:
    # A spring from the inner shell to an anchor, and nearly none on the outer side: only f_0 matters; by the mirror image too.
    response = run([cx.Absorber(angle=0, mass=1e9, linear_stiffness=1e9)])
    for side, shell in (("inner", "inner"), ("outer", "outer")):
        force = np.asarray(response.absorber_force().sel(side=side))[0]
        w = np.asarray(response.displacement(shell, [0.0]))[:, 0]
        close(force, -1e9 * w, 1e-4)
