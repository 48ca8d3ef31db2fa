"""``coaxshell run``: solve a system and tell its peaks."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from coaxshell.apps.cli import options
from coaxshell.apps.cli.documents import arrays_document, runs_document
from coaxshell.apps.cli.options import named_as_options
from coaxshell.apps.cli.output import Outputs, echo, print_document, tell_warnings, write_figure
from coaxshell.apps.cli.running import Request, WorkRequest, with_options
from coaxshell.errors import InputError

if TYPE_CHECKING:
    import xarray as xr

    from coaxshell.response import Response


@with_options(request=Request, work=WorkRequest)
def run(
    scenario: Annotated[
        str,
        typer.Argument(
            metavar="SCENARIO", help="A .toml file (see coaxshell init), a preset (see coaxshell presets), or - for standard input."
        ),
    ],
    *,
    request: Request,
    work: WorkRequest,
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", metavar="FILE", help="Save the run as NetCDF (.nc): arrays, system, settings, versions."),
    ] = None,
    compare: Annotated[
        str | None,
        typer.Option(
            "--compare",
            metavar="SCENARIO",
            help="Solve this one too, or read a saved run (.nc), and print both side by side: by how much the first is smaller or larger.",
        ),
    ] = None,
    figure: Annotated[
        Path | None, typer.Option("--figure", metavar="FILE", help="Draw the stress at head and tail of each shell; .png, .pdf or .svg.")
    ] = None,
    energy: Annotated[
        Path | None, typer.Option("--energy", metavar="FILE", help="Draw where the energy of the first run goes; .png, .pdf or .svg.")
    ] = None,
    as_json: options.JsonOption = False,
    force: options.ForceOption = False,
    quiet: options.QuietOption = False,
) -> None:
    """Solve a system and print its peaks.

    With --compare, beside those of another one. --set changes both systems, but absorbers and control only where a system has them;
    --output saves the first run. With --dimensions 3 the shells answer at --stations to the true spherical shock; beside a saved run in
    two dimensions the first station is compared; --workers and --dask share the work out, --store keeps it for --resume.
    """
    from coaxshell.apps.cli.comparison import print_comparison
    from coaxshell.apps.cli.output import print_summary
    from coaxshell.apps.cli.running import is_saved, load_reference, load_system
    from coaxshell.response import load_response
    from coaxshell.response.run_comparison import compared, run_labels

    outputs = Outputs(force)
    if output is not None:
        outputs.file(output, "--output", (".nc",))
    outputs.figure(figure)
    outputs.figure(energy, "--energy")
    systems = [load_system(scenario, request.changes or ())]
    if energy is not None:
        request.require_energy(systems[0])
    saved = [load_response(compare)] if compare is not None and is_saved(compare) else []
    if compare is not None and not saved:
        systems.append(load_reference(compare, request.changes or ()))
    for system in systems:
        request.check(system)
    execution = work.execution(request.settings(systems[0]))
    if len(systems) > 1 and work.store is not None:
        raise InputError("--store", "keeps one run", "leave it out, or compare with a saved run (.nc)")
    responses = [*(request.solve(system, quiet=quiet, execution=execution) for system in systems), *saved]
    names = run_labels(*responses) if compare is not None else (systems[0].name or scenario,)
    named = dict(zip(names, responses, strict=True))
    with named_as_options(compare="compare"):
        shown = compared(named) if compare is not None else named
    if output is not None:
        with named_as_options(path="output"):
            responses[0].save(output)
    balance = _draw(shown, figure, energy, quiet=quiet)
    if as_json:
        _tell_programs(named, balance)
    elif compare is not None:
        print_comparison(shown)
    else:
        print_summary(responses[0])
    for word, path in (("saved", output), ("wrote", figure), ("wrote", energy)):
        if path is not None:
            echo(f"{word} {path}", aside=as_json)


def _tell_programs(named: Mapping[str, Response], balance: xr.Dataset | None) -> None:
    """Print the document of some runs, with the energy of the first if that is known, and their warnings."""
    document = runs_document(named, [response.summary() for response in named.values()])
    print_document(document | ({} if balance is None else {"energy": arrays_document(balance)}))
    for response in named.values():
        tell_warnings(response.warnings)


def _draw(named: Mapping[str, Response], figure: Path | None, energy: Path | None, *, quiet: bool) -> xr.Dataset | None:
    """Draw the runs, and where the energy of the first goes, which is returned."""
    if figure is not None:
        from coaxshell.plotting import figure_comparison, figure_curves

        alone = len(named) == 1 and next(iter(named.values())).stations is not None
        write_figure(figure_curves(named) if alone else figure_comparison(named), figure)
    if energy is None:
        return None
    from coaxshell.apps.cli.progress import progress
    from coaxshell.plotting import figure_energy

    with progress(quiet) as report:
        balance = next(iter(named.values())).energy(progress=report)
    write_figure(figure_energy(balance), energy, "--energy")
    return balance
