"""Fluid operators, fields and sources at an axial wavenumber k > 0 against Bessel functions of twenty digits."""

from __future__ import annotations

from functools import cache

import mpmath
import numpy as np
import pytest

from coaxshell.acoustics.basis import Modes, RadialBasis
from coaxshell.acoustics.operators import annulus
from coaxshell.acoustics.radial_fields import annulus_field, disc_field, exterior_field
from coaxshell.acoustics.sources import LineGeometry, PlaneGeometry
from coaxshell.numerics.laplace_grid import LaplaceGrid

ORDERS = np.array([0.0, 1.0, 5.0, 20.0])
S = np.array([0.3 + 0.0j, 0.5 + 7.0j, 1.0 + 40.0j, 0.2 - 3.0j])
SLOWNESS = 1.7


def kappa(k: float, slowness: float, s: complex) -> mpmath.mpc:
    """Return the root of kappa^2 = alpha^2 s^2 + k^2 with a positive real part."""
    root = mpmath.sqrt(mpmath.mpc(slowness * s) ** 2 + mpmath.mpf(k) ** 2)
    return root if root.real > 0 else -root


@cache
def i(m: float, z: mpmath.mpc) -> mpmath.mpc:
    return mpmath.besseli(m, z)


@cache
def k(m: float, z: mpmath.mpc) -> mpmath.mpc:
    return mpmath.besselk(m, z)


def i_slope(m: float, z: mpmath.mpc) -> mpmath.mpc:
    return i(m + 1, z) + m / z * i(m, z)


def k_slope(m: float, z: mpmath.mpc) -> mpmath.mpc:
    return -k(m + 1, z) + m / z * k(m, z)


@pytest.fixture(autouse=True)
def _digits() -> None:
    mpmath.mp.dps = 30


def expected(formula: object, axial: float, slowness: float = SLOWNESS) -> np.ndarray:
    return np.array([[complex(formula(m, kappa(axial, slowness, complex(s)))) for s in S] for m in ORDERS])


@pytest.mark.slow_for("9.0", "0.001")
@pytest.mark.parametrize("axial", [0.0, 1e-3, 0.8, 9.0])
def test_walls_of_every_region(axial: float) -> None:
    radial = RadialBasis(Modes(ORDERS, axial), S)
    a, b = 0.6, 1.0
    np.testing.assert_allclose(radial(SLOWNESS, a).disc, expected(lambda m, x: i(m, x * a) / (x * i_slope(m, x * a)), axial), rtol=1e-12)
    np.testing.assert_allclose(
        radial(SLOWNESS, b).exterior, expected(lambda m, x: k(m, x * b) / (x * k_slope(m, x * b)), axial), rtol=1e-12
    )

    def walls(m: float, x: mpmath.mpc, at: float, driven: float, still: float) -> mpmath.mpc:
        """Pressure at a radius per slope 1 at one wall and 0 at the other."""
        numerator = i(m, x * at) * k_slope(m, x * still) - k(m, x * at) * i_slope(m, x * still)
        return numerator / (x * (i_slope(m, x * driven) * k_slope(m, x * still) - k_slope(m, x * driven) * i_slope(m, x * still)))

    gap = annulus(radial(SLOWNESS, a), radial(SLOWNESS, b))
    for found, at, driven in ((gap.aa, a, a), (gap.ab, a, b), (gap.ba, b, a), (gap.bb, b, b)):
        reference = expected(lambda m, x, at=at, driven=driven: walls(m, x, at, driven, b if driven == a else a), axial)
        np.testing.assert_allclose(found, reference, rtol=1e-9, atol=1e-13 * np.abs(reference).max())
    inner, outer = annulus_field(radial(SLOWNESS, 0.8), radial(SLOWNESS, a), radial(SLOWNESS, b))
    for field, driven in ((inner, a), (outer, b)):
        reference = expected(lambda m, x, driven=driven: walls(m, x, 0.8, driven, b if driven == a else a), axial)
        np.testing.assert_allclose(field.pressure, reference, rtol=1e-9, atol=1e-13 * np.abs(reference).max())


@pytest.mark.slow_for("3.0")
@pytest.mark.parametrize("axial", [0.8, 3.0])
def test_fields_away_from_walls(axial: float) -> None:
    radial = RadialBasis(Modes(ORDERS, axial), S)
    inside = disc_field(radial(SLOWNESS, 0.35), radial(SLOWNESS, 0.6))
    np.testing.assert_allclose(inside.slope, expected(lambda m, x: i_slope(m, 0.35 * x) / i_slope(m, 0.6 * x), axial), rtol=1e-11)
    outside = exterior_field(radial(SLOWNESS, 2.5), radial(SLOWNESS, 1.0))
    np.testing.assert_allclose(outside.slope, expected(lambda m, x: k_slope(m, 2.5 * x) / k_slope(m, x), axial), rtol=1e-9, atol=1e-300)


