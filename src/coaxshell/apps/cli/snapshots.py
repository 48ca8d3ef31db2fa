"""``coaxshell snapshots``: a sheet of pressure fields."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from coaxshell.apps.cli import options
from coaxshell.apps.cli.output import Outputs, echo, write_figure
from coaxshell.apps.cli.progress import progress
from coaxshell.apps.cli.running import Request, answers, tell_all_warnings, with_resolution
from coaxshell.errors import InputError


@with_resolution
def snapshots(
    context: typer.Context,
    source: options.SourceArgument,
    compare: options.CompareOption = None,
    times: Annotated[
        str | None,
        typer.Option("--times", metavar="TIME,...", help="Instants in transits, as in 0.2,1.2,3.6 or 0:5:0.5.", show_default="the paper's"),
    ] = None,
    output: Annotated[Path, typer.Option("--output", "-o", metavar="FILE", help="Where to; .png, .pdf or .svg.")] = Path("snapshots.png"),
    columns: Annotated[str, typer.Option("--columns", metavar="N", help="Instants in a row, 1 to 20.")] = "4",
    width: options.WidthOption = "6",
    pixels: Annotated[str, typer.Option("--pixels", metavar="N", help="Pixels along a side of each field.")] = "450",
    units: options.UnitsOption = "auto",
    pressure_limit: options.PressureLimitOption = None,
    stress_limit: options.StressLimitOption = None,
    changes: options.SetOption = None,
    *,
    request: Request,
    force: options.ForceOption = False,
    quiet: options.QuietOption = False,
) -> None:
    """Draw the pressure field at several instants.

    The hoop stress is drawn on the shells; with --compare, two systems side by side.
    """
    from coaxshell.plotting import FIGURE_SUFFIXES, FieldView, check_units, figure_snapshots

    target = Outputs(force).file(output, "--output", FIGURE_SUFFIXES)
    in_a_row = options.whole("--columns", columns)
    if not 1 <= in_a_row <= 20:
        raise InputError("--columns", f"{in_a_row} is not allowed", "give a whole number from 1 to 20")
    chosen = None if times is None else options.times(times)
    highest_pressure = options.limit("--pressure-limit", pressure_limit)
    highest_stress = options.limit("--stress-limit", stress_limit)
    with options.named_as_options():
        view = FieldView(0.5 * options.number("--width", width), options.whole("--pixels", pixels))
        check_units(units)
    responses = answers(context, [source, *([compare] if compare else [])], changes, request, quiet=quiet)
    with options.named_as_options(), progress(quiet) as report:
        figure = figure_snapshots(
            *responses,
            times=chosen,
            view=view,
            pressure_limit=highest_pressure,
            stress_limit=highest_stress,
            units=units,
            columns=in_a_row,
            progress=report,
        )
    write_figure(figure, target, "--output")
    tell_all_warnings(responses)
    echo(f"wrote {target}")
