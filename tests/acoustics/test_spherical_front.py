"""The spherical source of three-dimensional runs: closed forms, thirty digits, Poisson's sum, transparency, far sources, extremes."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest

from coaxshell.acoustics.basis import RadialBasis
from coaxshell.acoustics.sources import LineGeometry, PlaneGeometry, SphericalFrontGeometry
from coaxshell.numerics.bessel_ratios import kve
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.modes import Modes

GRID = LaplaceGrid(2e-2, 100)


def load_of(distance: float, modes: Modes, s: np.ndarray) -> np.ndarray:
    return SphericalFrontGeometry(distance).prepare(GRID, modes)(RadialBasis(modes, s), slice(None))


@pytest.mark.parametrize(
    ("k", "expected"), [(0.0, (0.242803277, 0.399155754, 0.0169972862)), (3.0, (0.00582165186, 0.0104774935, 0.00128075409))]
)
def test_known_amplitudes(k: float, expected: tuple[float, ...]) -> None:
    """R0 = 3, s = 2, orders 0, 1, 5, over S: of an independent derivation and program, to the nine digits given."""
    found = load_of(3.0, Modes(np.array([0.0, 1.0, 5.0]), k), np.array([2.0 + 0j]))[:, 0] / 2.0
    np.testing.assert_allclose(found, expected, rtol=5e-9)


def test_amplitudes_by_thirty_digits() -> None:
    random = np.random.default_rng(12)
    for _ in range(6):
        distance, k = 1.0 + 10.0 ** random.uniform(-2, 1), 10.0 ** random.uniform(-3, 1.5)
        s = complex(10.0 ** random.uniform(-1, 1), 10.0 ** random.uniform(-1, 1.5))
        orders = np.unique(np.concatenate([[0.0], random.integers(1, 80, 3)]))
        found = load_of(distance, Modes(orders, k), np.array([s]))[:, 0]
        with mpmath.workdps(30):
            kappa = mpmath.sqrt(mpmath.mpc(s) ** 2 + mpmath.mpf(k) ** 2)
            start = mpmath.mpf(distance) - 1
            for value, m in zip(found, orders, strict=True):
                slope = kappa * mpmath.besselk(m + 1, kappa) - m * mpmath.besselk(m, kappa)
                expected = start * mpmath.exp(s * start) * (2 if m else 1) * mpmath.besselk(m, kappa * distance) / slope
                np.testing.assert_allclose(value, complex(expected), rtol=2e-11, atol=1e-290)


def test_the_sum_over_wavenumbers_is_the_wave_and_its_images() -> None:
    """Poisson: (2/L) [K_0(kappa_0 D) + 2 sum K_0(kappa_j D) cos k_j z] = sum_n e^{-s R_n}/R_n; s = 2, D = 2, z = 0.5, L = 10."""
    s, distance, z, period = 2.0 + 0j, 2.0, 0.5, 10.0
    k = 2 * np.pi * np.arange(60) / period
    along = np.array([np.cos(k * z)])
    kappa = np.array([Modes(np.zeros(1), one).kappa(1.0, np.array([s]))[0] for one in k])
    plain = kve(0, kappa * distance) * np.exp(-kappa * distance)
    weights = np.where(k == 0, 1.0, 2.0) * (2.0 / period)
    images = np.hypot(distance, z - period * np.arange(-6, 7))
    np.testing.assert_allclose((weights * plain) @ along[0], (np.exp(-s * images) / images).sum(), rtol=1e-13)
    np.testing.assert_allclose((weights * plain) @ along[0], 0.00785531377, rtol=5e-9)


def test_incident_waves_of_all_orders_sum_to_the_wave_at_a_point() -> None:
    """sum_m, sum_j of the incident amplitudes at r = 1 is S e^{-s(R - S)}/R of the source and its images, at angles and heights."""
    geometry, s, period = SphericalFrontGeometry(3.0), np.array([1.0 + 0j, 1.5 + 6.0j]), 20.0
    theta, z = np.radians([0.0, 50.0, 180.0]), np.array([0.0, 0.4, 2.0])
    grid = type("Nodes", (), {"nodes": s})()
    total, orders = np.zeros((z.size, theta.size, s.size), np.complex128), np.arange(61.0)
    for j, k in enumerate(2 * np.pi * np.arange(130) / period):
        pressure, _ = geometry.incident(grid, RadialBasis(Modes(orders, k), s))
        around = np.einsum("mt,ms->ts", np.cos(np.outer(orders, theta)), pressure)
        total += (2.0 if j else 1.0) * (2.0 / period) * np.cos(k * z)[:, None, None] * around
    images = period * np.arange(-4, 5)
    plane = np.hypot(3.0 - np.cos(theta), np.sin(theta))
    ranges = np.sqrt(plane[None, :, None] ** 2 + (z[:, None, None] - images) ** 2)
    expected = 2.0 * (np.exp(-s * (ranges[..., None] - 2.0)) / ranges[..., None]).sum(axis=2)
    np.testing.assert_allclose(total, expected, rtol=1e-9)


@pytest.mark.parametrize("k", [0.0, 0.7, 5.0, 60.0])
def test_a_massless_wall_in_one_fluid_is_transparent(k: float) -> None:
    """The load is what an incident wave regular inside gives: L = P0 - E dp0/dr with P0 = D dp0/dr; P0 by Graf's theorem itself."""
    modes = Modes.up_to(30, k)
    s = GRID.nodes[::9]
    basis, geometry = RadialBasis(modes, s), SphericalFrontGeometry(2.5)
    pressure, slope = geometry.incident(type("Nodes", (), {"nodes": s})(), basis)
    load = geometry.prepare(GRID, modes)(basis, slice(None))
    surface = basis.surface
    np.testing.assert_allclose(pressure, surface.disc * slope, rtol=1e-12)
    np.testing.assert_allclose(pressure - surface.exterior * slope, load, rtol=1e-9)
    # A massless wall takes the load on both sides: P + E g = D g for the slope g of its motion, which is the incident wave's.
    np.testing.assert_allclose(load / (surface.disc - surface.exterior), slope, rtol=1e-12)
    with mpmath.workdps(30):
        for n in (0, 3):
            kappa = mpmath.sqrt(mpmath.mpc(complex(s[n])) ** 2 + mpmath.mpf(k) ** 2)
            for m in (0, 1, 7):
                graf = 1.5 * mpmath.exp(complex(s[n]) * 1.5) * (2 if m else 1) * mpmath.besseli(m, kappa) * mpmath.besselk(m, 2.5 * kappa)
                np.testing.assert_allclose(pressure[m, n], complex(graf), rtol=1e-10)


