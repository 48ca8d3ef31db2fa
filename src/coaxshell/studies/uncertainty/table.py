"""A study of uncertain properties in words: statistics and indices with their intervals."""

from __future__ import annotations

import json

from coaxshell.numerics.late import xarray as xr
from coaxshell.response.summary_text import aligned
from coaxshell.studies.labelled import FAILURE, WARNINGS


def told(dataset: xr.Dataset) -> bool:
    """Return whether there are statistics: no run has failed."""
    return not bool((dataset[FAILURE] != "").any())


def found_text(dataset: xr.Dataset) -> str:
    """Return aligned tables: the statistics of every metric, and its indices if there are any, each with its interval."""
    failed, warned = int((dataset[FAILURE] != "").sum()), int((dataset[WARNINGS] != "").sum())
    counted = f"{dataset[FAILURE].size} runs"
    if failed:
        return f"{counted}, {failed} of them failed: no statistics; the values of the others are in the file (variables runs.*)"
    counted += f"; {warned} carry physics warnings (variable {WARNINGS!r})" if warned else ""
    percent = f"{100 * dataset.attrs['confidence']:g} % interval"
    rows: list[tuple[str, ...]] = [("metric", "statistic", "value", "unit", percent)]
    names = json.loads(dataset.attrs["metrics"])
    for name in names:
        for statistic in dataset["statistic"].to_numpy():
            value, low, high = dataset[name].sel(statistic=statistic).to_numpy()
            unit = str(dataset[name].attrs.get("units", ""))
            rows.append((name, str(statistic), f"{value:.6g}", unit, f"{low:.6g} to {high:.6g}"))
    lines = [counted, "", *aligned(rows, left=2)]
    if "first_order" in dataset:
        lines += ["", *aligned(_indices(dataset, names, percent), left=2)]
    return "\n".join(lines)


def _indices(dataset: xr.Dataset, names: list[str], percent: str) -> list[tuple[str, ...]]:
    rows: list[tuple[str, ...]] = [("metric", "uncertain", "alone", percent, "with others", percent)]
    for name in names:
        of_metric = dataset.sel(metric=name)
        if bool(of_metric["first_order"].isnull().all()):
            rows.append((name, "does not vary", "", "", "", ""))
            continue
        for path in dataset["field"].to_numpy():
            cells: list[str] = []
            for order in ("first_order", "total_order"):
                value, low, high = of_metric[order].sel(field=path).to_numpy()
                cells += [f"{value:.3f}", f"{low:.3f} to {high:.3f}"]
            rows.append((name, str(path), *cells))
    return rows
