"""``coaxshell animate``: a film of the pressure field."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from coaxshell.apps.cli import options
from coaxshell.apps.cli.output import Outputs, echo
from coaxshell.apps.cli.progress import progress, tell_time
from coaxshell.apps.cli.running import Request, answers, tell_all_warnings, with_options


@with_options(request=Request, view=options.View)
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
    *,
    view: options.View,
    request: Request,
    force: options.ForceOption = False,
    quiet: options.QuietOption = False,
) -> None:
    """Make a film of the pressure field.

    The hoop stress is drawn on the shells; with --compare, two systems side by side.
    """
    from coaxshell.plotting import FILM_SUFFIXES, check_film, save_film
    from coaxshell.plotting.film import film_cost, require_room

    target = Outputs(force).file(output, "--output", FILM_SUFFIXES)
    count, rate = options.whole("--frames", frames), options.number("--fps", fps)
    last = None if until is None else options.number("--until", until)
    scales = view.scales
    with options.named_as_options(pixels="size"):
        seen = view.seen(options.whole("--size", size))
        check_film(target, count, rate)
        cost = film_cost(2 if compare else 1, count, seen)
        require_room(cost, count, seen)
    tell_time(cost, "the film", quiet)
    responses = answers(context, [source, *([compare] if compare else [])], request, quiet=quiet)
    with options.named_as_options(path="output"), progress(quiet) as report:
        save_film(
            *responses,
            path=target,
            frames=count,
            fps=rate,
            until=last,
            view=seen,
            **scales,
            progress=report,
        )
    tell_all_warnings(responses)
    echo(f"wrote {target}: {count} frames, {count / rate:.3g} s")
