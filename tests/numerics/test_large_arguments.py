"""Bessel functions of large arguments by Hankel's expansions, against the recurrences through all orders and 30-digit arithmetic."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest

from coaxshell.numerics.large_arguments import LargeArguments
from coaxshell.numerics.radial_functions import RadialFunctions, i_across, k_across

SAMPLE = np.array([0.0, 1.0, 7.0, 30.0, 60.0])
KAPPA = np.array([900.0 + 0.0j, 3.0 + 905.0j, 3.0 - 905.0j, 400.0 + 1200.0j, 2.0 + 4e4j])


def functions(radius: float, *, sparse: bool) -> RadialFunctions:
    return RadialFunctions(KAPPA, radius, SAMPLE if sparse else np.arange(61.0), sparse)


def test_a_sample_is_what_the_recurrences_have() -> None:
    """Slopes and quotients of two radii; that of I at three digits less, whose recurrence starts from a difference of exponentials."""
    (inner, outer), (a, b) = ([functions(radius, sparse=sparse) for radius in (0.6, 0.65)] for sparse in (True, False))
    kept = SAMPLE.astype(int)
    assert inner.large is not None
    assert a.large is None
    for name, digits in (("i_slope", 1e-12), ("k_slope", 1e-14)):
        np.testing.assert_allclose(getattr(inner, name), getattr(a, name)[kept], rtol=digits)
    np.testing.assert_allclose(i_across(inner, outer), i_across(a, b)[kept], rtol=1e-12)
    np.testing.assert_allclose(k_across(inner, outer), k_across(a, b)[kept], rtol=1e-13)


def test_slopes_to_30_digits() -> None:
    found = functions(0.6, sparse=True)
    with mpmath.workdps(30):
        for row, order in enumerate(SAMPLE.astype(int)):
            z = mpmath.mpc(complex(found.argument[1]))
            i_slope = z * (mpmath.besseli(order + 1, z) / mpmath.besseli(order, z)) + order
            k_slope = order - z * (mpmath.besselk(order + 1, z) / mpmath.besselk(order, z))
            np.testing.assert_allclose(found.i_slope[row, 1], complex(i_slope), rtol=1e-14)
            np.testing.assert_allclose(found.k_slope[row, 1], complex(k_slope), rtol=1e-14)


@pytest.mark.parametrize(("argument", "orders"), [(29.0, SAMPLE[:1]), (449.0, SAMPLE)])
def test_arguments_that_are_not_large_beside_their_orders_are_left_to_recurrences(argument: float, orders: np.ndarray) -> None:
    assert LargeArguments.of(orders, np.array([argument + 0.0j])) is None
    assert LargeArguments.of(orders, np.array([argument + 2.0 + 0.0j])) is not None
