"""Response functions against high-precision values, limits at fronts, and each other."""

from __future__ import annotations

import numpy as np
import pytest

from coaxshell.acoustics.response_functions import (
    annulus_wall,
    arrivals,
    disc_wall,
    exterior,
    exterior_wall,
    gap,
    interior,
    sums,
    wall_functions,
)
from coaxshell.acoustics.response_functions.exterior_response import exterior_field, fit, tabulated
from coaxshell.errors import InputError

# mpmath, 25 digits, Talbot's contour: order, r, time since the front, xi_e
EXTERIOR = [
    (0, 1, 0.05, 0.975461063516039),
    (0, 1, 0.7, 0.724418297705476),
    (0, 1, 3, 0.332004676146705),
    (0, 1, 15, 0.0680824631986551),
    (0, 2, 0.05, 0.691898958671629),
    (0, 2, 0.7, 0.533143435950403),
    (0, 2, 3, 0.268665986301435),
    (0, 2, 15, 0.0639181796896214),
    (1, 1, 0.05, 0.974856527946495),
    (1, 1, 0.7, 0.647145762555579),
    (1, 1, 3, 0.012323795159277),
    (1, 1, 15, -0.000519577466803094),
    (1, 2, 0.05, 0.68291792709192),
    (1, 2, 0.7, 0.400406479393258),
    (1, 2, 3, -0.0296720934138415),
    (1, 2, 15, -0.000574528341217552),
    (2, 1, 0.05, 0.97304404704679),
    (2, 1, 0.7, 0.440476447143015),
    (2, 1, 3, -0.0472902890919938),
]


@pytest.mark.parametrize(("order", "radius", "late", "value"), EXTERIOR)
def test_exterior_against_high_precision_inversion(order, radius, late, value):
    assert exterior([order], late + radius - 1.0, radius=radius)[0, 0] == pytest.approx(value, abs=2e-12)


def test_exterior_against_the_reference_table(tables):
    times = [0.1, 0.5, 1.0, 2.0, 5.0]
    expected = {
        0: [-0.951814482948, -0.79015823611, -0.640337302044, -0.446710300458, -0.209959648317],
        1: [-0.949475331599, -0.74522610243, -0.51063420921, -0.175596735391, 0.0445653978752],
        2: [-0.942475178767, -0.61819816439, -0.20193311671, 0.138532959551, -0.0123945836069],
        5: [-0.89419578644, -0.005612598915, 0.164088108271, 0.0193471426265, 0.00108588831],
        20: [-0.222706896, 0.151540863, -0.061000508, -0.009581062],
    }
    walls = exterior_wall(20, np.array(times))
    for order, values in expected.items():
        np.testing.assert_allclose(walls[order, : len(values)], values, atol=1e-9 if order == 20 else 6e-10 if order == 5 else 2e-12)


def test_sums_of_exponentials_and_contour_agree_at_the_wall():
    # Two evaluations that share nothing: poles fitted on the imaginary axis, and quadrature along a turned contour.
    times = np.concatenate([[0.0, 1e-5, 1e-3], np.linspace(0.02, 20.0, 200)])
    orders = np.array([0, 1, 2, 7, 30, 120, 300])
    np.testing.assert_allclose(exterior_wall(300, times)[orders], exterior_field(orders, times, 1.0), rtol=0, atol=3e-12)


def test_exterior_poles_are_stable_few_and_reproducible():
    every = tabulated()
    assert len(every) == 301
    assert max(poles.poles.real.max() for poles in every) < 0.0
    assert max(poles.poles.size for poles in every[1:]) <= 28
    assert every[0].poles.size <= 40
    times = np.linspace(0.0, 20.0, 101)
    for order in (3, 24):
        old, new = every[order], fit(order)
        old_values, new_values = (
            each.weights.real @ (np.exp(np.outer(each.poles, times)) - 1).real
            - each.weights.imag @ np.exp(np.outer(each.poles, times)).imag
            for each in (old, new)
        )
        np.testing.assert_allclose(old_values, new_values, rtol=0, atol=1e-11)


