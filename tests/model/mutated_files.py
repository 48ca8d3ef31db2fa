"""Records and scenarios as people have them, spoilt in many ways, and readers of our own to compare with: the same ones every time."""

from __future__ import annotations

import csv
import math
import random
import re
import tomllib

import pint

from coaxshell.model import System, presets
from coaxshell.model.base import Described

TIME_UNITS = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6}
PRESSURE_UNITS = {"Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "bar": 1e5, "psi": 6894.757293168361}
_TIMES, _PRESSURES = TIME_UNITS | {"": 1.0}, PRESSURE_UNITS | {"": 1.0, "mPa": 1e-3}
"""Those that a spoilt heading may come to name as well."""
SEPARATORS = (",", ";", "\t", " ")
UNITS = pint.UnitRegistry(cache_folder=None)


def record(random_):
    """Return the text of a record, its separator and its decimal sign."""
    separator = random_.choice(SEPARATORS)
    decimal = random_.choice((".", ",")) if separator != "," else "."
    time, pressure = random_.choice(list(TIME_UNITS)), random_.choice(list(PRESSURE_UNITS))
    lines = [f"time ({time}){separator}pressure ({pressure})"] if random_.random() < 0.8 else []
    if random_.random() < 0.2:
        lines.insert(0, "# gauge 3")
    instant = random_.choice((0.0, 0.0, -0.5))
    for _ in range(random_.randrange(4, 9)):
        cells = f"{instant:.3f}", f"{random_.uniform(-50, 300):.2f}"
        lines.append(separator.join(cell.replace(".", decimal) for cell in cells))
        instant += random_.uniform(0.01, 1)
    return "\n".join(lines) + random_.choice(("", "\n")), separator, decimal


def spoilt(random_, content, pieces, *, gently=False):
    """Return bytes with a few letters replaced, removed, doubled or put in, or lines moved, or the end cut off."""
    for _ in range(1 if gently else random_.randrange(1, 4)):
        place = random_.randrange(len(content) + 1)
        match random_.randrange(3 if gently else 7):
            case 0:
                content = content[:place] + content[place + 1 :]
            case 1:
                content = content[:place] + random_.choice(pieces) + content[place:]
            case 2:
                content = content[:place] + random_.choice(pieces) + content[place + 1 :]
            case 3:
                content = content[:place]
            case 4:
                content = content[:place] + content[place : place + 6] + content[place:]
            case 5:
                lines = content.split(b"\n")
                random_.shuffle(lines)
                content = b"\n".join(lines)
            case _:
                content = content[:place] + bytes([random_.randrange(256)]) + content[place + 1 :]
    return content


RECORD_PIECES = [
    *(piece.encode() for piece in ', ; \t . - e E5 ( ) ms k M m nan inf _ 0 9 # % " 1,5 x \x00 \u00a0 \u2212 \ufeff'.split(" ")),  # noqa: SIM905
    b" ",
    b"\n",
    b"\r\n",
    b"\xff",
]
SCENARIO_PIECES = [
    *(piece.encode() for piece in "= [ ] { } \" ' . , # 0 9 e5 - mm kPa true inf nan x \x00 \u2212 _".split(" ")),  # noqa: SIM905
    *(b" ", b"\n", b"\xff", b"density = 1\n", b"[control]\n", b"colour = 1\n", b"file = 'x'\n"),
]


def plain_reading(content, separator, decimal):
    """Return times and pressures (SI) of a record written as it was said to be; None where any line is not as it should be."""
    try:
        lines = [line for line in content.decode().splitlines() if line.strip() and not line.lstrip().startswith(("#", "%", "!", "//"))]
    except UnicodeError:
        return None
    rows = [[cell.strip() for cell in row if cell.strip() or separator != " "] for row in csv.reader(lines, delimiter=separator)]
    factors = (1.0, 1.0)
    if rows and not _number(rows[0][0], decimal):
        heading = rows.pop(0)
        if len(heading) == 4 and separator == " ":
            heading = [" ".join(heading[:2]), " ".join(heading[2:])]
        try:
            found = [cell[cell.index("(") + 1 : cell.index(")")] for cell in heading]
            factors = TIME_UNITS[found[0]], PRESSURE_UNITS[found[1]]
        except (ValueError, KeyError, IndexError):
            return None
    values = [[_number(cell, decimal) for cell in row] for row in rows]
    if not values or any(len(row) != 2 or None in row for row in values):
        return None
    return [[value[0] * factor for value in column] for column, factor in zip(zip(*values, strict=True), factors, strict=True)]


def loose_reading(content, separator, decimal):
    """Return what is left to read where headings or quotation marks are spoilt: all lines from the first numbers on must be numbers."""
    try:
        text = content.decode("utf-8-sig")
    except UnicodeError:
        text = content.decode("cp1252")
    lines = [line for line in text.splitlines() if line.strip() and not line.lstrip('" ').startswith(("#", "%", "!", "//"))]
    rows = [
        [_number(cell.strip(' "'), decimal) for cell in (line.split(separator) if separator != " " else line.split())] for line in lines
    ]
    first = next((k for k, row in enumerate(rows) if len(row) == 2 and None not in row), len(rows))
    if any(line[0] in "+-.0123456789" for line in lines[:first]) or any(len(row) != 2 or None in row for row in rows[first:]):
        return None
    units = re.findall(r"\(\s*([^()\s]*)\s*\)", text[: text.find(lines[first])].replace("\xa0", "").replace("\ufeff", "")) if first else []
    if len(units) not in (0, 2):
        return None
    factors = (_TIMES.get(units[0]), _PRESSURES.get(units[1])) if units else (1.0, 1.0)
    if None in factors:
        return None
    return [[value[0] * factor for value in column] for column, factor in zip(zip(*rows[first:], strict=True), factors, strict=True)]


def _number(cell, decimal):
    plain = cell.replace("−", "-")
    if (decimal == "," and "." in plain) or (decimal == "." and "," in plain) or "_" in plain:
        return None
    try:
        value = float(plain.replace(",", "."))
    except ValueError:
        return None
    return [value] if math.isfinite(value) else None


def scenario(random_):
    """Return the text of a preset as bytes."""
    return presets.text(random_.choice(presets.names())).encode()


def differences(system: System, text: str):
    """Yield the numbers of a TOML text that a system does not hold, each text with its unit converted by pint itself."""
    data = tomllib.loads(text)
    materials = data.pop("materials", {})
    yield from _differences(data, system)
    named = {layer.material.name: layer.material for shell in system.shells for layer in getattr(shell, "layers", ())}
    for name, table in materials.items():
        if name in named:
            yield from _differences(table, named[name])


def _differences(data, model, where=""):
    for key, value in data.items():
        here = f"{where}.{key}"
        if not isinstance(model, Described) or (key not in type(model).model_fields and key != "rigid"):
            yield f"{here}: has no place in {type(model).__name__}"
            continue
        found = getattr(model, key, None)
        if isinstance(value, dict):
            yield from _differences(value, found, here)
        elif isinstance(value, list):
            for index, item in enumerate(value):
                if isinstance(item, dict):
                    yield from _differences(item, found[index], f"{here}[{index}]")
        elif isinstance(value, bool) or isinstance(found, bool):
            if value is not found and key != "rigid":
                yield f"{here}: {value!r} became {found!r}"
        elif isinstance(value, int | float) or (isinstance(value, str) and isinstance(found, float)):
            if not _same(value, found, type(model).model_fields[key]):
                yield f"{here}: {value!r} became {found!r}"


def _same(value, found, field):
    if isinstance(value, str):
        unit = next((mark.dimension.unit for mark in field.metadata if hasattr(mark, "dimension")), "")
        try:
            quantity = UNITS.Quantity(value.replace("−", "-"))
        except Exception as error:  # noqa: BLE001 - what pint does not read is a difference, whatever it raises
            raise AssertionError(f"{value!r} became {found!r}, where pint says {error}") from None
        value = quantity.to(unit).magnitude if quantity.is_compatible_with(unit) and not quantity.dimensionless else quantity.magnitude
    return isinstance(found, int | float) and math.isclose(value, found, rel_tol=1e-9, abs_tol=1e-300)


def seeded(seed):
    """Return a generator of random numbers."""
    return random.Random(seed)
