"""Three dimensions added up at stations: two dimensions as their limits and integrals, images kept out, causality along the wall."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.apps.verification import chosen, run
from coaxshell.apps.verification.checks import stations
from coaxshell.apps.verification.rows import Row
from coaxshell.apps.verification.systems import SMOOTH_SPHERE
from coaxshell.model import presets
from coaxshell.model.system import System
from coaxshell.solver.axial import causality


@pytest.fixture(scope="module")
def bare() -> System:
    return presets.load("bare").replace(source=SMOOTH_SPHERE)


@pytest.mark.parametrize(
    ("start", "rows", "limit"),
    [
        ("integral of ", 4, 5e-8),  # measured 3.3e-8: straight pieces of the line source's record
        (("source at 200 a", "inner shell: distance", "outer shell: distance"), 3, 6e-3),  # 5.2e-3: of the ratio that is 4 in the end
        (("inner shell, stress: axial period", "outer shell, stress: axial period"), 2, 1e-7),  # 4.7e-8 at M = 40
        (("inner shell at z", "outer shell at z"), 6, 2e-9),  # 3e-10
    ],
    ids=["integral", "far sources", "period", "causality"],
)
def test_parts_of_the_check(quick_rows: Callable[[str], tuple[Row, ...]], start: str | tuple[str, ...], rows: int, limit: float) -> None:
    found = [row for row in quick_rows("stations") if row.what.startswith(start)]
    assert [row.verdict for row in found] == rows * ["pass"]
    assert max(row.error for row in found) < limit


@pytest.mark.parametrize("component", ["hoop", "axial", "shear"])
def test_a_source_elsewhere_is_the_same_shock_elsewhere(bare: System, component: str) -> None:
    # z = 0.3 m and 25 degrees: all parities around and along the axis.
    there = bare.replace(source=SMOOTH_SPHERE.replace(z=0.3, angle=25.0))
    angles, places, common = (
        np.array([0.0, 40.0, 180.0]),
        np.array([-0.5, 0.2]),
        {"duration": 1.0, "time_step": 2e-2, "modes": 6, "dimensions": 3},
    )
    moved = cx.simulate(there, **common, stations=places + 0.3, axial_period=12.0).stress("outer", angles + 25.0, component=component)
    fixed = cx.simulate(bare, **common, stations=places, axial_period=12.0).stress("outer", angles, component=component)
    np.testing.assert_allclose(moved, fixed, rtol=0, atol=1e-12 * float(abs(fixed).max()))


@pytest.mark.slow
def test_the_whole_check() -> None:
    (result,) = run(chosen(["stations"], quick=False), quick=False).results
    assert {row.verdict for row in result.rows} == {"pass"}


@pytest.mark.parametrize("z", [0.0, 0.3, 1.0, 2.5, 4.0, 9.0])
def test_first_arrival_by_fermat_s_principle(bare: System, z: float) -> None:
    # The solver's closed form, by which axial periods are chosen.
    assert causality.first_arrival(z, stations.START, 2.866017947) == pytest.approx(stations.first_arrival(bare, z), abs=1e-6)