def test_orders_beyond_the_table():
    times = np.array([0.0, 1e-3, 0.02, 0.5])
    mixed = exterior([301, 4, 300], times)
    np.testing.assert_allclose(mixed, -exterior_field(np.array([301, 4, 300]), times, 1.0), rtol=0, atol=1e-11)


@pytest.mark.parametrize("radius", [1.0, 1.3, 4.0])
def test_exterior_front(radius):
    front = radius - 1.0
    values = exterior([0, 3, 50, 300], [front - 1e-9, front, front + 1e-10], radius=radius)
    np.testing.assert_array_equal(values[:, 0], 0.0)
    np.testing.assert_allclose(values[:, 1], radius**-0.5, rtol=1e-10)
    np.testing.assert_allclose(values[:, 2], radius**-0.5, rtol=2e-5)


def test_gap_fronts_have_the_heights_of_ray_theory():
    inner, outer, alpha = 0.6, 1.0, 1.3
    orders, period = [0, 2, 17, 90], 2 * 0.4 * 1.3
    for driven, sign in (("inner", -1.0), ("outer", 1.0)):
        values = gap(orders, [-1.0, 0.0, period - 1e-11, period], inner=inner, outer=outer, driven=driven, slowness=alpha)
        np.testing.assert_array_equal(values[:, 0], 0.0)
        np.testing.assert_allclose(values[:, 1], sign / alpha, rtol=1e-10)
        np.testing.assert_allclose(values[:, 3] - values[:, 2], 2 * sign / alpha, rtol=0, atol=1e-8)
    across = gap(orders, [0.5 * period - 1e-11, 0.5 * period], inner=inner, outer=outer, radius=inner, driven="outer", slowness=alpha)
    np.testing.assert_allclose(across[:, 0], 0.0, atol=1e-10)
    np.testing.assert_allclose(across[:, 1], 2 * (outer / inner) ** 0.5 / alpha, rtol=1e-12)


def test_interior_fronts_turn_by_a_quarter_at_each_passage():
    radius, orders = 0.5, np.array([0, 1, 4, 9])
    near = np.array([1e-9, 1e-8])
    focus = interior(orders, 1.0 + near, disc_radius=radius)
    np.testing.assert_allclose(focus[:, 0] - focus[:, 1], (-1.0) ** orders * 2 / np.pi * np.log(10), atol=1e-4)
    jump = interior(orders, [2.0 - 1e-10, 2.0], disc_radius=radius)
    np.testing.assert_allclose(jump[:, 1] - jump[:, 0], -2.0, rtol=0, atol=1e-6)
    infinite = interior(orders, [1.0, 3.0], disc_radius=radius)
    np.testing.assert_array_equal(infinite, np.array([[1, -1], [-1, 1], [1, -1], [-1, 1]]) * np.inf)


def test_centre_of_the_disc():
    times = np.array([0.2, 0.55, 0.8, 1.7])
    centre = interior([0, 1, 6], times, radius=0.0, disc_radius=0.5)
    near = interior([0, 1, 6], times, radius=0.005, disc_radius=0.5)
    assert centre[0, 0] == 0.0
    np.testing.assert_array_equal(centre[1:], 0.0)
    np.testing.assert_allclose(near[0], centre[0], rtol=3e-3)
    assert abs(near[2]).max() < 1e-7


@pytest.mark.parametrize("orders", [[0, 6, 60], pytest.param([0, 1, 6, 60, 300], marks=pytest.mark.slow)], ids=["few", "many"])
def test_results_do_not_depend_on_where_the_contour_is_turned(monkeypatch, orders):
    times = np.concatenate([np.linspace(0.0, 20.0, 161), [1e-6, 0.999999, 1.000001, 13.0 + 1e-5]])
    calls = (
        lambda: gap(orders, times, inner=0.5, outer=1.0),
        lambda: gap(orders, times, inner=0.5, outer=1.0, radius=0.7, driven="outer", slowness=0.8),
        lambda: interior(orders, times[times % 1.0 > 0], disc_radius=0.5),
        lambda: exterior(orders, times, radius=2.0),
    )
    first = [call() for call in calls]
    monkeypatch.setattr(sums, "_GROWTH", 5.0)
    for call, values in zip(calls, first, strict=True):
        np.testing.assert_allclose(call(), values, rtol=0, atol=2e-9)


