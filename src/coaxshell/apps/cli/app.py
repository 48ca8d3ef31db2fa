"""The commands of ``coaxshell``, one a file."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from importlib import import_module
from typing import Annotated

import typer

from coaxshell._version import __version__
from coaxshell.apps.cli.output import echo

COMMANDS = (
    *("run", "presets", "init", "info", "record", "plot", "spectrum", "modes", "participation", "response", "control"),
    *("figure", "reproduce", "snapshots"),
    *("report", "animate", "export", "sweep", "optimise", "sensitivity", "fit", "verify", "response-function", "studio"),
)
"""In the order of the help; each is the function of the same name in the module of the same name."""


def application(arguments: Sequence[str] = ()) -> typer.Typer:
    """Return the program with the command that some arguments name, or with all.

    Importing all and reading their signatures takes a tenth of a short run.

    Parameters
    ----------
    arguments : sequence of str
        Those of the process. Without a command that is known there, as for the help, all are read.
    """
    app = typer.Typer(
        rich_markup_mode="rich" if sys.stdout.isatty() else None,
        pretty_exceptions_enable=False,
        context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 110},
    )
    app.callback(invoke_without_command=True)(coaxshell)
    named = next((each for each in arguments if not each.startswith("-")), None)  # the program's own options take no values
    for command in (named,) if named in COMMANDS else COMMANDS:
        name = command.replace("-", "_")
        app.command()(getattr(import_module(f"coaxshell.apps.cli.{name}"), name))
    return app


def _print_version(asked: bool) -> None:
    if asked:
        echo(f"coaxshell {__version__}")
        raise typer.Exit


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
