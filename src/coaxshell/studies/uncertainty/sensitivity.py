"""Sensitivity and robustness: what uncertain properties make of the metrics of a system."""

from __future__ import annotations

import json
import warnings
from collections.abc import Mapping, Sequence
from typing import Any, Unpack

import numpy as np

from coaxshell.errors import PhysicsWarning
from coaxshell.model.loading import SystemLike, as_system
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.keywords import showing
from coaxshell.numerics.late import xarray as xr
from coaxshell.solver.settings import Settings
from coaxshell.studies.evaluation import Outcome
from coaxshell.studies.execution import Execution, StudyKeywords, asked
from coaxshell.studies.labelled import CASE, failures_text, labelled
from coaxshell.studies.metrics import Metrics, metrics_of
from coaxshell.studies.running import run_study
from coaxshell.studies.uncertainty.plan import Plan, plan_of
from coaxshell.studies.uncertainty.statistics import STATISTICS, indices_with_intervals, statistics_with_intervals

RUNS = "runs."
"""Before the name of a metric: its value in every run."""
FIRST, TOTAL = "first_order", "total_order"
ESTIMATES = ("value", "low", "high")


@showing(StudyKeywords, Settings, Execution)
def sensitivity(
    system: SystemLike,
    over: Mapping[str, Any],
    metrics: Metrics = ("inner.peak_stress", "outer.peak_stress"),
    *,
    samples: int = 256,
    seed: int = 0,
    confidence: float = 0.95,
    **keywords: Unpack[StudyKeywords],
) -> xr.Dataset:
    """Return how much of the variance of each metric each uncertain property is the cause of, and the statistics of the metrics.

    Sobol indices from ``samples * (properties + 2)`` runs. If any run fails there are no indices and no statistics, since leaving it
    out would bias them: all failures are told in one warning, and the values of the other runs are in the answer.

    Parameters
    ----------
    system : System
        The nominal one.
    over : mapping of dotted path to distribution
        Two or more: ``{"source.distance": Normal("5 m", "0.2 m"), "absorbers.mass": {"relative": 0.1}, "absorbers.damping": [1e5, 1e6]}``;
        see :func:`coaxshell.studies.uncertainty.laws.law_of`. Independent of each other.
    metrics : sequence, or mapping of name to metric
        As those of :func:`coaxshell.sweep`.
    samples : int
        Base points, a power of two.
    seed : int
        Makes points and intervals repeatable.
    confidence : float
        Of the intervals, which are bootstrapped.
    duration, time_step, modes, tolerance, refinement, engine, dimensions, stations, axial_modes, axial_period
        As those of :func:`coaxshell.simulate`.
    executor, workers, store, resume, progress, dask, settings, execution
        As those of :func:`coaxshell.sweep`.

    Returns
    -------
    Dataset
        ``first_order`` and ``total_order``, dims (metric, field, estimate); each metric by its name, dims (statistic, estimate) with
        the statistics mean, deviation, p5, p50, p95; ``runs.NAME``, dims (case,), its value in every run. Estimates are value, low
        and high: the interval says how far the number of samples leaves it open.

    Raises
    ------
    InputError
        Anything wrong with the study, before its first run; see :func:`coaxshell.studies.uncertainty.plan.plan_of`.
    """
    system = as_system(system)
    resolution, execution = asked(system, keywords)
    plan = plan_of(system, over, metrics_of(metrics, system), resolution, (samples, seed, confidence), indices=True, where="over")
    return uncertainty_of(plan, execution)


