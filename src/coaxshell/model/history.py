"""Read a pressure history from a CSV file, naming the file and line of whatever is wrong in it."""

from __future__ import annotations

import math
import re
from pathlib import Path

from coaxshell.errors import InputError


def read_history(path: Path) -> tuple[list[float], list[float]]:
    """Return times (s) and pressures (Pa) of a two-column file; blank lines and ``#`` comments are skipped."""
    try:
        lines = path.read_text(encoding="utf-8-sig").splitlines()
    except (OSError, UnicodeError) as error:
        reason = (error.strerror if isinstance(error, OSError) else None) or "not a text file"
        raise InputError(
            str(path), f"cannot be read ({reason})", "give a text file with the columns time in s and pressure in Pa"
        ) from None
    times: list[float] = []
    pressures: list[float] = []
    header_allowed = True
    for number, line in enumerate(lines, start=1):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        where = f"{path}, line {number}"
        cells = _cells(line)
        if header_allowed and not any(_is_number(cell) for cell in cells if cell):
            header_allowed = False
            continue
        header_allowed = False
        time, pressure = _row(cells, where)
        if time < 0:
            raise InputError(where, f"time {time!r} s is negative", "times must be at least 0")
        if times and time <= times[-1]:
            raise InputError(where, f"time {time!r} s does not follow {times[-1]!r} s", "times must be strictly increasing")
        times.append(time)
        pressures.append(pressure)
    if len(times) < 2:
        raise InputError(str(path), f"{len(times)} samples are too few", "must hold at least 2 lines of time and pressure")
    return times, pressures


def _cells(line: str) -> list[str]:
    separator = next((s for s in (";", ",", "\t") if s in line), None)
    parts = line.split(separator) if separator else re.split(r"\s+", line.strip())
    return [part.strip().strip('"') for part in parts]


def _row(cells: list[str], where: str) -> tuple[float, float]:
    if len(cells) != 2:
        raise InputError(where, f"{len(cells)} columns found", "must be 2: time in s and pressure in Pa")
    found = []
    for name, cell in zip(("time", "pressure"), cells, strict=True):
        if not cell:
            raise InputError(where, f"the {name} is missing", "each line must hold a time in s and a pressure in Pa")
        value = float(cell) if _is_number(cell) else math.nan
        if not math.isfinite(value):
            raise InputError(where, f"{name} {cell!r} is not a finite number", "each line must hold a time in s and a pressure in Pa")
        found.append(value)
    return found[0], found[1]


def _is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return True
