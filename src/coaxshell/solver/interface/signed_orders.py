"""Amplitudes of cos m theta and sin m theta as those of e^{i m theta}, m = -M..M, and back."""

from __future__ import annotations

import numpy as np

from coaxshell.numerics.arrays import ComplexArray


def signed_orders(parities: ComplexArray) -> ComplexArray:
    """Return amplitudes of e^{i m theta}, m = -M..M, shape (shells, 2M + 1, nodes), from those of cos and sin."""
    cosine = parities[:, 0]
    sine = parities[:, 1] if parities.shape[1] == 2 else np.zeros_like(cosine)
    positive, negative = 0.5 * (cosine - 1j * sine), 0.5 * (cosine + 1j * sine)
    return np.concatenate([negative[:, :0:-1], cosine[:, :1], positive[:, 1:]], axis=1)


def of_parities(signed: ComplexArray, count: int) -> ComplexArray:
    """Return amplitudes of cos, and of sin if ``count`` is 2, (shells, count, M + 1, nodes), from those of e^{i m theta}."""
    order = signed.shape[1] // 2
    positive, negative = signed[:, order:], signed[:, order::-1]
    cosine, sine = positive + negative, 1j * (positive - negative)
    cosine[:, 0] = signed[:, order]
    return np.stack([cosine, sine][:count], axis=1)
