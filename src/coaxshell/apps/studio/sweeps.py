"""Sweeps from the page: the same points, metrics and labels as ``coaxshell.sweep``, solved in a worker with what it has at hand."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from coaxshell.apps.studio import limits, worker
from coaxshell.errors import InputError
from coaxshell.model import System
from coaxshell.model.base import shown
from coaxshell.model.naming import suggestion
from coaxshell.numerics.late import xarray as xr
from coaxshell.numerics.netcdf import write_netcdf
from coaxshell.response import Response
from coaxshell.solver.settings import Settings
from coaxshell.studies.design import Design, design_of
from coaxshell.studies.evaluation import Outcome, evaluated, failure
from coaxshell.studies.labelled import FAILURE, WARNINGS, labelled
from coaxshell.studies.metrics import Metric, metric_names, metrics_of
from coaxshell.studies.varied_fields import varied

METRICS = ["inner.peak_stress", "outer.peak_stress"]


def planned(
    system: System, settings: Settings, over: Any, metrics: Any, points: str, samples: int | None, seed: int
) -> tuple[Design, tuple[Metric, ...]]:
    """Return points and metrics of a sweep.

    Raises
    ------
    InputError
        As ``coaxshell.sweep``; also too many cases, and metrics that are functions in a file, which a page must not run.
    """
    if not isinstance(over, dict) or len(over) > limits.SWEPT:
        raise InputError("over", f"{shown(over)} is not allowed", f"give a table of 1 to {limits.SWEPT} paths and their values")
    for path, given in over.items():
        if isinstance(given, dict) and "step" in given:  # its count is known only once all its values are there
            raise InputError(f"over.{path}.step", "is not taken here", "give from, to and count")
        limits.check_path("over", path)
        limits.check_values(f"over.{path}", given)
        count = len(given) if isinstance(given, list) else given.get("count", 2) if isinstance(given, dict) else 1
        if not isinstance(count, int) or count > limits.CASES:
            raise InputError(f"over.{path}", f"{shown(count)} values are not allowed here", f"give a whole number, at most {limits.CASES}")
    if samples is not None and samples > limits.CASES:
        raise InputError("samples", f"{samples} are too many here", f"at most {limits.CASES}")
    known = metric_names(system, settings.dimensions)
    if not isinstance(metrics, list) or len(metrics) > len(known):
        raise InputError("metrics", f"{shown(metrics)} is not allowed", "give a list of names such as inner.peak_stress")
    for number, name in enumerate(metrics):
        if name not in known:
            raise InputError(f"metrics[{number}]", f"{shown(name)} is not a metric of this system", suggestion(str(name), known))
    design = design_of(system, over, points, samples, seed)
    for field, values in zip(design.fields, design.values, strict=True):
        if field.integer:
            limits.check_counts(f"over.{field.path}", max(values))
    cases = int(np.prod(design.shape))
    if cases > limits.CASES:
        raise InputError("over", f"{cases} cases are too many here", f"at most {limits.CASES}; coaxshell sweep takes more")
    return design, metrics_of(metrics, system)


def sweep(system: System, settings: Settings, design: Design, metrics: tuple[Metric, ...], path: Path) -> dict[str, Any]:
    """Carry out a sweep, write its dataset to a NetCDF file, and return it as plain data."""
    outcomes, cases = [], design.cases
    for number, changes in enumerate(cases):
        with worker.part(number, len(cases), f"case {number + 1} of {len(cases)}"):
            outcomes.append(_case(system, settings, changes, metrics))
    dataset = labelled(system, design, metrics, settings, outcomes)
    write_netcdf(dataset, path)
    return told(dataset, metrics)


def _case(system: System, settings: Settings, changes: dict[str, Any], metrics: tuple[Metric, ...]) -> Outcome:
    def solved(case: System) -> Response:
        limits.check_system(case)
        limits.check_cost(case, settings, live=False)
        return worker.answer(case, settings)

    try:
        return evaluated(varied(system, changes), metrics, solved)
    except InputError as error:
        return failure(metrics, str(error))


def told(dataset: xr.Dataset, metrics: tuple[Metric, ...]) -> dict[str, Any]:
    """Return the dataset of a sweep as plain data, failed cases as None."""
    reasons = np.asarray(dataset[FAILURE]).ravel()
    return {
        "dims": [str(dim) for dim in dataset[metrics[0].name].dims],
        "coordinates": [
            {"name": str(name), "unit": values.attrs["units"], "label": values.attrs["long_name"], "values": values.values.tolist()}
            for name, values in dataset.coords.items()
        ],
        "metrics": [
            {"name": metric.name, "unit": metric.units, "label": metric.long_name, "values": _plain(dataset[metric.name].values.tolist())}
            for metric in metrics
        ],
        "failures": [{"case": number, "reason": str(reason)} for number, reason in enumerate(reasons) if reason],
        "warnings": sorted({text for text in np.asarray(dataset[WARNINGS]).ravel() if text}),
    }


def _plain(values: Any) -> Any:
    if isinstance(values, list):
        return [_plain(value) for value in values]
    return values if np.isfinite(values) else None
