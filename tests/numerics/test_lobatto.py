"""Gauss-Lobatto points against polynomials, which they integrate, differentiate and interpolate exactly."""

from __future__ import annotations

import numpy as np
import pytest

from coaxshell.numerics.lobatto import interpolation, lobatto


@pytest.mark.parametrize("degree", [1, 2, 3, 8, 31])
def test_polynomials_are_integrated_and_differentiated_exactly(degree):
    rule = lobatto(degree)
    assert rule.points[0] == -1.0
    assert rule.points[-1] == 1.0
    for power in range(2 * degree):
        exact = 0.0 if power % 2 else 2.0 / (power + 1)
        np.testing.assert_allclose(rule.weights @ rule.points**power, exact, atol=3e-14)
    slope = degree * rule.points ** (degree - 1)
    np.testing.assert_allclose(rule.derivative @ rule.points**degree, slope, atol=1e-11)


@pytest.mark.parametrize("at", [-1.0, -0.3, 0.0, 0.77, 1.0])
def test_polynomials_are_interpolated_exactly(at):
    for degree in (1, 4, 13):
        points = lobatto(degree).points
        np.testing.assert_allclose(interpolation(degree, at) @ points**degree, at**degree, atol=1e-13)
