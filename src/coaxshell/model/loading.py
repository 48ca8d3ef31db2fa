"""A system from what a user has: the description itself, the name of a preset, or a scenario file."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from coaxshell.errors import InputError
from coaxshell.model import presets
from coaxshell.model.base import shown
from coaxshell.model.naming import suggestion
from coaxshell.model.system import System

SystemLike = System | str | Path
"""A system, the name of a preset, or the path of a scenario file (as text or as a path)."""

_TEXT = (".toml", ".txt")
_TABLES = (".csv", ".mat", ".wav")


def as_system(value: Any, where: str = "system") -> System:
    """Return the system that is meant.

    Parameters
    ----------
    value : System, str or Path
        A description, the name of a preset, or the path of a TOML file.
    where : str
        The argument that an error names.

    Raises
    ------
    InputError
        Neither of them, no such preset or file, or something wrong in the file.
    """
    if isinstance(value, System):
        return value
    if not isinstance(value, str | Path):
        raise InputError(where, f"{shown(value)} is not a system", "give a System, the name of a preset, or a .toml file")
    if isinstance(value, str) and value in presets.names():
        return presets.load(value)
    suffix = Path(value).suffix.lower()
    if suffix == ".nc":
        raise InputError(where, f"{str(value)!r} is a saved run, solved already", "give a .toml file or a preset; see coaxshell info")
    if suffix in _TABLES:
        remedy = 'a pressure record is named in a scenario, as pulse = { type = "sampled", file = ... }; see coaxshell record'
        raise InputError(where, f"{str(value)!r} is not a scenario (.toml) or a preset", remedy)
    if isinstance(value, Path) or suffix in _TEXT or Path(value).is_file():
        return System.from_toml(value)
    raise InputError(where, f"there is no preset {value!r}", f"{suggestion(value, presets.names())}, or a .toml file")
