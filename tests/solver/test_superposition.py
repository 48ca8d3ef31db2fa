"""The system is linear, does not know where zero degrees are, and starts its clock with the source."""

from __future__ import annotations

import numpy as np
import pytest

import coaxshell as cx

SETTINGS = {"duration": 1.5, "time_step": 5e-3, "modes": 24}
SHOCK = cx.SphericalShock(distance=4.0, peak_pressure=2.5e4, decay_time=1.314e-4)
PLANE = cx.PlaneShock(peak_pressure=4e4, decay_time=3e-4, angle=70.0)
ANGLES = np.array([0.0, 25.0, 90.0, 180.0, 251.0])


@pytest.fixture(scope="module")
def run():
    bare = cx.presets.load("bare")
    return lambda source: cx.simulate(bare.replace(source=source), **SETTINGS)


def close(found: object, expected: object, tolerance: float = 1e-12) -> None:
    found, expected = np.asarray(found), np.asarray(expected)
    np.testing.assert_allclose(found, expected, rtol=0, atol=tolerance * abs(expected).max())


@pytest.mark.parametrize("angle", [90.0, 180.0, 37.0, -120.0])
@pytest.mark.parametrize("source", [SHOCK, PLANE.replace(angle=0.0)], ids=["spherical", "plane"])
def test_turning_the_source_turns_the_answer(run, source: object, angle: float) -> None:
    straight, turned = run(source), run(source.replace(angle=angle))
    for shell in ("inner", "outer"):
        close(turned.displacement(shell, ANGLES + angle), straight.displacement(shell, ANGLES))
        close(turned.stress(shell, ANGLES + angle), straight.stress(shell, ANGLES), 1e-11)
        tangential = turned.displacement(shell, ANGLES + angle, component="tangential")
        close(tangential, straight.displacement(shell, ANGLES, component="tangential"))
    assert turned.solution.normal.shape[1] == (1 if angle == 180.0 else 2)  # the sine half only where it is needed


def test_two_sources_add(run) -> None:
    alone, other, both = run(SHOCK), run(PLANE), run([SHOCK, PLANE])
    for shell in ("inner", "outer"):
        close(both.stress(shell, ANGLES), np.asarray(alone.stress(shell, ANGLES)) + np.asarray(other.stress(shell, ANGLES)), 1e-11)


def test_sources_of_one_geometry_add(run) -> None:
    mirrored = [SHOCK.replace(angle=40.0), SHOCK.replace(angle=-40.0)]
    both, one = run(mirrored), run(mirrored[0])
    close(
        both.displacement("inner", ANGLES), np.asarray(one.displacement("inner", ANGLES)) + np.asarray(one.displacement("inner", -ANGLES))
    )
    close(both.displacement("inner", ANGLES), both.displacement("inner", -ANGLES))


def test_twice_the_pressure_is_twice_the_answer(run) -> None:
    close(run(SHOCK.replace(peak_pressure=5e4)).stress("inner"), 2 * np.asarray(run(SHOCK).stress("inner")))


def test_a_delay_shifts(run) -> None:
    steps = 60
    late = run(PLANE.replace(delay=steps * SETTINGS["time_step"] / 1400))
    now = np.asarray(run(PLANE).displacement("inner", ANGLES))
    found = np.asarray(late.displacement("inner", ANGLES))
    close(found[steps:], now[: len(now) - steps], 1e-7)
    assert abs(found[:steps]).max() < 1e-9 * abs(now).max()