@pytest.mark.slow_for("3.0")
@pytest.mark.parametrize("axial", [0.0, 0.8, 3.0])
def test_loads_of_sources(axial: float) -> None:
    """Incident e^{-kappa(1 - x)} and K_0(kappa R)/K_0(kappa S) times cos kz, plus what a rigid cylinder scatters; by the Wronskian."""
    grid, radial = LaplaceGrid(0.1, 8), RadialBasis(Modes(ORDERS, axial), S)
    factor = {0.0: 1.0}

    def plane(m: float, x: mpmath.mpc) -> mpmath.mpc:
        incident = lambda order: mpmath.exp(-x) * factor.get(m, 2.0) * order  # noqa: E731
        pressure, slope = incident(i(m, x)), incident(x * i_slope(m, x))
        return pressure - slope * k(m, x) / (x * k_slope(m, x))

    def line(m: float, x: mpmath.mpc) -> mpmath.mpc:
        share = factor.get(m, 2.0) * k(m, 3 * x) / k(0, 2 * x)
        pressure, slope = share * i(m, x), share * x * i_slope(m, x)
        return pressure - slope * k(m, x) / (x * k_slope(m, x))

    for geometry, formula in ((PlaneGeometry(), plane), (LineGeometry(3.0), line)):
        load = geometry.prepare(grid, radial.modes)(radial, slice(None))
        np.testing.assert_allclose(load, expected(formula, axial, 1.0), rtol=1e-9)


def test_the_wavenumber_of_a_fluid() -> None:
    for axial in (0.0, 1e-3, 0.8, 60.0):
        modes = Modes(ORDERS, axial)
        found = modes.kappa(SLOWNESS, S)
        assert (found.real > 0).all()
        np.testing.assert_allclose(found, [complex(kappa(axial, SLOWNESS, complex(s))) for s in S], rtol=1e-14)
    assert Modes(ORDERS, 1.0).key != Modes(ORDERS, 2.0).key
    np.testing.assert_allclose(Modes(ORDERS, 3.0).gradient_squared(0.5), (ORDERS / 0.5) ** 2 + 9.0)


@pytest.mark.slow_for("-30.0")
@pytest.mark.parametrize("inclination", [0.0, 12.0, -30.0])
def test_inclined_plane_waves(inclination: float) -> None:
    """Load at kappa = s cos alpha by the Wronskian; the incident orders sum to e^{-s(1 - x) cos alpha}, which the wave is at z = 0."""
    geometry, grid = PlaneGeometry(inclination), LaplaceGrid(0.1, 8)
    slope, across = np.sin(np.radians(inclination)), np.cos(np.radians(inclination))
    assert geometry.trace_slowness == pytest.approx(slope, rel=1e-15)
    radial = RadialBasis(Modes(ORDERS, -1j * S * geometry.trace_slowness), S)
    np.testing.assert_allclose(radial.surface.kappa, S * across, rtol=1e-14)
    np.testing.assert_allclose(radial.modes.kappa(SLOWNESS, S), S * np.sqrt(SLOWNESS**2 - slope**2), rtol=1e-14)

    def load(m: float, x: mpmath.mpc) -> mpmath.mpc:
        return -mpmath.exp(-x) * (2 if m else 1) / (x * k_slope(m, x))

    expected_load = np.array([[complex(load(m, mpmath.mpc(complex(s)) * across)) for s in S] for m in ORDERS])
    np.testing.assert_allclose(geometry.prepare(grid, radial.modes)(radial, slice(None)), expected_load, rtol=1e-9)
    every = RadialBasis(Modes.up_to(90, -1j * S * geometry.trace_slowness), S)
    pressure, _ = geometry.incident(type("Nodes", (), {"nodes": S})(), every)
    theta = np.radians([0.0, 70.0, 180.0])
    found = np.einsum("mt,ms->ts", np.cos(np.outer(every.modes.orders, theta)), pressure)
    np.testing.assert_allclose(found, np.exp(-np.outer((1.0 - np.cos(theta)) * across, S)), rtol=0, atol=1e-9)


def test_modes_at_a_wavenumber_for_each_node_have_a_key_of_their_own() -> None:
    one, other = Modes(ORDERS, 1j * S), Modes(ORDERS, 1.1j * S)
    assert one.key == Modes(ORDERS, 1j * S).key
    assert len({one.key, other.key, Modes(ORDERS).key, Modes(ORDERS, 1.0).key}) == 4
