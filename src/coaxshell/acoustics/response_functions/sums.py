"""Sums of undamped oscillations at many times."""

from __future__ import annotations

import numpy as np

from coaxshell.acoustics.response_functions.products import product
from coaxshell.numerics.arrays import FloatArray

_BLOCK = 2_000_000
_COHERENT = 1e5  # x t above which the rounding of t_i + t_j would show at fronts, where all terms are in phase


def is_uniform(times: FloatArray) -> bool:
    """Tell whether many times are equally spaced, to rounding."""
    if times.size < 64:
        return False
    even = np.linspace(times[0], times[-1], times.size)
    return bool(np.all(np.abs(times - even) <= 4e-16 * times.size * max(abs(float(times[-1])), abs(float(times[0])))))


def sines(x: FloatArray, weights: FloatArray, times: FloatArray, cosines: FloatArray | None = None) -> FloatArray:
    """Return sum_k w_k sin(x_k t) + c_k cos(x_k t) for several sets of weights (rows), shape (sets, times).

    Equally spaced times t_i + t_j cost products of small matrices.
    """
    if x.size == 0 or not (cheap_together(float(x[-1]), times) and is_uniform(times)):
        return _one_by_one(x, weights, times, cosines)
    columns = int(np.ceil(np.sqrt(times.size)))
    rows = -(-times.size // columns)
    step = (times[-1] - times[0]) / (times.size - 1)
    coarse = np.outer(times[0] + step * columns * np.arange(rows), x)
    fine = np.outer(x, step * np.arange(columns))
    sin, cos, sin_fine, cos_fine = np.sin(coarse), np.cos(coarse), np.sin(fine), np.cos(fine)
    result = np.empty((weights.shape[0], times.size))
    for row, w, c in zip(result, weights, np.zeros_like(weights) if cosines is None else cosines, strict=True):
        whole = product(sin * w + cos * c, cos_fine) + product(cos * w - sin * c, sin_fine)
        row[:] = whole.ravel()[: times.size]
    return result


def _one_by_one(x: FloatArray, weights: FloatArray, times: FloatArray, cosines: FloatArray | None) -> FloatArray:
    result = np.empty((weights.shape[0], times.size))
    size = max(1, _BLOCK // max(1, x.size))
    for start in range(0, times.size, size):
        phase = np.outer(x, times[start : start + size])
        part = np.einsum("sk,kt->st", weights, np.sin(phase))
        if cosines is not None:
            part += np.einsum("sk,kt->st", cosines, np.cos(phase))
        result[:, start : start + size] = part
    return result


def cheap_together(kappa: float, times: FloatArray) -> bool:
    """Tell whether equally spaced times are taken together for wavenumbers up to *kappa*."""
    return kappa * float(times[-1]) < _COHERENT
