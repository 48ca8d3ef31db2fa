"""``coaxshell report``: a run as one page that can be handed on."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from coaxshell.apps.cli import options
from coaxshell.apps.cli.output import Outputs, echo
from coaxshell.apps.cli.running import Request, answers, tell_all_warnings, with_resolution


@with_resolution
def report(
    context: typer.Context,
    source: options.SourceArgument,
    compare: options.CompareOption = None,
    output: Annotated[Path, typer.Option("--output", "-o", metavar="FILE", help="Where to; .html.")] = Path("report.html"),
    without: Annotated[
        list[str] | None,
        typer.Option("--without", metavar="spectra|energy|fields", help="Leave out a part that takes long. May be repeated."),
    ] = None,
    *,
    request: Request,
    force: options.ForceOption = False,
    quiet: options.QuietOption = False,
) -> None:
    """Write a report of a run that can be handed on.

    One HTML file that needs no network, ten A4 pages at most when printed: the system, loads, histories, where the stress is largest, shock
    spectra, energy, fields, control effort, absorbers, warnings, errors, how to repeat it; below each figure its data. The run is a saved
    one, or a preset or a .toml file that is solved; with --compare, two of them side by side.
    """
    from coaxshell.apps.cli.progress import progress, tell_time
    from coaxshell.apps.report import parts_left, report_cost
    from coaxshell.apps.report import report as write

    Outputs(force).file(output, "--output", (".html",))
    left_out = tuple(without or ())
    with options.named_as_options(without="without"):
        parts_left(left_out)
    responses = answers(context, [source, *([compare] if compare else [])], request, quiet=quiet, dimensions=3)
    with options.named_as_options(path="output", compare="compare"), progress(quiet, left=True) as told:
        tell_time(report_cost(*responses, without=left_out), "the report", quiet)
        write(responses[0], output, *responses[1:], without=left_out, progress=told)
    tell_all_warnings(responses)
    echo(f"wrote {output}")
