"""Transforms of sampled histories: closed forms over many scales, steps as short ramps, long records against the plain sum."""

from __future__ import annotations

import pickle

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.acoustics import pulse_transforms
from coaxshell.acoustics.pulse_histories import pulse_history, pulse_impulse
from coaxshell.acoustics.pulse_transforms import pulse_transform
from coaxshell.acoustics.sampled_transforms import _by_moments, _by_sum, piecewise_linear
from coaxshell.numerics.laplace_grid import LaplaceGrid

GRID = LaplaceGrid(1e-2, 500)
S = GRID.nodes


@pytest.mark.parametrize("ramp", [0.3, 1e-2, 1e-5, 1e-9, 1e-13, 1e-300])
@pytest.mark.parametrize("transform", [_by_sum, _by_moments])
def test_a_ramp_of_any_length(ramp: float, transform: object) -> None:
    """A rectangle with a ramp at its start: e^{-st} (1 - e^{-z})/z with z = s ramp, less e^{-2s}, over s."""
    z = S * ramp
    rise = np.where(np.abs(z) < 1e-6, 1.0 - z / 2, -np.expm1(-z) / np.where(z == 0, 1.0, z))
    found = transform(S, np.array([0.0, ramp, 2.0]), np.array([0.0, 1.0, 1.0]))  # type: ignore[operator]
    np.testing.assert_allclose(found * S, rise - np.exp(-2.0 * S), rtol=0, atol=2e-12)


@pytest.mark.parametrize("transform", [_by_sum, _by_moments])
def test_samples_next_to_each_other_are_a_step(transform: object) -> None:
    at = 0.7
    times, values = np.array([0.0, at, np.nextafter(at, 1.0), 1.5]), np.array([1.0, 1.0, -2.0, -2.0])
    expected = (1.0 - 3.0 * np.exp(-at * S) + 2.0 * np.exp(-1.5 * S)) / S
    np.testing.assert_allclose(transform(S, times, values) * S, expected * S, rtol=0, atol=1e-12)  # type: ignore[operator]


@pytest.mark.parametrize("scale", [1e-6, 1e-3, 1.0, 1e3])
def test_an_exponential_over_many_scales(scale: float) -> None:
    """Samples dense enough for straight lines: 1/(s + 1/tau) over all scales of the decay and of the grid."""
    grid = LaplaceGrid(1e-2 * scale, 200)
    times = scale * np.concatenate([[0.0], np.geomspace(1e-9, 40.0, 40_000)])
    found = piecewise_linear(grid.nodes, times, np.exp(-times / scale))
    np.testing.assert_allclose(found, 1.0 / (grid.nodes + 1.0 / scale), rtol=0, atol=1e-7 * scale)  # the lines' own: h^2/12
    np.testing.assert_allclose(found[::50], _by_sum(grid.nodes[::50], times, np.exp(-times / scale)), rtol=0, atol=1e-13 * scale)


def test_a_long_noisy_record_equals_its_sum() -> None:
    generator = np.random.default_rng(5)
    times = np.sort(generator.uniform(0.2, 9.0, 30_000))
    values = np.exp(-times) + 0.3 * generator.normal(size=times.size)
    few = np.array([0, 1, 7, 100, S.size - 1])
    found, expected = piecewise_linear(S, times, values)[few], _by_sum(S[few], times, values)
    np.testing.assert_allclose(found, expected, rtol=1e-9, atol=0)


def test_steps_and_bells_of_extreme_lengths() -> None:
    for rise in (1e-300, 1e-200, 1e-12):
        short = pulse_transform(cx.Step(pressure=1.0, rise_time=rise), S, 1.0, 1.0)
        np.testing.assert_allclose(short, 1.0 / S, rtol=1e-9)
    late = pulse_transform(cx.Gaussian(peak_pressure=1.0, width=1e-3, centre=2.0), S, 1.0, 1.0)
    expected = 1e-3 * np.sqrt(2.0 * np.pi) * np.exp(S * (0.5e-6 * S - 2.0))
    np.testing.assert_allclose(late, expected, rtol=1e-9)


def test_histories_and_impulses_of_a_step_between_neighbours() -> None:
    after = np.nextafter(0.5, 1.0)
    pulse = cx.Sampled(time=[0.0, 0.5, after, 1.0], pressure=[1.0, 1.0, 3.0, 3.0])
    t = np.array([0.25, 0.75, 1.0])
    np.testing.assert_allclose(pulse_history(pulse, t, 1.0, 1.0), [1.0, 3.0, 3.0], rtol=1e-15)
    np.testing.assert_allclose(pulse_impulse(pulse, t, 1.0, 1.0), [0.25, 1.25, 2.0], rtol=1e-14)


def test_a_long_record_is_transformed_once_for_all_nodes_of_a_contour(monkeypatch: pytest.MonkeyPatch) -> None:
    times = np.linspace(0.0, 4.0, 2001)
    pulse = cx.Sampled(time=times, pressure=np.exp(-times) * (1.0 + 0.2 * np.sin(50.0 * times)))
    asked: list[int] = []

    def counted(s: np.ndarray, *record: np.ndarray) -> np.ndarray:
        asked.append(s.size)
        return piecewise_linear(s, *record)

    monkeypatch.setattr(pulse_transforms, "piecewise_linear", counted)
    whole = pulse_transform(pulse, S, 1.0, 1.0)
    part = pulse_transform(pulse, S[:300].copy(), 1.0, 1.0)
    assert asked == [S.size]
    np.testing.assert_array_equal(part, whole[:300])
    np.testing.assert_allclose(part, _by_sum(S[:300], *pulse.curve), rtol=1e-9)
    for other in (LaplaceGrid(1e-2, 400).nodes, LaplaceGrid(2e-2, 500).nodes):
        np.testing.assert_allclose(pulse_transform(pulse, other, 1.0, 1.0)[::50], _by_sum(other[::50], *pulse.curve), rtol=1e-9)
    np.testing.assert_allclose(pulse_transform(pulse, S, 2.0, 3.0)[::50], _by_sum(S[::50] / 2.0, *pulse.curve) / 6.0, rtol=1e-9)
    assert len(pulse.transforms) == 2
    assert not pickle.loads(pickle.dumps(pulse)).transforms
