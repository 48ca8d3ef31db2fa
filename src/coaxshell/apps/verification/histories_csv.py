"""Another code's histories: a file with a column of times and columns such as ``displacement_inner_head [m]``, or our own CSV export."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from coaxshell.errors import InputError
from coaxshell.limits import HISTORY_COLUMNS, RECORD_BYTES
from coaxshell.model.base import shown
from coaxshell.model.records.columns import Column as FileColumn
from coaxshell.model.records.columns import Table, factor_of
from coaxshell.model.records.reader import table_of
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.reading import regular_bytes
from coaxshell.response.quantities import QUANTITIES, columns

TIMES = ("time", "t", "time seconds", "time transits", "zeit", "temps")
TRANSITS = ("transits", "transit", "a/c", "a/c_e")
SIDES = ("head", "tail")
VOLTAGES = {"V": 1.0, "mV": 1e-3, "kV": 1e3}
KINDS = {"m": "length", "Pa": "pressure", "m/s": "speed", "m/s^2": "acceleration"}
_USUAL = {
    "m": "m, mm, um or any other length",
    "Pa": "Pa, kPa, MPa or any other unit of stress",
    "m/s": "m/s, mm/s or any other speed",
    "m/s^2": "m/s^2, mm/s^2 or any other acceleration",
}
_EXAMPLE = 'write names such as "displacement_inner_head [m]", "stress_outer_tail [MPa]" or "stress_outer_90 [Pa]"'
_REMEDY = "give a CSV file; --template writes an example"


@dataclass(frozen=True)
class Column:
    """One history in SI.

    Attributes
    ----------
    name : str
        The heading without its unit.
    quantity : str
        One of those with columns in :mod:`coaxshell.response.quantities`, or ``"absorber_displacement"``.
    shell : str
        As written; the number of an absorber for its displacement.
    place : str
        ``"head"``, ``"tail"``, an angle in degrees, or "" for an absorber.
    values : ndarray
    """

    name: str
    quantity: str
    shell: str
    place: str
    values: FloatArray


@dataclass(frozen=True)
class Histories:
    """The histories of a file: times in transits or in seconds or both, and columns."""

    transits: FloatArray | None
    seconds: FloatArray | None
    columns: tuple[Column, ...]


def read_histories(path: Path) -> Histories:
    """Return the histories of a file, read as pressure records are: any usual separator, decimal sign, comments and encoding.

    Raises
    ------
    InputError
        Naming the file, the line or the column, and what is wrong.
    """
    content = regular_bytes(path, RECORD_BYTES, _REMEDY)
    table = table_of(content, str(path), HISTORY_COLUMNS) if content.strip() else Table(())
    if not table.columns or len(table.columns[0].values) < 2:
        raise InputError(str(path), "holds no histories", "give headings and at least 2 lines of numbers; --template writes an example")
    times: dict[str, FloatArray] = {}
    columns: list[Column] = []
    for one in table.columns:
        where = f"{path}, column {shown(one.heading)}"
        if _plain(one.name) not in TIMES:
            columns.append(_column(where, one))
            continue
        unit, factor = _time_unit(where, one)
        if unit in times:
            raise InputError(where, "is a second time", "give one column of times")
        times[unit] = _checked(path, table, one.values * factor)
    if not times:
        headings = ", ".join(shown(one.heading) for one in table.columns[:9])
        raise InputError(str(path), f"has no column of times among {headings}", 'add "time [transits]" or "time [s]"')
    if not columns:
        raise InputError(str(path), "has times only", _EXAMPLE)
    return Histories(times.get("transits"), times.get("s"), tuple(columns))


def _plain(name: str) -> str:
    return name.lower().replace("_", " ")


def _checked(path: Path, table: Table, time: FloatArray) -> FloatArray:
    """Return times that increase from 0 or later."""
    behind = np.flatnonzero(np.diff(time) <= 0)
    if behind.size:
        late = int(behind[0]) + 1
        where = f"{path}, {table.row(late)}"
        raise InputError(where, f"time {time[late]:g} does not follow {time[late - 1]:g}", "times must be strictly increasing")
    if time[0] < 0:
        raise InputError(str(path), f"time {time[0]:g} is negative", "t = 0 is when the front reaches the head of the outermost shell")
    return time


def _time_unit(where: str, column: FileColumn) -> tuple[str, float]:
    """Return "transits" or "s", and the factor of the values to it."""
    written = column.unit or {"time seconds": "s", "time transits": "transits"}.get(_plain(column.name))
    if written in TRANSITS:
        return "transits", 1.0
    factor = factor_of(written, "time") if written else None
    if factor is None:
        problem = f"has the unknown unit {shown(written)}" if written else "has no unit"
        raise InputError(where, problem, 'write "time [transits]" (a/c_e), "time [s]", "time [ms]" or "time [us]"')
    return "s", factor


def _column(where: str, column: FileColumn) -> Column:
    words = _plain(column.name).split()
    for quantity, shell, place in _meanings(words):
        return Column(column.name, quantity, shell, place, column.values * _factor(where, quantity, column.unit))
    if "z" in words and "=" in words:
        raise InputError(where, "is of a run in three dimensions, and runs in two are compared here", "export a run in two dimensions")
    raise InputError(where, "is not a name that is known here", _EXAMPLE)


def _meanings(words: list[str]) -> Iterator[tuple[str, str, str]]:
    """Give quantity, shell and place of the words of a heading, such as "displacement inner head" or "shell 2 of 4 stress tail"."""
    if len(words) == 3 and words[0] == "absorber" and words[2] == "displacement":
        yield "absorber_displacement", words[1], ""
    place = words[-1].removesuffix("deg") if words else ""
    if place not in SIDES and not _is_angle(place):
        return
    rest = words[:-1]
    for quantity in columns():
        naming = tuple(quantity.words.split())
        for start in range(len(rest) - len(naming) + 1):
            shell = rest[:start] + rest[start + len(naming) :]
            if tuple(rest[start : start + len(naming)]) == naming and shell:
                yield quantity.name, " ".join(shell), place


def _is_angle(text: str) -> bool:
    digits = text.removeprefix("-").replace(".", "", 1)
    return digits.isascii() and digits.isdigit() and len(digits) < 20


def _factor(where: str, quantity: str, unit: str | None) -> float:
    """Return the factor of a unit to SI; 1 without one."""
    if unit is None:
        return 1.0
    own = QUANTITIES[quantity].unit if quantity in QUANTITIES else "m"
    if own == "V":
        factor, usual = VOLTAGES.get(unit), ", ".join(VOLTAGES)
    elif own in KINDS:
        factor, usual = factor_of(unit, KINDS[own]), _USUAL[own]
    else:
        factor, usual = (1.0 if unit == own else None), own
    if factor is None:
        raise InputError(where, f"has the unknown unit {shown(unit)}", f"allowed: {usual}")
    return factor
