"""``coaxshell export``: a run for other programs."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from coaxshell.apps.cli import options
from coaxshell.apps.cli.options import times as read_times
from coaxshell.apps.cli.output import Outputs, echo
from coaxshell.apps.cli.progress import progress, tell_time
from coaxshell.apps.cli.running import Request, answers, tell_all_warnings, with_resolution
from coaxshell.errors import InputError

_KINDS = ("paraview", "csv", "mat")


@with_resolution
def export(
    context: typer.Context,
    source: options.SourceArgument,
    to: Annotated[str, typer.Option("--to", metavar="paraview|csv|mat", help="ParaView gets a folder, the others a file.")],
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", metavar="FILE|FOLDER", help="Folder or file.", show_default="after SOURCE, in this folder"),
    ] = None,
    times: Annotated[
        str | None,
        typer.Option("--times", metavar="TIME,...", help="ParaView: instants in transits, as in 0:5:0.05.", show_default="101, evenly"),
    ] = None,
    width: options.WidthOption = "6",
    points: Annotated[str, typer.Option("--points", metavar="N", help="ParaView: points along a side of the square.")] = "301",
    displaced: Annotated[
        str,
        typer.Option("--displaced", metavar="FACTOR", help="ParaView: draw the shells displaced this many times."),
    ] = "0",
    section: options.SectionOption = None,
    cuts: Annotated[bool, typer.Option("--cuts/--no-cuts", help="ParaView, three dimensions: cuts across the axis and along it.")] = True,
    volume: Annotated[
        str | None,
        typer.Option(
            "--volume", metavar="N", help="ParaView, three dimensions: a volume too, of N points along its diameter.", show_default="none"
        ),
    ] = None,
    velocity: Annotated[bool, typer.Option("--velocity", help="ParaView, three dimensions: the particle velocity too.")] = False,
    force: options.ForceOption = False,
    *,
    request: Request,
    quiet: options.QuietOption = False,
) -> None:
    """Write a run for ParaView, as CSV or for MATLAB."""
    from coaxshell.export import check_grid, export_csv, export_mat, export_paraview
    from coaxshell.export.paraview import SpatialFields, paraview_cost

    if to not in _KINDS:
        raise InputError("--to", f"{to!r} is unknown", f"allowed: {', '.join(_KINDS)}")
    target = _target(source, to, output, force)
    chosen = None if times is None else read_times(times)
    half_width, factor = 0.5 * options.number("--width", width), options.number("--displaced", displaced)
    side, within = options.whole("--points", points), None if volume is None else options.whole("--volume", volume)
    with options.named_as_options():
        check_grid(half_width, side, factor)
    (response,) = answers(context, [source], request, quiet=quiet, dimensions=3)
    names = {"folder": "output", "path": "output", "station": "section", "stations": "section", "volume": "volume", "velocity": "velocity"}
    with options.named_as_options(**names), progress(quiet) as report:
        if to == "paraview":
            fields: SpatialFields = {"cuts": cuts, "volume": within, "velocity": velocity, "station": section}
            if response.stations is not None:
                tell_time(paraview_cost(response, chosen, half_width, side, **fields), "the fields", quiet)
            export_paraview(
                response,
                target,
                times=chosen,
                half_width=half_width,
                points=side,
                displaced=factor,
                **fields,
                force=force,
                progress=report,
            )
        else:
            {"csv": export_csv, "mat": export_mat}[to](response, target)
    tell_all_warnings([response])
    series = [f"{name}.pvd" for name in ("field", "across", "along", "volume", "shells") if (target / f"{name}.pvd").exists()]
    echo(f"wrote {target}" + (f": open {', '.join(series[:-1])} and {series[-1]} in ParaView" if len(series) > 1 else ""))


def _target(source: str, to: str, output: Path | None, force: bool) -> Path:
    """Return where to write to, refused now if that cannot be."""
    stem = Path(source).stem
    if to == "paraview":
        from coaxshell.export.paraview import PARAVIEW_PARTS

        return Outputs(force).folder(output or Path(f"{stem}-paraview"), "--output", PARAVIEW_PARTS)
    return Outputs(force).file(output or Path(f"{stem}.{to}"), "--output", (f".{to}",))
