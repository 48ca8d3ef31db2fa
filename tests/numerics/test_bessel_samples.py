"""Bessel functions at a sample of orders: against 50-digit arithmetic, SciPy, and far beyond the range of a double."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.special import ive, kve

from coaxshell.numerics import bessel_ratios as br
from coaxshell.numerics.bessel_samples import i_sample, k_sample

TABLE = Path(__file__).parents[1] / "reference" / "data" / "bessel_ratios.npz"
Z = np.array([0.3 + 0.1j, 2.0 - 5.0j, 40.0 + 0.0j, 1.0 + 90.0j])


@pytest.mark.parametrize("top", [2, 20, 150, 1000, 2000])
def test_ratios_are_those_of_the_table(top: int) -> None:
    with np.load(TABLE) as stored:
        table = dict(stored)
    kept, near = table["orders"] <= top, np.abs(table["z"]) < 6000
    orders = table["orders"][kept].astype(np.int64)
    found_i, found_k = i_sample(orders, table["z"]).ratio, k_sample(orders, table["z"]).ratio
    np.testing.assert_allclose(found_k, table["k"][kept], rtol=2e-14)
    np.testing.assert_allclose(found_i, table["i"][kept], rtol=1e-10)
    np.testing.assert_allclose(found_i[:, near], table["i"][kept][:, near], rtol=1e-11)


def test_the_functions_themselves() -> None:
    orders = np.array([0, 1, 7, 12, 30])
    for sample, function in ((i_sample, ive), (k_sample, kve)):
        found = sample(orders, Z)
        values = found.mantissa * np.exp(found.exponent)
        np.testing.assert_allclose(values, [function(m, Z) for m in orders], rtol=1e-10)


def test_across_two_radii_without_over_or_underflow() -> None:
    za, zb, orders = 0.4 * Z, Z, np.array([3, 40, 300, 4000])
    across_i = i_sample(orders, za).over(i_sample(orders, zb)) * np.exp(za.real - zb.real)
    across_k = k_sample(orders, zb).over(k_sample(orders, za)) * np.exp(za - zb)
    every = 301
    expected_i = br.i_across(br.i_ratios(every, za), br.i_ratios(every, zb), za, zb)[orders[:3]]
    expected_k = br.k_across(br.k_ratios(every, za), br.k_ratios(every, zb), za, zb)[orders[:3]]
    np.testing.assert_allclose(across_i[:3], expected_i, rtol=1e-10)
    np.testing.assert_allclose(across_k[:3], expected_k, rtol=1e-10)
    assert not across_i[3].any()  # 0.4^4000
    assert not across_k[3].any()
    assert np.isfinite(i_sample(orders, [1e-6]).exponent).all()
    assert np.isfinite(k_sample(orders, [1e-6]).exponent).all()


@pytest.mark.parametrize("z", [0.0, -1.0, 3j, np.nan])
def test_the_left_half_plane_is_refused(z: complex) -> None:
    for sample in (i_sample, k_sample):
        with pytest.raises(ValueError, match="Re z > 0"):
            sample(np.array([0, 3]), z)
