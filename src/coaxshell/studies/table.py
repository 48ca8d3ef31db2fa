"""A sweep as a table: CSV with units in its header, and the smallest and largest value of each metric in words."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np

from coaxshell.numerics.files import write_text
from coaxshell.numerics.late import xarray as xr
from coaxshell.response.summary_text import aligned
from coaxshell.studies.labelled import FAILURE, WARNINGS


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
