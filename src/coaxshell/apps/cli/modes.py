"""``coaxshell modes``: natural frequencies of a system, dry and wet."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from coaxshell.apps.cli import options
from coaxshell.apps.cli.output import Outputs, echo, print_document, write_figure
from coaxshell.errors import InputError


def modes(
    scenario: Annotated[str, typer.Argument(metavar="SCENARIO", help="A .toml file, a preset, or - for standard input.")],
    changes: options.SetOption = None,
    order: Annotated[str, typer.Option("--order", metavar="N,...", help="Circumferential orders, as in 0-12 or 2,3,8.")] = "0-12",
    half_wavelength: Annotated[
        str | None,
        typer.Option(
            "--axial-half-wavelength",
            metavar="LENGTH,...",
            help="Of motion along the axis: a shell's length between diaphragms. Nothing changes along it if left out.",
        ),
    ] = None,
    wavenumber: Annotated[
        str | None,
        typer.Option("--wavenumber", metavar="WAVENUMBER,...", help="Along the axis, rad/m, as in 1,2,5; k = pi/length."),
    ] = None,
    up_to: Annotated[
        str | None, typer.Option("--up-to", metavar="FREQUENCY", help='Highest one, as in "2 kHz".', show_default="ten transits' worth")
    ] = None,
    most_damped: Annotated[str, typer.Option("--most-damped", metavar="RATIO", help="Largest damping ratio, 0.5 at most.")] = "0.2",
    output: options.FigureOrTableOption = None,
    as_json: options.JsonOption = False,
    force: options.ForceOption = False,
) -> None:
    """Find the natural frequencies of the shells.

    In their fluids and without. Each order rings at a few frequencies and loses its sound to the fluid outside: the damping ratio tells
    how fast. Shells with feedback are taken with it, absorbers are left out. Several along the axis give dispersion curves.
    """
    from coaxshell.apps.cli.running import load_system
    from coaxshell.export.natural_frequencies import export_natural_frequencies_csv, rows_of
    from coaxshell.plotting import figure_natural_frequencies
    from coaxshell.response import natural_frequencies

    target = Outputs(force).figure_or_table(output)
    system = load_system(scenario, changes or ())
    lengths: Any = None if half_wavelength is None else [each.strip() for each in half_wavelength.split(",")]
    ratio = options.number("--most-damped", most_damped)
    along = None if wavenumber is None else [options.number("--wavenumber", each) for each in wavenumber.split(",")]
    renamed = {
        "axial_wavenumber": "wavenumber",
        "order": "order",
        "axial_half_wavelength": "axial-half-wavelength",
        "up_to": "up-to",
        "most_damped": "most-damped",
    }
    with options.named_as_options(**renamed):
        found = natural_frequencies(system, orders_of(order), lengths, axial_wavenumber=along, up_to=up_to, most_damped=ratio)
    rows = list(rows_of(found))
    if as_json:
        print_document({"system": system.name, "absorbers": "left out", "modes": rows})
    else:
        _print(system.name, rows)
        if system.absorber_list or system.point_absorbers:
            echo("The absorbers of the system are left out.")
    if target is not None:
        if target.suffix == ".csv":
            export_natural_frequencies_csv(found, target)
        else:
            write_figure(figure_natural_frequencies(found), target, "--output")
        echo(f"wrote {target}", aside=as_json)


def orders_of(text: str, option: str = "--order") -> list[int]:
    """Return the orders of "0-12", "2,3,8" or both mixed."""
    found: list[int] = []
    for item in text.split(","):
        first, dash, last = item.strip().partition("-")
        if not first.isdecimal() or (dash and not (last.isdecimal() and int(first) <= int(last) < 10_000)):
            raise InputError(option, f"{item.strip()!r} is not an order, nor a range of them", "write them as in 0-12 or 2,3,8")
        found += range(int(first), int(last) + 1) if dash else [int(first)]
    return found


def _print(name: str, rows: list[dict[str, Any]]) -> None:
    from coaxshell.response.summary_text import aligned

    echo(f"Natural frequencies of {name}\n")
    if not rows:
        echo("none so low and so little damped: raise --up-to or --most-damped")
        return
    columns = [column for column in rows[0] if any(row[column] is not None for row in rows)]
    for line in aligned([columns, *([_cell(column, row[column]) for column in columns] for row in rows)]):
        echo(line.rstrip())


def _cell(column: str, value: Any) -> str:
    if value is None:
        return ""
    if column.endswith("motion"):
        return f"{round(value, 2) + 0.0:.2f}"  # no minus before nothing
    return f"{value:.4g}" if isinstance(value, float) else str(value)
