"""``coaxshell figure``: a figure of the paper, computed."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from coaxshell.apps.cli import options
from coaxshell.apps.cli.options import named_as_options
from coaxshell.apps.cli.output import Outputs, echo, tell_warnings, write_figure
from coaxshell.apps.cli.progress import progress
from coaxshell.apps.cli.running import Request, answers, tell_all_warnings, with_resolution
from coaxshell.errors import InputError

if TYPE_CHECKING:
    from coaxshell.apps.paper import StudyRecipe


@with_resolution
def figure(
    context: typer.Context,
    number: Annotated[str, typer.Argument(metavar="NUMBER", help="Number of the figure in the paper, 2 to 14.")],
    source: Annotated[
        list[Path] | None,
        typer.Option("--from", metavar="FILE", help="Draw a saved run (.nc) instead of computing one. Twice for a comparison."),
    ] = None,
    preset: Annotated[
        list[str] | None,
        typer.Option(
            "--preset", metavar="SCENARIO", help="Preset or .toml file to compute instead of the paper's. Twice for a comparison."
        ),
    ] = None,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", metavar="FILE", help="Where to; .png, .pdf or .svg.", show_default="figure-NUMBER.png")
    ] = None,
    *,
    request: Request,
    force: options.ForceOption = False,
    quiet: options.QuietOption = False,
) -> None:
    """Draw a figure of the paper.

    Its runs are computed, or read from saved ones with --from.
    """
    from coaxshell.apps.paper import StudyRecipe, figure_recipe
    from coaxshell.plotting import FIGURE_SUFFIXES

    recipe = figure_recipe(number)
    target = Outputs(force).file(output or Path(f"figure-{number}.png"), "--output", FIGURE_SUFFIXES)
    if source and (preset or request.changes):
        raise InputError("--from", "cannot be combined with --preset or --set", "a saved run has its own system: give one or the other")
    if source and isinstance(recipe, StudyRecipe):
        raise InputError("--from", f"has no effect on figure {number}, which compares many runs", "leave it out")
    sources = [str(path) for path in source or ()] or preset or list(recipe.presets)
    if len(sources) != len(recipe.presets):
        option, wanted = "--from" if source else "--preset", len(recipe.presets)
        raise InputError(option, f"{len(sources)} given, but figure {number} shows {wanted}", f"give the option {wanted} time(s)")
    if isinstance(recipe, StudyRecipe):
        tell_warnings(_draw_study(recipe, sources, request, target, quiet=quiet))
    else:
        responses = answers(context, sources, request, quiet=quiet, arguments=("--preset", "--preset"))
        with progress(quiet) as report:
            drawn = recipe.draw(responses, report)
        write_figure(drawn, target, "--output")
        tell_all_warnings(responses)
    echo(f"wrote {target}: {recipe.title}")


def _draw_study(recipe: StudyRecipe, sources: Sequence[str], request: Request, target: Path, *, quiet: bool) -> tuple[str, ...]:
    """Solve, draw and save a figure of many runs, and return their warnings."""
    from coaxshell.apps.cli.running import load_system
    from coaxshell.apps.paper import Runs
    from coaxshell.studies.executors import worker_count

    systems = [load_system(name, request.changes or (), "--preset") for name in sources]
    request.require_two_dimensions(systems[0])
    with named_as_options(), progress(quiet) as report:
        drawn = recipe.draw(systems, Runs(request.settings(systems[0]), workers=worker_count(None)), report)
    write_figure(drawn.figure, target, "--output")
    return drawn.warnings
