"""Statistics of a sample of runs, and Sobol indices: the share of a metric's variance that each uncertain property is the cause of, alone
and with the others. Each comes with an interval that tells how far the sample's size leaves it open.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.late import stats
from coaxshell.studies.uncertainty.distributions import unit_points

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

    found = stats.bootstrap(
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


NOTHING = 1e-12
"""A metric whose standard deviation is less than this share of its mean does not vary: it has no indices."""


def blocks(dimensions: int, samples: int, seed: int) -> FloatArray:
    """Return Saltelli's points: A, B, and for every coordinate i the points of A with coordinate i from B.

    A and B are the two halves of scrambled Sobol points of twice the dimensions: A. Saltelli et al., Comput. Phys. Commun. 181
    (2010) 259-270, section 5.

    Returns
    -------
    ndarray, shape (dimensions + 2, samples, dimensions)
    """
    both = unit_points(2 * dimensions, samples, seed)
    a, b = both[:, :dimensions], both[:, dimensions:]
    mixed = [np.where(np.arange(dimensions) == i, b, a) for i in range(dimensions)]
    return np.stack([a, b, *mixed])


def indices_with_intervals(values: FloatArray, confidence: float, seed: int) -> tuple[FloatArray, FloatArray]:
    """Return first- and total-order indices with the ends of their confidence intervals.

    S_i = V[E(Y | x_i)]/V[Y] and S_Ti = 1 - V[E(Y | all but x_i)]/V[Y], by the estimators of Saltelli et al. (2010), Table 2 (b)
    and (f), as :func:`scipy.stats.sobol_indices` has them; intervals by the percentile bootstrap over the base points.

    Parameters
    ----------
    values : ndarray, shape (dimensions + 2, samples)
        Of one metric, in the order of :func:`blocks`; *samples* a power of two, *dimensions* 2 or more.
    confidence : float
    seed : int

    Returns
    -------
    tuple of two ndarrays, each of shape (dimensions, 3)
        Value, lower end, upper end; NaN where a run has failed or nothing varies.
    """
    dimensions, samples = values.shape[0] - 2, values.shape[1]
    base = values[:2]
    if not np.isfinite(values).all() or float(np.std(base)) <= NOTHING * abs(float(np.mean(base))):
        nothing = np.full((dimensions, 3), np.nan)
        return nothing, nothing.copy()

    def both(chosen: npt.NDArray[np.int64]) -> FloatArray:
        at: FloatArray = values[:, chosen]
        found: Any = stats.sobol_indices(func={"f_A": at[None, 0], "f_B": at[None, 1], "f_AB": at[2:, None]}, n=samples)
        return np.stack([found.first_order, found.total_order])

    numbers = np.arange(samples)
    ends = stats.bootstrap(
        (numbers,),
        both,
        n_resamples=RESAMPLES,
        vectorized=False,
        confidence_level=confidence,
        method="percentile",
        rng=np.random.default_rng([seed, 2]),
    ).confidence_interval
    first, total = np.stack([both(numbers), ends.low, ends.high], axis=-1)
    return first, total
