"""The system that a command is to work on: a TOML file or a preset, with changes."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from coaxshell.cli.values import overrides
from coaxshell.errors import InputError

if TYPE_CHECKING:
    from coaxshell.model import System


def load_system(scenario: str, changes: Sequence[str] = ()) -> System:
    """Return the system of a preset or a TOML file, with ``path=value`` changes applied.

    Raises
    ------
    InputError
        No such preset or file, something wrong in the file, or a change that is not allowed.
    """
    from coaxshell.model import System, presets

    wanted = overrides(changes)
    if scenario in presets.names():
        system = presets.load(scenario)
    elif Path(scenario).suffix.lower() == ".toml":
        system = System.from_toml(scenario)
    elif Path(scenario).suffix.lower() == ".nc":
        raise InputError("scenario", f"{scenario!r} is a saved run, solved already", "give a .toml file or a preset; see coaxshell info")
    else:
        raise InputError("scenario", f"there is no preset {scenario!r}", f"give a .toml file or one of: {', '.join(presets.names())}")
    return system.with_overrides(wanted) if wanted else system
