"""``coaxshell animate``: a film of the pressure field."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from coaxshell.apps.cli import options
from coaxshell.apps.cli.output import Outputs, echo
from coaxshell.apps.cli.progress import progress, tell_time
from coaxshell.apps.cli.running import Request, answers, tell_all_warnings, with_resolution


@with_resolution
def animate(
    context: typer.Context,
    source: options.SourceArgument,
    compare: options.CompareOption = None,
    output: Annotated[
        Path, typer.Option("--output", "-o", metavar="FILE", help="Where to; .mp4 (needs the extra 'video') or .webp.")
    ] = Path("film.mp4"),
    frames: Annotated[str, typer.Option("--frames", metavar="N", help="Number of frames.")] = "250",
    fps: Annotated[str, typer.Option("--fps", metavar="N", help="Frames per second.")] = "25",
    size: Annotated[str, typer.Option("--size", metavar="N", help="Side of a panel in pixels.")] = "450",
    until: Annotated[
        str | None, typer.Option("--until", metavar="TIME", help="Last instant, transits.", show_default="the end of the shortest run")
    ] = None,
    width: options.WidthOption = "6",
    units: options.UnitsOption = "auto",
    pressure_limit: options.PressureLimitOption = None,
    stress_limit: options.StressLimitOption = None,
    changes: options.SetOption = None,
    *,
    request: Request,
    force: options.ForceOption = False,
    quiet: options.QuietOption = False,
) -> None:
    """Make a film of the pressure field.

    The hoop stress is drawn on the shells; with --compare, two systems side by side.
    """
    from coaxshell.plotting import FILM_SUFFIXES, FieldView, check_film, check_units, save_film
    from coaxshell.plotting.film import film_cost, require_room

    target = Outputs(force).file(output, "--output", FILM_SUFFIXES)
    count, rate = options.whole("--frames", frames), options.number("--fps", fps)
    last = None if until is None else options.number("--until", until)
    highest_pressure = options.limit("--pressure-limit", pressure_limit)
    highest_stress = options.limit("--stress-limit", stress_limit)
    with options.named_as_options(pixels="size"):
        view = FieldView(0.5 * options.number("--width", width), options.whole("--size", size))
        check_units(units)
        check_film(target, count, rate)
        cost = film_cost(2 if compare else 1, count, view)
        require_room(cost, count, view)
    tell_time(cost, "the film", quiet)
    responses = answers(context, [source, *([compare] if compare else [])], changes, request, quiet=quiet)
    with options.named_as_options(path="output"), progress(quiet) as report:
        save_film(
            *responses,
            path=target,
            frames=count,
            fps=rate,
            until=last,
            view=view,
            pressure_limit=highest_pressure,
            stress_limit=highest_stress,
            units=units,
            progress=report,
        )
    tell_all_warnings(responses)
    echo(f"wrote {target}: {count} frames, {count / rate:.3g} s")
