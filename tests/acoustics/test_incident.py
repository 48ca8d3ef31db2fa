"""Modal loads of the three geometries against brute force in theta: incident pressure plus rigid scattering of its radial velocity."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from scipy.special import ivp, kv, kve, kvp

from coaxshell.acoustics.basis import Modes, RadialBasis
from coaxshell.acoustics.operators import all_orders
from coaxshell.acoustics.sources import LineGeometry, PlaneGeometry, SphericalGeometry
from coaxshell.numerics.laplace_grid import LaplaceGrid

GRID = LaplaceGrid(0.02, 200)
ORDERS = all_orders(30)
MODES = Modes(ORDERS)
SAMPLE = slice(0, None, 7)
POINTS = 1200
THETA = 2 * np.pi * (np.arange(POINTS) + 0.5) / POINTS


def projected(field: np.ndarray) -> np.ndarray:
    """Return the cosine series of a field (theta, nodes), shape (orders, nodes)."""
    series = np.cos(np.outer(ORDERS, THETA)) @ field / POINTS
    series[1:] *= 2
    return series


def load_of(geometry: object) -> np.ndarray:
    return geometry.prepare(GRID, MODES)(RadialBasis(MODES, GRID.nodes), slice(None))[:, SAMPLE]


def scattered(pressure: Callable[[float], np.ndarray]) -> np.ndarray:
    """Return incident plus rigidly scattered pressure at r = 1, from the incident pressure at any r (derivative by differences)."""
    s, h = GRID.nodes[SAMPLE], 1e-4
    slope = (8 * (pressure(1 + h) - pressure(1 - h)) - (pressure(1 + 2 * h) - pressure(1 - 2 * h))) / (12 * h)
    ratio = np.array([kv(m, s) / (s * kvp(m, s)) for m in ORDERS])
    return projected(pressure(1.0)) - projected(slope) * ratio


def range_to(distance: float, r: float) -> np.ndarray:
    return np.sqrt(r * r + distance**2 - 2 * r * distance * np.cos(THETA))[:, None]


def test_plane() -> None:
    s = GRID.nodes[SAMPLE]
    expected = scattered(lambda r: np.exp(-s * (1 - r * np.cos(THETA[:, None]))))
    np.testing.assert_allclose(load_of(PlaneGeometry()), expected, rtol=0, atol=1e-9)


@pytest.mark.parametrize("distance", [1.5, 5.0, 40.0])
def test_line(distance: float) -> None:
    s = GRID.nodes[SAMPLE]

    def pressure(r: float) -> np.ndarray:
        far, near = s * range_to(distance, r), s * (distance - 1)
        return kve(0, far) / kve(0, near) * np.exp(near - far)

    np.testing.assert_allclose(load_of(LineGeometry(distance)), scattered(pressure), rtol=0, atol=1e-9)


@pytest.mark.parametrize("distance", [1.5, 5.0, 40.0])
def test_spherical(distance: float) -> None:
    s = GRID.nodes[SAMPLE]

    def pressure(r: float) -> np.ndarray:
        far = range_to(distance, r)
        return (distance - 1) / far * np.exp(-s * (far - (distance - 1)))

    np.testing.assert_allclose(load_of(SphericalGeometry(distance)), scattered(pressure), rtol=0, atol=1e-9)


@pytest.mark.parametrize("geometry", [SphericalGeometry, LineGeometry])
def test_from_far_away_the_wave_is_plane(geometry: type) -> None:
    plane = load_of(PlaneGeometry())
    errors = [abs(load_of(geometry(distance)) - plane)[:, :10].max() for distance in (1e3, 1e4)]
    assert errors[1] < 1e-3
    np.testing.assert_allclose(np.log10(errors[0] / errors[1]), 1.0, rtol=1e-3)


def test_spherical_and_line_sources_differ() -> None:
    assert abs(load_of(SphericalGeometry(5.0)) - load_of(LineGeometry(5.0))).max() > 5e-3


def test_plane_load_at_low_frequency_is_the_uniform_pressure() -> None:
    slow = RadialBasis(MODES, np.array([1e-4 + 0j]))
    load = PlaneGeometry().prepare(GRID, MODES)
    np.testing.assert_allclose(load(slow, slice(0, 1))[0], 1.0, rtol=2e-4)
    assert load(RadialBasis(MODES, GRID.nodes), slice(None)).shape == (31, GRID.nodes.size)
    # Order 1 doubles: the incident slope 2 I_1' and its rigid scattering alike.
    np.testing.assert_allclose(load(slow, slice(0, 1))[1], 4 * slow.s * ivp(1, slow.s), rtol=1e-3)
