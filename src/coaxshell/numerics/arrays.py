"""The two kinds of array that numbers travel in, and the product of a real matrix with either."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]


def real_product(matrix: FloatArray, values: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Return matrix @ values, (n,) or (n, k): of complex values, by the real matrix, at half the cost of a complex product."""
    if values.ndim < 2 or not np.iscomplexobj(values):
        return np.asarray(matrix @ values)
    return np.asarray((matrix @ np.ascontiguousarray(values).view(np.float64)).view(values.dtype))
