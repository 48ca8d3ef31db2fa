"""Another code's histories against ours, on the same plots."""

from __future__ import annotations

import math
import warnings
from pathlib import Path
from time import perf_counter
from typing import Literal

import numpy as np

from coaxshell.apps.verification.causes import likely_cause
from coaxshell.apps.verification.histories_csv import Column, Histories, read_histories
from coaxshell.apps.verification.rows import Curve, Panel, Row, Sheet, value
from coaxshell.apps.verification.suite import Report, Result, circumstances
from coaxshell.errors import InputError, PhysicsWarning
from coaxshell.model.places import shell_name
from coaxshell.model.system import System
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.files import write_text
from coaxshell.numerics.progress import Progress
from coaxshell.response.quantities import QUANTITIES
from coaxshell.response.response import Response
from coaxshell.response.simulation import simulate
from coaxshell.solver.settings import Settings

LONGEST = 50.0
"""Longest history that is computed for a comparison, in transits."""
TOLERANCE = 0.05
"""Largest relative L2 error, and error of a peak, that passes unless another is given."""
CLOCKS = 1e-3
"""Relative difference that columns of transits and of seconds may have."""

NOTE = (
    "Errors are those of the file relative to coaxshell: relative L2 over the file's own instants, and the difference of the largest "
    "magnitudes; each passes up to the tolerance. A likely cause is named where undoing it brings the error down a lot. "
    "Displacement is positive inward, stress is the core's at its mid-surface (Eq. 22), t = 0 when the front reaches the head. "
    "Accelerations beside a sharp front are those of their time step: compare at the same one, or with a rise time."
)


def against(
    path: Path,
    system: System,
    *,
    time_step: float = Settings.time_step,
    modes: int | Literal["auto"] = Settings.modes,
    tolerance: float = TOLERANCE,
    progress: Progress | None = None,
) -> Report:
    """Return the report that compares the histories of a CSV file with ours.

    Parameters
    ----------
    path : Path
    system : System
        What the other code solved.
    time_step, modes
        Resolution of our run; it is as long as the file's histories.
    tolerance : float
        Largest relative L2 error, and relative error of a peak, that passes; ``math.inf`` judges nothing.
    progress : callable, optional

    Raises
    ------
    InputError
        Something is wrong in the file, or does not fit the system.
    """
    start = perf_counter()
    if not tolerance > 0:
        raise InputError("tolerance", f"{tolerance:g} is not allowed", "must be greater than 0")
    theirs = read_histories(path)
    for column in theirs.columns:
        _check(path, system, column)
    time = _transits(path, theirs, system.reference_radius / system.exterior.sound_speed, time_step)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PhysicsWarning)
        duration = math.ceil(time[-1] / time_step - 1e-6) * time_step  # not one step more for the rounding of a file
        response = simulate(system, duration=duration, time_step=time_step, modes=modes, progress=progress)
    return _report(path, theirs, time, response, tolerance, start)


def _transits(path: Path, theirs: Histories, transit: float, time_step: float) -> FloatArray:
    """Return the instants of a file in transits; InputError where they cannot be meant."""
    if theirs.seconds is None:
        assert theirs.transits is not None  # a file has one of them at least
        time = theirs.transits
    else:
        time = theirs.seconds / transit
        if theirs.transits is not None and abs(theirs.transits[-1] - time[-1]) > CLOCKS * time[-1]:
            problem = f"times end at {theirs.transits[-1]:.6g} transits and at {theirs.seconds[-1]:.6g} s, {time[-1]:.6g} transits here"
            raise InputError(str(path), problem, f"a/c_e is {transit:.6g} s here: is --case what the file holds? or leave one column out")
    in_seconds = theirs.seconds is not None
    if time[-1] > LONGEST:
        unit = "ms or us" if in_seconds else "another unit"
        raise InputError(
            str(path), f"times reach {time[-1]:.4g} transits, beyond {LONGEST:g}", f"are they in {unit}? then say so in its heading"
        )
    if time[-1] < 8 * time_step:
        hint = "are they in transits? then write time [transits]" if in_seconds else "are they in seconds? then write time [s]"
        raise InputError(str(path), f"times reach {time[-1]:.3g} transits only (a/c_e = {transit:.4g} s)", hint)
    return time


def _check(path: Path, system: System, column: Column) -> None:
    """Refuse a column that the system does not have."""
    where = f"{path}, column {column.name!r}"
    try:
        if column.quantity == "absorber_displacement":
            count = len(system.absorber_list)
            if not (column.shell.isdecimal() and int(column.shell) < count):
                raise InputError("", f"{column.shell!r} is not one of the {count} absorbers", "they are counted from 0")
            return
        shell = system.shells[_index(system, column.shell)]
    except InputError as error:
        raise InputError(where, error.problem, error.remedy) from None
    roles = {layer.role for layer in getattr(shell, "layers", ())}
    quantity = QUANTITIES[column.quantity]
    if not roles and quantity.needs:
        raise InputError(where, "is of a rigid shell, which has no stress and no voltage", "leave the column out")
    needed = next((role for role in reversed(quantity.roles) if role not in roles), None)
    if needed is not None:
        raise InputError(where, f"is of a shell without a layer that is its {needed}", "leave the column out")


