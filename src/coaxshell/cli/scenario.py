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
    from coaxshell.model.loading import as_system

    wanted = overrides(changes)
    if scenario in STANDARD_INPUT:
        system = _of_input(where)
    else:
        try:
            system = as_system(scenario, where)
        except InputError as error:  # another file may have been given beside it
            option = where.startswith("-") and error.where != where
            raise InputError(f"{where}, {error.where}", error.problem, error.remedy) if option else error from None
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
