"""Prepare once, solve many: the same numbers as a fresh run, in any order; refinement; unresolved steps."""

from __future__ import annotations

import re

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.response import PreparedSystem
from coaxshell.solver.settings import Settings
from coaxshell.solver.solve import solve

SETTINGS = Settings(duration=1.0, time_step=5e-3, modes=15)
BARE = cx.presets.load("bare")
CUBIC = {"mass": 10, "damping": 2e5, "linear_stiffness": 1e9, "cubic_stiffness": 1e21}
SETS = {
    "none": (),
    "ring": cx.absorber_ring(5, **CUBIC),
    "linear ring": cx.absorber_ring(5, **{**CUBIC, "cubic_stiffness": 0}),
    "one off the axis": (cx.Absorber(angle=50, **CUBIC),),
    "linear pair": (cx.Absorber(angle=50, mass=3, linear_stiffness=1e8), cx.Absorber(angle=-40, mass=3, linear_stiffness=1e8)),
}
ARRAYS = ("normal", "tangential", "normal_rate", "tangential_rate", "absorber_displacement", "absorber_force")


@pytest.fixture(scope="module", params=["bare", "active"])
def prepared(request) -> PreparedSystem:
    return cx.prepare(cx.presets.load(request.param), settings=SETTINGS)


@pytest.mark.parametrize("name", [*SETS, *reversed(SETS)])
def test_equals_a_fresh_run_exactly(prepared: PreparedSystem, name: str) -> None:
    system = prepared.system.replace(absorbers=SETS[name])
    reused, fresh = prepared.simulate(SETS[name]).solution, solve(system, settings=SETTINGS)
    assert reused.problem.system == fresh.problem.system
    for array in ARRAYS:
        found, expected = getattr(reused, array), getattr(fresh, array)
        if expected is None:
            assert found is None
        else:
            np.testing.assert_array_equal(found, expected, err_msg=array)
    assert reused.warnings == fresh.warnings
    np.testing.assert_array_equal(reused.estimates.modal_stress, fresh.estimates.modal_stress)


def test_public_form() -> None:
    ready = cx.prepare(BARE, duration=1.0, time_step=5e-3, modes=15)
    fresh = cx.simulate(BARE.replace(absorbers=SETS["ring"]), duration=1.0, time_step=5e-3, modes=15)
    np.testing.assert_array_equal(ready.simulate(SETS["ring"]).stress("inner"), fresh.stress("inner"))
    assert ready.system == BARE


def test_the_systems_own_absorbers_are_the_default() -> None:
    system = BARE.replace(absorbers=SETS["ring"])
    ready = cx.prepare(system, settings=SETTINGS)
    np.testing.assert_array_equal(ready.simulate().solution.normal, ready.simulate(SETS["ring"]).solution.normal)
    assert ready.simulate(()).solution.absorber_force is None


def test_an_absorber_that_does_not_fit_is_refused_and_does_no_harm(prepared: PreparedSystem) -> None:
    before = prepared.simulate(SETS["ring"]).solution.normal
    with pytest.raises(InputError, match=r"absorbers\[0\]\.inner_shell: 1 has no shell outside it"):
        prepared.simulate([cx.Absorber(inner_shell=1, **CUBIC)])
    np.testing.assert_array_equal(prepared.simulate(SETS["ring"]).solution.normal, before)


def test_refinement_is_a_finer_run_read_less_often() -> None:
    system = BARE.replace(absorbers=SETS["one off the axis"])
    fine = cx.simulate(system, duration=1.0, time_step=2.5e-3, modes=15)
    refined = cx.simulate(system, duration=1.0, time_step=5e-3, modes=15, refinement=2)
    np.testing.assert_array_equal(refined.time, fine.time[::2])
    np.testing.assert_array_equal(refined.stress("inner"), fine.stress("inner")[::2])
    np.testing.assert_array_equal(refined.absorber_force(), fine.absorber_force().isel(time=slice(None, None, 2)))


@pytest.mark.parametrize("refinement", [0, 65, 1.5, True, "2.5", "two"])
def test_bad_refinement(refinement: object) -> None:
    with pytest.raises(InputError, match=r"refinement: .* whole number from 1 to 64"):
        cx.simulate(BARE, duration=1.0, time_step=5e-3, modes=15, refinement=refinement)


def test_an_unresolved_step_is_told_with_both_numbers_and_the_remedy() -> None:
    stiff = BARE.replace(absorbers=[cx.Absorber(angle=0, mass=0.5, damping=0, linear_stiffness=2e11, cubic_stiffness=1e20)])
    settings = {"duration": 0.6, "time_step": 1e-2, "modes": 15}
    warnings = [text for text in cx.simulate(stiff, **settings).warnings if text.startswith("absorbers: ")]
    assert len(warnings) == 1
    pattern = (
        r"vibrates at ([\d.e+]+) per transit .*, ([\d.]+) radians a step, more than 0\.5; "
        r"use time_step = ([\d.e-]+) or refinement = (\d+)"
    )
    frequency, angle, step, factor = re.search(pattern, warnings[0]).groups()
    assert float(frequency) * 1e-2 == pytest.approx(float(angle), rel=0.02)
    assert float(step) * float(frequency) == pytest.approx(0.5, rel=0.05)
    cured = cx.simulate(stiff, **settings, refinement=int(factor) + 1)
    assert not [text for text in cured.warnings if text.startswith("absorbers: ")]
    (twice,) = [text for text in cx.simulate(stiff, **settings, refinement=2).warnings if text.startswith("absorbers: ")]
    assert float(re.search(pattern, twice)[3]) == pytest.approx(2 * float(step), rel=0.1)  # beside the refinement of 2
    assert int(re.search(pattern, twice)[4]) == pytest.approx(int(factor), abs=2)


def test_a_resolved_step_is_not_warned_about() -> None:
    soft = BARE.replace(absorbers=[cx.Absorber(angle=0, mass=10, damping=1e5, linear_stiffness=1e8, cubic_stiffness=1e15)])
    assert not [text for text in cx.simulate(soft, duration=0.6, time_step=1e-3, modes=15).warnings if text.startswith("absorbers: ")]
