"""Shock response spectra as CSV: one row a natural frequency, a column a run, shell, angle, station and quantity."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from coaxshell.errors import InputError
from coaxshell.export.tables import write_csv
from coaxshell.model.places import shell_name
from coaxshell.numerics.oscillators import KINDS

if TYPE_CHECKING:
    import xarray as xr

    from coaxshell.response import Response


def export_spectra_csv(
    responses: Mapping[str, Response] | Response,
    path: str | Path,
    shells: Sequence[int | str] | int | str | None = None,
    angle: Sequence[float] | float = (0.0, 180.0),
    station: Any = None,
    frequency: Sequence[float] | None = None,
    quality_factor: float = 10.0,
) -> Path:
    """Write the shock response spectra of one run or several as CSV, names and units in the first row.

    Parameters
    ----------
    responses : Response, or mapping of name to Response
        Of several, all have the same natural frequencies, those chosen for the first unless given.
    path : str or Path
    shells, angle, station, frequency, quality_factor
        As for :func:`coaxshell.plotting.figure_shock_spectra`.

    Raises
    ------
    InputError
        The file is not a .csv or cannot be written, no shell is elastic, or an argument that the spectrum refuses.
    """
    table: dict[str, npt.NDArray[np.float64]] = {}
    for name, of_shells in spectra_of(responses, shells, angle, station, frequency, quality_factor).items():
        for shell, kinds in of_shells.items():
            for kind, found in kinds.items():
                table.setdefault("natural frequency (Hz)", found["frequency"].to_numpy())
                words = f"{kind.replace('-', ' ')} ({found.attrs['units']})"
                for place, values in _places(found):
                    table[" ".join(filter(None, [name, shell, place, words]))] = values
    return write_csv(table, path)


def spectra_of(
    responses: Mapping[str, Response] | Response,
    shells: Sequence[int | str] | int | str | None = None,
    angle: Sequence[float] | float = (0.0, 180.0),
    station: Any = None,
    frequency: Sequence[float] | None = None,
    quality_factor: float = 10.0,
) -> dict[str, dict[str, dict[str, xr.DataArray]]]:
    """Return the spectra that the file holds, by run, shell and kind, all at the natural frequencies of the first; errors are the same."""
    runs = dict(responses) if isinstance(responses, Mapping) else {"": responses}
    angles = [float(each) for each in np.atleast_1d(np.asarray(angle, dtype=np.float64))]
    spectra: dict[str, dict[str, dict[str, xr.DataArray]]] = {}
    for name, response in runs.items():
        of_shells = spectra[name] = {}
        for index in response.system.shell_indices(shells):
            kinds = of_shells[shell_name(index, response.shells)] = {}
            for kind in KINDS:
                found = response.shock_spectrum(index, angles, frequency, station=station, kind=kind, quality_factor=quality_factor)
                kinds[kind], frequency = found, found["frequency"].to_numpy().tolist()
    if not any(spectra.values()):
        raise InputError("shells", "no run has an elastic one of these", "choose others")
    return spectra


def _places(found: Any) -> list[tuple[str, npt.NDArray[np.float64]]]:
    """Return the spectra of an array by angle, and by station in three dimensions."""
    by_angle = [(f"{float(angle):g} deg", found.sel(angle=angle)) for angle in found["angle"]]
    if "station" not in found.dims:
        return [(place, one.to_numpy()) for place, one in by_angle]
    return [(f"{place} z = {float(z):g} m", one.sel(station=z).to_numpy()) for place, one in by_angle for z in one["station"]]
