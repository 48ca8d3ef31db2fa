"""``coaxshell run``: solve a system and tell its peaks."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from coaxshell.cli import options
from coaxshell.cli.files import writable
from coaxshell.cli.solving import Request


def run(
    scenario: Annotated[
        str, typer.Argument(metavar="SCENARIO", help="A .toml file (see coaxshell init) or a preset (see coaxshell presets).")
    ],
    changes: options.SetOption = None,
    duration: options.DurationOption = "5",
    time_step: options.TimeStepOption = "1e-3",
    modes: options.ModesOption = "150",
    tolerance: options.ToleranceOption = "1e-3",
    engine: options.EngineOption = "spectral",
    output: Annotated[
        Path | None, typer.Option("--output", "-o", metavar="FILE.nc", help="Save the run: arrays, system, settings, versions.")
    ] = None,
    quiet: options.QuietOption = False,
) -> None:
    """Solve a system and print the peaks of each shell."""
    from coaxshell.cli.scenario import load_system

    if output is not None:
        writable(output, "--output", (".nc",))
    system = load_system(scenario, changes or ())
    response = Request(duration, time_step, modes, tolerance, engine).solve(system, quiet=quiet)

    from coaxshell.cli.tables import print_summary

    if output is not None:
        response.save(output)
    print_summary(response)
    if output is not None:
        typer.echo(f"saved {output}")
