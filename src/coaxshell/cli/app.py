"""The commands of ``coaxshell``, one a file."""

from __future__ import annotations

import sys
from typing import Annotated

import typer

from coaxshell._version import __version__
from coaxshell.cli.animate import animate
from coaxshell.cli.export import export
from coaxshell.cli.figure import figure
from coaxshell.cli.info import info
from coaxshell.cli.init import init
from coaxshell.cli.optimise import optimise
from coaxshell.cli.plot import plot
from coaxshell.cli.presets import presets
from coaxshell.cli.record import record
from coaxshell.cli.reproduce import reproduce
from coaxshell.cli.response_function import response_function
from coaxshell.cli.run import run
from coaxshell.cli.sensitivity import sensitivity
from coaxshell.cli.snapshots import snapshots
from coaxshell.cli.streams import echo
from coaxshell.cli.studio import studio
from coaxshell.cli.sweep import sweep
from coaxshell.cli.verify import verify

app = typer.Typer(
    rich_markup_mode="rich" if sys.stdout.isatty() else None,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 110},
)


def _print_version(asked: bool) -> None:
    if asked:
        echo(f"coaxshell {__version__}")
        raise typer.Exit


@app.callback(invoke_without_command=True)
def coaxshell(
    context: typer.Context,
    version: Annotated[
        bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Print the version and leave.")
    ] = False,
    debug: Annotated[bool, typer.Option("--debug", help="Show where an error came from. Allowed anywhere on the line.")] = False,
) -> None:
    """Compute how concentric cylindrical shells in fluids answer an acoustic shock.

    Start with: coaxshell run bare
    """
    if context.invoked_subcommand is None:
        typer.echo(context.get_help())  # its colours are our own


for _command in (
    run,
    presets,
    init,
    info,
    record,
    plot,
    figure,
    reproduce,
    snapshots,
    animate,
    export,
    sweep,
    optimise,
    sensitivity,
    verify,
    response_function,
    studio,
):
    app.command()(_command)
