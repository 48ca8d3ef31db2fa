"""Another code's histories against ours, on the same plots."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable
from pathlib import Path
from time import perf_counter

import numpy as np

from coaxshell.errors import InputError, PhysicsWarning
from coaxshell.model.naming import shell_name
from coaxshell.model.system import System
from coaxshell.numerics.files import write_text
from coaxshell.response.response import Response
from coaxshell.response.simulation import simulate
from coaxshell.verification.bench import FloatArray
from coaxshell.verification.histories_csv import Column, Histories, read_histories
from coaxshell.verification.rows import Curve, Panel, Row, Sheet, value
from coaxshell.verification.suite import Report, Result, circumstances

LONGEST = 50.0
"""Longest history that is computed for a comparison, in transits."""
DRAWN = {"displacement": (1e6, "displacement (µm)"), "stress": (1e-6, "hoop stress (MPa)")}
UNIT = {"displacement": "m", "stress": "Pa"}

NOTE = (
    "Errors are those of the file relative to coaxshell: relative L2 over the file's own instants, and the difference of the largest "
    "magnitudes. Displacement is positive inward, stress is the core's at its mid-surface (Eq. 22), t = 0 when the front reaches the head."
)


def against(
    path: Path,
    system: System,
    *,
    time_step: float = 1e-3,
    modes: int = 150,
    tolerance: float | None = None,
    progress: Callable[[float, str], None] | None = None,
) -> Report:
    """Return the report that compares the histories of a CSV file with ours.

    Parameters
    ----------
    path : Path
    system : System
        What the other code solved.
    time_step, modes
        Resolution of our run; it is as long as the file's histories.
    tolerance : float, optional
        Largest relative L2 error that passes; without one nothing is judged.
    progress : callable, optional

    Raises
    ------
    InputError
        Something is wrong in the file, or does not fit the system.
    """
    start = perf_counter()
    theirs = read_histories(path)
    for column in theirs.columns:
        _index(path, system, column)
    transit = system.reference_radius / system.exterior.sound_speed
    time = theirs.time if theirs.unit == "transits" else theirs.time / transit
    if time[-1] > LONGEST:
        hint = (
            "are they in ms or us? then say so in its heading"
            if theirs.unit == "s"
            else "are they in another unit? then say so in its heading"
        )
        raise InputError(str(path), f"times reach {time[-1]:.4g} transits, beyond {LONGEST:g}", hint)
    if time[-1] < 8 * time_step:
        hint = (
            "are they in seconds? then write time [s]" if theirs.unit == "transits" else "are they in transits? then write time [transits]"
        )
        raise InputError(str(path), f"times reach {time[-1]:.3g} transits only (a/c_e = {transit:.4g} s)", hint)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PhysicsWarning)
        duration = math.ceil(time[-1] / time_step) * time_step
        response = simulate(system, duration=duration, time_step=time_step, modes=modes, progress=progress)
    return _report(path, theirs, time, response, tolerance, start)


def _index(path: Path, system: System, column: Column) -> int:
    try:
        return system.shell_index(column.shell)
    except InputError as error:
        raise InputError(f"{path}, column {column.name!r}", error.problem, error.remedy) from None


def _report(path: Path, theirs: Histories, time: FloatArray, response: Response, tolerance: float | None, start: float) -> Report:
    rows: list[Row] = []
    panels: dict[str, list[Panel]] = {}
    for column in theirs.columns:
        curve = np.asarray(getattr(response, column.quantity)(column.shell, [column.angle]))[:, 0]
        ours = np.interp(time, response.time, curve)
        rows += _rows(column, ours, tolerance)
        panels.setdefault(column.quantity, []).append(_panel(column, response.time, curve, time, path.name))
    name = response.system.name or "this system"
    about = f"{path.name} against coaxshell, {name}: {response.engine} engine, M = {response.modes}, dt = {response.settings.time_step:g}."
    sheets = tuple(Sheet(f"{name}: {quantity}", f"Lines: coaxshell. Dashed: {path.name}.", drawn) for quantity, drawn in panels.items())
    result = Result("against", f"{path.name} against {name}", about, tuple(rows), sheets, perf_counter() - start)
    return Report(f"coaxshell: {path.name} against {name}", (result,), circumstances(), NOTE)


def _rows(column: Column, ours: FloatArray, tolerance: float | None) -> tuple[Row, Row]:
    """Return the rows of the whole history and of its peak; nothing fails without a tolerance."""
    unit, limit = UNIT[column.quantity], math.inf if tolerance is None else tolerance
    peaks = [float(history[np.abs(history).argmax()]) for history in (ours, column.values)]
    norm, largest = float(np.linalg.norm(ours)), abs(peaks[0])
    missing = "ours is zero throughout" if norm == 0 else ""
    error = float(np.linalg.norm(column.values - ours)) / norm if norm else math.nan
    flipped = float(np.linalg.norm(column.values + ours)) / norm if norm else math.nan
    found = f"differs by {error:.3g}" + (f" ({flipped:.2g} with the sign reversed)" if flipped < 0.5 * error else "")
    whole = Row(f"{column.name}, whole history", "coaxshell", "coaxshell's", found, error, limit, "relative L2", missing)
    peak_error = abs(abs(peaks[1]) - largest) / largest if largest else math.nan
    peak = Row(f"{column.name}, peak", "coaxshell", value(peaks[0], unit), value(peaks[1], unit), peak_error, limit, "relative", missing)
    return whole, peak


def _panel(column: Column, time: FloatArray, curve: FloatArray, at: FloatArray, file: str) -> Panel:
    scale, label = DRAWN[column.quantity]
    curves = [
        Curve("coaxshell", time, scale * curve, colour="blue"),
        Curve(file, at, scale * column.values, "dashed", colour="orange"),
    ]
    return Panel(column.name, "time (a/c)", label, curves)


def template(system: System, path: Path, *, time_step: float = 0.01, duration: float = 5.0, modes: int = 150) -> Path:
    """Write an example file with our own numbers: both quantities of every shell at head and tail.

    Raises
    ------
    InputError
        The file cannot be written.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PhysicsWarning)
        response = simulate(system, duration=duration, time_step=min(time_step, 2e-3), modes=modes)
    every = max(1, round(time_step / response.settings.time_step))
    columns: dict[str, FloatArray] = {"time [transits]": response.time[::every]}
    count = response.shells
    names = [shell_name(shell, count) for shell in range(count)] if count <= 3 else ["inner", *map(str, range(1, count - 1)), "outer"]
    for quantity, unit in UNIT.items():
        for shell in names:
            if quantity == "stress" and not hasattr(system.shells[system.shell_index(shell)], "layers"):
                continue
            for side, angle in (("head", 0.0), ("tail", 180.0)):
                columns[f"{quantity}_{shell}_{side} [{unit}]"] = np.asarray(getattr(response, quantity)(shell, [angle]))[::every, 0]
    lines = [f"# {line}" for line in _explanation(system)] + [", ".join(columns)]
    lines += [", ".join(f"{number:.9g}" for number in row) for row in zip(*columns.values(), strict=True)]
    write_text(path, "\n".join(lines) + "\n")
    return path


def _explanation(system: System) -> tuple[str, ...]:
    transit = system.reference_radius / system.exterior.sound_speed
    return (
        f"{system.name or 'system'}: replace the numbers by your own and run  coaxshell verify --against FILE --case ...",
        f"time in transits (a/c_e = {transit:.9g} s here) or seconds: time [transits], time [s], time [ms]; any increasing instants",
        "t = 0: the front reaches the head of the outermost shell; displacement positive inward; stress: the core's, mid-surface",
        "columns: displacement|stress _ inner|outer|number _ head|tail|degrees, unit in brackets: m, mm, um; Pa, kPa, MPa",
    )
