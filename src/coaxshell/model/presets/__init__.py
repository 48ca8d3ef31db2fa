"""Ready-made systems: the paper's own and its verification cases, as TOML files beside this one."""

from __future__ import annotations

import re
from functools import cache
from importlib import resources
from itertools import takewhile

from coaxshell.errors import InputError
from coaxshell.model.naming import lookup
from coaxshell.model.system import System

NAMES = (
    "bare",
    "absorbers",
    "active",
    "hybrid",
    "electrodes",
    "electrodes-hybrid",
    "iakovlev-evacuated",
    "iakovlev-filled",
    "iakovlev-double",
    "steel-tube",
    "coated",
)


def names() -> tuple[str, ...]:
    """Return the names of the presets."""
    return NAMES


def text(name: str) -> str:
    """Return the commented TOML text of a preset; InputError with a suggestion when there is none of that name."""
    if not isinstance(name, str):
        raise InputError("preset", f"{name!r} is not a name", "must be one of " + ", ".join(NAMES))
    found = lookup({key: key for key in NAMES}, name, "preset", "preset")
    return resources.files(__package__).joinpath(f"{found}.toml").read_text(encoding="utf-8")


def description(name: str) -> str:
    """Return the first sentence of the comment that the text of a preset starts with."""
    comment = " ".join(line.lstrip("# ").strip() for line in takewhile(lambda line: line.startswith("#"), text(name).splitlines()))
    return re.split(r"(?<!Fig\.)(?<!Figs\.)(?<=\.) ", comment, maxsplit=1)[0]


def load(name: str) -> System:
    """Return the preset of that name; InputError with a suggestion when there is none."""
    return _parsed(text(name))


@cache
def _parsed(toml: str) -> System:
    return System.from_toml_string(toml)
