"""``coaxshell init``: a scenario file to start from."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from coaxshell.cli.files import replacing, writable
from coaxshell.cli.values import named_as_options
from coaxshell.errors import InputError


def init(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="The scenario file to write, .toml.")] = Path("scenario.toml"),
    preset: Annotated[str, typer.Option("--preset", metavar="NAME", help="System to start from; see coaxshell presets.")] = "bare",
    force: Annotated[bool, typer.Option("--force", help="Overwrite the file if there is one.")] = False,
) -> None:
    """Write a commented scenario file to change and run."""
    from coaxshell.cli.template import scenario_text

    with named_as_options(preset="preset"):
        text = scenario_text(preset)
    target = writable(file, "FILE", (".toml",))
    if target.exists() and not force:
        raise InputError("FILE", f"{str(target)!r} exists already", "give another name, or --force to overwrite it")
    with replacing(target) as partial:
        partial.write_text(text, encoding="utf-8")
    typer.echo(f"wrote {target}; next: coaxshell run {target}")
