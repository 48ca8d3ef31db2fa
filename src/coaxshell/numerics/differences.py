"""Derivatives of samples in time, and what one does along another."""

from __future__ import annotations

import numpy as np

from coaxshell.numerics.arrays import FloatArray


def time_derivative(values: FloatArray, step: float) -> FloatArray:
    """Return the derivative along the last axis by differences of fourth order, one-sided at both ends.

    Parameters
    ----------
    values : ndarray, shape (..., T)
        T >= 5, which the settings guarantee.
    step : float
    """
    f = values
    rate = np.empty_like(f)
    rate[..., 2:-2] = f[..., :-4] - 8 * f[..., 1:-3] + 8 * f[..., 3:-1] - f[..., 4:]
    first, second = np.array([-25.0, 48.0, -36.0, 16.0, -3.0]), np.array([-3.0, -10.0, 18.0, -6.0, 1.0])
    rate[..., 0], rate[..., 1] = f[..., :5] @ first, f[..., :5] @ second
    rate[..., -1], rate[..., -2] = -(f[..., :-6:-1] @ first), -(f[..., :-6:-1] @ second)
    rate /= 12.0 * step
    return rate


def work_along(force: FloatArray, way: FloatArray) -> FloatArray:
    """Return the integral of force d(way) along the last axis by trapezoids, where both jump together too.

    It is exact of a force in proportion to the way, however few samples a jump has: no rate is taken there.

    Parameters
    ----------
    force, way : ndarray, shape (..., T)

    Returns
    -------
    ndarray, shape (...)
    """
    return np.asarray(np.einsum("...t,...t->...", 0.5 * (force[..., 1:] + force[..., :-1]), np.diff(way)))
