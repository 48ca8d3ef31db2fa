"""Answers at given frequencies as CSV: one row a frequency."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from coaxshell.export.tables import write_csv
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.late import xarray as xr
from coaxshell.response.frequency.curves import curves_of, is_level


def frequency_columns(found: xr.DataArray) -> dict[str, FloatArray]:
    """Return an answer as columns by names with units: the frequency, and of each place a level, or magnitude and phase (degrees).

    Parameters
    ----------
    found : DataArray
        From :func:`coaxshell.frequency_response` or :meth:`coaxshell.Response.spectrum`, at several frequencies.
    """
    name, unit = str(found.name).replace("_", " "), found.attrs.get("units", "")
    columns: dict[str, FloatArray] = {"frequency (Hz)": found["frequency"].to_numpy()}
    for curve in curves_of(found):
        where = f" {curve.label}" if curve.label else ""
        if is_level(found):
            columns[f"{name}{where} ({unit})"] = np.asarray(curve.values, dtype=np.float64)
        else:
            columns[f"{name}{where}, magnitude ({unit})"] = np.abs(curve.values)
            columns[f"{name}{where}, phase (degree)"] = np.degrees(np.angle(curve.values))
    return columns


def export_frequency_response_csv(found: xr.DataArray, path: str | Path) -> Path:
    """Write an answer at given frequencies as CSV, names and units in the first row.

    Parameters
    ----------
    found : DataArray
        From :func:`coaxshell.frequency_response` or :meth:`coaxshell.Response.spectrum`, at several frequencies.
    path : str or Path

    Raises
    ------
    InputError
        The file is not a .csv or cannot be written.
    """
    return write_csv(frequency_columns(found), path)
