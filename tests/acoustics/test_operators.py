"""Fluid regions: wall pressures per wall acceleration against direct evaluation, limits and reciprocity."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.special import iv, ivp, kv, kvp

from coaxshell.acoustics.operators import all_orders, annulus
from coaxshell.numerics.radial_functions import RadialFunctions

S = np.array([0.05 + 0.0j, 0.7 + 0.4j, 2.0 + 6.0j, 1.0 + 40.0j, 30.0 + 5.0j])
ORDERS = all_orders(24)
M = ORDERS[:, None]
RA, RB = 0.5, 0.9


def radial(radius: float, s: np.ndarray = S, orders: np.ndarray = ORDERS) -> RadialFunctions:
    return RadialFunctions(s, radius, orders)


def test_disc_and_exterior_by_direct_evaluation() -> None:
    z = S * RB
    np.testing.assert_allclose(radial(RB).disc, iv(M, z) / (S * ivp(M, z)), rtol=1e-11)
    np.testing.assert_allclose(radial(RB).exterior, kv(M, z) / (S * kvp(M, z)), rtol=1e-11)


def test_annulus_by_a_two_by_two_solve() -> None:
    # p = A I(kr) + B K(kr) with dp/dr given on both walls, solved as it stands, columns scaled to unit slope.
    op = annulus(radial(RA), radial(RB))
    for m in (0, 1, 3, 12, 24):
        for j, s in enumerate(S):
            slopes = s * np.array([[ivp(m, s * RA), kvp(m, s * RA)], [ivp(m, s * RB), kvp(m, s * RB)]])
            values = np.array([[iv(m, s * RA), kv(m, s * RA)], [iv(m, s * RB), kv(m, s * RB)]])
            scale = abs(slopes).max(axis=0)
            wall = values / scale @ np.linalg.inv(slopes / scale)
            found = np.array([[op.aa[m, j], op.ab[m, j]], [op.ba[m, j], op.bb[m, j]]])
            np.testing.assert_allclose(found, wall, rtol=1e-11, atol=1e-13 * abs(wall).max())


@pytest.mark.parametrize("s", [S, 1e-3 + 1j * np.array([1e-3, 1.0, 1e3, 1e5])], ids=["moderate", "wide"])
def test_reciprocity(s: np.ndarray) -> None:
    orders = all_orders(400)
    op = annulus(radial(RA, s, orders), radial(RB, s, orders))
    scale = abs(op.ba).max(axis=0, keepdims=True)
    np.testing.assert_allclose(RA * op.ab / scale, -RB * op.ba / scale, rtol=1e-10, atol=1e-14)


def test_annulus_around_nothing_is_the_disc() -> None:
    # The hole is felt as its area for m = 0 and 1, as r_a^(2m) above.
    s = S[:3]
    disc = radial(RB, s).disc
    errors = [abs(annulus(radial(ra, s), radial(RB, s)).bb / disc - 1).max() for ra in (1e-2, 1e-3, 1e-4)]
    assert errors[-1] < 1e-7
    np.testing.assert_allclose(np.log10(np.divide(errors[:-1], errors[1:])), 2.0, rtol=2e-3)


def test_a_gap_far_thinner_than_a_wave_is_a_spring_and_a_mass() -> None:
    # Uniform squeeze of a thin gap h: mean pressure (g_b - g_a)/(s^2 h), both walls alike (m = 0).
    h = 1e-4
    s = np.array([0.5 + 0.3j])
    op = annulus(radial(RB - h, s), radial(RB, s))
    for entry, sign in ((op.aa, -1), (op.ab, 1), (op.ba, -1), (op.bb, 1)):
        np.testing.assert_allclose(entry[0], sign / (s**2 * h), rtol=3e-4)


def test_low_frequency_is_incompressible_flow() -> None:
    # Harmonic functions r^m and r^-m; the disc's m = 0 is the spring 2/(s^2 r) of a compressible core.
    s = np.array([1e-4 + 0.0j])
    m = ORDERS[1:]
    np.testing.assert_allclose(radial(RB, s).disc[1:, 0], RB / m, rtol=2e-8)
    np.testing.assert_allclose(radial(RB, s).exterior[2:, 0], -RB / m[1:], rtol=2e-8)
    np.testing.assert_allclose(radial(RB, s).disc[0, 0], 2 / (s[0] ** 2 * RB), rtol=1e-8)
    q = (RA / RB) ** (2 * m)
    op = annulus(radial(RA, s), radial(RB, s))
    np.testing.assert_allclose(op.bb[1:, 0], RB / m * (1 + q) / (1 - q), rtol=3e-8)
    np.testing.assert_allclose(op.aa[1:, 0], -RA / m * (1 + q) / (1 - q), rtol=3e-8)
    np.testing.assert_allclose(op.ab[1:, 0], 2 * RB / m * (RA / RB) ** m / (1 - q), rtol=3e-8)


def test_high_frequency_is_a_plane_wave() -> None:
    # p = -+ rho c v on the exterior and interior wall, with the first curvature correction 1/(2z).
    s = np.array([4000.0 + 2000.0j])
    orders = all_orders(1)
    np.testing.assert_allclose(s * radial(1.0, s, orders).exterior, -1 + 1 / (2 * s) * np.ones((2, 1)), rtol=1e-7)
    np.testing.assert_allclose(s * radial(1.0, s, orders).disc, 1 + 1 / (2 * s) * np.ones((2, 1)), rtol=1e-7)


def test_a_sample_of_orders_equals_all_of_them() -> None:
    some = np.array([0.0, 3.0, 17.0, 24.0])
    rows = some.astype(int)
    sampled = annulus(radial(RA, S, some), radial(RB, S, some))
    for part, every in zip(sampled, annulus(radial(RA), radial(RB)), strict=True):
        np.testing.assert_allclose(part, every[rows], rtol=1e-14)


def test_everything_is_finite_at_order_2000() -> None:
    s = 0.5 + 1j * np.geomspace(1e-3, 1e5, 20)
    orders = all_orders(2000)
    for entry in annulus(radial(RA, s, orders), radial(1.0, s, orders)):
        assert np.isfinite(entry).all()
