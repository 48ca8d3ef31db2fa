"""Natural frequencies as CSV: one row a mode, wet ones first, then the dry ones of each shell."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from coaxshell.export.tables import write_rows
from coaxshell.numerics.late import xarray as xr

_COLUMNS = ("kind", "axial half wavelength (m)", "order", "mode", "frequency (Hz)", "damping ratio")


def rows_of(found: xr.Dataset) -> Iterator[dict[str, Any]]:
    """Yield the modes that :func:`coaxshell.natural_frequencies` found, by names with units.

    Kind ("wet", or the name of a shell with "dry"), axial half wavelength (None where nothing changes along the axis), order, number of
    the mode within it, frequency, damping ratio, and of wet modes the real part of each shell's motion, the largest being 1.
    """
    along = "axial_half_wavelength"
    cuts = [found.isel({along: i}) for i in range(found[along].size)] if along in found.dims else [found]
    for cut in cuts:
        yield from _rows(cut, float(cut[along]) if along in cut.coords else None)


def _rows(found: xr.Dataset, length: float | None) -> Iterator[dict[str, Any]]:
    names = [str(name) for name in found["shell"].values]
    orders = found["order"].values.tolist()
    frequency, ratio, shape = (found[name].values for name in ("frequency", "damping_ratio", "shape"))
    for row, mode in zip(*np.nonzero(np.isfinite(frequency)), strict=True):
        one = _row("wet", length, orders[row], int(mode), frequency[row, mode], ratio[row, mode])
        yield one | {f"{name} motion": float(shape[row, mode, i].real) for i, name in enumerate(names)}
    dry, dry_ratio = found["dry_frequency"].values, found["dry_damping_ratio"].values
    for shell, row, mode in zip(*np.nonzero(np.isfinite(dry)), strict=True):
        one = _row(f"{names[shell]} dry", length, orders[row], int(mode), dry[shell, row, mode], dry_ratio[shell, row, mode])
        yield one | {f"{name} motion": None for name in names}


def _row(kind: str, length: float | None, order: int, mode: int, frequency: float, ratio: float) -> dict[str, Any]:
    return dict(zip(_COLUMNS, (kind, length, order, mode, float(frequency), float(ratio)), strict=True))


def export_natural_frequencies_csv(found: xr.Dataset, path: str | Path) -> Path:
    """Write natural frequencies as CSV, names and units in the first row; what does not apply stays empty.

    Parameters
    ----------
    found : Dataset
        From :func:`coaxshell.natural_frequencies`.
    path : str or Path

    Raises
    ------
    InputError
        The file is not a .csv or cannot be written.
    """
    rows = list(rows_of(found))
    return write_rows(rows[0] if rows else _COLUMNS, (row.values() for row in rows), path)
