"""Response functions of closed fluid regions: the sum over resonances, with what lies above it by contour."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import numpy.typing as npt

from coaxshell.acoustics.laplace_grid import WORKERS
from coaxshell.acoustics.response_functions.echoes import Response
from coaxshell.acoustics.response_functions.legs import legs, snapped
from coaxshell.acoustics.response_functions.levels import levels
from coaxshell.acoustics.response_functions.resonances import resonances
from coaxshell.acoustics.response_functions.shapes import expansion
from coaxshell.acoustics.response_functions.sums import cheap_together, is_uniform, sines
from coaxshell.numerics.arrays import FloatArray

_BLOCK = 24


def cavity(orders: npt.NDArray[np.int64], times: FloatArray, responses: Sequence[Response]) -> FloatArray:
    """Return the responses of one cavity at times >= 0 in units of the fluid's own sound speed, shape (responses, orders, times).

    Accurate to about 1e-11 of the largest value. Right-hand limits at jumps; large where a front has passed the centre an
    odd number of times, which makes it a logarithm.
    """
    for response in responses:
        times = snapped(times, response)
    result = np.empty((len(responses), orders.size, times.size))
    ranked = np.argsort(orders, kind="stable")
    blocks = [ranked[start : start + _BLOCK] for start in range(0, orders.size, _BLOCK)]
    with ThreadPoolExecutor(WORKERS) as pool:
        for block, values in zip(blocks, pool.map(lambda block: _block(orders[block], times, responses), blocks), strict=True):
            result[:, block] = values
    for row, response in zip(result, responses, strict=True):
        drive = -response.inner if response.driven_inside else response.outer
        row[orders == 0] += 2.0 * drive * times / (response.outer**2 - response.inner**2)
        if response.at == 0.0:
            row[orders > 0] = 0.0
    return result


def _block(orders: npt.NDArray[np.int64], times: FloatArray, responses: Sequence[Response]) -> FloatArray:
    result = np.empty((len(responses), orders.size, times.size))
    ladder = list(levels(int(orders[-1]), times, responses))
    found = resonances(orders, responses[0].inner, responses[0].outer, ladder[-1][0])
    weights = np.array([expansion(found, response) for response in responses])
    even = is_uniform(times)
    for kappa, chosen in ladder:
        wholly = even and 12 * chosen.size > times.size and cheap_together(kappa, times)
        kappas = np.empty(orders.size)
        for order, row in enumerate(found.rows):
            gaps = found.gaps[row]
            end = int(np.searchsorted(gaps, kappa))
            kappas[order] = gaps[end]
            used = slice(row.start, row.start + end + 1)
            values = sines(found.wavenumbers[used], weights[:, used], times if wholly else times[chosen])
            result[:, order, chosen] = values[:, chosen] if wholly else values
        result[:, :, chosen] += legs(orders, kappas, times[chosen], responses)
    return result
