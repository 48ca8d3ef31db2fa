"""The exterior response at the wall: sums of exponentials where they are tabulated, the contour integral beyond."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from coaxshell.acoustics.response_functions.exterior_field import exterior_field
from coaxshell.acoustics.response_functions.exterior_poles import Poles, tabulated
from coaxshell.numerics.arrays import FloatArray


def exterior_at_wall(orders: npt.NDArray[np.int64], times: FloatArray) -> FloatArray:
    """Return K_m/(s K_m') at r = 1 at times >= 0, shape (orders, times)."""
    table = tabulated()
    result = np.empty((orders.size, times.size))
    for row, order in enumerate(orders):
        if order < len(table):
            result[row] = _sum(table[int(order)], times)
    high = orders >= len(table)
    if np.any(high):
        result[high] = exterior_field(orders[high], times, 1.0)
    return result


def _sum(fit: Poles, times: FloatArray) -> FloatArray:
    waves = np.einsum("tp,p->t", np.exp(np.outer(times, fit.poles)), fit.weights)
    return np.asarray(waves.real - fit.weights.real.sum() - 1.0, dtype=np.float64)
