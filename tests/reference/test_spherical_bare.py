"""The paper's bare double shell under a true spherical wave against a solution in the Laplace domain that shares no code with this one."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.apps.verification import chosen, run
from coaxshell.apps.verification.bench import spherical_bare
from coaxshell.apps.verification.checks.spherical_reference import ANGLES, QUANTITIES, STATIONS
from coaxshell.apps.verification.rows import Row


def test_until_the_wave_has_passed(quick_rows: Callable[[str], tuple[Row, ...]]) -> None:
    # M = 50, t = 0 to 2, the worst of nine histories of each quantity of each shell.
    # Measured 5.8e-7 or less: outer displacement at 1.5 m, where it has hardly begun.
    found = quick_rows("spherical-histories")
    assert len(found) == 2 * len(QUANTITIES)
    assert max(row.error for row in found) < 1e-6


@pytest.mark.slow
def test_all_of_it() -> None:
    # M = 60, t = 0 to 4. Measured 4.9e-9 or less; asked for is 1e-5.
    (result,) = run(chosen(["spherical-histories"], quick=False), quick=False).results
    assert max(row.error for row in result.rows) < 2e-8


def test_shapes_and_places_of_the_reference() -> None:
    stored = spherical_bare()
    for key in QUANTITIES:
        assert stored[key].shape == (2, len(STATIONS), len(ANGLES), stored["t"].size)


def test_the_slice_would_show() -> None:
    # The paper's two-dimensional source is another wave: it leaves the sphere's stress by half its size and more.
    stored = spherical_bare()
    source = cx.SphericalWave(distance=3.0, pulse=cx.Gaussian(peak_pressure=2.5e4, width=0.1 / 1400))
    plane = cx.simulate(cx.presets.load("bare").replace(source=source), duration=4.0, time_step=2e-2, modes=60)
    found, expected = np.asarray(plane.stress("inner", [180.0]))[:, 0], stored["hoop"][0, 0, 2]
    assert np.linalg.norm(found - expected) > 0.3 * np.linalg.norm(expected)
