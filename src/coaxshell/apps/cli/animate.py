"""``coaxshell animate``: a film of the pressure field."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from coaxshell.apps.cli import options
from coaxshell.apps.cli.output import Outputs, echo
from coaxshell.apps.cli.progress import progress, tell_time
from coaxshell.apps.cli.running import Request, answers, tell_all_warnings, with_options
from coaxshell.errors import InputError

if TYPE_CHECKING:
    from coaxshell.response import Response


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
    section: options.SectionOption = None,
    wall: Annotated[
        list[str] | None,
        typer.Option("--wall", metavar="NAME", help="Three dimensions: this shell laid flat instead; inner, outer, ... May be repeated."),
    ] = None,
    component: Annotated[
        str, typer.Option("--component", metavar="NAME", help="Of the stress of a wall laid flat: hoop, axial, shear or von-mises.")
    ] = "hoop",
    *,
    view: options.View,
    request: Request,
    force: options.ForceOption = False,
    quiet: options.QuietOption = False,
) -> None:
    """Make a film of the pressure field.

    The hoop stress is drawn on the shells; with --compare, two systems side by side. Of a run in three dimensions the cross-section and
    the plane along the axis are shown, or with --wall the stress of shells over angle and axial position.
    """
    from coaxshell.plotting import FILM_SUFFIXES, check_film, save_film
    from coaxshell.plotting.cut_frames import shown_runs
    from coaxshell.plotting.film import film_cost, films_cost, require_room
    from coaxshell.plotting.unrolled import stress_component

    target = Outputs(force).file(output, "--output", FILM_SUFFIXES)
    count, rate = options.whole("--frames", frames), options.number("--fps", fps)
    last = None if until is None else options.number("--until", until)
    scales = view.scales
    with options.named_as_options(pixels="size", component="component"):
        seen = view.seen(options.whole("--size", size))
        check_film(target, count, rate)
        cost = film_cost(2 if compare else 1, count, seen)
        require_room(cost, count, seen)
        stress = stress_component(component)
    if wall and (compare or section):
        raise InputError("--wall", f"cannot be combined with {'--compare' if compare else '--section'}", "leave one out")
    responses = answers(context, [source, *([compare] if compare else [])], request, quiet=quiet, dimensions=3)
    if wall:
        _of_walls(responses[0], wall, target, stress, (count, rate, last), (seen.pixels, scales["stress_limit"]), quiet=quiet)
        return
    with options.named_as_options(path="output", station="section"), progress(quiet) as report:
        tell_time(films_cost(shown_runs(responses, [""] * len(responses), section), count, seen), "the film", quiet)
        save_film(
            *responses,
            path=target,
            frames=count,
            fps=rate,
            until=last,
            view=seen,
            **scales,
            progress=report,
            station=section,
        )
    tell_all_warnings(responses)
    echo(f"wrote {target}: {count} frames, {count / rate:.3g} s")


def _of_walls(
    response: Response,
    walls: list[str],
    target: Path,
    component: str,
    pace: tuple[int, float, float | None],
    look: tuple[int, float | None],
    *,
    quiet: bool,
) -> None:
    """Make the film of walls laid flat."""
    from coaxshell.plotting import save_wall_film
    from coaxshell.plotting.unrolled import require_stations
    from coaxshell.plotting.wall_film import wall_film_cost
    from coaxshell.response.spatial import SpatialResponse

    count, rate, last = pace
    with options.named_as_options(path="output", pixels="size", shell="wall", shells="wall", response="wall"), progress(quiet) as report:
        require_stations(response)
        assert isinstance(response, SpatialResponse)
        tell_time(wall_film_cost(response, len(walls), count, look[0]), "the film", quiet)
        save_wall_film(
            response,
            [int(wall) if wall.isdigit() else wall for wall in walls],
            path=target,
            component=component,
            frames=count,
            fps=rate,
            until=last,
            size=look[0],
            stress_limit=look[1],
            progress=report,
        )
    tell_all_warnings([response])
    echo(f"wrote {target}: {count} frames, {count / rate:.3g} s")
