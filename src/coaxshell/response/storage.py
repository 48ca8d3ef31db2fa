"""Write a response to one NetCDF file, whole or not at all, and read it back."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from coaxshell.errors import InputError
from coaxshell.limits import SAVED_TEXT
from coaxshell.numerics.late import Late
from coaxshell.numerics.netcdf import write_netcdf
from coaxshell.numerics.seal import add_seal
from coaxshell.response import restored
from coaxshell.response.dataset import ARRAYS, SPATIAL_VERSION, to_dataset
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.solution import ModalSolution

if TYPE_CHECKING:
    from coaxshell.response import station_files
    from coaxshell.response.foreign import ForeignFile
    from coaxshell.solver.axial.solution import SpatialSolution
else:
    station_files = Late("coaxshell.response.station_files")  # two dimensions need nothing of it


def save(solution: ModalSolution | SpatialSolution, path: str | Path, *, compression: bool = False) -> Path:
    """Write a solution to a NetCDF file and return its path; an older file there is replaced only by a complete new one.

    The file holds the dimensionless modal amplitudes bit by bit (in three dimensions those of all fields at all stations), the scenario as
    TOML (records of pressure with all their samples), settings, estimates, warnings, timings and versions; a checksum over all of it, and
    one over the file's bytes.

    Parameters
    ----------
    solution : ModalSolution or SpatialSolution
    path : str or Path
    compression : bool
        Compress without loss (smaller, slower).

    Raises
    ------
    InputError
        If the file cannot be written there, or if the run was made with other formulas than its description stands for.
    """
    if solution.problem != dimensionless(solution.problem.system, solution.problem.dimensions, solution.settings):
        raise InputError("response", "was made with other formulas than a file could repeat", "save its histories as tables instead")
    dataset = to_dataset(solution) if isinstance(solution, ModalSolution) else station_files.to_dataset(solution)
    SAVED_TEXT.check(len(dataset["scenario"].item().encode()), "response", "resample its record, or cut it")
    packed = {"zlib": True, "complevel": 4, "shuffle": True} if compression else {}
    arrays = [str(name) for name in dataset.data_vars if name in ARRAYS or "station" in dataset[name].dims]
    encoding = {name: {"_FillValue": None, **packed} for name in arrays if dataset[name].size}
    write_netcdf(dataset, path, encoding, add_seal)
    return Path(path)


def load_solution(path: str | Path) -> ModalSolution | SpatialSolution:
    """Return the solution of a file written by :func:`save`, of this version or an earlier one.

    A file from elsewhere opens no other file, and nothing is allocated before its sizes have been judged.

    Raises
    ------
    InputError
        If there is no such file, or it is not ours, cut short, damaged, changed, not of its own settings, or of a newer format.
    """
    from coaxshell.response.foreign import opened

    with opened(path) as file:
        try:
            spatial = restored.judge_format(file) == SPATIAL_VERSION
            return station_files.solution_of(file) if spatial else restored.solution_of(file)
        except InputError as error:
            if not error.where:
                raise InputError(str(path), error.problem, error.remedy) from None
            raise InputError(str(path), f"holds a scenario that this version does not accept: {error}") from error


def scenario(path: str | Path) -> tuple[str, dict[str, Any]]:
    """Return the description (TOML) and the settings of a file, without reading its arrays.

    Raises
    ------
    InputError
        As :func:`load_solution`.
    """
    from coaxshell.response.foreign import opened

    with opened(path) as file:
        _judge_format(file, path)
        return file.text("scenario"), restored.settings_of(file)


def info(path: str | Path) -> str:
    """Return in words what a file holds, without reading its arrays.

    Raises
    ------
    InputError
        As :func:`load_solution`.
    """
    from coaxshell.response.foreign import opened

    with opened(path) as file:
        _judge_format(file, path)
        return _described(file)


def _judge_format(file: ForeignFile, path: str | Path) -> None:
    try:
        restored.judge_format(file)
    except InputError as error:
        raise InputError(str(path), error.problem, error.remedy) from None


def _described(file: ForeignFile) -> str:
    spatial = restored.judge_format(file) == SPATIAL_VERSION
    sizes = station_files.sizes_of(file) if spatial else restored.sizes_of(file)
    known = station_files.dimensions_of(file) if spatial else {name: dims for name, (dims, _, _) in ARRAYS.items()}
    parts = {part: file.attribute(f"{part}_version") for part in ("coaxshell", "numerics", "numpy", "scipy", "python")}
    versions = ", ".join(f"{part} {version}" for part, version in parts.items() if version is not None)
    settings = ", ".join(f"{key} {value}" for key, value in restored.settings_of(file).items())
    dimensions = {name: ", ".join(f"{dim} {sizes[dim]}" for dim in dims) for name, dims in known.items() if name in file}
    stations = f"stations {sizes['station']}, " if spatial else ""
    return "\n".join(
        [
            f"{file.attribute('title')}: {stations}shells {sizes['shell']}, orders 0 to {sizes['mode'] - 1}, instants {sizes['time']}",
            f"written {file.attribute('created')} in format {file.attribute('coaxshell_format_version')} by {versions}",
            f"settings: {settings}",
            *(f"warning: {text}" for text in json.loads(str(file.attribute("warnings")))),
            "arrays:",
            *(f"  {name} ({sizes})" for name, sizes in dimensions.items()),
            "scenario:",
            file.text("scenario"),
        ]
    )
