"""The inverse Laplace transform on known pairs: accuracy, order in the time step, windows, wrap-around, forward partner."""

from __future__ import annotations

import math

import numpy as np
import pytest

from coaxshell.numerics.laplace_grid import LaplaceGrid

DECAY = 3.0


def power_error(steps: int, power: int) -> float:
    """Return the largest error after t = 0.2 of the inverse of (s + a)^-p, relative to the largest value."""
    grid = LaplaceGrid(4.0 / steps, steps)
    found = grid.invert((grid.nodes + DECAY) ** -power)
    exact = grid.time ** (power - 1) * np.exp(-DECAY * grid.time) / math.factorial(power - 1)
    late = grid.time >= 0.2
    return float(abs(found - exact)[late].max() / exact.max())


@pytest.mark.parametrize(("power", "tolerance"), [(2, 1e-7), (3, 1e-8), (4, 1e-9)])
def test_known_transforms(power: int, tolerance: float) -> None:
    assert power_error(2000, power) < tolerance


class TestOrder:
    rate = 4.0  # of (s + a)^-3 away from its front: the roll-off, smooth but for its second derivative, keeps the band limit local

    def test_observed(self) -> None:
        coarse, fine = power_error(200, 3), power_error(400, 3)
        assert math.log2(coarse / fine) > self.rate


def test_the_roll_off_keeps_the_band_limit_at_the_front() -> None:
    # A jump at t = 0. What the band limit spreads from it over later times is amplified by e^(sigma t), here up to 1e5.
    grid = LaplaceGrid(2e-3, 1000)
    spectrum, exact = 1.0 / (grid.nodes + DECAY), np.exp(-DECAY * grid.time)
    late = grid.time > 0.2
    smooth = abs(grid.invert(spectrum) - exact)[late].max()
    sharp = abs(grid.invert(spectrum, np.ones(grid.nodes.size)) - exact)[late].max()
    assert smooth < 5e-4
    assert sharp > 1e4 * smooth


def test_lanczos_is_smooth_at_a_jump() -> None:
    # The roll-off overshoots a jump as Gibbs's sum does, by 9 per cent; the sinc factor leaves about 1 per cent.
    grid = LaplaceGrid(2e-3, 1000)
    spectrum = np.exp(-0.5 * grid.nodes) / grid.nodes
    assert grid.invert(spectrum, grid.lanczos()).max() < 1.02
    assert grid.invert(spectrum).max() > 1.04


@pytest.mark.parametrize("window", ["taper", "lanczos"])
def test_windows_pass_low_frequencies(window: str) -> None:
    values = getattr(LaplaceGrid(1e-3, 500), window)()
    assert values[0] == 1.0
    np.testing.assert_allclose(values[-1], 0.0, rtol=0, atol=1e-15)
    assert (np.diff(values) <= 1e-15).all()


def test_what_comes_after_the_period_is_damped() -> None:
    grid = LaplaceGrid(1e-2, 400)
    late = np.exp(-grid.nodes * (grid.period + 1.0)) / (grid.nodes + DECAY) ** 3  # starts after one period
    response = abs(grid.invert(late)).max()
    within = abs(grid.invert(1.0 / (grid.nodes + DECAY) ** 3)).max()
    np.testing.assert_allclose(response / within, grid.wrap_around, rtol=1e-12)
    np.testing.assert_allclose(math.exp(-grid.shift * grid.period), grid.wrap_around, rtol=1e-12)
    assert grid.period >= 2 * grid.time[-1]


def test_forward_and_inverse_are_partners() -> None:
    grid = LaplaceGrid(1e-2, 300)
    history = np.random.default_rng(5).normal(size=(3, 301))
    found = grid.invert(grid.transform(history), np.ones(grid.nodes.size))
    np.testing.assert_allclose(found, history, rtol=0, atol=1e-10)


def test_forward_of_a_known_history() -> None:
    grid = LaplaceGrid(1e-2, 300)
    found = grid.transform(np.exp(-DECAY * grid.time))
    ratio = np.exp(-(grid.nodes + DECAY) * grid.time_step)  # a geometric sum
    np.testing.assert_allclose(found, grid.time_step * (1 - ratio**301) / (1 - ratio), rtol=1e-11)


@pytest.mark.parametrize(("step", "steps"), [(1e-3, 5000), (1e-2, 777), (7e-3, 3)])
def test_a_sparser_grid_has_every_so_many_of_the_nodes(step: float, steps: int) -> None:
    grid = LaplaceGrid(step, steps)
    kept = grid.nodes[::16]
    np.testing.assert_allclose(grid.sparser(16).nodes[: kept.size], kept, rtol=1e-14)


def test_the_roll_off_is_shared_and_stays_as_it_is() -> None:
    with pytest.raises(ValueError, match="read-only"):
        LaplaceGrid(1e-2, 100).taper()[0] = 2.0


def test_many_transforms_are_inverted_as_one_at_a_time(monkeypatch: pytest.MonkeyPatch) -> None:
    from coaxshell.numerics import laplace_grid

    grid = LaplaceGrid(2e-2, 60)
    spectra = (grid.nodes + DECAY * np.arange(1, 7)[:, None]).reshape(2, 3, -1) ** -2
    whole = grid.invert(spectra)
    assert whole.shape == (2, 3, 61)
    monkeypatch.setattr(laplace_grid, "_BLOCK", 2 * grid.nodes.size)
    np.testing.assert_allclose(grid.invert(spectra), whole, rtol=1e-13, atol=0)
    assert grid.invert(spectra[:0]).shape == (0, 3, 61)
