"""``coaxshell info``: what a saved run holds."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from coaxshell.apps.cli.documents import runs_document
from coaxshell.apps.cli.options import JsonOption
from coaxshell.apps.cli.output import echo, print_document


def info(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="A run (.nc) saved by coaxshell run --output.")],
    as_json: JsonOption = False,
) -> None:
    """Tell what a saved run holds."""
    from coaxshell import response

    if as_json:
        found = response.load_response(file)
        print_document({"file": str(file), **runs_document({found.system.name or file.stem: found}, [found.summary()])})
        return
    echo(response.info(file).rstrip())
    echo()

    from coaxshell.apps.cli.output import print_summary

    print_summary(response.load_response(file))
