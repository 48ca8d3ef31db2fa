"""Statistics of a sample of runs, each with an interval that tells how far the sample's size leaves it open."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.stats import bootstrap

from coaxshell.numerics.arrays import FloatArray

RESAMPLES = 999


def _percentile(share: float) -> Callable[[FloatArray], FloatArray]:
    return lambda values: np.asarray(np.quantile(values, share, axis=-1))


STATISTICS: dict[str, Callable[[FloatArray], FloatArray]] = {
    "mean": lambda values: np.mean(values, axis=-1),
    "deviation": lambda values: np.std(values, axis=-1, ddof=1),
    "p5": _percentile(0.05),
    "p50": _percentile(0.50),
    "p95": _percentile(0.95),
}
"""Mean, standard deviation, percentiles; of values (..., samples)."""
ROBUST = (*STATISTICS, "worst")
"""Names of the statistics that an objective may ask for."""


def statistic(name: str, values: FloatArray) -> float:
    """Return a statistic of a sample by its name; "worst" is the largest value."""
    return float(np.max(values) if name == "worst" else STATISTICS[name](values))


def statistics_with_intervals(values: FloatArray, confidence: float, seed: int) -> FloatArray:
    """Return every statistic of :data:`STATISTICS` with the ends of its confidence interval.

    The interval is that of the percentile bootstrap (B. Efron, R. J. Tibshirani, An Introduction to the Bootstrap, 1993, ch. 13),
    which takes the runs for independent draws. Scrambled Sobol points are more even than that: for the mean it is an upper estimate.

    Parameters
    ----------
    values : ndarray, shape (samples,)
    confidence : float
    seed : int

    Returns
    -------
    ndarray, shape (statistics, 3)
        Value, lower end, upper end; NaN where a value is.
    """
    if not np.isfinite(values).all():
        return np.full((len(STATISTICS), 3), np.nan)

    def all_of(sample: FloatArray, axis: int = -1) -> FloatArray:
        return np.stack([one(np.moveaxis(sample, axis, -1)) for one in STATISTICS.values()])

    found = bootstrap(
        (values,),
        all_of,
        n_resamples=RESAMPLES,
        batch=100,
        vectorized=True,
        confidence_level=confidence,
        method="percentile",
        rng=np.random.default_rng([seed, 1]),
    )
    interval = found.confidence_interval
    return np.column_stack([all_of(values), interval.low, interval.high])
