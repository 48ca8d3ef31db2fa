"""Sums of circumferential orders at given angles, by a cosine matrix, and their mean squares.

A modal array has the shape (parities, M + 1, T): parity 0 multiplies cos(m theta), parity 1 (absent when it vanishes) sin(m theta).
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import numpy.typing as npt
import scipy.special

from coaxshell.numerics.arrays import FloatArray

BLOCK = 2**20
"""Values of one block of a field on the circle: 8 MiB, which stays in a processor's cache or near it."""


def angle_basis(angle: npt.ArrayLike, orders: int, parities: int, component: str = "normal") -> FloatArray:
    """Return the value of every order at every angle, exact at multiples of 90 degrees.

    Parameters
    ----------
    angle : array_like, shape (A,)
        Degrees from the source direction.
    orders : int
        M + 1, the number of orders from 0.
    parities : int
        1 (symmetric) or 2.
    component : str
        "normal": cos(m theta) and sin(m theta); "tangential": sin(m theta) and -cos(m theta).

    Returns
    -------
    ndarray, shape (A, parities, M + 1)
    """
    # Degrees are reduced before they become radians: m theta is exact there, and head and tail are exactly +-1.
    phase = np.mod(np.multiply.outer(np.asarray(angle, dtype=np.float64), np.arange(orders)), 360.0)
    cos, sin = scipy.special.cosdg(phase), scipy.special.sindg(phase)
    pair = (cos, sin) if component == "normal" else (sin, -cos)
    return np.stack(pair[:parities], axis=1)


def at_angles(modal: FloatArray, basis: FloatArray) -> FloatArray:
    """Return the sum of all orders at the angles of a basis.

    Parameters
    ----------
    modal : ndarray, shape (parities, M + 1, T)
    basis : ndarray, shape (A, parities, M + 1)
        From :func:`angle_basis`, possibly times a factor for each order.

    Returns
    -------
    ndarray, shape (T, A)
    """
    times = modal.shape[-1]
    return np.asarray((basis.reshape(len(basis), -1) @ modal.reshape(-1, times)).T, dtype=np.float64)


def mean_square(modal: FloatArray) -> FloatArray:
    """Return the mean square over the circle by Parseval: c_0^2 + (1/2) sum over m >= 1 of (c_m^2 + s_m^2).

    Parameters
    ----------
    modal : ndarray, shape (parities, M + 1, T)

    Returns
    -------
    ndarray, shape (T,)
    """
    weight = np.full(modal.shape[:2], 0.5)
    weight[0, 0], weight[1:, 0] = 1.0, 0.0  # order 0 has no sine
    return np.asarray(np.einsum("hm,hmt,hmt->t", weight, modal, modal), dtype=np.float64)


def time_blocks(window: slice, width: int) -> Iterator[slice]:
    """Yield consecutive slices of a window of time indices, each of about BLOCK values at *width* values an instant."""
    step = max(1, BLOCK // max(1, width))
    for start in range(window.start, window.stop, step):
        yield slice(start, min(start + step, window.stop))
