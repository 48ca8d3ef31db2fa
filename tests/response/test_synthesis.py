"""Sums of orders against plain loops."""

from __future__ import annotations

import math

import numpy as np
import pytest

from coaxshell.response.synthesis import BLOCK, angle_basis, at_angles, mean_square, time_blocks

ANGLES = [0.0, 37.5, 180.0, -90.0, 401.0]


def plain_sum(modal: np.ndarray, theta: float, instant: int, component: str) -> float:
    total = 0.0
    for m in range(modal.shape[1]):
        c, s = math.cos(m * math.radians(theta)), math.sin(m * math.radians(theta))
        for half in range(modal.shape[0]):
            total += modal[half, m, instant] * ((c, s) if component == "normal" else (s, -c))[half]
    return total


@pytest.fixture
def modal() -> np.ndarray:
    values = np.random.default_rng(1).standard_normal((2, 9, 5))
    values[1, 0] = 0.0
    return values


@pytest.mark.parametrize("parities", [1, 2])
@pytest.mark.parametrize("component", ["normal", "tangential"])
def test_at_angles_is_the_plain_sum(modal: np.ndarray, parities: int, component: str) -> None:
    modal = modal[:parities]
    expected = [[plain_sum(modal, theta, k, component) for theta in ANGLES] for k in range(5)]
    np.testing.assert_allclose(at_angles(modal, angle_basis(ANGLES, 9, parities, component)), expected, rtol=0, atol=1e-13)


def test_head_and_tail_are_exact() -> None:
    basis = angle_basis([0.0, 180.0, 90.0, -180.0], 2001, 2)
    sign = (-1.0) ** np.arange(2001)
    np.testing.assert_array_equal(basis[0], [np.ones(2001), np.zeros(2001)])
    np.testing.assert_array_equal(basis[1], [sign, np.zeros(2001)])
    np.testing.assert_array_equal(basis[3], [sign, np.zeros(2001)])
    np.testing.assert_array_equal(basis[2, 0, :4], [1, 0, -1, 0])


@pytest.mark.parametrize("parities", [1, 2])
def test_mean_square_is_the_mean_over_pixels(modal: np.ndarray, parities: int) -> None:
    modal = modal[:parities]
    field = at_angles(modal, angle_basis(np.arange(0.0, 360.0, 0.5), 9, parities))
    np.testing.assert_allclose(mean_square(modal), (field**2).mean(axis=1), rtol=1e-13)


def test_mean_square_ignores_a_sine_of_order_zero() -> None:
    modal = np.zeros((2, 3, 1))
    modal[1, 0] = 5.0
    assert mean_square(modal) == 0.0


def test_time_blocks_cover_the_window_once() -> None:
    blocks = list(time_blocks(slice(7, 5000), 720))
    assert [i for block in blocks for i in range(block.start, block.stop)] == list(range(7, 5000))
    assert max(block.stop - block.start for block in blocks) * 720 <= BLOCK
    assert len(list(time_blocks(slice(0, 3), 10 * BLOCK))) == 3
