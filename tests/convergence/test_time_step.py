"""Halving the time step: observed orders of displacement and stress for three sources."""

from __future__ import annotations

import numpy as np

import coaxshell as cx

STEPS = (1.6e-2, 8e-3, 4e-3)
FINE = 1e-3
ROUNDING = 3e-10  # below, the step no longer matters
SETTINGS = {"duration": 2.0, "modes": 30}


def errors(source: object, quantity: str) -> np.ndarray:
    """Return the relative L2 error of a quantity at the outer head for each step, at the instants of the coarsest one."""
    system = cx.presets.load("bare").replace(source=source)

    def history(step: float) -> np.ndarray:
        response = cx.simulate(system, time_step=step, **SETTINGS)
        return np.asarray(getattr(response, quantity)("outer", [0.0]))[:: round(STEPS[0] / step), 0][:125]

    exact = history(FINE)
    return np.array([np.linalg.norm(history(step) - exact) / np.linalg.norm(exact) for step in STEPS])


class Convergence:
    """Assert that every halving gains at least ``rate``, and the error that the finest step leaves."""

    rate: float
    left: float
    quantity: str
    source: object

    def test_rate(self) -> None:
        found = errors(self.source, self.quantity)
        gains = np.log2(found[:-1] / found[1:])[found[1:] > ROUNDING]
        assert gains.size
        assert (gains > self.rate).all(), found
        assert found[-1] < self.left, found


PULSE = {"peak_pressure": 2.5e4, "decay_time": 1.314e-4}


class TestDisplacementUnderASphericalFront(Convergence):
    rate, left = 2.0, 3e-6
    quantity = "displacement"
    source = cx.SphericalShock(distance=5.0, **PULSE)


class TestStressUnderASphericalFront(Convergence):
    rate, left = 2.0, 1e-5
    quantity = "stress"
    source = cx.SphericalShock(distance=5.0, **PULSE)


class TestDisplacementUnderAPlaneFront(Convergence):
    rate, left = 2.0, 3e-6
    quantity = "displacement"
    source = cx.PlaneShock(**PULSE)


class TestDisplacementUnderALineSource(Convergence):
    rate, left = 2.0, 3e-6
    quantity = "displacement"
    source = cx.LineShock(distance=5.0, **PULSE)


class TestSmoothPulse(Convergence):
    """A pulse without a front: faster than any power once it is resolved."""

    rate, left = 15.0, 1e-9
    quantity = "stress"
    source = cx.PlaneWave(pulse=cx.Gaussian(peak_pressure=2.5e4, width=1.2e-5))


def test_a_slow_rise_is_as_good_as_its_resolution() -> None:
    found = errors(cx.PlaneWave(pulse=cx.Step(pressure=1e4, rise_time=2e-4)), "displacement")
    assert (found < [1e-4, 1e-5, 1e-6]).all(), found
