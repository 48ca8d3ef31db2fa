"""What commands print for programs: one document each, SI, names of the Python interface and of metrics, units beside them."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import xarray as xr

    from coaxshell.apps.paper.reproduction import Results
    from coaxshell.apps.verification import Report
    from coaxshell.response import Response
    from coaxshell.response.spatial_summary import SpatialSummary
    from coaxshell.response.summary import Summary


def runs_document(named: Mapping[str, Response], summaries: Sequence[Summary | SpatialSummary]) -> dict[str, Any]:
    """Return the summaries of named runs, each with its metrics, and the units of all fields; of two runs how their metrics compare."""
    from coaxshell.response.quantities import summary_rows
    from coaxshell.studies.metrics import metrics_of, summary_metrics

    runs: list[dict[str, Any]] = []
    metric_units: dict[str, str] = {}
    for (name, response), summary in zip(named.items(), summaries, strict=True):
        metrics = summary_metrics(summary, response.system)
        metric_units |= {metric.name: metric.units for metric in metrics_of(list(metrics), response.system)} if metrics else {}
        runs.append({"name": name, **summary.to_dict(), "metrics": metrics})
    dimensions = max((run["settings"].get("dimensions", 2) for run in runs), default=2)
    units = {key: unit for key, _, unit in summary_rows(dimensions)} | {"segment": "m", "actuator_limit": "V"}
    units |= {
        "absorber_displacement": "m",
        "absorber_force": "N/m",
        "window": "a/c_e",
        "time": "a/c_e",
        "angle": "deg",
        "transit_time": "s",
    }
    if dimensions == 3:
        forces = {run.get("absorber_force_unit", "N" if run["settings"].get("dimensions", 2) == 3 else "N/m") for run in runs}
        units |= {"station": "m", "absorber_force": "N/m of lines, N of points" if len(forces) > 1 else forces.pop()}
    return {"runs": runs, **_compared(runs), "units": units | metric_units}


def _compared(runs: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """Return the first run's metrics over the second's, where both have them."""
    if len(runs) != 2:
        return {}
    first, second = (run["metrics"] for run in runs)
    return {"first_over_second": {name: value / second[name] for name, value in first.items() if second.get(name)}}


def frequency_document(found: Mapping[str, xr.DataArray]) -> dict[str, Any]:
    """Return answers at given frequencies by their systems: of each place its levels, or magnitudes and phases (degrees)."""
    import numpy as np

    from coaxshell.response.frequency.curves import curves_of, is_level

    answers: list[dict[str, Any]] = []
    for system, answer in found.items():
        told, curves = answer.attrs.get("warnings", ""), []
        for label, values in curves_of(answer):
            parts = {"values": values} if is_level(answer) else {"magnitude": np.abs(values), "phase": np.degrees(np.angle(values))}
            curves.append({"place": label, **{name: part.tolist() for name, part in parts.items()}})
        entry = {"system": system, "quantity": str(answer.name), "frequency": answer["frequency"].values.tolist(), "curves": curves}
        answers.append({**entry, "modes": answer.attrs["modes"], "warnings": told.split("\n") if told else []})
    units = {answer["quantity"]: str(array.attrs["units"]) for answer, array in zip(answers, found.values(), strict=True)}
    return {"answers": answers, "units": {"frequency": "Hz", "phase": "degree", **units}}


def arrays_document(dataset: xr.Dataset) -> dict[str, Any]:
    """Return a dataset as lists under the names of its coordinates and variables, with their units, and what each means."""
    named = {str(name): dataset[name] for name in (*dataset.coords, *dataset.data_vars)}
    return {
        **{name: array.values.tolist() for name, array in named.items()},
        "dimensions": {name: list(map(str, array.dims)) for name, array in named.items()},
        "units": {name: str(array.attrs["units"]) for name, array in named.items() if "units" in array.attrs},
        "meaning": {name: str(array.attrs["long_name"]) for name, array in named.items() if "long_name" in array.attrs},
    }


def spectra_document(spectra: Mapping[str, Mapping[str, Mapping[str, xr.DataArray]]], quality_factor: float) -> dict[str, Any]:
    """Return shock response spectra by run, shell and kind as one entry a run, shell, angle and station."""
    entries: list[dict[str, Any]] = []
    units = {"frequency": "Hz", "angle": "deg", "station": "m"}
    for run, shells in spectra.items():
        for shell, kinds in shells.items():
            first = next(iter(kinds.values()))
            units |= {str(found.name): str(found.attrs["units"]) for found in kinds.values()}
            for place in _places(first):
                values = {str(found.name): found.sel(place).values.tolist() for found in kinds.values()}
                entries.append({"run": run, "shell": shell, **place, "frequency": first["frequency"].values.tolist(), **values})
    return {"quality_factor": quality_factor, "spectra": entries, "units": units}


def _places(found: xr.DataArray) -> list[dict[str, float]]:
    """Return angle, and station where there are some, of each spectrum of an array."""
    stations = found["station"].values.tolist() if "station" in found.dims else [None]
    return [
        {"angle": angle, **({} if station is None else {"station": station})}
        for angle in found["angle"].values.tolist()
        for station in stations
    ]


def report_document(report: Report) -> dict[str, Any]:
    """Return a conformance report check by check and row by row."""
    columns = ("what", "source", "expected", "found", "error", "tolerance", "measure", "verdict", "skipped")
    checks = [
        {
            **{name: getattr(result, name) for name in ("name", "title", "about", "seconds")},
            "rows": [{name: getattr(row, name) for name in columns} for row in result.rows],
        }
        for result in report.results
    ]
    told = {"title": report.title, "circumstances": report.circumstances, "verdict": report.verdict, "failed": len(report.failed)}
    return {**told, "checks": checks}


def claims_document(results: Results) -> dict[str, Any]:
    """Return a reproduction of the paper: how many claims have which verdict, each claim, and the seconds of each part."""
    from coaxshell.apps.paper.reproduction import VARIANTS

    claims = [
        {
            **{name: getattr(judged.claim, name) for name in ("number", "name", "place", "statement", "criterion")},
            "findings": {
                name: {"verdict": found.verdict, "why": found.why, "measured": dict(found.measured)}
                for name, found in judged.findings.items()
            },
        }
        for judged in results.judged
    ]
    tally = {name: dict(results.tally(name)) for name in VARIANTS} if results.judged else {}
    figures = [figure.recipe.number for figure in results.figures]
    return {"tally": tally, "claims": claims, "figures": figures, "seconds": dict(results.seconds), "elapsed": results.elapsed}


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