def test_wall_functions_are_the_public_ones_at_the_walls():
    times = np.linspace(0.0, 3.0, 301)
    inner, gap_slowness, slowness = 0.45, 0.9, 1.1
    walls = wall_functions(30, times, inner_radius=inner, gap_slowness=gap_slowness, interior_slowness=slowness)
    np.testing.assert_allclose(walls.exterior, -exterior(30, times), atol=1e-13)
    public = interior(30, times, disc_radius=inner, slowness=slowness)
    finite = np.isfinite(public)
    assert np.count_nonzero(~finite[0]) == 2  # at t = 0.99 and 2.97
    np.testing.assert_allclose(walls.interior[finite], public[finite], atol=1e-10)
    for values, at, driven in zip(walls.gap, (inner, inner, 1.0, 1.0), ("inner", "outer") * 2, strict=True):
        public = gap(30, times, inner=inner, outer=1.0, radius=at, driven=driven, slowness=gap_slowness)
        np.testing.assert_allclose(values, public, rtol=0, atol=1e-11)
    vacuum = wall_functions(2, times, inner_radius=inner, gap_slowness=None, interior_slowness=None)
    assert vacuum.gap is None
    assert vacuum.interior is None


def test_wall_values_at_a_logarithm_keep_the_trapezoidal_rule_of_second_order():
    sums = []
    for steps in (200, 400, 800, 1600):
        times = np.linspace(0.0, 2.0, steps + 1)[:-1]
        values = disc_wall(2, times, 0.5, 1.0) * np.sin(np.pi * times / 2.0) ** 4
        assert np.all(np.isfinite(values))
        sums.append(values.sum(axis=1) * times[1])
    errors = np.diff(sums, axis=0)
    assert np.all(np.abs(errors[-1]) < 0.3 * np.abs(errors[-2]) + 1e-10)


def test_a_gap_around_nothing_is_the_disc():
    times = np.linspace(0.05, 0.9, 18)
    thin = annulus_wall(6, times, 0.01, 0.5, 1.0).bb
    disc = disc_wall(6, times, 0.5, 1.0)
    np.testing.assert_allclose(thin[3:], disc[3:], rtol=0, atol=1e-12)


def test_arrivals():
    assert arrivals(0.0, 0.5, 0.5, "outer", 1.0, 3.0) == [(0.0, False), (1.0, True), (2.0, False), (3.0, True)]
    found = arrivals(0.5, 1.0, 0.7, "inner", 2.0, 2.0)
    np.testing.assert_allclose([time for time, _ in found], [0.4, 1.6])


@pytest.mark.parametrize(
    ("call", "where"),
    [
        (lambda: exterior(-1, [1.0]), "orders"),
        (lambda: exterior([0.5], [1.0]), "orders"),
        (lambda: exterior(2001, [1.0]), "orders"),
        (lambda: exterior(1, [np.nan]), "times"),
        (lambda: exterior(1, "soon"), "times"),
        (lambda: exterior(1, [1.0], radius=0.9), "radius"),
        (lambda: interior(1, [1.0], radius=1.1), "radius"),
        (lambda: interior(1, [1.0], radius=1e-3), "radius"),
        (lambda: interior(1, [1.0], slowness=0.0), "slowness"),
        (lambda: gap(1, [1.0], inner=0.5, outer=0.5), "outer"),
        (lambda: gap(1, [1.0], inner=0.0, outer=0.5), "inner"),
        (lambda: gap(1, [1.0], inner=0.5, outer=1.0, radius=1.2), "radius"),
    ],
)
def test_bad_arguments(call, where):
    with pytest.raises(InputError) as refused:
        call()
    assert refused.value.where == where
