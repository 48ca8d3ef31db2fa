"""``coaxshell plot``: any quantity of any run against time."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from coaxshell.apps.cli import options
from coaxshell.apps.cli.output import Outputs, echo, write_figure
from coaxshell.apps.cli.running import Request, answers, tell_all_warnings, with_resolution


@with_resolution
def plot(
    context: typer.Context,
    source: options.SourceArgument,
    quantity: Annotated[
        str,
        typer.Option(
            "--quantity",
            metavar="NAME",
            help="A quantity of a shell: stress, displacement, relative_displacement, actuator_voltage, ...; any other word lists all.",
        ),
    ] = "stress",
    shell: Annotated[
        list[str] | None,
        typer.Option("--shell", metavar="NAME", help="inner, outer or a number from 0 inside. May be repeated.", show_default="all"),
    ] = None,
    angle: Annotated[str, typer.Option("--angle", metavar="ANGLE,...", help="Degrees from the source, as in 0,90,180.")] = "0,180",
    compare: options.CompareOption = None,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", metavar="FILE", help="Where to; .png, .pdf or .svg.", show_default="QUANTITY.png")
    ] = None,
    *,
    request: Request,
    force: options.ForceOption = False,
    quiet: options.QuietOption = False,
) -> None:
    """Draw a quantity of a run against time.

    The run is a saved one, or a preset or a .toml file that is solved; with --compare, two of them. Runs in three dimensions are drawn at
    --stations, at most four, and may stand beside one in two. The paper's own figures: coaxshell figure.
    """
    from coaxshell.plotting import FIGURE_SUFFIXES, QUANTITIES, figure_curves
    from coaxshell.response.arguments import one_of
    from coaxshell.response.run_comparison import run_labels

    chosen = one_of("--quantity", quantity.replace("-", "_"), QUANTITIES)
    target = Outputs(force).file(output or Path(f"{chosen}.png"), "--output", FIGURE_SUFFIXES)
    angles = [options.number("--angle", each) for each in angle.split(",")]
    sources = [source, *([compare] if compare else [])]
    responses = answers(context, sources, request, quiet=quiet, dimensions=3)
    names = run_labels(*responses) if compare else (responses[0].system.name or Path(source).stem,)
    with options.named_as_options(shell="shell", shells="shell", quantity="quantity", responses="compare", station="stations"):
        drawn = figure_curves(dict(zip(names, responses, strict=True)), chosen, shell, angles)
    write_figure(drawn, target, "--output")
    tell_all_warnings(responses)
    echo(f"wrote {target}")
