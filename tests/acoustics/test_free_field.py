"""Incident waves in free field: closed forms, an independent inversion of the line source, Euler's equation, points at the source."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
from scipy.integrate import quad

from coaxshell.acoustics.pulse_histories import pulse_history, pulse_impulse
from coaxshell.acoustics.pulse_transforms import pulse_transform
from coaxshell.acoustics.sources import TimeFunction
from coaxshell.acoustics.sources.line import LineField
from coaxshell.acoustics.sources.plane import PlaneField
from coaxshell.acoustics.sources.spherical import SphericalField
from coaxshell.model.pulses import Exponential, Gaussian, Sampled, Step

SCALE, PRESSURE = 0.5, 4.0
PULSES = [
    Exponential(peak_pressure=3.0, decay_time=0.1),
    Step(pressure=2.0),
    Step(pressure=2.0, rise_time=0.2),
    Gaussian(peak_pressure=5.0, width=0.05),
    Sampled(time=[0.0, 0.1, 0.3, 0.35], pressure=[1.0, 3.0, -1.0, 0.5]),
]
DISTANCE = 5.0


def function_of(pulse) -> TimeFunction:
    return TimeFunction(
        lambda t: pulse_history(pulse, t, SCALE, PRESSURE),
        lambda t: pulse_impulse(pulse, t, SCALE, PRESSURE),
        lambda s: pulse_transform(pulse, s, SCALE, PRESSURE),
    )


@pytest.mark.parametrize("pulse", PULSES, ids=lambda pulse: pulse.type)
def test_history_integral_and_transform_belong_together(pulse):
    function = function_of(pulse)
    breaks = np.array([0.1, 0.2, 0.3, 0.35]) / SCALE

    def integral(of, end):
        return quad(of, 0, end, points=breaks[breaks < end], limit=400, epsabs=1e-12, epsrel=1e-12)[0]

    for end in (0.05, 0.3, 0.65, 2.0):
        np.testing.assert_allclose(function.impulse(np.array(end)), integral(function.history, end), rtol=1e-12, atol=1e-14)
    s = 9.0
    numeric = integral(lambda t: function.history(np.array(t)) * np.exp(-s * t), 4.0)
    np.testing.assert_allclose(function.transform(np.array([s + 0j]))[0].real, numeric, rtol=1e-12)
    assert function.history(np.array(-1e-12)) == 0.0
    assert function.impulse(np.array(-1e-12)) == 0.0


def test_the_front_is_reached_at_once():
    pulse = PULSES[0]
    np.testing.assert_allclose(pulse_history(pulse, np.array([0.0]), SCALE, PRESSURE), 3.0 / PRESSURE, rtol=1e-15)


def test_plane_and_spherical_waves_are_the_closed_forms():
    function, x, y = function_of(PULSES[0]), np.array([1.0, -2.0, 0.3]), np.array([0.0, 1.0, -2.5])
    f = lambda t: np.where(t >= 0, 0.75 * np.exp(-t * 5.0), 0.0)  # noqa: E731
    plane = PlaneField(function, x, y)
    range_ = np.hypot(x - DISTANCE, y)
    spherical = SphericalField(function, DISTANCE, x, y)
    for t in (0.0, 1.7, 4.0):
        np.testing.assert_allclose(plane.pressure(t), f(t - 1 + x), rtol=1e-12)
        np.testing.assert_allclose(plane.velocity(t)[0], -f(t - 1 + x), rtol=1e-12)
        np.testing.assert_allclose(spherical.pressure(t), 4.0 / range_ * f(t - range_ + 4.0), rtol=1e-12)
    assert spherical.pressure(0.0)[0] == pytest.approx(0.75, rel=1e-12)  # at the head, at t = 0


@pytest.mark.slow_except("0-step")
@pytest.mark.parametrize("pulse", PULSES[:2], ids=lambda pulse: pulse.type)
@pytest.mark.parametrize("order", [0, 1])
def test_the_line_source_by_an_independent_inversion(pulse, order):
    function = function_of(pulse)
    x, y = np.array([1.0, 0.0, -3.0, 1.5, 4.0]), np.array([0.0, 0.4, 2.0, -1.2, 0.1])
    range_, start = np.hypot(x - DISTANCE, y), DISTANCE - 1.0
    field = LineField(function, DISTANCE, x, y, 9.0)
    for since in (0.013, 0.4, 1.9):
        for i in range(x.size):
            time = since + range_[i] - start
            found = (field.pressure(time) if order == 0 else np.hypot(*field.velocity(time)))[i]

            def transform(s, r=float(range_[i])):
                pulse_part = complex(function.transform(np.array([complex(s)]))[0])
                ratio = mpmath.besselk(order, s * r) * mpmath.exp(s * (r - start)) / mpmath.besselk(0, s * start)
                return ratio * pulse_part

            expected = float(mpmath.invertlaplace(transform, since, method="talbot", degree=14))
            assert abs(abs(found) - abs(expected)) < 2e-6


def test_the_head_gets_the_pulse_itself():
    function = function_of(PULSES[0])
    field = LineField(function, DISTANCE, np.array([1.0]), np.array([0.0]), 5.0)
    for t in (0.0, 0.1, 2.0):
        np.testing.assert_allclose(field.pressure(t), function.history(np.array([t])), rtol=1e-10, atol=1e-13)


@pytest.mark.parametrize("kind", ["plane", "spherical", "line"])
def test_velocity_obeys_eulers_equation(kind):
    # dv/dt = -grad p by central differences, on a smooth pulse; the paper's wave obeys it along the ray.
    function, h = function_of(PULSES[3]), 2e-3
    at = np.array([0.4, 1.2, -1.0]), np.array([0.9, -0.3, 0.2])

    def field(dx=0.0, dy=0.0):
        x, y = at[0] + dx, at[1] + dy
        if kind == "plane":
            return PlaneField(function, x, y)
        return SphericalField(function, DISTANCE, x, y) if kind == "spherical" else LineField(function, DISTANCE, x, y, 6.0)

    for t in (0.7, 1.2, 2.5):
        rates = [(a - b) / (2 * h) for a, b in zip(field().velocity(t + h), field().velocity(t - h), strict=True)]
        slopes = [
            (field(h, 0).pressure(t) - field(-h, 0).pressure(t)) / (2 * h),
            (field(0, h).pressure(t) - field(0, -h).pressure(t)) / (2 * h),
        ]
        for rate, slope in zip(rates, slopes, strict=True):
            np.testing.assert_allclose(rate, -slope, atol=1e-4 * 12)  # the pulse's steepest slope is about 12 here


def test_fields_stay_finite_at_the_source():
    function, here = function_of(PULSES[0]), (np.array([DISTANCE, DISTANCE + 1e-9]), np.zeros(2))
    for field in (SphericalField(function, DISTANCE, *here), LineField(function, DISTANCE, *here, 3.0)):
        assert np.isfinite(field.pressure(1.0)).all()
        assert np.isfinite(field.velocity(1.0)).all()


def test_nothing_comes_before_the_front():
    function = function_of(PULSES[0])
    x, y = np.linspace(-3, 3, 31), np.zeros(31)
    for field in (PlaneField(function, x, y), SphericalField(function, DISTANCE, x, y), LineField(function, DISTANCE, x, y, 3.0)):
        assert np.all(field.pressure(0.5)[x < 0.49] == 0.0)
        assert np.all(field.pressure(0.5)[x > 0.51] != 0.0)
