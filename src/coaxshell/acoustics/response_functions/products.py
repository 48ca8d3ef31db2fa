"""Matrix products cut into slices that BLAS computes in one thread.

There are thousands of small products here. Shared out over threads, each waits for the slowest; on a busy machine that cost
five times the whole computation.
"""

from __future__ import annotations

import numpy as np

from coaxshell.numerics.arrays import FloatArray

_ONE_THREAD = 250_000  # OpenBLAS goes to several threads above 2^18 multiplications


def product(left: FloatArray, right: FloatArray) -> FloatArray:
    """Return left @ right."""
    height = max(1, _ONE_THREAD // max(1, right.size))
    whole = left.shape[0] // height * height
    result = np.empty((left.shape[0], right.shape[1]))
    if whole:
        slices = left[:whole].reshape(-1, height, left.shape[1])
        np.matmul(slices, right, out=result[:whole].reshape(-1, height, right.shape[1]))
    if whole < left.shape[0]:
        result[whole:] = left[whole:] @ right
    return result
