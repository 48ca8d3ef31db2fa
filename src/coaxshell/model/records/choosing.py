"""Which columns are time and pressure, and in which units: what the reader of a record is told, finds, or takes."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from coaxshell.errors import InputError
from coaxshell.model.base import shown
from coaxshell.model.naming import plain, suggestion
from coaxshell.model.records.columns import Column, Table, factor_of
from coaxshell.model.units import to_si
from coaxshell.numerics.arrays import FloatArray

READING = ("time_column", "pressure_column", "time_unit", "pressure_unit", "interval")
"""Entries that tell how a file is read; the other ones of a record tell what is made of it."""

_TIMES = ("time", "t", "times", "seconds", "zeit", "temps", "tiempo", "tempo", "tid", "czas", "час", "时间", "時間", "x")
_PRESSURES = (
    "pressure",
    "p",
    "overpressure",
    "druck",
    "pression",
    "presion",
    "presión",
    "pressione",
    "tryck",
    "druk",
    "давление",
    "压力",
)


@dataclass(frozen=True)
class Wanted:
    """What a column may hold.

    Attributes
    ----------
    word : str
        Of its options, WORD_column and WORD_unit, and of errors.
    names : tuple of str
        Headings by which it is known.
    unit : str
        In SI.
    factor : callable
        From a unit as it stands in a file to its factor to SI; None if it is none of this kind.
    example : str
        What a unit of it looks like, for errors.
    """

    word: str
    names: tuple[str, ...]
    unit: str
    factor: Callable[[str], float | None]
    example: str


TIME = Wanted("time", _TIMES, "s", lambda unit: factor_of(unit, "time"), "ms or us")
PRESSURE = Wanted("pressure", _PRESSURES, "Pa", lambda unit: factor_of(unit, "pressure"), "kPa or psi")


@dataclass(frozen=True)
class Chosen:
    """Times (s) and values (SI) of a record, and in words which columns and units they are."""

    time: FloatArray
    values: FloatArray
    account: str


def choose(table: Table, options: Mapping[str, Any], name: str, wanted: Wanted = PRESSURE) -> Chosen:
    """Return the record in a table, of pressures unless values of another kind are wanted.

    Raises
    ------
    InputError
        The columns cannot be told, a unit is none, the interval is missing, or times do not increase.
    """
    interval = _interval(table, options)
    time = None if interval is not None else _time_column(table, options, name, wanted)
    values, about_values = _in_si(_value_column(table, time, options, name, wanted), table, wanted, options, name)
    if time is None:
        times, about_time = np.arange(len(values), dtype=np.float64) * float(interval or 0.0), f"a sample every {interval:.6g} s"
    else:
        times, about_time = _in_si(time, table, TIME, options, name)
        late = np.flatnonzero(np.diff(times) <= 0)
        if late.size:
            row = int(late[0]) + 1
            raise InputError(
                f"{name}, {table.row(row)}",
                f"time {float(times[row])!r} s does not follow {float(times[row - 1])!r} s",
                "times must be strictly increasing",
            )
    if len(times) < 2:
        raise InputError(name, f"{len(times)} samples are too few", f"must hold at least 2 samples of time and {wanted.word}")
    return Chosen(times, values, f"{about_time}, {about_values}")


def _interval(table: Table, options: Mapping[str, Any]) -> float | None:
    """Return the interval between samples where there is no column of times."""
    if options.get("interval") is not None:
        if options.get("time_column") is not None:
            raise InputError("interval", "has no effect beside time_column", "give one of them")
        found = to_si(options["interval"], "time")
        if found <= 0:
            raise InputError("interval", f"{found!r} s is not allowed", "must be greater than 0")
        return found
    named = any(_is(column, TIME) for column in table.columns)
    return None if named or options.get("time_column") is not None else table.interval


def _time_column(table: Table, options: Mapping[str, Any], name: str, wanted: Wanted) -> Column:
    if options.get("time_column") is not None:
        return _asked(table, options["time_column"], "time_column")
    if len(table.columns) == 1:
        raise InputError(name, "has 1 column and no times", "give interval, the time between samples, or a column of times")
    found = [column for column in table.columns if _is(column, TIME)]
    if len(found) > 1:
        named = [column for column in found if plain(column.name) in TIME.names]
        found = named if len(named) == 1 else found
    if len(found) > 1:
        raise InputError(name, f"{len(found)} columns hold times", f"give time_column: {_listing(table)}")
    first = table.columns[0]
    if not found and _is(first, wanted):
        raise InputError(name, f"no column of times is found: {_listing(table)}", "give time_column, or interval")
    return found[0] if found else first


def _value_column(table: Table, time: Column | None, options: Mapping[str, Any], name: str, wanted: Wanted) -> Column:
    where = f"{wanted.word}_column"
    if options.get(where) is not None:
        found = _asked(table, options[where], where)
        if found is time:
            raise InputError(where, f"{shown(options[where])} is the column of times", f"give another: {_listing(table)}")
        return found
    others = [column for column in table.columns if column is not time]
    if len(others) > 1:
        likely = [column for column in others if _is(column, wanted)]
        others = likely if len(likely) == 1 else others
    if len(others) != 1:
        raise InputError(name, f"{len(table.columns)} columns found: {_listing(table)}", f"give {where}, a name or a number from 1 on")
    return others[0]


def _is(column: Column, wanted: Wanted) -> bool:
    """Tell whether unit or name of a column are those of a kind."""
    return wanted.factor(column.unit) is not None if column.unit is not None else plain(column.name) in wanted.names


def _asked(table: Table, wanted: Any, where: str) -> Column:
    if (isinstance(wanted, int) and not isinstance(wanted, bool)) or (isinstance(wanted, str) and len(wanted) < 6 and wanted.isdecimal()):
        if 1 <= int(wanted) <= len(table.columns):
            return table.columns[int(wanted) - 1]
        raise InputError(where, f"there is no column {int(wanted):.6g}", f"allowed: {_listing(table)}")
    if not isinstance(wanted, str):
        raise InputError(where, f"{shown(wanted)} is no column", f"give a name or a number: {_listing(table)}")
    for same in (
        lambda column: wanted.strip() == column.heading,
        lambda column: plain(wanted) in (plain(column.heading), plain(column.name)),
    ):
        found = [column for column in table.columns if same(column)]
        if len(found) == 1:
            return found[0]
        if found:
            raise InputError(where, f"{len(found)} columns are called {shown(wanted)}", f"give a number: {_listing(table)}")
    names = [column.heading or str(k) for k, column in enumerate(table.columns[:20], start=1)]
    raise InputError(where, f"{shown(wanted)} is no column of the file", suggestion(wanted, names))


def _listing(table: Table) -> str:
    shown_ = [f"{k} {column.heading!r:.40}" if column.heading else str(k) for k, column in enumerate(table.columns[:12], start=1)]
    return ", ".join(shown_) + (", ..." if len(table.columns) > 12 else "")


def _in_si(column: Column, table: Table, wanted: Wanted, options: Mapping[str, Any], name: str) -> tuple[FloatArray, str]:
    """Return the values of a column in SI, and in words which unit was read or taken."""
    kind, told = wanted.word, options.get(f"{wanted.word}_unit")
    label = f"{kind} {column.name!r}" if column.name else kind
    if told is not None:
        factor = wanted.factor(told) if isinstance(told, str) else None
        if factor is None:
            raise InputError(f"{kind}_unit", f"{shown(told)} is no unit of {kind}", f"give one such as {wanted.example}")
        return _times(column.values, factor), f"{label} in {told}, as told"
    if wanted is not TIME and table.full_scale:
        return column.values, f"{label}, shares of full scale"
    if column.unit is None:
        return column.values, f"{label} without a unit, taken as {wanted.unit}"
    factor = wanted.factor(column.unit)
    if factor is None:
        volts = f"; for volts, scale too: {kind}_unit for each volt" if wanted is PRESSURE else ""
        problem = f"{shown(column.unit)} is no unit of {kind}"
        raise InputError(f"{name}, column {column.heading!r:.60}", problem, f"give {kind}_unit{volts}")
    return _times(column.values, factor), f"{label} in {column.unit}"


def _times(values: FloatArray, factor: float) -> FloatArray:
    """Return values times a unit's factor; a division for small factors, so that 0.1 ms is the float 0.0001."""
    inverse = round(1 / factor) if factor < 1 else 0
    return values / inverse if inverse and abs(inverse * factor - 1) < 1e-12 else values * factor