def _index(system: System, name: str) -> int:
    """Return the number of a shell by any of its names."""
    count = len(system.shells)
    names = {shell_name(shell, count): shell for shell in range(count)}
    return names[name] if name in names else system.shell_index(name)


def _ours(response: Response, column: Column) -> tuple[FloatArray, FloatArray]:
    """Return our history, and that of the opposite side; the head is where the first source strikes first."""
    if column.quantity == "absorber_displacement":
        own = np.asarray(response.absorber_displacement())[int(column.shell)]
        return own, own
    head = response.system.sources[0].angle
    angle = head if column.place == "head" else head + 180.0 if column.place == "tail" else float(column.place)
    histories = response.history(_index(response.system, column.shell), [angle, angle + 180.0], column.quantity)
    own, opposite = np.asarray(histories, dtype=np.float64).T
    return own, opposite


def _report(path: Path, theirs: Histories, time: FloatArray, response: Response, tolerance: float, start: float) -> Report:
    rows: list[Row] = []
    panels: dict[str, list[Panel]] = {}
    for column in theirs.columns:
        curve, opposite = _ours(response, column)
        rows += _rows(column, time, response, curve, opposite, tolerance)
        panels.setdefault(column.quantity, []).append(_panel(column, response.time, curve, time, path.name))
    name = response.system.name or "this system"
    about = f"{path.name} against coaxshell, {name}: {response.engine} engine, M = {response.modes}, dt = {response.settings.time_step:g}."
    sheets = tuple(
        Sheet(f"{name}: {quantity.replace('_', ' ')}", f"Lines: coaxshell. Dashed: {path.name}.", drawn)
        for quantity, drawn in panels.items()
    )
    result = Result("against", f"{path.name} against {name}", about, tuple(rows), sheets, perf_counter() - start)
    return Report(f"coaxshell: {path.name} against {name}", (result,), circumstances(), NOTE)


def _rows(
    column: Column, time: FloatArray, response: Response, curve: FloatArray, opposite: FloatArray, tolerance: float
) -> tuple[Row, Row]:
    """Return the rows of the whole history, with the likely cause of a deviation that does not pass, and of its peak."""
    unit = QUANTITIES[column.quantity].unit if column.quantity in QUANTITIES else "m"
    ours = np.interp(time, response.time, curve)
    peaks = [float(history[np.abs(history).argmax()]) for history in (ours, column.values)]
    norm, largest = float(np.linalg.norm(ours)), abs(peaks[0])
    missing = "both are zero throughout" if norm == 0 and peaks[1] == 0 else ""
    error = float(np.linalg.norm(column.values - ours)) / norm if norm else math.inf
    found = f"differs by {error:.3g}"
    if norm and error > min(tolerance, TOLERANCE):
        step = float(response.time[1] - response.time[0])
        cause = likely_cause(time, column.values, step, curve, opposite, error)
        if cause is not None:
            found += f"; likely {cause.text(float(response.time_seconds[1]) / step)}: {cause.left:.2g} once corrected"
    whole = Row(f"{column.name}, whole history", "coaxshell", "coaxshell's", found, error, tolerance, "relative L2", missing)
    peak_error = abs(abs(peaks[1]) - largest) / largest if largest else math.inf
    peak = Row(
        f"{column.name}, peak", "coaxshell", value(peaks[0], unit), value(peaks[1], unit), peak_error, tolerance, "relative", missing
    )
    return whole, peak


def _panel(column: Column, time: FloatArray, curve: FloatArray, at: FloatArray, file: str) -> Panel:
    if column.quantity in QUANTITIES:
        scale, label = QUANTITIES[column.quantity].shown[1], QUANTITIES[column.quantity].axis
    else:
        scale, label = 1e6, "displacement of absorbers (µm)"
    curves = [
        Curve("coaxshell", time, scale * curve, colour="blue"),
        Curve(file, at, scale * column.values, "dashed", colour="orange"),
    ]
    return Panel(column.name, "time (a/c)", label, curves)


def template(
    system: System,
    path: Path,
    *,
    time_step: float = 0.01,
    duration: float = Settings.duration,
    modes: int | Literal["auto"] = Settings.modes,
) -> Path:
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
    names = [str(shell) if " " in name else name for shell in range(count) for name in (shell_name(shell, count),)]
    head = system.sources[0].angle
    for quantity in (QUANTITIES["displacement"], QUANTITIES["stress"]):
        for shell in names:
            if quantity.lack(system, system.shell_index(shell)) is not None:
                continue
            for side, angle in (("head", head), ("tail", head + 180.0)):
                values = np.asarray(response.history(shell, [angle], quantity.name))
                columns[f"{quantity.name}_{shell}_{side} [{quantity.unit}]"] = values[::every, 0]
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
