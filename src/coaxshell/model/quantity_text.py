"""Quantities as people type them: the number and the unit of a text, with signs, spaces, commas and powers of every keyboard.

Texts come from outside: each is measured before anything is matched, and every pattern is linear in its length.
"""

from __future__ import annotations

import re

from coaxshell.errors import InputError
from coaxshell.limits import QUANTITY

# Minus signs and spaces of typesetting and of spreadsheets, full-width signs, and one letter for micro.
_SIGNS = str.maketrans(
    dict.fromkeys("−‒–﹣－", "-") | dict.fromkeys("\u00a0\u2007\u2009\u202f\u3000", " ") | {"μ": "µ", "＋": "+", "⁄": "/", "∕": "/"}
)
_SUPERSCRIPTS = str.maketrans("⁺⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "+-0123456789")

_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")
# "6,5" and "0,025" have a decimal comma; three digits after a comma could as well be thousands, and two commas must be.
_COMMA = re.compile(r"(?P<whole>[+-]?\d+),(?P<part>\d+)(?![\d,.])")
_TWO_WAYS = re.compile(r"[+-]?\d+(?:,\d|[' ]\d{3}(?!\d)|\.\d+[.,']\d)")
_POWER = re.compile(r"\s*[×x*·⋅]\s*10\s*(?:(?:\^|\*\*)\s*\(?([+-]?\d{1,4})\)?|([⁺⁻]?[⁰¹²³⁴⁵⁶⁷⁸⁹]{1,4}))(?![\d.])")

_WORD = re.compile(r"[A-Za-zµ]+")
_PRODUCT = re.compile(r"([kMGm]?N)(s|m)")
_SPELLINGS = {
    "pa": "Pa", "hpa": "hPa", "kpa": "kPa", "gpa": "GPa", "pascal": "pascal", "pascals": "pascal", "kilopascal": "kilopascal",
    "megapascal": "megapascal", "gigapascal": "gigapascal", "psi": "psi", "psig": "psi", "ksi": "ksi", "bar": "bar", "barg": "bar",
    "mbar": "mbar", "atm": "atm", "lb": "lb", "lbs": "lb", "lbm": "lb", "kg": "kg", "kgs": "kg", "hz": "Hz", "khz": "kHz", "km": "km",
    "cm": "cm", "in": "inch", "inch": "inch", "inches": "inch", "ft": "ft", "feet": "foot", "sec": "s", "secs": "s", "seconds": "s",
    "msec": "ms", "usec": "us", "deg": "deg", "metre": "metre", "metres": "metre", "meters": "metre", "kn": "kN", "gn": "GN",
}  # fmt: skip
"""Units by their letters in lower case, for a spelling that is none: those whose letters mean one unit only, whatever their case."""

_MILLI_OR_MEGA = {"mpa": "mPa", "mn": "mN", "mm": "mm", "ms": "ms", "mv": "mV", "mhz": "mHz"}


def parts(text: str, kind: str) -> tuple[str, str] | None:
    """Return the number of a text, as Python writes one, and its unit ("" without one); None when it begins with no number.

    Parameters
    ----------
    text : str
    kind : str
        What it should be, for the error.

    Raises
    ------
    InputError
        The text is longer than any quantity, or its number can be read in two ways.
    """
    QUANTITY.check(len(text), "", "give a number and a unit, such as '6 mm'")
    plain = text.translate(_SIGNS).strip()
    comma = _COMMA.match(plain)
    if comma is not None and (len(comma["part"]) != 3 or comma["whole"].lstrip("+-") == "0"):
        plain = f"{comma['whole']}.{comma['part']}{plain[comma.end() :]}"
    if _TWO_WAYS.match(plain):
        raise InputError("", f"{text!r} may be read in two ways", f"give {kind} with a decimal point and no separators of thousands")
    match = _NUMBER.match(plain)
    if match is None:
        return None
    number, rest = match[0], plain[match.end() :]
    power = _POWER.match(rest)
    if power is not None and number.isascii() and "e" not in number.lower():
        number, rest = f"{number}e{int(power[1] or power[2].translate(_SUPERSCRIPTS))}", rest[power.end() :]
    return number, rest.strip()


def respelt(unit: str) -> str:
    """Return a unit with the spellings that people use, such as ``kpa``, ``PSI``, ``lbm`` and ``Ns/m``, as those of the registry."""
    return _WORD.sub(lambda word: _respelt(word[0]), unit)


def _respelt(word: str) -> str:
    product = _PRODUCT.fullmatch(word)
    if product is not None:
        return f"({product[1]}*{product[2]})"
    if word == "Mpa":  # the capital says mega; "mpa" and "MPA" could be either
        return "MPa"
    return _SPELLINGS.get(word.lower(), word)


def hint(unit: str, known: bool) -> str:
    """Return what is probably wrong with a unit that is none (or, if *known*, of another kind), or ""."""
    lower = unit.lower()
    if lower in _MILLI_OR_MEGA:
        small = _MILLI_OR_MEGA[lower]
        return f"is it {small} (a thousandth) or M{small[1:]} (a million)? "
    if lower in ("psia", "bara"):
        return f"subtract the pressure at rest and write {lower[:-1]}: a pulse is what comes on top of it; "
    return "capitals count in units (kPa, mm, GPa); " if not known and lower != unit else ""
