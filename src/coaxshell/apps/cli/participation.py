"""``coaxshell participation``: which natural modes carry a peak."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from coaxshell.apps.cli import options
from coaxshell.apps.cli.output import Outputs, echo, print_document, write_figure
from coaxshell.apps.cli.running import Request, answers, tell_all_warnings, with_resolution

if TYPE_CHECKING:
    import xarray as xr

_LEAST = 0.01
"""Share of a peak that a mode carries at least, to stand in the table."""


@with_resolution
def participation(
    context: typer.Context,
    source: options.SourceArgument,
    shell: Annotated[str, typer.Option("--shell", metavar="NAME", help="inner, outer or a number from 0 inside.")] = "0",
    quantity: Annotated[
        str, typer.Option("--quantity", metavar="NAME", help="stress, displacement, shell_velocity, sensor_voltage, ...")
    ] = "stress",
    angle: Annotated[
        str | None, typer.Option("--angle", metavar="ANGLE", help="Degrees from the source.", show_default="that of the largest")
    ] = None,
    time: Annotated[
        str | None, typer.Option("--time", metavar="TIME", help="Transits.", show_default="when the magnitude is largest")
    ] = None,
    up_to: Annotated[
        str | None,
        typer.Option("--up-to", metavar="FREQUENCY", help='Highest natural frequency, as "5 kHz".', show_default="60 c/(2 pi a)"),
    ] = None,
    output: Annotated[Path | None, typer.Option("--output", "-o", metavar="FILE", help="Draw it too; .png, .pdf or .svg.")] = None,
    *,
    request: Request,
    as_json: options.JsonOption = False,
    force: options.ForceOption = False,
    quiet: options.QuietOption = False,
) -> None:
    """Tell which natural modes carry a peak.

    The largest value of a quantity of a shell as the sum of its circumferential orders, and of each order by its natural modes in the
    fluids: frequency, damping, what each carries. What is left is what the fluid outside remembers. The run is a saved one, or a preset or
    a .toml file that is solved, in two dimensions with thin walls.
    """
    from coaxshell.plotting.participation import figure_participation

    Outputs(force).figure(output, "--output")
    place: dict[str, Any] = {
        "angle": None if angle is None else options.number("--angle", angle),
        "time": None if time is None else options.number("--time", time),
    }
    (response,) = answers(context, [source], request, quiet=quiet)
    with options.named_as_options(shell="shell", quantity="quantity", angle="angle", time="time", up_to="up-to"):
        found = response.participation(int(shell) if shell.isdigit() else shell, quantity, up_to=up_to, **place)
    if as_json:
        print_document(_document(found))
    else:
        _print(found)
    if output is not None:
        write_figure(figure_participation(found), output, "--output")
        echo(f"wrote {output}", aside=as_json)
    tell_all_warnings([response])


def _document(found: xr.Dataset) -> dict[str, Any]:
    from coaxshell.response.participation import largest_modes

    orders = {name: found[name].values.tolist() for name in ("order", "order_contribution", "order_share", "rest_share")}
    unit = found.attrs["units"]
    units = {"frequency": "Hz", "damping_ratio": "1", "contribution": unit, "value": unit, "time": "a/c_e", "angle": "deg"}
    return {**found.attrs, "orders": orders, "modes": [row._asdict() for row in largest_modes(found)], "units": units}


def _print(found: xr.Dataset) -> None:
    from coaxshell.model.prefixes import engineering
    from coaxshell.numerics.texts import percent
    from coaxshell.response.participation import largest_modes
    from coaxshell.response.summary_text import aligned

    told, unit = found.attrs, found.attrs["units"]
    name = told["quantity"].replace("_", " ")
    echo(
        f"{name} of {told['shell_name']}: {engineering(told['value'], unit)} at {told['angle']:.4g} deg, t = {told['time']:.4g} transits\n"
    )
    rows = [("order", "frequency", "damping ratio", "carries", "share")]
    for row in largest_modes(found, least=_LEAST):
        shown = (engineering(row.frequency, "Hz"), f"{row.damping_ratio:.3f}", engineering(row.contribution, unit))
        rows.append((str(row.order), *shown, percent(row.share)))
    for line in aligned(rows, left=1):
        echo(line)
    echo("")
    orders = found["order"].values.tolist()
    shares = [f"m = {m}: {percent(share)}" for m, share in zip(orders, found["order_share"].values.tolist(), strict=True)]
    echo("orders: " + ", ".join(shares) + f"; all others {percent(told['other_orders'])}")
    rest = percent(float(found["rest_share"].sum()))
    echo(f"carried by no mode of these orders (memory of the fluids, translation, higher modes): {rest}")
