"""The system that a command is to work on: a TOML file, standard input or a preset, with changes."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from coaxshell.cli.values import overrides
from coaxshell.errors import InputError

if TYPE_CHECKING:
    from coaxshell.model import System


STANDARD_INPUT = ("-", "/dev/stdin")


def load_system(scenario: str, changes: Sequence[str] = (), where: str = "SCENARIO") -> System:
    """Return the system of a preset, a TOML file or standard input ("-"), with ``path=value`` changes applied.

    *where* is the argument that names it.

    Raises
    ------
    InputError
        No such preset or file, something wrong in the file, or a change that is not allowed.
    """
    from coaxshell.model import presets
    from coaxshell.model.naming import suggestion

    wanted = overrides(changes)
    if scenario in presets.names():
        system = presets.load(scenario)
    elif scenario in STANDARD_INPUT:
        system = _of_input(where)
    elif Path(scenario).suffix.lower() in (".toml", ".txt") or (Path(scenario).is_file() and Path(scenario).suffix.lower() != ".nc"):
        system = _of_file(scenario, where)
    elif Path(scenario).suffix.lower() == ".nc":
        raise InputError(where, f"{scenario!r} is a saved run, solved already", "give a .toml file or a preset; see coaxshell info")
    else:
        raise InputError(where, f"there is no preset {scenario!r}", f"{suggestion(scenario, presets.names())}, or a .toml file")
    return system.with_overrides(wanted) if wanted else system


def _of_input(where: str) -> System:
    """Return the system whose TOML text comes from standard input; files that it names are relative to the current folder."""
    import sys

    from coaxshell.limits import TOML_BYTES
    from coaxshell.model import System, toml

    content = sys.stdin.buffer.read(TOML_BYTES.value + 1)
    TOML_BYTES.check(len(content), "standard input")
    try:
        return System.model_validate(toml.loads(toml.text_of(content, "standard input"), Path(), "standard input"))
    except InputError as error:
        raise InputError(f"{where}, {error.where}", error.problem, error.remedy) if where.startswith("-") else error from None


def _of_file(path: str, where: str) -> System:
    """Return the system of a TOML file; an error in it names the option too, since another file may have been given beside it."""
    from coaxshell.model import System

    try:
        return System.from_toml(path)
    except InputError as error:
        raise InputError(f"{where}, {error.where}", error.problem, error.remedy) if where.startswith("-") else error from None
