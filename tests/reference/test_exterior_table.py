"""The exterior response function K_m(s)/(s K_m'(s)) in time, against the table to all its digits."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from coaxshell.acoustics.operators import all_orders
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.radial_functions import RadialFunctions

GRID = LaplaceGrid(5e-3, 1200, wrap_around=1e-12)


@pytest.fixture(scope="module")
def histories(sharp_inverse: Callable[..., np.ndarray]) -> np.ndarray:
    spectrum = RadialFunctions(GRID.nodes, 1.0, all_orders(20)).exterior
    return sharp_inverse(GRID, spectrum, lead=1.0)


# Of the 12 digits after the point 11 are reached: rounding, amplified by e^(sigma t), is 4e-12 here.
@pytest.mark.parametrize(
    ("table", "m", "tolerance"), [("exterior", m, 1e-11) for m in (0, 1, 2)] + [("exterior", 5, 5e-11), ("exterior-short", 20, 2e-9)]
)
def test_against_the_table(histories: np.ndarray, tables: dict[str, Any], table: str, m: int, tolerance: float) -> None:
    at = np.round(np.array(tables[table]["time"]) / GRID.time_step).astype(int)
    np.testing.assert_allclose(histories[m, at], tables[table][f"m{m}"], rtol=0, atol=tolerance)


def test_the_front_is_one(histories: np.ndarray) -> None:
    # -1 at t = 0+, then +t/2 at every order (K_m'/K_m = -1 - 1/(2s) - ...).
    np.testing.assert_allclose(histories[:6, 0], -1.0, rtol=1e-7)
    np.testing.assert_allclose((histories[:6, 1] + 1) / GRID.time_step, 0.5, rtol=0.08)
