"""What ``--json`` prints: one document on stdout, in SI, with the units beside it; everything else goes to stderr."""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    import xarray as xr

    from coaxshell.response.summary import Summary

JsonOption = Annotated[bool, typer.Option("--json", help="Print one JSON document for programs instead of a table.")]


def print_document(content: Mapping[str, Any]) -> None:
    """Print plain data as one JSON document; what is not finite becomes null."""
    sys.stdout.write(json.dumps(_plain(content), indent=2, ensure_ascii=False, allow_nan=False) + "\n")
    sys.stdout.flush()


def _plain(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {str(key): _plain(one) for key, one in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(one) for one in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


def runs_document(named: Mapping[str, Summary]) -> dict[str, Any]:
    """Return the summaries of named runs, with the units of their fields."""
    from coaxshell.response.quantities import summary_rows

    units = {key: unit for key, _, unit in summary_rows()} | {"segment": "m", "actuator_limit": "V"}
    units |= {
        "absorber_displacement": "m",
        "absorber_force": "N/m",
        "window": "a/c_e",
        "time": "a/c_e",
        "angle": "deg",
        "transit_time": "s",
    }
    return {"runs": [{"name": name, **summary.to_dict()} for name, summary in named.items()], "units": units}


def cases_document(dataset: xr.Dataset) -> dict[str, Any]:
    """Return a sweep case by case: fields, metrics, why it failed, its warnings; with the units of fields and metrics."""
    frame = dataset.to_dataframe().reset_index()
    names = [str(name) for name in frame.columns]
    columns = [frame[name].tolist() for name in names]
    units = {name: str(dataset[name].attrs["units"]) for name in names if "units" in dataset[name].attrs}
    return {"cases": [dict(zip(names, row, strict=True)) for row in zip(*columns, strict=True)], "units": units}


def statistics_document(dataset: xr.Dataset) -> dict[str, Any]:
    """Return the statistics of uncertain metrics and their indices, each as (value, low, high) of its interval."""
    from coaxshell.studies.labelled import FAILURE
    from coaxshell.studies.uncertainty.table import told

    metrics: Sequence[str] = json.loads(dataset.attrs["metrics"])
    found: dict[str, Any] = {"runs": int(dataset[FAILURE].size), "failed": int((dataset[FAILURE] != "").sum())}
    found |= {"confidence": float(dataset.attrs["confidence"]), "statistics": {}, "units": {}}
    if not told(dataset):
        return found
    for name in metrics:
        found["units"][name] = str(dataset[name].attrs.get("units", ""))
        found["statistics"][name] = {str(one): dataset[name].sel(statistic=one).values.tolist() for one in dataset["statistic"].values}
    for order in ("first_order", "total_order"):
        if order in dataset:
            fields = dataset["field"].values
            found[order] = {n: {str(f): dataset[order].sel(metric=n, field=f).values.tolist() for f in fields} for n in metrics}
    return found
