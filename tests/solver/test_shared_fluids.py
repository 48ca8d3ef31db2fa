"""Runs in three dimensions find the added masses of their fluids, and leave them for the next run, where there is room."""

from __future__ import annotations

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.solver import coupling
from coaxshell.solver.axial.solve import solve_spatial
from coaxshell.solver.settings import Settings
from coaxshell.solver.shared_parts import shared_parts

SETTINGS = Settings(duration=1.0, time_step=5e-2, modes=4, dimensions=3)
HYBRID = cx.presets.load("hybrid")
ROOM = 10_000_000


@pytest.fixture
def made(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Orders of every added mass that was worked out."""
    found: list[int] = []
    real = coupling.fluid_matrix
    monkeypatch.setattr(coupling, "fluid_matrix", lambda problem, radial: found.append(radial.modes.count) or real(problem, radial))
    return found


def test_fluids_are_found_by_the_next_run_whatever_its_control_and_absorbers(made: list[int]) -> None:
    shared = shared_parts(ROOM)
    solve_spatial(HYBRID.replace(control=None, absorbers=()), SETTINGS, fluids=shared)
    bare, kept = len(made), shared.bytes
    assert kept
    found = solve_spatial(HYBRID, SETTINGS, fluids=shared)
    with_fluids = len(made) - bare  # for the stability of its loop, at nodes of its own
    expected = solve_spatial(HYBRID, SETTINGS)
    without = len(made) - bare - with_fluids
    assert shared.bytes == kept
    assert without - with_fluids == 4 * len(found.sampling.modes)  # two blocks of nodes, once for the absorbers and once for the stations
    for name, values in expected.fields.items():
        np.testing.assert_array_equal(found.fields[name], values, err_msg=name)


def test_other_fluids_are_their_own(made: list[int]) -> None:
    shared, other = shared_parts(ROOM), cx.presets.load("bare").with_overrides({"fluids.gap.sound_speed": "1200 m/s"})
    solve_spatial(cx.presets.load("bare"), SETTINGS, fluids=shared)
    found, expected = solve_spatial(other, SETTINGS, fluids=shared), solve_spatial(other, SETTINGS)
    np.testing.assert_array_equal(found.fields["w"], expected.fields["w"])
    assert shared.bytes


def test_nothing_is_kept_where_not_all_has_room() -> None:
    shared = shared_parts(20_000)
    solve_spatial(cx.presets.load("bare"), SETTINGS, fluids=shared)
    assert shared.bytes == 0
