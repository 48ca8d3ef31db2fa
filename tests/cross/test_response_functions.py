"""The direct engine's weights against the response functions in time: two ways from the same operators."""

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.acoustics import response_functions as rf
from coaxshell.acoustics.operators import all_orders
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.direct.weights import fluid_weights
from coaxshell.solver.scaling import dimensionless

ORDER, STEP, STEPS = 6, 2e-3, 900


@pytest.fixture(scope="module")
def parts() -> tuple[np.ndarray, np.ndarray]:
    """Weights per step, and minus the pressures that the response functions give, both (shells, shells, orders, T)."""
    grid = LaplaceGrid(STEP, STEPS)
    weights = fluid_weights(dimensionless(cx.presets.load("bare")), grid, all_orders(ORDER)) / STEP
    exterior, disc = rf.exterior_wall(ORDER, grid.time), rf.disc_wall(ORDER, grid.time, 0.5, 1.0)
    aa, ab, ba, bb = rf.annulus_wall(ORDER, grid.time, 0.5, 1.0, 1.0)
    return weights, np.array([[disc - aa, -ab], [ba, bb - exterior]])


@pytest.mark.parametrize(("i", "j"), [(0, 0), (0, 1), (1, 0), (1, 1)])
def test_away_from_fronts_a_weight_is_the_sample(parts: tuple[np.ndarray, np.ndarray], i: int, j: int) -> None:
    weights, samples = parts
    time = STEP * np.arange(STEPS + 1)
    fronts = [k * 0.5 for k in range(5)]
    away = np.all([np.abs(time - front) > 0.06 for front in fronts], axis=0)
    scale = np.abs(samples[i, j][:, away]).max()
    np.testing.assert_allclose(weights[i, j][:, away], samples[i, j][:, away], rtol=0, atol=2e-4 * scale)
