"""Tables of numbers as text: separators, decimal signs, comments, headings and encodings as instruments and spreadsheets write them.

What a line means is never guessed around: a line among the numbers that is not all numbers is an error with its place, and so is
whatever can be read in two ways.
"""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain

import numpy as np

from coaxshell.errors import InputError
from coaxshell.limits import RECORD_COLUMNS, RECORD_SAMPLES, Limit
from coaxshell.model.base import shown
from coaxshell.model.records.columns import Column, Table, column, factor_of, is_unit, split_heading
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.reading import decoded

COMMENTS = ("#", "%", "//", "!")
PREAMBLE = 2000
"""Lines before the first number."""
_CONTROL = re.compile(r"[\x01-\x08\x0b\x0e-\x1f\x7f]")
REMEDY = "give a text file with columns of time and pressure, units in their headings, as in: time (ms), pressure (kPa)"


@dataclass(frozen=True)
class Dialect:
    """How the lines of a file are written: ``separator`` is "" for blanks; ``quoted`` if cells stand in quotation marks."""

    separator: str
    decimal: str = "."
    quoted: bool = False

    def cells(self, line: str) -> list[str]:
        """Return the cells of a line, without blanks and quotation marks around them."""
        if self.quoted and '"' in line and line.count('"') % 2 == 0:
            found = next(csv.reader([line], delimiter=self.separator or " ", skipinitialspace=True))
        else:
            found = line.split(self.separator or None)
        return [cell.strip() for cell in found]

    def number(self, cell: str) -> float:
        """Return the number in a cell; NaN if there is none."""
        plain = cell.replace(",", ".") if self.decimal == "," else cell
        return number(plain)


def number(text: str) -> float:
    """Return a finite number as people and Fortran write it; NaN for anything else."""
    plain = text.replace("−", "-").replace("D", "E").replace("d", "e")
    try:
        found = float(plain) if plain.isascii() and "_" not in plain else math.nan
    except ValueError:
        return math.nan
    return found if math.isfinite(found) else math.nan


def text_table(content: bytes, name: str, most: Limit = RECORD_COLUMNS) -> Table:
    """Return the columns of a text, at most so many.

    Raises
    ------
    InputError
        Naming the file and the line: it is no text, holds no numbers, or a line that does not fit the others.
    """
    try:
        text = decoded(content, fallback="cp1252")
    except UnicodeError:
        raise InputError(name, "cannot be read (not a text file)", REMEDY) from None
    if "\0" in text or (text and not text.isprintable() and sum(c < " " and c not in "\t\n\f" for c in text[:2000]) > 3):
        raise InputError(name, "cannot be read (not a text file)", REMEDY)
    lines = text.removeprefix("\ufeff").removesuffix("\x1a").split("\n")  # a mark of old systems for the end of a file
    _refuse_controls(lines, name)
    RECORD_SAMPLES.check(len(lines), name)
    first, dialect = _first_numbers(lines)
    if first is None:
        raise _no_numbers(name, lines, dialect)
    numbers, body = _body(text, lines, first)
    dialect = _with_decimal(dialect, body, numbers, name)
    body = _without_trailing(body, dialect)
    headings = _headings(lines, first, dialect, len(dialect.cells(body[0])), name)
    table = _fast(body, dialect) if text.isascii() and "_" not in text else None
    if table is None:
        table = _slow(body, numbers, dialect, headings, name)
    most.check(table.shape[1], name)
    columns = tuple(_column(heading, unit, values) for (heading, unit), values in zip(headings, table.T, strict=True))
    return Table(columns, numbers)


def _refuse_controls(lines: Sequence[str], name: str) -> None:
    """Raise InputError for a control character outside comments: Python takes some for spaces, and would pass over a spoilt digit."""
    if _CONTROL.search("\n".join(lines)) is None:
        return
    for number, line in enumerate(lines, start=1):
        control = None if is_comment(line) else _CONTROL.search(line)
        if control is not None:
            raise InputError(f"{name}, line {number}", f"{control[0]!r} is no part of a text", "write the file again")


def _column(heading: str, unit: str, values: FloatArray) -> Column:
    return column(heading, np.ascontiguousarray(values), unit or None)


def is_comment(line: str) -> bool:
    """Tell whether a line is blank or a comment."""
    plain = line.strip().lstrip('"')
    return not plain or plain.startswith(COMMENTS)


def _first_numbers(lines: Sequence[str]) -> tuple[int | None, Dialect]:
    """Return the index of the first line of numbers and how it is written; None, and a likely dialect, if there is none."""
    for index, line in enumerate(lines[:PREAMBLE]):
        if is_comment(line):
            continue
        dialect = dialect_of(line)
        cells = dialect.cells(line)
        while len(cells) > 1 and not cells[-1]:
            cells.pop()
        if not any(math.isnan(dialect.number(cell)) for cell in cells):
            return index, dialect
    likely = next((line for line in lines if not is_comment(line)), "")
    return None, dialect_of(likely)


