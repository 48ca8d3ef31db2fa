"""``coaxshell init``: a scenario file to start from."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from coaxshell.apps.cli import options
from coaxshell.apps.cli.options import named_as_options
from coaxshell.apps.cli.output import Outputs, echo
from coaxshell.numerics.files import write_text


def init(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="The scenario file to write, .toml.")] = Path("scenario.toml"),
    preset: Annotated[str, typer.Option("--preset", metavar="NAME", help="System to start from; see coaxshell presets.")] = "bare",
    force: options.ForceOption = False,
) -> None:
    """Write a commented scenario file to change and run."""
    from coaxshell.apps.cli.template import scenario_text

    with named_as_options(preset="preset"):
        text = scenario_text(preset)
    target = Outputs(force).file(file, "FILE", (".toml",))
    write_text(target, text, "FILE")
    echo(f"wrote {target}; next: coaxshell run {target}")
