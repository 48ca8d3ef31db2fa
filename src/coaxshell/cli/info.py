"""``coaxshell info``: what a saved run holds."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from coaxshell.cli.streams import echo


def info(file: Annotated[Path, typer.Argument(metavar="FILE", help="A run (.nc) saved by coaxshell run --output.")]) -> None:
    """Tell what a saved run holds."""
    from coaxshell import response

    echo(response.info(file).rstrip())
    echo()

    from coaxshell.cli.tables import print_summary

    print_summary(response.load_response(file))