@showing(StudyKeywords, Settings, Execution)
def robustness(
    system: SystemLike,
    uncertain: Mapping[str, Any],
    metrics: Metrics = ("inner.peak_stress", "outer.peak_stress"),
    *,
    samples: int = 128,
    seed: int = 0,
    confidence: float = 0.95,
    **keywords: Unpack[StudyKeywords],
) -> xr.Dataset:
    """Return mean, standard deviation and percentiles of the metrics of a system whose properties are uncertain.

    From *samples* runs at scrambled Sobol points, the same for every system at one seed, so that two designs are compared under the
    same conditions. Failed runs are treated as by :func:`sensitivity`.

    Parameters
    ----------
    system : System
        The nominal one.
    uncertain : mapping of dotted path to distribution
        One or more; see :func:`sensitivity`.
    samples : int
        Runs; a power of two keeps the balance of the points.
    metrics, seed, confidence, and all others
        As those of :func:`sensitivity`.

    Returns
    -------
    Dataset
        As that of :func:`sensitivity`, without indices.

    Raises
    ------
    InputError
        Anything wrong with the study, before its first run.
    """
    system = as_system(system)
    resolution, execution = asked(system, keywords)
    plan = plan_of(system, uncertain, metrics_of(metrics, system), resolution, (samples, seed, confidence), indices=False)
    return uncertainty_of(plan, execution)


def uncertainty_of(plan: Plan, execution: Execution) -> xr.Dataset:
    """Return the dataset of a study whose parts have been checked; see :func:`sensitivity` and :func:`robustness`."""
    outcomes = run_study(plan.systems, plan.metrics, plan.resolution, execution, plan.parts)
    message = failures_text(outcomes)
    if message:
        wanted = "indices and statistics" if plan.indices else "statistics"
        remedy = f"there are no {wanted}, which the other runs alone would bias: narrow the distributions, or resume if it was an accident"
        warnings.warn(f"{message}; {remedy}", PhysicsWarning, stacklevel=3)
    return _labelled(plan, outcomes)


def _labelled(plan: Plan, outcomes: Sequence[Outcome]) -> xr.Dataset:
    runs = labelled(plan.system, plan.design, plan.metrics, plan.resolution, outcomes)
    found = runs.rename({metric.name: f"{RUNS}{metric.name}" for metric in plan.metrics})
    found = found.assign_coords(estimate=list(ESTIMATES), statistic=list(STATISTICS))
    for metric in plan.metrics:
        values = _shaped(runs, metric.name, plan)[:2].ravel()
        table = statistics_with_intervals(values, plan.confidence, plan.seed)
        found[metric.name] = (("statistic", "estimate"), table, dict(runs[metric.name].attrs))
    found.attrs |= {
        "title": f"{'sensitivity' if plan.indices else 'robustness'} of {plan.system.name or 'a system'} to {', '.join(plan.paths)}",
        "points": "Saltelli's blocks of scrambled Sobol points" if plan.indices else "scrambled Sobol points",
        "samples": plan.samples,
        "seed": plan.seed,
        "confidence": float(plan.confidence),
        "uncertain": json.dumps(plan.parts["uncertain"]),
    }
    return _with_indices(plan, runs, found) if plan.indices else found


def _with_indices(plan: Plan, runs: xr.Dataset, found: xr.Dataset) -> xr.Dataset:
    pairs = [indices_with_intervals(_shaped(runs, metric.name, plan), plan.confidence, plan.seed) for metric in plan.metrics]
    found = found.assign_coords(metric=[metric.name for metric in plan.metrics], field=plan.paths)
    block = ["A", "B", *(f"A with {path} of B" for path in plan.paths)]
    found = found.assign_coords(block=(CASE, np.repeat(np.array(block, dtype=object), plan.samples)))
    for name, order, number in ((FIRST, "alone", 0), (TOTAL, "alone and with others", 1)):
        attributes = {"units": "1", "long_name": f"share of the variance of a metric that a field causes {order}"}
        found[name] = (("metric", "field", "estimate"), np.stack([pair[number] for pair in pairs]), attributes)
    return found


def _shaped(runs: xr.Dataset, name: str, plan: Plan) -> FloatArray:
    """Return the values of a metric, shape (blocks, samples)."""
    values: FloatArray = runs[name].to_numpy().reshape(-1, plan.samples)
    return values
