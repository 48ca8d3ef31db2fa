"""How well records tell what was looked for: intervals from the Jacobian, correlations, and what cannot be told from them.

With r the residuals in units of the noise, J their slopes in coordinates of one size each and x the answer,

    cov x = (J^T J)^{-1} (sum over records tau_i chi_i^2 J_i^T J_i) (J^T J)^{-1},

chi_i^2 = r_i^T r_i/(n_i - p n_i/n) what is left of a record, and tau_i = 1 + 2 sum rho_k the correlation time of what is left, in
samples: residuals that hang together say less than as many that do not (W. H. Greene, Econometric Analysis, ch. 9; A. Sokal, Monte Carlo
methods in statistical mechanics, 1996, sec. 3).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from coaxshell.numerics.arrays import FloatArray

LOOSE = 0.5
"""Standard deviation of a direction, in units of the size of what moves along it, above which it is not identified."""
POORLY = 0.95
"""Correlation above which two are told apart poorly."""
_SHARE = 0.25
_SMALLEST = 1e-12


@dataclass(frozen=True)
class Certainty:
    """What records tell of n unknowns.

    Attributes
    ----------
    deviation : ndarray, shape (n,)
        Standard deviations, in coordinates.
    correlation : ndarray, shape (n, n)
    factor : float
        Half width of an interval of the confidence asked for, in standard deviations.
    loose : list of list of (int, float)
        Directions that are not identified: numbers of the unknowns that move along each, and by how much.
    spread : ndarray, shape (records,)
        chi of each record.
    correlated : ndarray, shape (records,)
        tau of each record, samples.
    """

    deviation: FloatArray
    correlation: FloatArray
    factor: float
    loose: list[list[tuple[int, float]]]
    spread: FloatArray
    correlated: FloatArray


def certainty(jacobian: FloatArray, residual: FloatArray, rows: Sequence[slice], told: Sequence[bool], confidence: float) -> Certainty:
    """Return how certain an answer is.

    Parameters
    ----------
    jacobian : ndarray, shape (samples, n)
    residual : ndarray, shape (samples,)
    rows : sequence of slice
        Samples of each record.
    told : sequence of bool
        Whether the noise of each record was told: residuals smaller than it then shrink no interval.
    confidence : float
    """
    from scipy.stats import t

    samples, n = jacobian.shape
    correlated = np.array([correlation_time(residual[one]) for one in rows])
    square = np.array([float(residual[one] @ residual[one]) / max((one.stop - one.start) * (1.0 - n / samples), 1.0) for one in rows])
    spread = np.where(np.array(told), np.maximum(square, 1.0), square)
    left = np.zeros((n, n))
    for one, factor in zip(rows, spread * correlated, strict=True):
        left += factor * jacobian[one].T @ jacobian[one]
    _, singular, turned = np.linalg.svd(jacobian, full_matrices=False)
    largest = float(singular.max(initial=0.0)) or 1.0
    inverse = (turned.T / np.maximum(singular, _SMALLEST * largest) ** 2) @ turned
    covariance = inverse @ left @ inverse
    covariance = 0.5 * (covariance + covariance.T)
    deviation = np.sqrt(np.maximum(np.diag(covariance), 0.0))
    scale = np.where(deviation > 0.0, deviation, 1.0)
    degrees = max(1.0, float(sum((one.stop - one.start) / tau for one, tau in zip(rows, correlated, strict=True))) - n)
    return Certainty(
        deviation,
        np.clip(covariance / np.outer(scale, scale), -1.0, 1.0),
        float(t.ppf(0.5 + 0.5 * confidence, degrees)),
        _loose(covariance),
        np.sqrt(square),
        correlated,
    )


def correlation_time(residual: FloatArray) -> float:
    """Return tau = 1 + 2 sum_k rho_k up to the first autocorrelation that is not positive, in samples, at least 1."""
    x = residual - residual.mean()
    size = 1 << (2 * x.size - 1).bit_length()
    power = np.abs(np.fft.rfft(x, size)) ** 2
    sums = np.fft.irfft(power, size)[: x.size]
    if sums[0] <= 0.0:
        return 1.0
    shares = sums / sums[0]
    ends = np.flatnonzero(shares <= 0.0)
    last = int(ends[0]) if ends.size else shares.size
    return float(max(1.0, 1.0 + 2.0 * shares[1:last].sum()))


def _loose(covariance: FloatArray) -> list[list[tuple[int, float]]]:
    """Return the directions of the largest variances as long as they are not identified, the least certain first."""
    variances, directions = np.linalg.eigh(covariance)
    found = []
    for k in np.argsort(variances)[::-1]:
        if variances[k] <= LOOSE**2:
            break
        direction = directions[:, k]
        members = [int(i) for i in np.argsort(-np.abs(direction)) if abs(direction[i]) >= _SHARE * np.abs(direction).max()]
        found.append([(i, float(direction[i] / direction[members[0]])) for i in members])
    return found
