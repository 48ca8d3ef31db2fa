"""Incident waves in space: closed forms, the wave equation and Euler's equation by differences, agreement with the plane z = 0."""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest

from coaxshell.acoustics.pulse_histories import pulse_history, pulse_impulse
from coaxshell.acoustics.pulse_transforms import pulse_transform
from coaxshell.acoustics.sources import LineGeometry, PlaneGeometry, SphericalFrontGeometry, TimeFunction
from coaxshell.model.pulses import Exponential, Gaussian, Pulse

GEOMETRIES = [PlaneGeometry(), PlaneGeometry(35.0), PlaneGeometry(-20.0), LineGeometry(5.0), SphericalFrontGeometry(5.0)]
POINTS = np.array([0.4, 1.2, -1.0, 2.0]), np.array([0.9, -0.3, 0.2, 0.0]), np.array([0.0, 0.8, -0.5, 1.3])


def function_of(pulse: Pulse) -> TimeFunction:
    return TimeFunction(
        lambda t: pulse_history(pulse, t, 0.5, 4.0),
        lambda t: pulse_impulse(pulse, t, 0.5, 4.0),
        lambda s: pulse_transform(pulse, s, 0.5, 4.0),
    )


SMOOTH = function_of(Gaussian(peak_pressure=5.0, width=0.1, centre=0.6))
SHOCK = function_of(Exponential(peak_pressure=3.0, decay_time=0.1))


@pytest.mark.parametrize("geometry", [one for one in GEOMETRIES if not isinstance(one, LineGeometry)], ids=str)
def test_wave_equation_and_eulers_equation(geometry: object) -> None:
    h, latest = 1e-3, 6.0

    def at(time: float, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> tuple[np.ndarray, tuple[np.ndarray, ...]]:
        field = geometry.spatial_field(SMOOTH, POINTS[0] + x, POINTS[1] + y, POINTS[2] + z, latest)
        return field.pressure(time), field.velocity(time)

    for time in (1.5, 2.6, 3.7):
        steps = [partial(at, time, **{axis: h}) for axis in "xyz"], [partial(at, time, **{axis: -h}) for axis in "xyz"]
        ahead, behind = [[one()[0] for one in side] for side in steps]
        (late, v_late), (early, v_early), now = at(time + h), at(time - h), at(time)[0]
        scale = 1.25 / 0.2**2
        laplacian = sum(a - 2 * now + b for a, b in zip(ahead, behind, strict=True)) / h**2
        np.testing.assert_allclose((late - 2 * now + early) / h**2, laplacian, rtol=0, atol=1e-4 * scale)
        for axis in range(3):
            rate = (v_late[axis] - v_early[axis]) / (2 * h)
            np.testing.assert_allclose(rate, -(ahead[axis] - behind[axis]) / (2 * h), rtol=0, atol=1e-4 * scale)


def test_closed_forms() -> None:
    x, y, z = POINTS
    range_ = np.sqrt((x - 5.0) ** 2 + y**2 + z**2)
    sphere = SphericalFrontGeometry(5.0).spatial_field(SHOCK, x, y, z, 9.0)
    plane = PlaneGeometry(30.0).spatial_field(SHOCK, x, y, z, 9.0)
    f = lambda t: np.where(t >= 0, 0.75 * np.exp(-t * 5.0), 0.0)  # noqa: E731
    for t in (0.3, 1.7, 4.0):
        since = t - (range_ - 4.0)
        np.testing.assert_allclose(sphere.pressure(t), 4.0 / range_ * f(since), rtol=1e-12)
        impulse = np.where(since > 0, 0.15 * (1 - np.exp(-5.0 * since)), 0.0)
        for found, ray in zip(sphere.velocity(t), ((x - 5.0), y, z), strict=True):
            np.testing.assert_allclose(found, 4.0 / range_ * (f(since) + impulse / range_) * ray / range_, rtol=1e-12, atol=1e-15)
        along = f(t - (1 - x) * np.cos(np.pi / 6) - 0.5 * z)
        for found, ray in zip(plane.velocity(t), (-np.cos(np.pi / 6), 0.0, 0.5), strict=True):
            np.testing.assert_allclose(found, along * ray, rtol=1e-12)


@pytest.mark.parametrize("geometry", GEOMETRIES, ids=str)
def test_in_the_plane_of_the_head_it_is_the_field_of_the_cross_section(geometry: object) -> None:
    x, y, z = POINTS[0], POINTS[1], np.zeros(4)
    space, plane = geometry.spatial_field(SHOCK, x, y, z, 5.0), geometry.free_field(SHOCK, x, y, 5.0)
    for t in (0.2, 1.0, 4.9):
        np.testing.assert_allclose(space.pressure(t), plane.pressure(t), rtol=1e-13)
        for a, b in zip(space.velocity(t), plane.velocity(t), strict=False):
            np.testing.assert_allclose(a, b, rtol=1e-13, atol=1e-16)


def test_a_line_source_is_alike_at_all_heights_of_a_grid() -> None:
    x, z = np.linspace(-2.0, 0.9, 5)[:, None], np.linspace(-3.0, 3.0, 4)
    field = LineGeometry(3.0).spatial_field(SHOCK, x, np.zeros(1), z, 4.0)
    assert field.pressure(2.0).shape == (5, 4)
    np.testing.assert_array_equal(field.pressure(2.0), np.broadcast_to(field.pressure(2.0)[:, :1], (5, 4)))
    assert (field.velocity(2.0)[2] == 0.0).all()


def test_far_and_near_sources_stay_finite() -> None:
    x, y, z = np.array([0.3, -1.0, 1.0]), np.array([0.4, 0.0, 0.0]), np.array([0.2, 0.5, 0.0])
    far, plane = (g.spatial_field(SMOOTH, x, y, z, 5.0) for g in (SphericalFrontGeometry(1e16), PlaneGeometry()))
    np.testing.assert_allclose(far.pressure(2.5), plane.pressure(2.5), rtol=1e-12)
    np.testing.assert_allclose(far.velocity(2.5)[0], plane.velocity(2.5)[0], rtol=1e-12, atol=1e-15)
    here = SphericalFrontGeometry(2.0).spatial_field(SHOCK, np.array([2.0, 2.0]), np.array([0.0, 1e-9]), np.zeros(2), 5.0)
    assert np.isfinite([here.pressure(1.0), *here.velocity(1.0)]).all()
