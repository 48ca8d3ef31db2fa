"""The outcomes of a sweep as one labelled dataset, as CSV with units in its header, and in words: extremes of the metrics, failures."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from coaxshell._version import __version__
from coaxshell.model.system import System
from coaxshell.numerics.files import write_text
from coaxshell.numerics.identity import numerics
from coaxshell.numerics.late import xarray as xr
from coaxshell.response.summary_text import aligned
from coaxshell.solver.settings import Settings
from coaxshell.studies.design import Design
from coaxshell.studies.evaluation import Outcome
from coaxshell.studies.metrics import Metric
from coaxshell.studies.varied_fields import Field

CASE = "case"
FAILURE, WARNINGS = "failure", "physics_warnings"


def labelled(system: System, design: Design, metrics: Sequence[Metric], resolution: Settings, outcomes: Sequence[Outcome]) -> xr.Dataset:
    """Return one variable a metric, one coordinate a varied field, both with units; failed cases are NaN, ``failure`` says why.

    The dimensions are the paths for a grid, else ``case``; a field spread by its logarithm says ``scale = "log"``. The dataset holds
    nothing of when or by whom it was computed: the same study gives an identical one.
    """
    shape = design.shape
    grid = design.points == "grid"
    dims = tuple(field.path for field in design.fields) if grid else (CASE,)
    coordinates = {
        field.path: xr.Variable((field.path,) if grid else (CASE,), _column(values), _told(field, scale))
        for field, values, scale in zip(design.fields, design.values, design.scales, strict=True)
    }
    variables: dict[str, xr.Variable] = {}
    table = np.array([outcome.values for outcome in outcomes], dtype=np.float64)
    for metric, column in zip(metrics, table.T, strict=True):
        variables[metric.name] = xr.Variable(dims, column.reshape(shape), {"units": metric.units, "long_name": metric.long_name})
    for name, texts, long_name in (
        (FAILURE, [outcome.reason for outcome in outcomes], "why a case has no values; empty where it has"),
        (WARNINGS, ["; ".join(outcome.warnings) for outcome in outcomes], "physics warnings of a case"),
    ):
        variables[name] = xr.Variable(dims, np.array(texts, dtype=object).reshape(shape), {"long_name": long_name})
    attributes = {
        "title": f"sweep of {system.name or 'a system'} over {', '.join(field.path for field in design.fields)}",
        "source": f"coaxshell {__version__}",
        "numerics": numerics(),
        "scenario": system.to_toml_string(),
        "settings": json.dumps(resolution.arguments()),
        "points": design.points,
        "metrics": json.dumps([metric.name for metric in metrics]),
    }
    return xr.Dataset(variables, coordinates, attributes)


def _told(field: Field, scale: str) -> dict[str, str]:
    """Return what a coordinate says of itself; of its scale only where that is not linear."""
    return {"units": field.units, "long_name": field.long_name} | ({"scale": scale} if scale != "linear" else {})


def _column(values: Sequence[Any]) -> np.ndarray[Any, Any]:
    kinds = {type(value) for value in values}
    if kinds <= {float, int}:
        return np.array(values, dtype=np.int64 if kinds == {int} else np.float64)
    if kinds == {bool}:
        return np.array(values, dtype=bool)
    return np.array([value if isinstance(value, str) else repr(value) for value in values], dtype=object)


def failures_text(outcomes: Sequence[Outcome]) -> str:
    """Return what is to be said of the failed cases, alike ones together, in one sentence; "" if there are none."""
    groups: dict[str, list[int]] = {}
    for number, outcome in enumerate(outcomes):
        if outcome.failed:
            groups.setdefault(re.sub(r"[-+]?\d[\d.e+-]*", "#", outcome.reason), []).append(number)
    if not groups:
        return ""
    total = sum(len(numbers) for numbers in groups.values())
    parts = [f"{len(numbers)} like case {numbers[0]}: {outcomes[numbers[0]].reason}" for numbers in groups.values()]
    shown = parts[:5] + ([f"and {len(parts) - 5} other reasons"] if len(parts) > 5 else [])
    return f"{total} of {len(outcomes)} cases failed and are NaN, the variable {FAILURE!r} says why; {'; '.join(shown)}"


def write_csv(dataset: xr.Dataset, path: Path) -> None:
    """Write one line a case: the varied fields, the metrics, the reason of a failure; units in the header."""
    frame = dataset.drop_vars(WARNINGS).to_dataframe().reset_index()
    fields = [str(name) for name, coordinate in dataset.coords.items() if coordinate.ndim]
    metrics = [str(name) for name in dataset.data_vars if name not in (FAILURE, WARNINGS)]
    frame = frame[[*fields, *metrics, FAILURE]]
    units = {name: str(dataset[name].attrs.get("units", "")) for name in [*fields, *metrics]}
    headed = frame.rename(columns={name: f"{name} [{unit}]" for name, unit in units.items() if unit not in ("", "1")})
    write_text(path, headed.to_csv(index=False))


def best_cases(dataset: xr.Dataset) -> str:
    """Return an aligned table: the smallest and the largest value of every metric and where they are, and how many cases failed."""
    failed = int((dataset[FAILURE] != "").sum())
    warned = int((dataset[WARNINGS] != "").sum())
    rows: list[tuple[str, ...]] = [("metric", "", "value", "unit", "at")]
    for name in json.loads(dataset.attrs["metrics"]):
        values = dataset[name]
        if not bool(np.isfinite(values).any()):
            rows.append((name, "", "none", "", ""))
            continue
        for word, place in (("smallest", values.argmin(...)), ("largest", values.argmax(...))):
            found = values.isel(place)
            at = ", ".join(f"{key} = {_short(found[key].item())}" for key in found.coords)
            rows.append((name, word, f"{float(found):.6g}", str(values.attrs.get("units", "")), at))
    counted = f"{dataset[FAILURE].size} cases"
    counted += f", {failed} of them failed" if failed else ""
    counted += f"; {warned} carry physics warnings (variable {WARNINGS!r})" if warned else ""
    return "\n".join([counted, "", *aligned(rows, left=2)])


def _short(value: object) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)
