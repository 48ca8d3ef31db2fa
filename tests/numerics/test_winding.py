"""Turns around zero against the sum of the steps' angles."""

from __future__ import annotations

import numpy as np
import pytest

from coaxshell.numerics.winding import turning


def summed(values: np.ndarray) -> np.ndarray:
    return np.asarray(np.angle(values[:, 1:] / values[:, :-1]).sum(axis=1))


@pytest.mark.parametrize("seed", range(20))
def test_it_is_the_sum_of_the_steps(seed: int) -> None:
    random = np.random.default_rng(seed)
    values = random.standard_normal((7, 50)) + 1j * random.standard_normal((7, 50))  # crosses either way at every other step
    np.testing.assert_allclose(turning(values), summed(values), rtol=0, atol=1e-12)


@pytest.mark.parametrize("turns", [-3, -1, 0, 1, 2])
def test_whole_turns(turns: int) -> None:
    curve = (2.0 + np.sin(np.arange(200)))[None] * np.exp(2j * np.pi * turns * np.linspace(0.03, 1.03, 200))
    assert turning(curve) == pytest.approx(2 * np.pi * turns, abs=1e-12)


@pytest.mark.parametrize("zero", [0.0, -0.0])
@pytest.mark.parametrize("signs", [(1, 1), (1, -1), (-1, 1), (-1, -1)])
def test_real_negative_nodes_may_have_either_zero(zero: float, signs: tuple[int, int]) -> None:
    values = np.array([[complex(-1, signs[0]), complex(-1, zero), complex(-1, signs[1])]])
    for piece in (values, values[:, :2], values[:, 1:]):
        full = turning(piece)
        assert full == pytest.approx(summed(piece + 0.0), abs=1e-12)
    assert turning(values[:, :2]) + turning(values[:, 1:]) == pytest.approx(turning(values), abs=1e-12)


def test_pieces_add_up() -> None:
    random = np.random.default_rng(5)
    values = random.standard_normal((3, 90)) + 1j * random.standard_normal((3, 90))
    np.testing.assert_allclose(turning(values[:, :41]) + turning(values[:, 40:]), turning(values), rtol=0, atol=1e-12)
