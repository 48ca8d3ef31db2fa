"""``coaxshell spectrum``: shock response spectra of the shells of any run."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from coaxshell.apps.cli import options
from coaxshell.apps.cli.output import Outputs, echo, print_document, write_figure
from coaxshell.apps.cli.running import Request, answers, tell_all_warnings, with_resolution


@with_resolution
def spectrum(
    context: typer.Context,
    source: options.SourceArgument,
    shell: Annotated[
        list[str] | None,
        typer.Option("--shell", metavar="NAME", help="inner, outer or a number from 0 inside. May be repeated.", show_default="all"),
    ] = None,
    angle: Annotated[str, typer.Option("--angle", metavar="ANGLE,...", help="Degrees from the source, as in 0,90,180.")] = "0,180",
    frequency: Annotated[
        str | None,
        typer.Option(
            "--frequency", metavar="FREQUENCY,...", help="Natural frequencies in Hz, as in 100,200,500.", show_default="chosen from the run"
        ),
    ] = None,
    quality: Annotated[str, typer.Option("--quality", metavar="RATIO", help="Q = 1/(2 zeta) of the oscillators.")] = "10",
    compare: options.CompareOption = None,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", metavar="FILE", help="Where to; .png, .pdf, .svg or .csv.", show_default="spectrum.png")
    ] = None,
    *,
    request: Request,
    as_json: options.JsonOption = False,
    force: options.ForceOption = False,
    quiet: options.QuietOption = False,
) -> None:
    """Draw or tabulate the shock response spectra of a run.

    What small equipment on the shells feels: the largest pseudo-velocity of oscillators by their natural frequency, at some angles and the
    largest all around, on four-coordinate paper. The run is a saved one, or a preset or a .toml file that is solved; with --compare,
    two of them. A .csv and --json hold displacement, pseudo-velocity and acceleration; --json writes a file only where --output names one.
    """
    from coaxshell.apps.cli.documents import spectra_document
    from coaxshell.export import export_spectra_csv
    from coaxshell.export.spectra import spectra_of
    from coaxshell.plotting import figure_shock_spectra
    from coaxshell.response.run_comparison import run_labels
    from coaxshell.response.shock_spectrum import frequencies_of, quality_of

    target = Outputs(force).figure_or_table(None if as_json and output is None else output or Path("spectrum.png"))
    angles = [options.number("--angle", each) for each in angle.split(",")]
    frequencies = None if frequency is None else [options.number("--frequency", each) for each in frequency.split(",")]
    as_options = partial(
        options.named_as_options, shell="shell", shells="shell", responses="compare", frequency="frequency", quality_factor="quality"
    )
    factor = options.number("--quality", quality)
    with as_options():
        frequencies_of(frequencies)
        quality_of(factor)
    responses = answers(context, [source, *([compare] if compare else [])], request, quiet=quiet, dimensions=3)
    named = dict(zip(run_labels(*responses) if compare else ("",), responses, strict=True))
    with as_options():
        if as_json:
            print_document(spectra_document(spectra_of(named, shell, angles, None, frequencies, factor), factor))
        if target is not None and target.suffix.lower() == ".csv":
            export_spectra_csv(named, target, shell, angles, None, frequencies, factor)
        elif target is not None:
            write_figure(figure_shock_spectra(named, shell, angles, None, frequencies, factor), target, "--output")
    tell_all_warnings(responses)
    if target is not None:
        echo(f"wrote {target}", aside=as_json)
