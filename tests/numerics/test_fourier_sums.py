"""Fast sums of exponentials against the plain sum, up to the end of the period, where the spreading kernel wraps around."""

from __future__ import annotations

import numpy as np
import pytest

from coaxshell.numerics.fourier_sums import exponential_sums
from coaxshell.numerics.laplace_grid import LaplaceGrid

GRID = LaplaceGrid(0.01, 300)


def plain(times: np.ndarray, weights: np.ndarray, grid: LaplaceGrid) -> np.ndarray:
    return weights.T @ np.exp(-np.outer(times, grid.nodes))


@pytest.mark.parametrize("fraction", [0.02, 0.4, 1.0], ids=["short", "half", "whole period"])
def test_against_the_plain_sum(fraction: float) -> None:
    random = np.random.default_rng(3)
    times = np.sort(random.uniform(0, fraction * GRID.period, 400))
    weights = random.normal(size=(400, 5))
    expected = plain(times, weights, GRID)
    np.testing.assert_allclose(exponential_sums(times, weights, GRID), expected, rtol=0, atol=1e-10 * abs(expected).max())


@pytest.mark.parametrize("time", [0.0, 1e-12, 0.01, 0.0123, 3.0, GRID.period - 0.01, GRID.period * (1 - 1e-13)])
def test_a_single_time(time: float) -> None:
    found = exponential_sums(np.array([time]), np.array([[1.0]]), GRID)[0]
    expected = np.exp(-GRID.nodes * time)
    # Near the end of the period the damping e^(-sigma t) is 1e-10, and what wraps around keeps its full relative accuracy.
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-10 * abs(expected).max())


def test_times_beyond_the_period() -> None:
    # A source's front may take longer to pass than a short run's period; e^(-s t) at the nodes then merely repeats its phase.
    times = np.array([0.1, 1.2, 2.5, 3.3]) * GRID.period
    weights = np.diag(np.exp(GRID.shift * times))
    np.testing.assert_allclose(exponential_sums(times, weights, GRID), plain(times, weights, GRID), rtol=0, atol=1e-10)


def test_sets_are_independent() -> None:
    times = np.linspace(0.0, 2.0, 50)
    weights = np.random.default_rng(4).normal(size=(50, 3))
    together = exponential_sums(times, weights, GRID)
    for j in range(3):
        np.testing.assert_allclose(together[j], exponential_sums(times, weights[:, j : j + 1], GRID)[0], rtol=1e-12, atol=1e-14)
