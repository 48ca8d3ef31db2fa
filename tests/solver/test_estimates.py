"""The engine's own error estimates, and the number of modes chosen by them, against many more modes."""

from __future__ import annotations

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.response.synthesis import mean_square

STEP = {"duration": 3.0, "time_step": 2e-3}
MANY = 600


@pytest.fixture(scope="module", params=["bare", "iakovlev-evacuated", "iakovlev-double"])
def case(request: pytest.FixtureRequest) -> tuple[cx.System, cx.Response]:
    system = cx.presets.load(request.param)
    return system, cx.simulate(system, **STEP, modes=MANY)


def stress_error(response: cx.Response, many: cx.Response, shell: int) -> float:
    """Return the relative L2 error over surface and time of the stress that comes from leaving out orders above M."""
    full = np.asarray(many.modal(shell, "stress"))
    left_out = full.copy()
    left_out[:, : response.modes + 1] = 0.0
    return float(np.sqrt(mean_square(left_out).sum() / mean_square(full).sum()))


@pytest.mark.parametrize("modes", [40, 120])
def test_truncation_is_estimated_within_a_factor(case: tuple[cx.System, cx.Response], modes: int) -> None:
    system, many = case
    response = cx.simulate(system, **STEP, modes=modes)
    for shell in range(response.shells):
        true = stress_error(response, many, shell)
        assert 1 / 3 < response.estimates.modal_stress[shell] / true < 3


@pytest.mark.parametrize("tolerance", [3e-2, 3e-3])
def test_auto_modes_meet_the_tolerance(case: tuple[cx.System, cx.Response], tolerance: float) -> None:
    system, many = case
    response = cx.simulate(system, **STEP, modes="auto", tolerance=tolerance)
    assert 8 <= response.modes < MANY
    errors = [stress_error(response, many, shell) for shell in range(response.shells)]
    assert max(errors) < 1.3 * tolerance
    assert max(errors) > tolerance / 5  # nor far too many


def test_modes_are_independent_of_how_many_there_are(case: tuple[cx.System, cx.Response]) -> None:
    system, many = case
    few = cx.simulate(system, **STEP, modes=30).solution.normal
    expected = many.solution.normal[:, :, :31]
    np.testing.assert_allclose(few, expected, rtol=0, atol=1e-9 * abs(expected).max())


def test_time_window_estimate_bounds_the_error_of_the_step() -> None:
    bare = cx.presets.load("bare")
    coarse, fine = (cx.simulate(bare, duration=2.0, time_step=step, modes=40) for step in (1e-2, 1e-3))
    head = np.asarray(fine.displacement("outer", [0]))[::10, 0]
    error = abs(np.asarray(coarse.displacement("outer", [0]))[:, 0] - head).max() / abs(head).max()
    assert error < 3 * coarse.estimates.time_window
    assert coarse.estimates.time_window < 3 * error
