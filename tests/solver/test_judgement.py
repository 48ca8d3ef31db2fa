"""Errors and warnings of a run are made when they are read, once, and are in every copy."""

from __future__ import annotations

import copy
import pickle
from dataclasses import replace

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.response.summary import summarise
from coaxshell.solver import judgement, solution

SETTINGS = {"duration": 1.0, "time_step": 2e-2, "modes": 6}


@pytest.fixture
def made(monkeypatch: pytest.MonkeyPatch) -> list[object]:
    """Every judgement made."""
    found: list[object] = []
    made = judgement._judgement
    monkeypatch.setattr(judgement, "_judgement", lambda *run: found.append(made(*run)) or found[-1])
    return found


def run() -> cx.Response:
    return cx.simulate("hybrid", **SETTINGS)


def test_nothing_is_judged_until_it_is_read_and_then_once(made: list[object]) -> None:
    response = run()
    told = summarise(response.solution, judged=False)
    assert not made
    assert "error estimates" not in response.timings
    estimates, warnings = response.estimates, response.warnings
    assert len(made) == 1
    assert (response.estimates, response.warnings) == (estimates, warnings) == made[0]
    assert warnings
    assert response.timings["error estimates"] > 0
    whole = response.summary()
    assert whole.warnings == warnings
    assert told.warnings == ()
    assert np.isnan([told.time_window_error, told.shells[0].stress_truncation]).all()
    for some, all_of_it in zip(told.shells, whole.shells, strict=True):
        assert some.stress == all_of_it.stress
        assert replace(all_of_it.sensor_voltage, lower_half=None) == some.sensor_voltage


@pytest.mark.parametrize("copied", [replace, copy.copy, lambda run: pickle.loads(pickle.dumps(run))])
def test_a_copy_has_been_judged(copied, made: list[object]) -> None:
    found, expected = copied(run().solution), run()
    assert len(made) == 1
    assert found.spectra is None
    np.testing.assert_array_equal(found.estimates.by_cause(), expected.estimates.by_cause())
    assert found.warnings == expected.warnings


def test_a_run_whose_transforms_are_not_kept_is_judged_at_once(made: list[object], monkeypatch: pytest.MonkeyPatch) -> None:
    later = run().estimates.by_cause()
    monkeypatch.setattr(solution, "KEPT_BYTES", 0)
    np.testing.assert_array_equal(run().estimates.by_cause(), later)
    assert len(made) == 2


def test_what_a_solution_does_not_have_is_told() -> None:
    with pytest.raises(AttributeError, match="'ModalSolution' object has no attribute 'pressure'"):
        run().solution.pressure  # noqa: B018
