"""Transforms of the pulses against quadrature of the pulse itself."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from coaxshell.acoustics.pulse_transforms import pulse_transform
from coaxshell.model.pulses import Exponential, Gaussian, Sampled, Step

TIME, PRESSURE = 7e-4, 2e9
S = np.array([0.3 + 0.0j, 1.0 + 2.0j, 0.5 + 30.0j, 6.0 + 200.0j])


def quadrature(history: object, breaks: list[float]) -> np.ndarray:
    """Return the integral of history(t) e^(-st), t dimensionless, by Gauss points on many panels between the breaks."""
    x, weights = np.polynomial.legendre.leggauss(20)
    total = np.zeros(S.size, complex)
    for a, b in itertools.pairwise(breaks):
        edges = np.linspace(a, b, 1500)
        half = np.diff(edges)[:, None] / 2
        t = (edges[:-1, None] + half + half * x).ravel()
        w = (half * weights).ravel()
        total += np.array([np.sum(w * history(t) * np.exp(-s * t)) for s in S])
    return total


def check(pulse: object, history: object, breaks: list[float]) -> None:
    found = pulse_transform(pulse, S, TIME, PRESSURE) * PRESSURE
    expected = quadrature(history, breaks)
    np.testing.assert_allclose(found, expected, rtol=1e-10, atol=1e-12 * abs(expected).max())


def test_exponential() -> None:
    pulse = Exponential(peak_pressure=3e5, decay_time=2e-4)
    check(pulse, lambda t: 3e5 * np.exp(-t * TIME / 2e-4), [0.0, 30.0])


@pytest.mark.parametrize("rise", [0.0, 1e-4, 2e-3])
def test_step(rise: float) -> None:
    pulse = Step(pressure=4e4, rise_time=rise)
    end = rise / TIME
    breaks = [0.0, end, end + 110.0] if rise else [0.0, 110.0]
    check(pulse, lambda t: 4e4 * np.minimum(1.0, t / end if rise else 1.0), breaks)


@pytest.mark.parametrize("width", [2e-5, 3e-4])
@pytest.mark.parametrize("later", [1.0, 1.7])
def test_gaussian(width: float, later: float) -> None:
    centre = 6 * width * later
    pulse = Gaussian(peak_pressure=5e4, width=width, centre=centre)
    end = (centre + 12 * width) / TIME
    check(pulse, lambda t: 5e4 * np.exp(-(((t * TIME - centre) / width) ** 2) / 2), [0.0, end])


def test_sampled() -> None:
    times, values = [1e-4, 3e-4, 4e-4, 9e-4], [2e4, -5e4, 1e4, 3e4]
    pulse = Sampled(time=times, pressure=values)
    scaled = [t / TIME for t in times]
    check(pulse, lambda t: np.interp(t * TIME, times, values), scaled)


def test_sampled_in_blocks() -> None:
    # 3000 samples do not fit one block with 2000 nodes; a ramp sampled finely is the ramp.
    times = np.linspace(0, 5e-3, 3001)
    s = 0.5 + 1j * np.linspace(0, 50, 2000)
    found = pulse_transform(Sampled(time=times, pressure=1e3 * times / 5e-3), s, TIME, 1e3)
    end = 5e-3 / TIME
    exact = (1 - np.exp(-s * end) * (1 + s * end)) / (s**2 * end)
    np.testing.assert_allclose(found, exact, rtol=0, atol=1e-11 * abs(exact).max())


def test_a_fine_sampling_of_an_exponential_tends_to_it() -> None:
    errors = []
    for count in (400, 800):
        times = np.linspace(0, 6e-3, count + 1)
        sampled = Sampled(time=times, pressure=1e5 * np.exp(-times / 2e-4))
        smooth = Exponential(peak_pressure=1e5, decay_time=2e-4)
        errors.append(abs(pulse_transform(sampled, S, TIME, PRESSURE) / pulse_transform(smooth, S, TIME, PRESSURE) - 1)[:2].max())
    np.testing.assert_allclose(np.log2(errors[0] / errors[1]), 2.0, rtol=1e-3)
