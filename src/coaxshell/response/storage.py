"""Write a response to one NetCDF file, whole or not at all, and read it back."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from coaxshell.errors import InputError
from coaxshell.numerics.late import xarray as xr
from coaxshell.numerics.netcdf import write_netcdf
from coaxshell.response.dataset import ARRAYS, OURS, format_problem, from_dataset, to_dataset
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.solution import ModalSolution

_LONGEST_SCENARIO = 8_000_000

UNREADABLE = (OSError, ValueError, KeyError, TypeError, RuntimeError)
"""What HDF5 and xarray raise on files that are cut short, damaged, or something else altogether."""


def save(solution: ModalSolution, path: str | Path, *, compression: bool = False) -> Path:
    """Write a solution to a NetCDF file and return its path; an older file there is replaced only by a complete new one.

    The file holds the dimensionless modal amplitudes bit by bit, the scenario as TOML, settings, estimates, warnings, timings and versions.

    Parameters
    ----------
    solution : ModalSolution
    path : str or Path
    compression : bool
        Compress without loss (smaller, slower).

    Raises
    ------
    InputError
        If the file cannot be written there, or if the run was made with other formulas than its description stands for.
    """
    if solution.problem != dimensionless(solution.problem.system):
        raise InputError("response", "was made with other formulas than a file could repeat", "save its histories as tables instead")
    dataset = to_dataset(solution)
    packed = {"zlib": True, "complevel": 4, "shuffle": True} if compression else {}
    encoding = {name: {"_FillValue": None, **packed} for name in ARRAYS if name in dataset and dataset[name].size}
    write_netcdf(dataset, path, encoding)
    return Path(path)


def _opened(path: str | Path) -> xr.Dataset:
    """Open one of our files without reading its arrays and without decoding anything; InputError if that is not possible."""
    source = Path(path)
    if not source.is_file():
        raise InputError(str(path), "is a folder" if source.is_dir() else "does not exist", OURS)
    try:
        dataset = xr.open_dataset(source, engine="h5netcdf", decode_times=False, mask_and_scale=False, decode_timedelta=False, cache=False)
    except PermissionError:
        raise InputError(str(path), "cannot be read (permission denied)", "choose another file") from None
    except UNREADABLE as error:
        raise InputError(str(path), "is not a NetCDF file, or is cut short or damaged", OURS) from error
    problem = format_problem(dataset.attrs)
    if problem is not None:
        dataset.close()
        raise InputError(str(path), problem.problem, problem.remedy)
    return dataset


@contextmanager
def _reading(path: str | Path) -> Iterator[xr.Dataset]:
    """Yield one of our files, opened; InputError if that is not possible, or if it turns out to be damaged."""
    with _opened(path) as dataset:
        try:
            yield dataset
        except InputError:
            raise
        except UNREADABLE as error:
            raise InputError(str(path), f"is damaged ({type(error).__name__}: {error})", "write it again") from error


def load_solution(path: str | Path) -> ModalSolution:
    """Return the solution of a file written by :func:`save`.

    Raises
    ------
    InputError
        If there is no such file, or it is not ours, cut short, damaged, or of a newer format.
    """
    with _reading(path) as dataset:
        try:
            return from_dataset(dataset.load())
        except InputError as error:
            raise InputError(str(path), f"holds a scenario that this version does not accept: {error}") from error


def scenario(path: str | Path) -> tuple[str, dict[str, Any]]:
    """Return the description (TOML) and the settings of a file, without reading its arrays.

    Raises
    ------
    InputError
        As :func:`load_solution`.
    """
    with _reading(path) as dataset:
        text = dataset["scenario"]
        if text.size != 1 or text.nbytes > _LONGEST_SCENARIO:
            raise ValueError(f"a scenario of {text.nbytes} bytes")
        settings = json.loads(dataset.attrs["settings"])
        if not isinstance(settings, dict):
            raise TypeError("settings that are not a table")
        return str(text.item()), settings


def info(path: str | Path) -> str:
    """Return in words what a file holds, without reading its arrays.

    Raises
    ------
    InputError
        As :func:`load_solution`.
    """
    with _reading(path) as dataset:
        return _described(dataset)


def _described(dataset: xr.Dataset) -> str:
    about, sizes = dataset.attrs, dataset.sizes
    versions = ", ".join(f"{part} {about[f'{part}_version']}" for part in ("coaxshell", "numpy", "scipy", "python"))
    settings = ", ".join(f"{key} {value}" for key, value in json.loads(about["settings"]).items())
    held = [dataset[name] for name in ARRAYS if name in dataset]
    return "\n".join(
        [
            f"{about['title']}: shells {sizes['shell']}, orders 0 to {sizes['mode'] - 1}, instants {sizes['time']}",
            f"written {about['created']} in format {about['coaxshell_format_version']} by {versions}",
            f"settings: {settings}",
            *(f"warning: {text}" for text in json.loads(about["warnings"])),
            "arrays:",
            *(f"  {array.name} ({', '.join(f'{dim} {size}' for dim, size in array.sizes.items())})" for array in held),
            "scenario:",
            str(dataset["scenario"].item()),
        ]
    )
