"""One, two and three shells, rigid ones, vacuum gaps and lopsided walls, each tied to a case that must agree with it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

import coaxshell as cx

SETTINGS = {"duration": 2.0, "time_step": 4e-3, "modes": 30}


@pytest.fixture(scope="module")
def run(water: cx.Fluid, shock: cx.PlaneShock) -> Callable[..., np.ndarray]:
    """Return a function from shells and fluids to W of all shells."""

    def solve(shells: list, fluids: list | None = None) -> np.ndarray:
        system = cx.System(shells=shells, fluids=fluids or [water] * (len(shells) + 1), source=shock)
        return cx.simulate(system, **SETTINGS).solution.normal[:, 0]

    return solve


@pytest.fixture(scope="module")
def ghost(ring: Callable[..., cx.Shell]) -> Callable[[float], cx.Shell]:
    return lambda radius: ring(radius, 1e-4, density=1e-6, youngs_modulus=1e-2)


def close(found: np.ndarray, expected: np.ndarray, tolerance: float) -> None:
    np.testing.assert_allclose(found, expected, rtol=0, atol=tolerance * abs(expected).max())


def test_a_shell_that_is_not_there_changes_nothing(run, ring, ghost) -> None:
    two = run([ring(0.5), ring(1.0)])
    three = run([ring(0.5), ghost(0.75), ring(1.0)])
    four = run([ghost(0.2), ring(0.5), ghost(0.8), ring(1.0)])
    close(three[[0, 2]], two, 1e-8)
    close(four[[1, 3]], two, 1e-8)
    close(run([ghost(0.3), ring(1.0)])[1], run([ring(1.0)])[0], 1e-8)


def test_three_shells_all_matter(run, ring) -> None:
    two, three = run([ring(0.5), ring(1.0)]), run([ring(0.5), ring(0.75), ring(1.0)])
    assert three.shape[0] == 3
    assert abs(three[0]).max() < 0.95 * abs(two[0]).max()  # shielded twice
    assert abs(three[1]).max() > 0.1 * abs(three[2]).max()


def test_a_vacuum_gap_decouples(run, ring, water) -> None:
    apart = run([ring(0.5), ring(1.0)], [water, cx.VACUUM, water])
    close(apart[1], run([ring(1.0)], [cx.VACUUM, water])[0], 1e-12)
    assert (apart[0] == 0).all()


def test_a_vacuum_is_the_limit_of_a_light_gas(run, ring, water) -> None:
    empty = run([ring(0.5), ring(1.0)], [cx.VACUUM, water, water])
    errors = [abs(run([ring(0.5), ring(1.0)], [cx.Fluid(density=rho, sound_speed=340), water, water]) - empty).max() for rho in (1.0, 0.1)]
    np.testing.assert_allclose(errors[0] / errors[1], 10.0, rtol=2e-3)


def test_a_rigid_shell_does_not_move_and_shields(run, ring) -> None:
    shielded = run([ring(0.5), cx.RigidShell(radius=1.0)])
    assert (shielded == 0).all()


def test_a_rigid_core_is_the_limit_of_a_stiff_heavy_one(run, ring) -> None:
    core = run([cx.RigidShell(radius=0.5), ring(1.0)])
    assert (core[0] == 0).all()
    heavy = run([ring(0.5, density=7.8e9, youngs_modulus=1.8e17), ring(1.0)])
    close(heavy[1], core[1], 1e-5)
    assert abs(core[1] - run([ring(0.5), ring(1.0)])[1]).max() > 0.01 * abs(core[1]).max()


def test_a_lopsided_wall(run) -> None:
    soft, stiff = cx.Layer(cx.materials.ALUMINIUM, 1e-2), cx.Layer(cx.materials.STRUCTURAL_STEEL, 1e-2)
    walls = {name: run([cx.Shell(radius=1.0, layers=layers)])[0] for name, layers in {"out": [soft, stiff], "in": [stiff, soft]}.items()}
    difference = abs(walls["out"] - walls["in"]).max(axis=-1)
    assert difference[0] < 1e-12 * abs(walls["out"][0]).max()  # breathing does not bend it
    assert difference[12] > 1e-3 * abs(walls["out"][12]).max()
