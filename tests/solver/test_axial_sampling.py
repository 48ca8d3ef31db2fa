"""Axial wavenumbers: Poisson's sum, the ellipse of orders, causality along the axis, periods that are too short."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.acoustics.sources import LineGeometry, SphericalFrontGeometry
from coaxshell.errors import InputError
from coaxshell.numerics.bessel_ratios import kve
from coaxshell.numerics.modes import Modes
from coaxshell.solver.axial.causality import Front, first_arrival, least_period, reach
from coaxshell.solver.axial.sampling import AxialSampling, axial_sampling, fastest_wave
from coaxshell.solver.scaling import Problem, dimensionless
from coaxshell.solver.settings import Settings

MEMBRANE = 2.866017947
"""Speed of membrane waves in the walls of the paper's Table 1, in that of sound in water."""


def bare(settings: Settings, distance: float | None = 5.0) -> tuple[Problem, Settings]:
    problem = dimensionless(cx.presets.load("bare"))
    source = LineGeometry(3.0) if distance is None else SphericalFrontGeometry(distance)
    return replace(problem, sources=(source,)), settings


def test_shares_sum_to_the_wave_and_its_images() -> None:
    """(2/L) [K_0(kappa_0 D) + 2 sum K_0(kappa_j D) cos k_j z] = sum_n e^{-s R_n}/R_n; s = 2, D = 2, L = 10."""
    sampling, s, z = AxialSampling(10.0, 40, 40.0), np.array([2.0 + 0j]), np.array([0.0, 0.5, -3.0])
    kappa = np.array([Modes(np.zeros(1), k).kappa(1.0, s)[0] for k in sampling.wavenumbers])
    even, odd = sampling.shares(z)
    found = even @ (kve(0, 2.0 * kappa) * np.exp(-2.0 * kappa))
    images = np.hypot(2.0, z[:, None] - 10.0 * np.arange(-6, 7))
    np.testing.assert_allclose(found, (np.exp(-2.0 * images) / images).sum(axis=1), rtol=1e-13)
    np.testing.assert_allclose(found[1], 0.00785531377, rtol=5e-9)
    assert (odd[0] == 0.0).all()


def test_shares_are_each_others_slopes() -> None:
    sampling, h = AxialSampling(7.0, 9, 12.0), 1e-5
    z = np.array([0.3, -1.1])
    (even, odd), k = sampling.shares(z), sampling.wavenumbers
    slopes = [(ahead - behind) / (2 * h) for ahead, behind in zip(sampling.shares(z + h), sampling.shares(z - h), strict=True)]
    np.testing.assert_allclose(slopes[0], -k * odd, rtol=0, atol=1e-7)
    np.testing.assert_allclose(slopes[1], k * even, rtol=0, atol=1e-7)
    everywhere = sampling.shares(np.linspace(0.0, 7.0, 200, endpoint=False))[0]
    np.testing.assert_allclose(sampling.mean, (everywhere**2).mean(axis=0), rtol=1e-12)


def test_orders_and_wavenumbers_fill_an_ellipse() -> None:
    disc = AxialSampling(2 * np.pi, 60, 60.0)
    assert disc.wavenumbers.size == 61  # k_max itself is one of them
    assert disc.wavenumbers[0] == 0.0
    orders = [modes.max_order for modes in disc.modes]
    assert orders[0] == 60
    assert orders[36] == 48  # 36, 48, 60
    assert orders[-1] == 0
    for tall in (disc, AxialSampling(5.0, 20, 45.5)):
        for modes in tall.modes:
            share = (modes.wavenumber / tall.highest) ** 2
            assert (modes.max_order / tall.max_order) ** 2 + share <= 1.0 + 1e-12
            assert ((modes.max_order + 1) / tall.max_order) ** 2 + share > 1.0
    assert sum(modes.count for modes in disc.modes) < 0.81 * 61 * 61
    assert disc.modes is disc.modes


def test_known_reaches_and_arrivals() -> None:
    """T = 4 and c of the paper's walls: of an independent derivation."""
    np.testing.assert_allclose(reach(4.0, 4.0, MEMBRANE), 12.18, atol=5e-3)
    np.testing.assert_allclose(reach(4.0, 199.0, MEMBRANE), 40.10, atol=5e-3)
    np.testing.assert_allclose(first_arrival(4.0, 4.0, MEMBRANE), 1.144280433, rtol=1e-9)


