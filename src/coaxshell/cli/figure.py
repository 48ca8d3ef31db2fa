"""``coaxshell figure``: a figure of the paper, computed."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from coaxshell.cli import options
from coaxshell.cli.files import writable
from coaxshell.cli.solving import Request
from coaxshell.errors import InputError

if TYPE_CHECKING:
    from coaxshell.plotting import FigureRecipe
    from coaxshell.response import Response


def figure(
    number: Annotated[str, typer.Argument(metavar="NUMBER", help="Number of the figure in the paper; 3 for now.")],
    source: Annotated[Path | None, typer.Option("--from", metavar="FILE.nc", help="Draw a saved run instead of computing one.")] = None,
    preset: Annotated[
        str | None, typer.Option("--preset", metavar="NAME", help="Preset or .toml file to compute instead of the paper's.")
    ] = None,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", metavar="FILE", help="Where to; .png, .pdf or .svg. [default: figure-NUMBER.png]")
    ] = None,
    changes: options.SetOption = None,
    duration: options.DurationOption = "5",
    time_step: options.TimeStepOption = "1e-3",
    modes: options.ModesOption = "150",
    tolerance: options.ToleranceOption = "1e-3",
    engine: options.EngineOption = "spectral",
    quiet: options.QuietOption = False,
) -> None:
    """Draw a figure of the paper, computed or from a saved run."""
    from coaxshell.cli.tables import tell_warnings
    from coaxshell.plotting import FIGURE_SUFFIXES, figure_recipe, save_figure

    recipe = figure_recipe(number)
    target = writable(output or Path(f"figure-{number}.png"), "--output", FIGURE_SUFFIXES)
    if source is not None and (preset is not None or changes):
        raise InputError("--from", "cannot be combined with --preset or --set", "a saved run has its own system: give one or the other")
    response = (
        _load(source)
        if source is not None
        else _solve(recipe, preset, changes, Request(duration, time_step, modes, tolerance, engine), quiet)
    )
    save_figure(recipe.draw(response), target)
    tell_warnings(response.warnings)
    typer.echo(f"wrote {target}: {recipe.title}")


def _load(source: Path) -> Response:
    from coaxshell.response import load_response

    return load_response(source)


def _solve(recipe: FigureRecipe, preset: str | None, changes: list[str] | None, request: Request, quiet: bool) -> Response:
    from coaxshell.cli.scenario import load_system

    return request.solve(load_system(preset or recipe.preset, changes or ()), quiet=quiet)
