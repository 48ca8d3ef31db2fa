"""Ratios of modified Bessel functions against 50-digit arithmetic (reference/make_bessel_table.py), orders 0..2000, |z| 1e-3..1e5."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.special import iv, ive, kv, kve

from coaxshell.numerics import bessel_ratios as br

TABLE = Path(__file__).parents[1] / "reference" / "data" / "bessel_ratios.npz"
Z = np.array([0.3 + 0.1j, 2.0 - 5.0j, 40.0 + 0.0j, 1.0 + 90.0j])


@pytest.fixture(scope="module")
def table() -> dict[str, np.ndarray]:
    with np.load(TABLE) as stored:
        return dict(stored)


@pytest.mark.parametrize("top", [2, 20, 150, 300, 1000, 1999, 2000])
def test_i_ratios(table: dict[str, np.ndarray], top: int) -> None:
    # The start of the downward recurrence moves with the highest order; near the imaginary axis it is never forgotten.
    # Conditioning alone costs |z| eps = 2e-11 at |z| = 1e5; 5e-11 is measured there, 3e-12 up to |z| = 5000.
    kept, near = table["orders"] <= top, np.abs(table["z"]) < 6000
    found = br.i_ratios(top, table["z"])[table["orders"][kept]]
    np.testing.assert_allclose(found, table["i"][kept], rtol=1e-10)
    np.testing.assert_allclose(found[:, near], table["i"][kept][:, near], rtol=1e-11)


@pytest.mark.parametrize("top", [0, 1, 40, 150])
def test_the_start_is_carried_up_beside_the_axis_and_taken_from_i_itself_farther_from_it(top: int) -> None:
    # Carried up where m^2 Re(1/z) <= 3 and |z| >= m: on either side of both, against I_{m+1}/I_m, which is good to some 1e-13 itself.
    size = np.outer([0.8, 0.99, 1.0, 1.3, 4.0], [1.0, 1.01]).ravel() * max(top, 1)
    for share in (1e-4, 0.1, 1.0, 1.1, 4.0):
        z = np.minimum(3.0 * share * (size / max(top, 1)) ** 2, size) + 1j * size
        np.testing.assert_allclose(br.starting_ratio(top, z), ive(top + 1, z) / ive(top, z), rtol=1e-11)


@pytest.mark.parametrize("top", [2, 150, 2000])
def test_k_ratios(table: dict[str, np.ndarray], top: int) -> None:
    kept = table["orders"] <= top
    found = br.k_ratios(top, table["z"])[table["orders"][kept]]
    np.testing.assert_allclose(found, table["k"][kept], rtol=2e-14)


def test_the_table_covers_what_is_promised(table: dict[str, np.ndarray]) -> None:
    z = table["z"]
    assert abs(z).min() <= 1e-3
    assert abs(z).max() >= 1e5 * (1 - 1e-12)
    assert table["orders"].max() == 2000
    assert ((z.imag == 0) & (z.real > 0)).sum() >= 10
    assert ((z.real <= 3) & (abs(z) > 2000)).sum() >= 6


def test_where_a_naive_quotient_overflows() -> None:
    assert np.isinf(kve(150, 0.5))
    derivative = 150 / 0.5 - br.k_ratios(150, 0.5)[150, 0]  # K'/K = m/z - S_m
    np.testing.assert_allclose(1 / derivative, -0.00333331, rtol=2e-6)


def test_wronskian() -> None:
    # I_m K_{m+1} + I_{m+1} K_m = 1/z (DLMF 10.28.2), with I_m K_m from the ratios and the order 0.
    r, s = br.i_ratios(30, Z), br.k_ratios(30, Z)
    product = br.running_product(iv(0, Z) * kv(0, Z), r * s)
    np.testing.assert_allclose(product * (r + s) * Z, 1.0, rtol=1e-12)


def test_across_two_radii() -> None:
    za, zb = 0.4 * Z, Z
    across_i = br.i_across(br.i_ratios(12, za), br.i_ratios(12, zb), za, zb)
    across_k = br.k_across(br.k_ratios(12, za), br.k_ratios(12, zb), za, zb)
    for m in range(13):
        np.testing.assert_allclose(across_i[m], iv(m, za) / iv(m, zb), rtol=1e-11)
        np.testing.assert_allclose(across_k[m], kv(m, zb) / kv(m, za), rtol=1e-11)


def test_across_underflows_to_zero_at_high_order() -> None:
    za, zb = np.array([0.01 + 0.1j]), np.array([0.1 + 1.0j])
    across = br.i_across(br.i_ratios(2000, za), br.i_ratios(2000, zb), za, zb)
    assert np.isfinite(across).all()
    np.testing.assert_allclose(across[50], 0.1**50, rtol=0.02)
    assert across[2000] == 0


@pytest.mark.parametrize("z", [0.0, -1.0, 3j, [1.0, -2.0 + 1j], np.nan])
def test_the_left_half_plane_is_refused(z: object) -> None:
    for ratios in (br.i_ratios, br.k_ratios):
        with pytest.raises(ValueError, match="Re z > 0"):
            ratios(3, z)


def test_a_matrix_of_arguments_is_refused() -> None:
    with pytest.raises(ValueError, match=r"shape \(1, 2\)"):
        br.i_ratios(3, [[1.0, 2.0]])
