"""Records in objects of pandas, xarray and numpy: columns with headings and units as those libraries keep them."""

from __future__ import annotations

from typing import Any

import numpy as np

from coaxshell.errors import InputError
from coaxshell.limits import RECORD_COLUMNS, RECORD_SAMPLES
from coaxshell.model.base import shown
from coaxshell.model.records.columns import Column, Table, column

REMEDY = "give a pandas Series or DataFrame, an xarray DataArray or Dataset, or an array of shape (samples, 2): time in s, pressure in Pa"


def object_table(data: Any, name: str) -> Table:
    """Return the columns of an object; InputError if it is none of those that are known, or holds what is no number."""
    library = type(data).__module__.partition(".")[0]
    if library == "pandas" and hasattr(data, "index"):
        columns = _of_pandas(data, name)
    elif library == "xarray" and hasattr(data, "coords"):
        columns = _of_xarray(data, name)
    else:
        columns = _of_array(data, name)
    RECORD_COLUMNS.check(len(columns), name)
    return Table(tuple(columns))


def _of_pandas(data: Any, name: str) -> list[Column]:
    frame = data.to_frame("pressure" if data.name is None else data.name) if hasattr(data, "to_frame") else data
    columns = [_column(heading, frame.iloc[:, k].to_numpy(), name) for k, heading in enumerate(frame.columns)]
    numbered = type(frame.index).__name__ == "RangeIndex" and frame.index.name is None
    if numbered and hasattr(data, "to_frame"):
        return columns
    return columns if numbered else [_column(frame.index.name or "time", frame.index.to_numpy(), name), *columns]


def _of_xarray(data: Any, name: str) -> list[Column]:
    arrays = list(data.data_vars.items()) if hasattr(data, "data_vars") else [(data.name or "pressure", data)]
    found: dict[str, Column] = {}
    for label, array in arrays:
        if array.ndim != 1:
            raise InputError(name, f"{label} has {array.ndim} dimensions", "select one record: give a series along time")
        dim = array.dims[0]
        if dim in array.coords and dim not in found:
            found[dim] = _column(dim, array.coords[dim].to_numpy(), name, array.coords[dim].attrs.get("units"))
        found[str(label)] = _column(label, array.to_numpy(), name, array.attrs.get("units"))
    return list(found.values())


def _of_array(data: Any, name: str) -> list[Column]:
    try:
        array = np.asarray(data, dtype=float)
    except (TypeError, ValueError):
        raise InputError(name, f"{shown(data)} is no record", REMEDY) from None
    if array.ndim != 2 or array.shape[1] < 2:
        raise InputError(name, f"an array of shape {array.shape} is no record", REMEDY)
    return [_column("", values, name) for values in array.T]


def _column(heading: Any, values: Any, name: str, unit: str | None = None) -> Column:
    RECORD_SAMPLES.check(len(values), name)
    label = str(heading)
    array = np.asarray(values)
    if array.dtype.kind == "m":
        array, unit = array / np.timedelta64(1, "s"), "s"
    if array.dtype.kind not in "iufO":
        raise InputError(name, f"{label or 'a column'} holds no numbers ({array.dtype})", REMEDY)
    try:
        numbers = np.array(array, dtype=float)
    except (TypeError, ValueError):
        raise InputError(name, f"{label or 'a column'} holds what is no number", REMEDY) from None
    bad = np.flatnonzero(~np.isfinite(numbers))
    if bad.size:
        raise InputError(name, f"sample {bad[0] + 1} of {label or 'a column'} is not finite", "leave out what is missing")
    return column(label, numbers, unit)
