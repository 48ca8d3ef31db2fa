"""The answers that a command is to show: saved runs as they are, presets and scenarios solved."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from coaxshell.cli.solving import RESOLUTION, Request
from coaxshell.errors import InputError

if TYPE_CHECKING:
    from coaxshell.response import Response

_FOR_SOLVING = {"changes": "--set", **{name: "--" + name.replace("_", "-") for name in RESOLUTION}}


def is_saved(source: str) -> bool:
    """Return whether a source names a saved run."""
    return Path(source).suffix.lower() == ".nc"


def answers(
    context: typer.Context,
    sources: Sequence[str],
    changes: Sequence[str] | None,
    request: Request,
    *,
    quiet: bool,
    options: tuple[str, str] = ("SOURCE", "--compare"),
) -> list[Response]:
    """Return the response of each source: a saved run (.nc), a preset or a scenario (.toml).

    *options* are the arguments that name the first and the second source.

    Raises
    ------
    InputError
        There is no such source, or every one is a saved run and an option for solving is given.
    """
    if all(is_saved(source) for source in sources):
        _refuse_solving_options(context)
    found = []
    for number, source in enumerate(sources):
        if is_saved(source):
            from coaxshell.response import load_response

            found.append(load_response(source))
        else:
            from coaxshell.cli.comparison import load_reference
            from coaxshell.cli.scenario import load_system

            load = load_reference if number else load_system
            found.append(request.solve(load(source, changes or (), options[number > 0]), quiet=quiet))
    return found


def _refuse_solving_options(context: typer.Context) -> None:
    for parameter, option in _FOR_SOLVING.items():
        source = context.get_parameter_source(parameter)
        if source is not None and source.name == "COMMANDLINE":
            raise InputError(option, "has no effect on a saved run", "leave it out, or name a preset or a .toml file to solve")


def tell_all_warnings(responses: Sequence[Response]) -> None:
    """Tell the warnings of all responses, each once."""
    from coaxshell.cli.tables import tell_warnings

    tell_warnings(dict.fromkeys(text for response in responses for text in response.warnings))