def dialect_of(line: str) -> Dialect:
    """Return how a line of numbers is written, as far as it alone tells."""
    quoted = '"' in line
    for separator in (";", "\t"):
        if separator in line:
            return Dialect(separator, "," if "," in line else ".", quoted)
    words = line.split()
    if "," in line and not quoted:
        comma = len(words) > 1 and all(word.count(",") <= 1 and word[0] != "," and word[-1] != "," for word in words)
        return Dialect("", ",") if comma else Dialect(",")
    if quoted and "," in line:
        cells = Dialect(",", ".", quoted).cells(line)
        return Dialect(",", "," if any("," in cell for cell in cells) else ".", quoted)
    return Dialect("", ".", quoted)


def _body(text: str, lines: Sequence[str], first: int) -> tuple[Sequence[int], list[str]]:
    """Return the lines of numbers and their places in the file; blank lines and comments are left out."""
    rest = lines[first:]
    while rest and not rest[-1].strip():
        rest = rest[:-1]
    places: list[int] | range = range(first + 1, first + 1 + len(rest))
    if any(mark in text for mark in ("\n\n", "\n ", "\n\t", '\n"', *(f"\n{mark}" for mark in COMMENTS))):
        kept = [(place, line) for place, line in zip(places, rest, strict=True) if not is_comment(line)]
        places, rest = [place for place, _ in kept], [line for _, line in kept]
    return places, list(rest)


def _with_decimal(dialect: Dialect, body: Sequence[str], places: Sequence[int], name: str) -> Dialect:
    """Return the dialect with the decimal sign that the lines use; InputError where they use two."""
    if dialect.separator == ",":
        return dialect
    commas = next((k for k, line in enumerate(body) if "," in line), None)
    if commas is None:
        return Dialect(dialect.separator, ".", dialect.quoted)
    if not dialect.separator and len(body[commas].split()) == 1:
        where = f"{name}, line {places[commas]}"
        raise InputError(
            where, f"{shown(body[commas])} may be read in two ways", "every line must hold as many numbers, with one separator"
        )
    points = next((k for k, line in enumerate(body) if "." in line), None)
    if points is not None:
        where = f"{name}, line {places[max(commas, points)]}"
        raise InputError(
            where,
            "commas and points are both used in numbers, which may be read in two ways",
            "use one decimal sign, and none for thousands",
        )
    return Dialect(dialect.separator, ",", dialect.quoted)


def _without_trailing(body: list[str], dialect: Dialect) -> list[str]:
    """Return the lines without a separator at the end of every one."""
    mark = dialect.separator
    if mark and all(line.rstrip(" ").endswith(mark) for line in body):
        return [line.rstrip(" ").removesuffix(mark) for line in body]
    return body


def _fast(body: Sequence[str], dialect: Dialect) -> FloatArray | None:
    """Return all numbers at once if every line has as many, else None."""
    if dialect.separator:
        counts = {line.count(dialect.separator) + 1 for line in body}
        cells = dialect.separator.join(body).split(dialect.separator)
    else:
        rows = [line.split() for line in body]
        counts = set(map(len, rows))
        cells = list(chain.from_iterable(rows))
    if len(counts) != 1:
        return None
    if dialect.decimal == ",":
        cells = [cell.replace(",", ".") for cell in cells]
    try:
        values = np.fromiter(map(float, cells), float, len(cells))
    except ValueError:
        return None
    return values.reshape(len(body), -1) if np.isfinite(values).all() else None


def _slow(body: Sequence[str], places: Sequence[int], dialect: Dialect, headings: Sequence[tuple[str, str]], name: str) -> FloatArray:
    """Return all numbers, line by line; InputError at the first that does not fit."""
    count = len(headings)
    labels = [heading or ("time", "pressure")[k] if count == 2 else heading or f"column {k + 1}" for k, (heading, _) in enumerate(headings)]
    rows = []
    for place, line in zip(places, body, strict=True):
        cells = dialect.cells(line)
        where = f"{name}, line {place}"
        if len(cells) != count:
            raise InputError(where, f"{len(cells)} values for {count} columns", "each line must hold one number for each column")
        row = [dialect.number(cell) for cell in cells]
        for label, cell, value in zip(labels, cells, row, strict=True):
            if math.isnan(value):
                raise _no_number(where, label, cell)
        rows.append(row)
    return np.array(rows)


def _no_number(where: str, label: str, cell: str) -> InputError:
    if not cell:
        return InputError(where, f"the {label} is missing", "each line must hold one number for each column")
    if "," in cell and "." in cell:
        return InputError(where, f"{label} {shown(cell)} may be read in two ways", "use one decimal sign, and none for thousands")
    return InputError(where, f"{label} {shown(cell)} is not a finite number", "each value must be a number such as 1.2e-6")


