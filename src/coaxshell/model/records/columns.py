"""Columns of numbers with their headings, whatever file they come from, and the unit that a heading tells."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from coaxshell.errors import InputError
from coaxshell.model.units import to_si
from coaxshell.numerics.arrays import FloatArray

_BARE = (
    "s",
    "sec",
    "ms",
    "msec",
    "us",
    "µs",
    "usec",
    "ns",
    "Pa",
    "kPa",
    "MPa",
    "GPa",
    "hPa",
    "bar",
    "mbar",
    "psi",
    "ksi",
    "atm",
    "V",
    "mV",
)
"""Units that are recognised without brackets."""
_ENDS = {")": "(", "]": "[", "}": "{", ">": "<"}
_LONGEST = 200


@dataclass(frozen=True)
class Column:
    """One column.

    Attributes
    ----------
    heading : str
        As it stands in the file; "" without one.
    name : str
        The heading without its unit.
    unit : str, optional
        The unit in the heading, as it stands there; None without one.
    values : ndarray
    """

    heading: str
    name: str
    unit: str | None
    values: FloatArray

    def factor(self, kind: str) -> float | None:
        """Return the factor to SI if the unit is one of *kind* ("time", "pressure", ...), else None."""
        return None if self.unit is None else factor_of(self.unit, kind)


@dataclass(frozen=True)
class Table:
    """The columns of a file.

    Attributes
    ----------
    columns : tuple of Column
    lines : sequence of int
        The line of each row; empty where a file has none.
    interval : float, optional
        Interval between rows (s), where the file tells it.
    full_scale : bool
        Whether the numbers are shares of a full scale, not pressures.
    """

    columns: tuple[Column, ...]
    lines: Sequence[int] = ()
    interval: float | None = None
    full_scale: bool = False

    def row(self, index: int) -> str:
        """Name a row for an error."""
        return f"line {self.lines[index]}" if len(self.lines) else f"sample {index + 1}"


def column(heading: str, values: FloatArray, unit: str | None = None) -> Column:
    """Return a column, its unit read from the heading unless given."""
    name, found = split_heading(heading)
    return Column(heading.strip(), name, unit or found, values)


def split_heading(heading: str) -> tuple[str, str | None]:
    """Return name and unit of a heading such as ``time (ms)``, ``p [kPa]``, ``p/kPa``, ``p in kPa``, ``pressure_kPa`` or ``kPa``."""
    text = heading.strip()[:_LONGEST].strip()
    if text and text[-1] in _ENDS:
        opening = text.rfind(_ENDS[text[-1]])
        if opening >= 0:
            inside = text[opening + 1 : -1].strip()
            return text[:opening].rstrip(" :,_/"), inside or None
    stray = next((k for k, letter in enumerate(text) if letter in "()[]{}<>"), None)
    if stray is not None:  # half a pair of brackets: a unit that nobody can be sure of
        return text[:stray].rstrip(), text[stray:]
    if is_unit(text):
        return "", text
    for mark in ("/", " in ", "_", " ", ",", ":"):
        name, found, unit = text.rpartition(mark)
        if found and name.strip() and is_unit(unit.strip()):
            return name.strip(" :,_"), unit.strip()
    return text, None


def is_unit(text: str) -> bool:
    """Tell whether a text without brackets is plainly a unit of time or pressure."""
    return text.replace("μ", "µ") in _BARE


def factor_of(unit: str, kind: str) -> float | None:
    """Return the factor of a unit to SI; None if it is no unit of *kind*."""
    if not unit.strip() or len(unit) > 40 or "%" in unit:  # "%Pa" is a spoilt kPa sooner than a hundredth
        return None
    try:
        return to_si(f"1 {unit}", kind)
    except InputError:
        return None