@pytest.mark.parametrize("speed", [0.3, 1.0, 1.0001, 2.866, 40.0])
@pytest.mark.parametrize("start", [1e-3, 4.0, 1e9])
def test_reach_by_trying_every_point_where_a_wave_could_leave_the_front(speed: float, start: float) -> None:
    for time in (1e-3, 0.4, 5.0, 60.0):
        front = np.sqrt(time * (time + 2.0 * start))
        left = front * np.linspace(0.0, 1.0, 200001)
        there = left * left / (np.hypot(start, left) + start)
        np.testing.assert_allclose(reach(time, start, speed), (left + speed * (time - there)).max(), rtol=1e-7)
        np.testing.assert_allclose(first_arrival(-reach(time, start, speed), start, speed), time, rtol=1e-9)
    assert reach(-1.0, start, speed) == 0.0
    assert first_arrival(0.0, start, speed) == 0.0


def test_no_image_is_felt_within_the_least_period() -> None:
    fronts = [Front(0.0, 4.0), Front(-2.0, 0.5, 1.5)]
    period = least_period(4.0, [0.0, 3.0], fronts, 2.0)
    arrivals = [
        front.delay + first_arrival(z - front.z + n * period, front.start, 2.0) for z in (0.0, 3.0) for front in fronts for n in (-1, 1)
    ]
    np.testing.assert_allclose(min(arrivals), 4.0, rtol=1e-12)
    assert least_period(4.0, [0.0], [], 2.0) == 0.0


def test_the_period_of_a_run() -> None:
    problem, settings = bare(Settings(duration=4.0, time_step=0.01, modes=60, dimensions=3, stations=(0.0, -1.5)))
    sampling = axial_sampling(problem, settings)
    np.testing.assert_allclose(fastest_wave(problem, 60.0), MEMBRANE, rtol=1e-9)
    np.testing.assert_allclose(sampling.period, 1.5 + reach(4.0, 4.0, MEMBRANE), rtol=1e-9)
    assert (sampling.max_order, sampling.highest) == (60, 60.0)
    longer = axial_sampling(problem, replace(settings, axial_period=40.0, axial_modes=25.0))
    assert (longer.period, longer.highest, longer.wavenumbers.size) == (40.0, 25.0, int(25 * 40 / (2 * np.pi)) + 1)


def test_the_period_follows_where_the_source_is_and_when_it_fires() -> None:
    problem, settings = bare(Settings(duration=4.0, time_step=0.01, modes=60, dimensions=3, stations=(0.0, 1.5)))
    late = cx.SphericalWave(distance=5.0, z=-2.0, delay=1.0 * problem.scales.time, pulse=problem.system.sources[0].pulse)
    moved = replace(problem, system=problem.system.model_copy(update={"source": late}))
    np.testing.assert_allclose(axial_sampling(moved, settings).period, 3.5 + reach(3.0, 4.0, MEMBRANE), rtol=1e-9)


def test_bending_waves_may_be_the_fastest() -> None:
    problem, _ = bare(Settings())
    wall = problem.shells[0]
    stiffened = wall.section.bending + sum(layer.coupling**2 / layer.zeta33 for layer in wall.section.piezoelectric)
    expected = 2.0 * 400.0 * np.sqrt(stiffened / wall.mass)
    assert expected > MEMBRANE
    np.testing.assert_allclose(fastest_wave(problem, 400.0), expected, rtol=1e-12)


def test_a_line_source_needs_no_axial_wavenumber() -> None:
    problem, settings = bare(Settings(modes=30, dimensions=3, stations=(0.0, 9.0)), distance=None)
    sampling = axial_sampling(problem, settings)
    np.testing.assert_array_equal(sampling.wavenumbers, [0.0])
    assert sampling.modes[0].max_order == 30


def test_a_period_that_is_too_short_is_refused_with_the_one_that_will_do() -> None:
    problem, settings = bare(Settings(duration=4.0, time_step=0.01, modes=60, dimensions=3, stations=(0.0, 1.5), axial_period=13.0))
    with pytest.raises(InputError, match=r"^axial_period: 13 m is too short: .*; give at least 13\.6[0-9] m, or leave it out$") as error:
        axial_sampling(problem, settings)
    enough = float(error.value.remedy.split()[3])
    assert axial_sampling(problem, replace(settings, axial_period=enough)).period == enough


def test_a_material_without_axial_constants_is_refused_before_the_run() -> None:
    without = cx.materials.PZT4.replace(c66=None)
    shell = cx.Shell(radius=1.0, layers=[cx.Layer("aluminium", 6e-3), cx.Layer(without, 3e-3, role="sensor")])
    system = cx.presets.load("bare").replace(shells=[shell], fluids=["vacuum", "water-1400"])
    settings = Settings(duration=1.0, time_step=1e-2, modes=4, dimensions=3, stations=[0.0])
    with pytest.raises(cx.InputError, match=r"shells\[0\]\.layers\[1\]\.material\.c66"):
        axial_sampling(dimensionless(system), settings)
