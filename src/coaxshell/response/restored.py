"""A solution from a file: sizes agreed with scenario and settings before any array is read, then the checksum."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import fields, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from coaxshell.errors import InputError
from coaxshell.model import toml
from coaxshell.model.absorbers import AbsorberRing
from coaxshell.model.system import System
from coaxshell.numerics.arrays import FloatArray
from coaxshell.response.dataset import ARRAYS, ERROR, OURS, SPATIAL_VERSION, checksum
from coaxshell.response.thinning import with_missing
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.settings import Settings
from coaxshell.solver.solution import CAUSES, QUANTITIES, Estimates, ModalSolution

if TYPE_CHECKING:
    from coaxshell.response.foreign import ForeignFile

_NEEDED = ("settings", "warnings", "timings")
_EARLIER = tuple(f"modal_{quantity}_estimate" for quantity in QUANTITIES)
"""Estimates in files of format 1, one value a shell."""


def judge_format(file: ForeignFile) -> int:
    """Return the version of a file's format; InputError if it is not ours, or newer than this package."""
    version = file.attribute("coaxshell_format_version")
    if version is None:
        raise InputError("", "was not written by coaxshell", OURS)
    if not isinstance(version, int) or version < 1:
        raise ValueError(f"its format is {str(version)[:20]!r}")
    if version > SPATIAL_VERSION:
        by = str(file.attribute("coaxshell_version") or "of a newer version")[:40]
        raise InputError("", f"has format {version} of coaxshell {by}, beyond {SPATIAL_VERSION} of this version", "update coaxshell")
    return version


def settings_of(file: ForeignFile) -> dict[str, Any]:
    """Return the settings of a file as they stand in it."""
    return table(file.attribute("settings"))


class Described(NamedTuple):
    """What a file says of its run beside the arrays: attributes as they stand, scenario, settings, system, warnings, timings."""

    about: dict[str, Any]
    text: str
    settings: Settings
    system: System
    warnings: tuple[str, ...]
    timings: dict[str, float]


def described(file: ForeignFile) -> Described:
    """Return what a file says of its run; no array is read."""
    about = {name: file.attribute(name) for name in (*_NEEDED, "checksum", "axial_sampling")}
    if missing := [name for name in _NEEDED if about[name] is None]:
        raise KeyError(f"{missing[0]} is missing")
    told = {name: value for name, value in about.items() if value is not None or name == "checksum"}
    text = file.text("scenario")
    settings = Settings(**settings_of(file))
    return Described(told, text, settings, _system(text), _warnings(about["warnings"]), _timings(about["timings"]))


def solution_of(file: ForeignFile) -> ModalSolution:
    """Return the solution that a file holds.

    The scenario is read as it stands: it names no other file. Sizes are compared with it and with the settings before any array is
    read. Arrays that are not those that were saved are accepted only as a part of the history: fewer or other instants.

    Raises
    ------
    InputError
        If the file is not ours, of a newer format, or its scenario is not a valid system.
    KeyError, TypeError, ValueError
        If something is missing or does not fit; the reader of files turns these into an InputError.
    """
    version = judge_format(file)
    told = described(file)
    sizes = sizes_of(file)
    _agree(sizes, told.system, told.settings)
    known = {field.name for field in fields(ModalSolution)}
    arrays: dict[str, Any] = {name: file.array(name) for name in ("time", "error_estimate", *ARRAYS) if name in file}
    solution = ModalSolution(
        problem=dimensionless(told.system, settings=told.settings),
        settings=told.settings,
        estimates=_estimates(file, arrays),
        warnings=told.warnings,
        timings=told.timings,
        **{name: values for name, values in arrays.items() if name in known},
    )
    judge_instants(solution.time, solution.settings)
    if version > 1 and not file.sealed and solution.whole and told.about["checksum"] != checksum(arrays, told.text, told.about):
        raise ValueError("its checksum is another: it was changed after it was saved")
    return replace(solution, warnings=with_missing(solution))


