"""``coaxshell snapshots``: a sheet of pressure fields."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from coaxshell.apps.cli import options
from coaxshell.apps.cli.output import Outputs, echo, write_figure
from coaxshell.apps.cli.progress import progress, tell_time
from coaxshell.apps.cli.running import Request, answers, tell_all_warnings, with_options
from coaxshell.errors import InputError


@with_options(request=Request, view=options.View)
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
    pixels: Annotated[str, typer.Option("--pixels", metavar="N", help="Pixels along a side of each field.")] = "450",
    section: options.SectionOption = None,
    *,
    view: options.View,
    request: Request,
    force: options.ForceOption = False,
    quiet: options.QuietOption = False,
) -> None:
    """Draw the pressure field at several instants.

    The hoop stress is drawn on the shells; with --compare, two systems side by side. Of a run in three dimensions the cross-section and
    the plane along the axis are shown.
    """
    from coaxshell.plotting import FIGURE_SUFFIXES, SNAPSHOT_TIMES, figure_snapshots
    from coaxshell.plotting.cut_frames import shown_runs
    from coaxshell.plotting.film import films_cost

    target = Outputs(force).file(output, "--output", FIGURE_SUFFIXES)
    in_a_row = options.whole("--columns", columns)
    if not 1 <= in_a_row <= 20:
        raise InputError("--columns", f"{in_a_row} is not allowed", "give a whole number from 1 to 20")
    chosen = None if times is None else options.times(times)
    scales = view.scales
    with options.named_as_options():
        seen = view.seen(options.whole("--pixels", pixels))
    responses = answers(context, [source, *([compare] if compare else [])], request, quiet=quiet, dimensions=3)
    with options.named_as_options(station="section"), progress(quiet) as report:
        runs = shown_runs(responses, [""] * len(responses), section)
        tell_time(films_cost(runs, len(chosen or SNAPSHOT_TIMES), seen), "the fields", quiet)
        figure = figure_snapshots(
            *responses,
            times=chosen,
            view=seen,
            **scales,
            columns=in_a_row,
            progress=report,
            station=section,
        )
    write_figure(figure, target, "--output")
    tell_all_warnings(responses)
    echo(f"wrote {target}")
