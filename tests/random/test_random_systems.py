"""Random valid systems meet what physics says of all of them, and the errors they print are honest."""

from __future__ import annotations

import numpy as np
import pytest
from oracles import ORACLES
from random_study import Study

DEAR = {"energy", "engines", "saved"}
LEAST = 0.01
"""Of the true error over the printed one: none is a hundred times too large."""
CHEAP = [name for name in ORACLES if name not in DEAR]


@pytest.mark.slow_for("1")
@pytest.mark.parametrize("seed", range(10))
def test_a_few_systems(seed: int) -> None:
    study = Study()
    study.add(seed, CHEAP[seed % 6 :: 6], refine=seed in (6, 8))
    assert not study.refused
    assert not study.broken()
    for found in study.ratios.values():
        assert max(one.ratio for one in found) < 10.0
        assert min(one.most for one in found) > LEAST


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(10, 40))
def test_more_systems(seed: int) -> None:
    study = Study()
    study.add(seed)
    assert not study.broken()


@pytest.mark.slow
def test_printed_errors_are_honest() -> None:
    study = Study()
    for seed in range(40, 120):
        study.add(seed, ())
    for found in study.ratios.values():
        ratios = np.array([one.ratio for one in found])
        assert np.mean(ratios > 2.0) < 0.05
        assert ratios.max() < 10.0
        assert np.median(ratios) > 0.05
        assert min(one.most for one in found) > LEAST