def sizes_of(file: ForeignFile) -> dict[str, int]:
    """Return the size of each dimension, the same in all arrays; nothing is read, ValueError if they do not fit."""
    dimensions = {name: dims for name, (dims, _, _) in ARRAYS.items()}
    estimates = {"error_estimate": ERROR} if "error_estimate" in file else dict.fromkeys(_EARLIER, ("shell",))
    return agreed_sizes(file, {"time": ("time",), **estimates, **dimensions}, ("time", "normal", "tangential", *estimates))


def agreed_sizes(file: ForeignFile, dimensions: Mapping[str, tuple[str, ...]], needed: tuple[str, ...]) -> dict[str, int]:
    """Return the size of each dimension of some arrays, those *needed* and those that a file has; ValueError if they do not fit."""
    sizes: dict[str, int] = {}
    for name, dims in dimensions.items():
        if name in needed or name in file:
            shape = file.shape(name)
            if len(shape) != len(dims) or any(sizes.setdefault(dim, size) != size for dim, size in zip(dims, shape, strict=True)):
                raise ValueError(f"{name} has the shape {shape}, which does not fit the others")
    return sizes


def _system(text: str) -> System:
    """Return the system of a scenario that names no file of its own."""
    data = toml.loads(text, None, "scenario")
    if _names_a_file(data):
        raise InputError("source.pulse.file", "names another file", "a saved run holds its records itself")
    return System.model_validate(data)


def _names_a_file(data: Any) -> bool:
    if isinstance(data, dict):
        return isinstance(data.get("file"), str) or any(_names_a_file(value) for value in data.values())
    return isinstance(data, list) and any(_names_a_file(value) for value in data)


def _agree(sizes: Mapping[str, int], system: System, settings: Settings) -> None:
    """Refuse arrays that are not those of the scenario and the settings."""
    if settings.dimensions != 2:
        raise ValueError("stations of three dimensions in a format of two")
    ring = system.absorbers
    absorbers = ring.count if isinstance(ring, AbsorberRing) else len(ring)
    for found, expected, what, where in (
        (sizes["shell"], len(system.shells), "shells", "scenario"),
        (sizes.get("absorber", 0), absorbers, "absorbers", "scenario"),
        (sizes["mode"] - 1, settings.modes, "as highest order", "settings"),
    ):
        if found != expected:
            raise ValueError(f"{found} {what} in the arrays, {expected} in the {where}")
    if sizes["half"] not in (1, 2) or any(sizes.get(dim, size) != size for dim, size in _FIXED.items()):
        raise ValueError("arrays of another shape than ours")


_FIXED = {"side": 2, "quantity": len(QUANTITIES), "cause": len(CAUSES)}


def _estimates(file: ForeignFile, arrays: Mapping[str, Any]) -> Estimates:
    if "error_estimate" in arrays:
        return Estimates(*np.moveaxis(arrays["error_estimate"], -1, 0))
    # Files of earlier versions: one number for the time step of all shells, nothing of the march.
    orders = np.stack([file.array(name) for name in _EARLIER], axis=1)
    step = np.full(orders.shape, finite(file.attribute("time_window_estimate")))
    return Estimates(orders, step, np.full(orders.shape, np.nan))


def judge_instants(time: FloatArray, settings: Settings) -> None:
    """Refuse instants that are no part of the run that the settings describe."""
    step = settings.time_step
    if time.size == 0 or time[0] < -1e-6 * step or time[-1] > (settings.steps + 1e-6) * step or np.any(np.diff(time) <= 0.0):
        raise ValueError("its instants are not those of its settings")


def table(text: Any) -> dict[str, Any]:
    """Return a table that stands in an attribute as JSON."""
    found = _json(text)
    if not isinstance(found, dict):
        raise TypeError("what should be a table is none")
    return found


def _json(text: Any) -> Any:
    if not isinstance(text, str):
        raise TypeError("what should be a text is none")
    return json.loads(text, parse_constant=finite)


def _warnings(text: Any) -> tuple[str, ...]:
    found = _json(text)
    if not isinstance(found, list) or not all(isinstance(one, str) for one in found):
        raise TypeError("warnings that are not texts")
    return tuple(found)


def _timings(text: Any) -> dict[str, float]:
    return {name: finite(value) for name, value in table(text).items()}


def finite(value: Any) -> float:
    """Return a finite number."""
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise ValueError(f"{str(value)[:20]!r} is not a finite number")
    return float(value)