def test_without_an_axial_wavenumber_it_is_a_line_source_of_another_history() -> None:
    """2 F(0) = integral over z = S e^{sS} 2 K_0(s S) times the line source of unit pressure at the head."""
    modes, s = Modes.up_to(20), GRID.nodes
    line = LineGeometry(4.0).prepare(GRID, modes)(RadialBasis(modes, s), slice(None))
    np.testing.assert_allclose(load_of(4.0, modes, s), 3.0 * kve(0, 3.0 * s) * line, rtol=1e-11, atol=1e-300)


@pytest.mark.slow
def test_from_far_away_it_is_plane() -> None:
    """Of the sum over k at z = 0; the period grows with sqrt(S), so that images stay out: a stationary phase, smooth in the wavenumber."""
    modes, s = Modes.up_to(6), np.array([2.0 + 0j, 3.0 + 4.0j])
    plane = PlaneGeometry().prepare(GRID, modes)(RadialBasis(modes, s), slice(None))
    errors = []
    for distance in (1e3, 1e4, 1e9, 1e15):
        period = 40.0 * np.sqrt(distance)
        total = 0.0
        for j in range(1200):
            k = 2 * np.pi * j / period
            total = total + (2.0 if j else 1.0) * (2.0 / period) * load_of(distance, Modes(modes.orders, k), s)
        errors.append(np.abs(total - plane).max())
    np.testing.assert_allclose(errors[0] / errors[1], 10.0, rtol=0.05)
    assert errors[2] < 2e-8
    assert errors[3] < 1e-11


@pytest.mark.parametrize("distance", [1.0 + 1e-6, 5.0, 1e8, 1e200])
def test_extreme_wavenumbers_orders_and_frequencies(distance: float) -> None:
    """Neither overflow nor NaN at any wavenumber, order, frequency and distance; |P_m| <= 2 S |E| e^{Re(s - kappa) S}."""
    s = np.array([1e-3 + 0j, 0.1 + 1e-3j, 1.0 + 10.0j, 2.0 + 2000.0j, 2.0 + 1e5j, 50.0 + 0j])
    with np.errstate(over="raise", invalid="raise", divide="raise"):
        for k in (0.0, 1e-6, 1.0, 2000.0):
            basis = RadialBasis(Modes.up_to(2000, k), s)
            load = SphericalFrontGeometry(distance).prepare(GRID, basis.modes)(basis, slice(None))
            assert np.isfinite(load).all()
            # |K_m(kappa R0)/K_m(kappa)| <= e^{-S Re kappa}, and Re (s - kappa) <= 0: nothing grows.
            decay = np.exp((-(k**2) / (basis.surface.kappa + s)).real * (distance - 1.0))
            bound = (distance - 1.0) * 2.0 * np.abs(basis.surface.exterior) * decay
            assert (np.abs(load) <= bound * (1 + 1e-9) + 1e-300).all()
