"""``coaxshell record``: what is understood of a measured pressure record, before anything is solved with it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from coaxshell.apps.cli import options
from coaxshell.apps.cli.output import Outputs, print_document, write_figure
from coaxshell.errors import InputError

if TYPE_CHECKING:
    from coaxshell.model.pulses import Sampled

Text = str | None


def record(
    path: Annotated[Path, typer.Argument(metavar="FILE", help="CSV or other text, .mat (up to version 7) or .wav.")],
    time_column: Annotated[Text, typer.Option("--time-column", metavar="NAME|N", help="Heading, or number from 1 on.")] = None,
    pressure_column: Annotated[Text, typer.Option("--pressure-column", metavar="NAME|N", help="Heading, or number from 1 on.")] = None,
    time_unit: Annotated[Text, typer.Option("--time-unit", metavar="UNIT", help="Instead of the one in the heading.")] = None,
    pressure_unit: Annotated[Text, typer.Option("--pressure-unit", metavar="UNIT", help="Instead of the one in the heading.")] = None,
    interval: Annotated[Text, typer.Option("--interval", metavar="TIME", help="Between samples, without a column of times.")] = None,
    scale: Annotated[Text, typer.Option("--scale", metavar="FACTOR", help="On the pressures; of a .wav: Pa at full scale.")] = None,
    offset: Annotated[Text, typer.Option("--offset", metavar="PRESSURE", help="Subtracted after scaling.")] = None,
    baseline: Annotated[
        Text, typer.Option("--baseline", metavar="TIME|pre-trigger", help="Subtract the mean over this time from the first sample.")
    ] = None,
    start: Annotated[Text, typer.Option("--start", metavar="TIME", help="Keep what comes from here on; it becomes t = 0.")] = None,
    end: Annotated[Text, typer.Option("--end", metavar="TIME", help="Keep what comes before.")] = None,
    shift: Annotated[Text, typer.Option("--shift", metavar="TIME", help="Added to the times.")] = None,
    resample: Annotated[
        Text, typer.Option("--resample", metavar="TIME", help="An even grid of this interval; the impulse is kept.")
    ] = None,
    taper: Annotated[Text, typer.Option("--taper", metavar="TIME", help="Bring the last part of this length to zero.")] = None,
    figure: Annotated[Path | None, typer.Option("--figure", metavar="FILE", help="Draw it with its spectrum; .png, .pdf, .svg.")] = None,
    as_json: options.JsonOption = False,
    force: options.ForceOption = False,
) -> None:
    """Show what is understood of a measured pressure record.

    Columns and units as read, peak, rise, decay, impulse, duration, sampling rate and band, with remarks on what looks wrong. The
    options are the entries of pulse = {type = "sampled", file = "FILE", ...} in a scenario.
    """
    from coaxshell.model.pulses import Sampled

    given = {
        "time_column": time_column,
        "pressure_column": pressure_column,
        "time_unit": time_unit,
        "pressure_unit": pressure_unit,
        "interval": interval,
        "scale": scale,
        "offset": offset,
        "baseline": baseline,
        "start": start,
        "end": end,
        "shift": shift,
        "resample": resample,
        "taper": taper,
    }
    wanted = {name: value for name, value in given.items() if value is not None}
    Outputs(force).figure(figure)
    try:
        found = Sampled.from_file(path, **wanted)
    except InputError as error:
        if error.where in given:
            raise InputError(f"--{error.where.replace('_', '-')}", error.problem, error.remedy) from None
        raise
    if as_json:
        print_document(content(found))
    else:
        _print(found, path, wanted)
    if figure is not None:
        from coaxshell.plotting.record import figure_record

        write_figure(figure_record(found, path.name), figure)
        typer.echo(f"wrote {figure}", err=as_json)


def content(found: Sampled) -> dict[str, Any]:
    """Return measures, remarks and account of a record as plain data, SI."""
    from dataclasses import asdict

    return {"reference": found.reference, **asdict(found.measures), "remarks": list(found.remarks)}


def _print(found: Sampled, path: Path, wanted: dict[str, str]) -> None:
    from coaxshell.model.prefixes import engineering
    from coaxshell.response.summary_text import aligned

    told = found.measures
    even = told.largest_interval - told.interval <= 1e-6 * told.interval
    interval = engineering(told.interval, "s") + ("" if even else f" to {engineering(told.largest_interval, 's')}")
    rows = [
        ("samples", f"{told.samples:,}"),
        ("duration", engineering(told.duration, "s")),
        ("interval", interval),
        ("sampling rate", engineering(1 / told.interval, "Hz") + ("" if even else " at most")),
        ("peak", f"{engineering(told.peak, 'Pa')} at {engineering(told.peak_time, 's')}"),
        ("rise, 10 to 90 %", engineering(told.rise_time, "s")),
        ("decay to 1/e", "not within the record" if told.decay_time is None else engineering(told.decay_time, "s")),
        ("peak to zero", "not within the record" if told.positive_duration is None else engineering(told.positive_duration, "s")),
        ("impulse", f"{engineering(told.impulse, 'Pa s')}, at most {engineering(told.largest_impulse, 'Pa s')}"),
        ("99 % of energy below", engineering(told.band, "Hz")),
    ]
    typer.echo(found.reference)
    typer.echo("")
    typer.echo("\n".join(aligned(rows, left=2)))
    typer.echo("")
    for remark in found.remarks:
        typer.echo(f"remark: {remark}")
    entries = "".join(f", {name} = {json.dumps(value, ensure_ascii=False)}" for name, value in wanted.items())
    typer.echo(f'in a scenario: pulse = {{ type = "sampled", file = {json.dumps(path.name, ensure_ascii=False)}{entries} }}')
