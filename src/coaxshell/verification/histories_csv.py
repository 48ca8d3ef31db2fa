"""Another code's histories: a CSV file with a time column and columns such as ``displacement_inner_head [m]``."""

from __future__ import annotations

import csv
import io
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from coaxshell.errors import InputError

FloatArray = npt.NDArray[np.float64]

UNITS = {
    "displacement": {"m": 1.0, "mm": 1e-3, "um": 1e-6, "µm": 1e-6, "μm": 1e-6},
    "stress": {"Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "N/m^2": 1.0},
}
TIME_UNITS = {"transits": None, "a/c": None, "s": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6, "μs": 1e-6}
SIDES = {"head": 0.0, "tail": 180.0}

_HEADING = re.compile(r"\s*(?P<name>[^\[\]()]*?)\s*(?:[\[(](?P<unit>[^\[\]()]*)[\])])?\s*")
_COLUMN = re.compile(r"(?P<quantity>displacement|stress)_(?P<shell>[a-z]+|\d+)_(?P<place>head|tail|-?\d+(?:\.\d+)?)(?:deg)?")
_EXAMPLE = 'write names such as "displacement_inner_head [m]", "stress_outer_tail [MPa]" or "stress_outer_90 [Pa]"'


@dataclass(frozen=True)
class Column:
    """One history in SI: its name, quantity, shell as written, angle in degrees, and values."""

    name: str
    quantity: str
    shell: str
    angle: float
    values: FloatArray


@dataclass(frozen=True)
class Histories:
    """The histories of a file: times in ``unit`` ("transits" or "s") and columns."""

    time: FloatArray
    unit: str
    columns: tuple[Column, ...]


def read_histories(path: Path) -> Histories:
    """Return the histories of a CSV file with a line of headings; blank lines and ``#`` comments are skipped.

    Raises
    ------
    InputError
        Naming the file, the line or the column, and what is wrong.
    """
    try:
        lines = path.read_text(encoding="utf-8-sig").splitlines()
    except (OSError, UnicodeError) as error:
        reason = (error.strerror if isinstance(error, OSError) else None) or "not a text file"
        raise InputError(str(path), f"cannot be read ({reason.lower()})", "give a CSV file; --template writes an example") from None
    kept = [(number, line) for number, line in enumerate(lines, start=1) if line.strip() and not line.lstrip().startswith("#")]
    if len(kept) < 3:
        raise InputError(str(path), "holds no histories", "give headings and at least 2 lines of numbers; --template writes an example")
    separator = next((s for s in (";", ",", "\t") if s in kept[0][1]), ",")
    headings = _cells(kept[0][1], separator)
    table = _numbers(path, kept[1:], headings, separator)
    return _histories(path, headings, table)


def _cells(line: str, separator: str) -> list[str]:
    return [cell.strip() for cell in next(csv.reader(io.StringIO(line), delimiter=separator, skipinitialspace=True))]


def _numbers(path: Path, lines: Sequence[tuple[int, str]], headings: list[str], separator: str) -> FloatArray:
    rows = []
    for number, line in lines:
        cells = _cells(line, separator)
        where = f"{path}, line {number}"
        if len(cells) != len(headings):
            raise InputError(where, f"{len(cells)} values for {len(headings)} columns", "each line must hold one number for each heading")
        rows.append([_number(cell, where, heading) for cell, heading in zip(cells, headings, strict=True)])
    return np.array(rows)


def _number(cell: str, where: str, heading: str) -> float:
    try:
        value = float(cell)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise InputError(where, f"{cell!r} in column {heading!r} is not a finite number", "each value must be a number such as 1.2e-6")
    return value


def _histories(path: Path, headings: list[str], table: FloatArray) -> Histories:
    time, unit, columns = None, "", []
    for heading, values in zip(headings, table.T, strict=True):
        match = _HEADING.fullmatch(heading)
        name, given = (match["name"].lower(), match["unit"]) if match else (heading.lower(), None)
        if name in ("time", "time_seconds", "time_transits", "t"):
            if time is not None:
                raise InputError(f"{path}, column {heading!r}", "is a second time", "give one column of times")
            unit, factor = _time_unit(path, heading, name, given)
            time = values * factor
        else:
            columns.append(_column(path, heading, name, given, values))
    if time is None:
        raise InputError(str(path), f"has no column of times among {', '.join(headings)}", 'add "time [transits]" or "time [s]"')
    if not columns:
        raise InputError(str(path), "has times only", _EXAMPLE)
    if np.any(np.diff(time) <= 0):
        late = int(np.argmax(np.diff(time) <= 0)) + 1
        raise InputError(str(path), f"time {time[late]:g} does not follow {time[late - 1]:g}", "times must be strictly increasing")
    if time[0] < 0:
        raise InputError(str(path), f"time {time[0]:g} is negative", "t = 0 is when the front reaches the head of the outermost shell")
    return Histories(time, unit, tuple(columns))


def _time_unit(path: Path, heading: str, name: str, given: str | None) -> tuple[str, float]:
    """Return "transits" or "s", and the factor of the values to it."""
    written = given or {"time_seconds": "s", "time_transits": "transits"}.get(name)
    if written is None or written not in TIME_UNITS:
        problem = "has no unit" if written is None else f"has the unknown unit {written!r}"
        raise InputError(f"{path}, column {heading!r}", problem, 'write "time [transits]" (a/c_e), "time [s]", "time [ms]" or "time [us]"')
    factor = TIME_UNITS[written]
    return ("transits", 1.0) if factor is None else ("s", factor)


def _column(path: Path, heading: str, name: str, given: str | None, values: FloatArray) -> Column:
    match = _COLUMN.fullmatch(name)
    if match is None:
        raise InputError(f"{path}, column {heading!r}", "is not a name that is known here", _EXAMPLE)
    known = UNITS[match["quantity"]]
    if given and given not in known:
        raise InputError(f"{path}, column {heading!r}", f"has the unknown unit {given!r}", f"allowed: {', '.join(known)}")
    place = match["place"]
    angle = SIDES[place] if place in SIDES else float(place)
    return Column(name, match["quantity"], match["shell"], angle, values * (known[given] if given else 1.0))
