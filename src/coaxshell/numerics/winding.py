"""How far a complex function turns around zero along a contour: what the argument principle counts zeros by."""

from __future__ import annotations

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray


def turning(values: ComplexArray) -> FloatArray:
    """Return the sum of arg(f_{k+1}/f_k) over the nodes, each step taken as less than half a turn.

    It is the angle between the ends and a whole turn for every crossing of the negative real axis, so that only the ends take an
    arctangent.

    Parameters
    ----------
    values : ndarray, shape (orders, nodes)
        f, without zeros.

    Returns
    -------
    ndarray, shape (orders,)
        Radians.
    """
    below = values.imag < 0
    order, node = np.nonzero(below[:, 1:] != below[:, :-1])
    side = (values[order, node + 1] * values[order, node].conj()).imag  # its sign is that of the step's angle
    downward = below[order, node + 1]
    whole = (downward & (side > 0)).astype(float) - (~downward & (side < 0))
    first, last = np.angle(values[:, [0, -1]] + 0.0).T  # -0.0 becomes 0.0: a negative real number lies above
    return np.asarray(last - first + 2 * np.pi * np.bincount(order, whole, minlength=len(values)), dtype=np.float64)
