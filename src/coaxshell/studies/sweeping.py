"""Sweeps: a system at many points of some of its fields, read by some metrics."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from typing import Any, Unpack

from coaxshell.errors import InputError, PhysicsWarning
from coaxshell.model.loading import SystemLike, as_system
from coaxshell.model.system import System
from coaxshell.numerics.keywords import showing
from coaxshell.numerics.late import xarray as xr
from coaxshell.solver.settings import Settings
from coaxshell.studies.design import Design, Points, design_of
from coaxshell.studies.execution import Execution, StudyKeywords, asked
from coaxshell.studies.labelled import failures_text, labelled
from coaxshell.studies.metrics import Metric, Metrics, metrics_of
from coaxshell.studies.running import run_study
from coaxshell.studies.varied_fields import varied


@showing(StudyKeywords, Settings, Execution)
def sweep(
    system: SystemLike,
    over: Mapping[str, Any],
    metrics: Metrics = ("inner.peak_stress", "outer.peak_stress"),
    *,
    points: Points = "grid",
    samples: int | None = None,
    seed: int = 0,
    **keywords: Unpack[StudyKeywords],
) -> xr.Dataset:
    """Return metrics of a system at many points of some of its fields.

    Cases that differ only in their absorbers share their kernels, prepared once a worker. A case that fails is NaN, with its
    reason in the variable ``failure``, and all failures are told in one warning at the end.

    Parameters
    ----------
    system : System
        The base of all cases.
    over : mapping of dotted path to values
        See :func:`coaxshell.studies.design.design_of`: ``{"absorbers.count": range(51), "source.peak_pressure": ["10 kPa", "20 kPa"]}``.
    metrics : sequence, or mapping of name to metric
        Names such as ``inner.peak_stress`` (:mod:`coaxshell.studies.metrics`), and functions from a Response to a number.
    points : str
        "grid" (every combination), "zip" (lists side by side), "latin-hypercube" or "sobol" (*samples* points between two ends).
    samples, seed : int
        Number of sampled points, and what makes them repeatable.
    duration, time_step, modes, tolerance, refinement, engine, dimensions, stations, axial_modes, axial_period
        As those of :func:`coaxshell.simulate`.
    executor, workers, store, resume, progress, dask
        See :class:`coaxshell.Execution`: where the work is done, and where finished cases are kept.
    settings, execution : Settings, Execution, optional
        All of these at once; those given beside them change them.

    Returns
    -------
    Dataset
        One variable a metric, units and long names in the attributes; dims are the paths for a grid, else ``case``.

    Raises
    ------
    InputError
        Anything wrong with the study, before its first case; see :func:`coaxshell.studies.design.design_of`, ``metrics_of``.
    """
    system = as_system(system)
    resolution, execution = asked(system, keywords)
    design = design_of(system, over, points, samples, seed)
    return sweep_design(system, design, metrics_of(metrics, system), resolution, execution)


def sweep_design(system: System, design: Design, metrics: tuple[Metric, ...], resolution: Settings, execution: Execution) -> xr.Dataset:
    """Return the dataset of a sweep whose parts have been checked; see :func:`sweep`."""
    systems = [_case(system, changes) for changes in design.cases]
    outcomes = run_study(systems, metrics, resolution, execution, study_parts(system, design, metrics, resolution), where="over")
    message = failures_text(outcomes)
    if message:
        warnings.warn(message, PhysicsWarning, stacklevel=3)
    return labelled(system, design, metrics, resolution, outcomes)


def study_parts(system: System, design: Design, metrics: tuple[Metric, ...], resolution: Settings) -> dict[str, Any]:
    """Return what tells one sweep from another, as plain data by part."""
    over = {field.path: [repr(value) for value in values] for field, values in zip(design.fields, design.values, strict=True)}
    return {
        "scenario": system.canonical(),
        "points": [design.points, over],
        "metrics": {metric.name: metric.identity for metric in metrics},
        "resolution": resolution.arguments(),
    }


def _case(system: System, changes: Mapping[str, Any]) -> System | InputError:
    try:
        return varied(system, changes)
    except InputError as error:
        return error
