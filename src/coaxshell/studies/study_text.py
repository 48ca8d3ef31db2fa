"""A study as the text of its file: what :mod:`coaxshell.studies.study_file` reads, written for a person."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import tomli_w

from coaxshell.model import presets, toml
from coaxshell.model.system import System


def study_text(command: str, system: System, entries: Mapping[str, Any], tables: Mapping[str, Mapping[str, Any]]) -> str:
    """Return the study file of a command; its reader gives back the same study.

    Parameters
    ----------
    command : str
        "sweep", "optimise" or "sensitivity".
    system : System
        Its scenario: the name of the preset that it equals, else the description itself at the end.
    entries : mapping
        Single entries such as "metrics" in their order, numbers exact; None leaves one out.
    tables : mapping of mappings
        Such as "variables" and "resolution", one line an entry.
    """
    preset = next((name for name in presets.names() if presets.load(name) == system), None)
    lines = [f"# for coaxshell {command} FILE.toml", *([] if preset is None else [f"scenario = {_inline(preset)}"])]
    lines += [f"{_key(name)} = {_inline(value)}" for name, value in entries.items() if value is not None]
    for title, table in tables.items():
        lines += ["", f"[{_key(title)}]", *(f"{_key(name)} = {_inline(value)}" for name, value in table.items())]
    text = "\n".join(lines) + "\n"
    return text if preset is not None else f"{text}\n{tomli_w.dumps({'scenario': toml.tables(system)})}"


def _inline(value: Any) -> str:
    """Return a value on one line."""
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{_key(name)} = {_inline(item)}" for name, item in value.items()) + " }"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(_inline(item) for item in value) + "]"
    return tomli_w.dumps({"x": value}).removeprefix("x = ").rstrip("\n")


def _key(name: str) -> str:
    """Return a key, in quotation marks where it needs them."""
    return tomli_w.dumps({name: 0}).removesuffix(" = 0\n")
