"""From the text of an option to its value; every problem is an InputError that names the option."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from coaxshell.errors import InputError

_OF_SETTINGS = ("duration", "time_step", "modes", "tolerance", "engine", "refinement")
_OF_FIELDS = ("times", "until", "frames", "fps", "pixels", "width", "units", "points", "displaced", "output", "folder", "path")


def number(option: str, text: str) -> float:
    """Return the number written in an option."""
    try:
        return float(text)
    except ValueError:
        raise InputError(option, f"{text!r} is not a number", "give a number such as 5 or 1e-3") from None


def whole(option: str, text: str) -> int:
    """Return the whole number written in an option."""
    try:
        return int(text)
    except ValueError:
        raise InputError(option, f"{text!r} is not a whole number", "give one such as 1 or 4") from None


def overrides(texts: Sequence[str], option: str = "--set") -> dict[str, Any]:
    """Return {path: value} from ``path=value`` texts; the value is read as TOML, or else as text such as ``6 mm``."""
    found: dict[str, Any] = {}
    for text in texts:
        path, equals, value = text.partition("=")
        path = path.strip()
        if not path or not equals or not value.strip():
            raise InputError(option, f"{text!r} is not an assignment", 'write path=value, as in "source.peak_pressure=50 kPa"')
        if path in found:
            raise InputError(option, f"{path!r} is given twice", "give each path once")
        found[path] = _value(value.strip())
    return found


def _value(text: str) -> Any:
    from coaxshell.model.toml_text import parsed

    try:
        found = parsed(f"value = {text}")
    except InputError:
        return text
    return found["value"] if len(found) == 1 else text


@contextmanager
def named_as_options(**names: str) -> Iterator[None]:
    """Let errors about arguments name the option instead: ``time_step`` becomes ``--time-step``, or what *names* says of it."""
    try:
        yield
    except InputError as error:
        if error.where in names or error.where in _OF_SETTINGS + _OF_FIELDS:
            option = names.get(error.where, error.where).replace("_", "-")
            raise InputError(f"--{option}", error.problem, error.remedy) from None
        raise
