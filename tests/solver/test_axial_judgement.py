"""Errors and warnings of a run in three dimensions are made when they are read, once, and are in every part and copy."""

from __future__ import annotations

import pickle
from dataclasses import replace

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.response.spatial import SpatialResponse
from coaxshell.response.spatial_summary import summarise_stations
from coaxshell.solver.axial import judgement, line_solve, linked

SETTINGS = {"duration": 1.0, "time_step": 5e-2, "modes": 4, "dimensions": 3, "stations": [0.0, 0.5]}
POINTS = [cx.PointAbsorber(angle=0.0, z=0.2, mass=5.0, cubic_stiffness=1e16)]


@pytest.fixture
def made(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Names of everything done for a judgement alone, one for each time."""
    found: list[str] = []

    def counted(where: object, name: str) -> None:
        real = getattr(where, name)
        monkeypatch.setattr(where, name, lambda *given, **more: found.append(name) or real(*given, **more))

    counted(judgement, "estimated_errors")
    counted(line_solve, "_march_error")
    counted(line_solve, "_mean_tangent")
    counted(linked, "_march_error")
    return found


def run(absorbers: object = None) -> SpatialResponse:
    system = cx.presets.load("hybrid")
    found = cx.simulate(system if absorbers is None else system.replace(absorbers=absorbers), **SETTINGS)
    assert isinstance(found, SpatialResponse)
    return found


@pytest.mark.parametrize(("absorbers", "once"), [(None, ["_march_error", "_mean_tangent", "estimated_errors"]), (POINTS, None)])
def test_nothing_is_judged_until_it_is_read_and_then_once(absorbers: object, once: list[str] | None, made: list[str]) -> None:
    response = run(absorbers)
    told = summarise_stations(response.spatial, response.motions, judged=False)
    assert not made
    assert "error estimates" not in response.timings
    assert (response.motions[1].solution.estimates, response.warnings) == (response.estimates, response.spatial.warnings)
    assert made == (once or ["_march_error", "estimated_errors"])
    assert response.timings["error estimates"] > 0
    assert response.estimates.march.max() > 0
    summary = response.summary()
    assert summary.warnings == response.warnings
    assert told.warnings == ()
    assert [one["stress"] for one in told.largest] == [one["stress"] for one in summary.largest]


@pytest.mark.parametrize("copied", [replace, lambda run: run.some([1]), lambda run: pickle.loads(pickle.dumps(run))])
def test_a_part_or_a_copy_has_been_judged(copied, made: list[str]) -> None:
    response = run(())
    found = copied(response.spatial)
    assert made == ["estimated_errors"]
    np.testing.assert_array_equal(found.estimates.by_cause(), response.estimates.by_cause())
    assert found.at(0).warnings == response.warnings
    assert made == ["estimated_errors"]


def test_a_run_that_would_keep_too_much_is_judged_at_once(made: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(judgement, "KEPT_BYTES", 0)
    run(())
    assert made == ["estimated_errors"]
