"""Fields inside the fluid regions: direct evaluation, wall values, the wave equation, extremes."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.special import iv, ivp, kv, kvp

from coaxshell.acoustics.operators import all_orders, annulus, annulus_amplitudes
from coaxshell.acoustics.radial_fields import annulus_field, disc_field, exterior_field, outgoing
from coaxshell.numerics.radial_functions import RadialFunctions

S = np.array([0.05 + 0.0j, 0.7 + 0.4j, 2.0 + 6.0j, 1.0 + 40.0j, 30.0 + 5.0j])
ORDERS = all_orders(24)
M = ORDERS[:, None]
RA, R, RB = 0.5, 0.62, 0.9


def radial(radius: float, s: np.ndarray = S, orders: np.ndarray = ORDERS) -> RadialFunctions:
    return RadialFunctions(s, radius, orders)


def test_disc_by_direct_evaluation() -> None:
    field = disc_field(radial(R), radial(RB))
    np.testing.assert_allclose(field.pressure, iv(M, S * R) / (S * ivp(M, S * RB)), rtol=1e-12)
    np.testing.assert_allclose(field.slope, ivp(M, S * R) / ivp(M, S * RB), rtol=1e-12)


def test_exterior_by_direct_evaluation() -> None:
    field = exterior_field(radial(RB), radial(R))
    np.testing.assert_allclose(field.pressure, kv(M, S * RB) / (S * kvp(M, S * R)), rtol=1e-12)
    np.testing.assert_allclose(field.slope, kvp(M, S * RB) / kvp(M, S * R), rtol=1e-12)
    np.testing.assert_allclose(outgoing(radial(RB), radial(R)), kv(M, S * RB) / kv(M, S * R), rtol=1e-12)


def test_annulus_by_a_two_by_two_solve() -> None:
    # p = A I(kr) + B K(kr) with dp/dr given on both walls, solved as it stands, columns scaled to unit slope.
    fields = annulus_field(radial(R), radial(RA), radial(RB))
    for m in (0, 1, 3, 12, 24):
        for j, s in enumerate(S):
            slopes = s * np.array([[ivp(m, s * RA), kvp(m, s * RA)], [ivp(m, s * RB), kvp(m, s * RB)]])
            rows = np.array([[iv(m, s * R), kv(m, s * R)], [s * ivp(m, s * R), s * kvp(m, s * R)]])
            scale = abs(slopes).max(axis=0)
            here = rows / scale @ np.linalg.inv(slopes / scale)
            found = np.array([[f.pressure[m, j] for f in fields], [f.slope[m, j] for f in fields]])
            np.testing.assert_allclose(found, here, rtol=1e-11, atol=1e-11 * abs(here).max())


def test_wall_values_are_the_operators_and_the_given_slopes() -> None:
    inner, outer = radial(RA), radial(RB)
    operator, amplitudes = annulus(inner, outer), annulus_amplitudes(inner, outer)
    at_inner, at_outer = annulus_field(inner, inner, outer, amplitudes), annulus_field(outer, inner, outer, amplitudes)
    for found, wanted in zip([f.pressure for f in (*at_inner, *at_outer)], operator, strict=True):
        np.testing.assert_allclose(found, wanted, rtol=1e-12, atol=1e-12)
    for found, wanted in zip([f.slope for f in (*at_inner, *at_outer)], (1.0, 0.0, 0.0, 1.0), strict=True):
        np.testing.assert_allclose(found, wanted, rtol=1e-12, atol=1e-12)
    for region, wall in ((disc_field, outer.disc), (exterior_field, outer.exterior)):
        np.testing.assert_allclose(region(outer, outer).pressure, wall, rtol=1e-12)
        np.testing.assert_allclose(region(outer, outer).slope, 1.0, rtol=1e-12)


@pytest.mark.parametrize("region", ["disc", "inner wall", "outer wall", "exterior"])
def test_the_wave_equation_holds_between_the_walls(region: str) -> None:
    # (r p')' = (kappa^2 r + m^2/r) p by central differences of second order in the slope.
    def field(r: float):
        here = radial(r)
        if region == "disc":
            return disc_field(here, radial(RB))
        if region == "exterior":
            return exterior_field(here, radial(RA))
        return annulus_field(here, radial(RA), radial(RB))[region == "outer wall"]

    errors = []
    for step in (2e-4, 1e-4):
        second = ((R + step) * field(R + step).slope - (R - step) * field(R - step).slope) / (2 * step)
        wanted = (S**2 * R + M**2 / R) * field(R).pressure
        errors.append(float(abs(second / wanted - 1).max()))
    assert errors[1] < 2e-5
    np.testing.assert_allclose(errors[0] / errors[1], 4.0, rtol=1e-4)


def test_everything_is_finite_at_order_2000_and_decays_away_from_the_wall() -> None:
    s = 0.5 + 1j * np.geomspace(1e-3, 1e5, 20)
    orders = all_orders(2000)
    near, middle, far, centre = (radial(r, s, orders) for r in (RA, R, 1.0, 1e-9))
    fields = [disc_field(middle, far), disc_field(centre, far), exterior_field(far, middle), *annulus_field(middle, near, far)]
    for field in fields:
        assert np.isfinite(field.pressure).all()
        assert np.isfinite(field.slope).all()
    np.testing.assert_allclose(fields[0].slope[-1, 0], 0.0, atol=1e-200)


def test_the_centre_of_a_disc_holds_order_zero_and_the_velocity_of_order_one() -> None:
    field = disc_field(radial(1e-9), radial(RB))
    np.testing.assert_allclose(field.pressure[0], 1 / (S * iv(1, S * RB)), rtol=1e-12)
    np.testing.assert_allclose(field.slope[1], 0.5 / ivp(1, S * RB), rtol=1e-12)
    assert abs(field.pressure[1:]).max() < 1e-8
    assert abs(field.slope[2:]).max() < 1e-7


def test_a_sample_of_orders_equals_all_of_them() -> None:
    some = np.array([0.0, 3.0, 17.0, 24.0])
    rows = some.astype(int)
    sampled = annulus_field(radial(R, S, some), radial(RA, S, some), radial(RB, S, some))
    every = annulus_field(radial(R), radial(RA), radial(RB))
    for one, all_ in zip(sampled, every, strict=True):
        np.testing.assert_allclose(one.pressure, all_.pressure[rows], rtol=1e-13)
        np.testing.assert_allclose(one.slope, all_.slope[rows], rtol=1e-13)
