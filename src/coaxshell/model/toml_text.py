"""The one reader of TOML text: bounded in size, depth, dots and entries before the parser sees it, errors with the line.

The parser spends time and memory that grow as the square of the dots in a key, and a recursion for each level of nesting: what no
person writes is refused by a scan that is linear in the text.
"""

from __future__ import annotations

import re
import tomllib
from typing import Any

from coaxshell.errors import InputError
from coaxshell.limits import TOML_BYTES, TOML_DOTS, TOML_ENTRIES, TOML_LISTS, TOML_NESTING, TOML_VALUES, Limit

_MARK = re.compile(r"\"\"\"|'''|[\"'#\[\]{}=,.\n]")
_ENDS = {  # possessive: nothing is tried twice
    '"""': re.compile(r'(?:[^"\\]++|\\.|"(?!""))*+"""', re.DOTALL),
    "'''": re.compile(r"(?:[^']++|'(?!''))*+'''"),
    '"': re.compile(r'(?:[^"\\\n]++|\\.)*+"'),
    "'": re.compile(r"[^'\n]*+'"),
    "#": re.compile(r"[^\n]*+"),
}
_LONG_NUMBER = re.compile(r"[0-9_]{400}")
REMEDY = "the text must be valid TOML"


def parsed(text: str, name: str = "TOML") -> dict[str, Any]:
    """Return TOML text as nested tables.

    Parameters
    ----------
    text : str
    name : str
        What errors call it, such as the path of the file.

    Raises
    ------
    InputError
        Naming *name* and the line: the text is no TOML, or goes beyond a bound.
    """
    TOML_BYTES.check(len(text), name)
    text = text.removeprefix("\ufeff")
    _check(text, name)
    try:
        text.encode()
        return tomllib.loads(text)
    except UnicodeEncodeError as error:
        raise _at(text, error.start, name, "holds half a character (a lone surrogate)") from None
    except tomllib.TOMLDecodeError as error:
        raise InputError(name, str(error)[:300], REMEDY) from None
    except (ValueError, RecursionError, OverflowError) as error:
        long = _LONG_NUMBER.search(text)
        raise _at(text, long.start() if long else 0, name, f"cannot be read ({str(error)[:60]})") from None


def _at(text: str, place: int, name: str, problem: str) -> InputError:
    return InputError(name, f"line {text.count(chr(10), 0, place) + 1} {problem}", REMEDY)


def _check(text: str, name: str) -> None:
    """Refuse text beyond a bound, by its marks outside strings and comments."""
    depth = dots = entries = lists = values = 0
    place = 0

    def check(limit: Limit, found: int) -> None:
        if found > limit.value:
            limit.check(found, f"{name}, line {text.count(chr(10), 0, place) + 1}", "write it simpler, or in several tables")

    while (match := _MARK.search(text, place)) is not None:
        mark, place = match[0], match.end()
        if mark == ".":
            dots += 1
            check(TOML_DOTS, dots)
            continue
        if mark in _ENDS:
            end = _ENDS[mark].match(text, place)
            if end is None:
                return  # a string without its end: the parser says where
            place = end.end()
            continue
        if mark in "=]":  # the parts of keys and of the names of tables
            entries += dots + (mark == "=")
            check(TOML_ENTRIES, entries)
        dots = 0
        if mark in "[{":
            depth, lists = depth + 1, lists + 1
            check(TOML_NESTING, depth)
            check(TOML_LISTS, lists)
        elif mark in "]}":
            depth = max(0, depth - 1)
        elif mark == ",":
            values += 1
            check(TOML_VALUES, values)