def _headings(lines: Sequence[str], first: int, dialect: Dialect, count: int, name: str) -> list[tuple[str, str]]:
    """Return heading and unit ("" where the heading holds it, or nothing does) of each column, from the lines before the numbers.

    They are the line just before the numbers, or that and the one before it where the last holds nothing but units. A comment with as
    many cells, some of them with units, counts if no other line tells any.
    """
    before = [(k, line) for k, line in enumerate(lines[:first]) if line.strip()]
    plain = [(k, line) for k, line in before if not is_comment(line)]
    rows = [(k, _heading_cells(line, dialect, count)) for k, line in plain[-2:]]
    found = [("", "")] * count
    if rows:
        k, cells = rows[-1]
        own = dialect.cells(plain[-1][1])
        numbers = [cell for cell in own if not math.isnan(dialect.number(cell))]
        if (numbers and (len(own) == count or own[0] == numbers[0])) or own[0][
            :1
        ] in "+-.0123456789":  # a line of numbers that is spoilt, not headings
            bad = next((cell for cell in own if cell not in numbers), "")
            raise _no_number(
                f"{name}, line {k + 1}", ("time", "pressure")[own.index(bad) % 2 if bad in own else 1] if count == 2 else "value", bad
            )
        if len(cells) == count and _only_units(cells):
            above = rows[0][1] if len(rows) == 2 and len(rows[0][1]) == count else [""] * count
            found = [(heading, cell.strip("()[]{} ")) for heading, cell in zip(above, cells, strict=True)]
        elif len(cells) == count:
            found = [(cell, "") for cell in cells]
            if len(rows) == 2 and len(rows[0][1]) == count and any(_told(cell) for cell in rows[0][1]) and not any(map(_told, cells)):
                raise InputError(
                    f"{name}, line {k + 1}",
                    f"{shown(cells[0])} is not a finite number",
                    "below the headings only units and numbers may stand",
                )
    if not any(unit or _told(heading) for heading, unit in found):
        _check_lost(plain, rows, dialect, count, name)
        found = _commented(before, dialect, count) or found
    return found


def _check_lost(plain: Sequence[tuple[int, str]], rows: Sequence[tuple[int, list[str]]], dialect: Dialect, count: int, name: str) -> None:
    """Refuse headings with units that do not belong to the numbers by their place or their number: their units would be lost."""
    for k, line in plain[-50:]:
        cells = _heading_cells(line, dialect, count)
        if any(_told(cell) for cell in cells) and (len(cells) == count or (rows and k == rows[-1][0])):
            problem = "headings stand apart from the numbers" if len(cells) == count else f"{len(cells)} headings for {count} columns"
            raise InputError(f"{name}, line {k + 1}", problem, "put one heading for each column into the line above the numbers")


def _heading_cells(line: str, dialect: Dialect, count: int) -> list[str]:
    """Return the cells of a heading, which may be separated otherwise than the numbers."""
    cells = dialect.cells(line)
    if not dialect.separator and not _only_units(cells):
        cells = _with_brackets(cells)
    for separator in (",", ";", "\t", ""):
        if len(cells) == count:
            break
        other = _with_brackets(Dialect(separator, ".", True).cells(line))
        cells = other if len(other) == count else cells
    while len(cells) > count and not cells[-1]:
        cells.pop()
    return cells


def _with_brackets(cells: list[str]) -> list[str]:
    """Return cells with a unit in brackets put to the name before it: ``time (ms) p (kPa)`` between blanks is two."""
    joined: list[str] = []
    for cell in (cell.rstrip(",;") for cell in cells):
        if joined and cell[:1] in ("(", "[", "{") and joined[-1][-1:] not in (")", "]", "}"):
            joined[-1] += f" {cell}"
        else:
            joined.append(cell)
    return joined


def _only_units(cells: Sequence[str]) -> bool:
    """Tell whether cells hold units and nothing else: all are empty, in brackets or plain units, and one at least is a known one."""
    bare = [cell.strip("()[]{} ") for cell in cells]
    wrapped = all(not cell or cell[0] in "([{" or is_unit(cell) for cell in cells)
    return wrapped and any(is_unit(cell) or factor_of(cell, "time") or factor_of(cell, "pressure") for cell in bare)


def _told(heading: str) -> bool:
    """Tell whether a heading holds a unit."""
    return split_heading(heading)[1] is not None


def _commented(before: Sequence[tuple[int, str]], dialect: Dialect, count: int) -> list[tuple[str, str]] | None:
    """Return headings with units from the last comment that has one for each column, as numpy.savetxt writes them."""
    for _, line in reversed(before):
        if is_comment(line):
            cells = _heading_cells(line.strip().lstrip('#%/!" '), dialect, count)
            if len(cells) == count and all(_told(cell) for cell in cells):
                return [(cell, "") for cell in cells]
    return None


def _no_numbers(name: str, lines: Sequence[str], dialect: Dialect) -> InputError:
    kept = [(k, line) for k, line in enumerate(lines) if not is_comment(line)]
    if len(kept) > 1:
        place, line = kept[1]
        cells = dialect.cells(line)
        bad = next((cell for cell in cells if math.isnan(dialect.number(cell))), "")
        label = ("time", "pressure")[min(cells.index(bad), 1)] if len(cells) == 2 else "value"
        problem = f"the {label} is missing" if not bad else f"{label} {shown(bad)} is not a finite number"
        return InputError(f"{name}, line {place + 1}", problem, "each line must hold numbers only")
    return InputError(name, "0 samples are too few", "must hold at least 2 lines of numbers, such as time and pressure")
