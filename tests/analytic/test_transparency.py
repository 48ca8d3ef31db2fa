"""Shells without mass or stiffness in one fluid: an exact wave passes unchanged; the paper's spherical one nearly does."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy.special import ive, kve

import coaxshell as cx
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.scaling import dimensionless

GRID = LaplaceGrid(0.02, 250)
M = np.arange(41.0)[:, None]
S = GRID.nodes
RADII = (0.5, 1.0)
DISTANCE = 5.0
PEAK, DECAY = 2.5e4, 1.314e-4


@pytest.fixture(scope="module")
def through(ring: Callable[..., cx.Shell], water: cx.Fluid, spectra: Callable[..., Any]) -> Callable[[object], np.ndarray]:
    """Return a function from a source to W of both shells over the pulse's transform, (shells, orders, nodes)."""

    def solve(source: object) -> np.ndarray:
        ghosts = [ring(radius, 1e-3, density=1e-9, youngs_modulus=1e-3) for radius in RADII]
        system = cx.System(shells=ghosts, fluids=[water] * 3, source=source)
        scales = dimensionless(system).scales
        pulse = PEAK / scales.pressure / (S + scales.time / DECAY)
        return spectra(system, GRID, 40).normal[:, 0] / pulse

    return solve


def slope(r: float) -> np.ndarray:
    """Return e^(-s) I_m'(s r), s dp/dr of the plane wave per unit pulse up to Neumann's factor."""
    z = S * r
    derivative = (ive(abs(M - 1), z) + ive(M + 1, z)) / 2 * np.exp(z.real)
    return np.where(M == 0, 1, 2) * np.exp(-S) * derivative


def relative_error(found: np.ndarray, expected: np.ndarray) -> float:
    """Return the largest error of any order and node, relative to the largest amplitude at that node."""
    return float((abs(found - expected) / abs(expected).max(axis=0)).max())


def test_plane_wave_passes(through: Callable[[object], np.ndarray]) -> None:
    # dp/dr = s^2 W in the free field.
    found = through(cx.PlaneShock(peak_pressure=PEAK, decay_time=DECAY))
    for shell, r in enumerate(RADII):
        assert relative_error(found[shell], slope(r) / S) < 1e-11


def test_line_source_passes(through: Callable[[object], np.ndarray]) -> None:
    found = through(cx.LineShock(distance=DISTANCE, peak_pressure=PEAK, decay_time=DECAY))
    far, near = S * DISTANCE, S * (DISTANCE - 1)
    factor = kve(M, far) / kve(0, near)  # e^(near - far) = e^(-s) is in slope
    for shell, r in enumerate(RADII):
        assert relative_error(found[shell], slope(r) * factor / S) < 1e-11


def spherical_free_field(r: float, distance: float) -> np.ndarray:
    """Return W of the paper's wave at r, -(S/R) dR/dr [1 + 1/(sR)] e^(-s(R - S))/s, projected by brute force."""
    theta = 2 * np.pi * (np.arange(1500) + 0.5) / 1500
    range_ = np.sqrt(r * r + distance**2 - 2 * r * distance * np.cos(theta))[:, None]
    velocity = (distance - 1) / range_ * (r - distance * np.cos(theta))[:, None] / range_ * (1 + 1 / (S * range_))
    series = np.cos(M * theta) @ (velocity * np.exp(-S * (range_ - distance + 1))) / 1500
    return -np.where(M == 0, 1, 2) * series / S


def test_the_spherical_wave_nearly_passes(through: Callable[[object], np.ndarray]) -> None:
    # A slice through a spherical wave solves no two-dimensional wave equation. Measured over t = 0..5 (relative L2 of the head's
    # displacement): 2.3 per cent at the inner shell, 7.4 at the outer, at 5 m; it falls as the source moves away.
    pulse = 1 / (S + 1 / (DECAY * 1400))
    discrepancy = {}
    for distance in (5.0, 50.0):
        found = through(cx.SphericalShock(distance=distance, peak_pressure=PEAK, decay_time=DECAY))
        for shell, r in enumerate(RADII):
            ours, free = GRID.invert(found[shell] * pulse), GRID.invert(spherical_free_field(r, distance) * pulse)
            discrepancy[distance, shell] = np.linalg.norm((ours - free).sum(axis=0)) / np.linalg.norm(free.sum(axis=0))
    np.testing.assert_allclose([discrepancy[5.0, 0], discrepancy[5.0, 1]], [0.0235, 0.0743], rtol=0.01)
    for shell in (0, 1):
        assert 0 < discrepancy[50.0, shell] < discrepancy[5.0, shell] / 5
