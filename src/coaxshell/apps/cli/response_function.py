"""``coaxshell response-function``: what a fluid region answers to an impulse of its wall's acceleration, drawn or as numbers."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from coaxshell.apps.cli import options
from coaxshell.apps.cli.options import named_as_options, number
from coaxshell.apps.cli.output import Outputs, echo, write_figure
from coaxshell.errors import InputError

if TYPE_CHECKING:
    from coaxshell.numerics.arrays import FloatArray
    from coaxshell.plotting.response_functions import ResponseFunction

REGIONS = ("exterior", "interior", "gap")
_MOST_CURVES = 7
_MOST_STEPS = 200_000
_HIGHEST = 300
_LONGEST = 20.0


def response_function(
    region: Annotated[str, typer.Argument(metavar="REGION", help="exterior, interior or gap.")],
    output: Annotated[Path, typer.Option("--output", "-o", metavar="FILE", help="Where to; .png, .pdf, .svg, or .csv for numbers.")],
    modes: Annotated[
        str, typer.Option("--modes", metavar="N,...", help="Circumferential orders, seven at most in a figure.")
    ] = "0,1,2,5,20",
    radius: Annotated[
        str | None, typer.Option("--radius", metavar="LENGTH", help="Where the pressure is; the moving wall if left out.")
    ] = None,
    inner_radius: Annotated[
        str, typer.Option("--inner-radius", metavar="LENGTH", help="Of the inner shell: the interior's wall, the gap's inner wall.")
    ] = "0.5",
    outer_radius: Annotated[str, typer.Option("--outer-radius", metavar="LENGTH", help="Of the gap's outer wall.")] = "1",
    slowness: Annotated[str, typer.Option("--slowness", metavar="RATIO", help="c_e/c of the fluid inside or in the gap.")] = "1",
    duration: Annotated[str, typer.Option("--duration", metavar="TIME", help="How long, transits.")] = "5",
    time_step: Annotated[str, typer.Option("--time-step", metavar="TIME", help="Time step, transits.")] = "2.5e-3",
    force: options.ForceOption = False,
) -> None:
    """Draw or tabulate the response function of a region.

    It is the pressure after a unit impulse of a wall's acceleration. Lengths are in radii of the outermost shell.
    """
    if region not in REGIONS:
        raise InputError("REGION", f"{region!r} is not a fluid region", f"allowed: {', '.join(REGIONS)}")
    table = output.suffix.lower() == ".csv"
    orders = _orders(modes, None if table else _MOST_CURVES)
    target = Outputs(force).figure_or_table(output)
    geometry = {"--inner-radius": inner_radius, "--outer-radius": outer_radius, "--slowness": slowness}
    sizes = {name: number(name, text) for name, text in geometry.items()}
    place = None if radius is None else number("--radius", radius)
    times = _times(number("--duration", duration), number("--time-step", time_step))

    with named_as_options(disc_radius="inner-radius", inner="inner-radius", outer="outer-radius", radius="radius", slowness="slowness"):
        found = _functions(region, orders if table else list(range(max(60, *orders) + 1)), times, place, sizes)
    if table:
        _write(target, orders, found)
    else:
        from coaxshell.plotting.response_functions import figure_response_functions

        write_figure(figure_response_functions(found, orders), target, "--output")
    echo(f"wrote {target}: {region} response function, orders {', '.join(map(str, orders))}")


def _orders(text: str, most: int | None) -> list[int]:
    try:
        orders = sorted({int(part) for part in text.split(",")})
    except ValueError:
        raise InputError(
            "--modes", f"{text!r} is not a list of orders", "give whole numbers with commas between, as in 0,1,2,5,20"
        ) from None
    if orders[0] < 0 or orders[-1] > _HIGHEST:
        raise InputError("--modes", f"{text!r} is out of range", f"give orders from 0 to {_HIGHEST}")
    if most is not None and len(orders) > most:
        raise InputError("--modes", f"{len(orders)} orders are too many for one figure", f"give at most {most}, or write a .csv file")
    return orders


def _times(duration: float, step: float) -> FloatArray:
    import numpy as np

    if not 0.0 < duration <= _LONGEST:
        raise InputError("--duration", f"{duration:g} is not allowed", f"give a time above 0, at most {_LONGEST:g}")
    if not 0.0 < step <= duration / 10.0:
        raise InputError(
            "--time-step", f"{step:g} is not allowed", f"give a time above 0, at most a tenth of the duration, {duration / 10:g}"
        )
    if duration / step > _MOST_STEPS:
        raise InputError("--time-step", f"{step:g} makes {duration / step:.3g} steps", f"give one that makes at most {_MOST_STEPS}")
    return np.linspace(0.0, duration, round(duration / step) + 1)


def _functions(region: str, orders: list[int], times: FloatArray, radius: float | None, sizes: dict[str, float]) -> list[ResponseFunction]:
    from coaxshell.acoustics.response_functions import arrivals, exterior, gap, interior
    from coaxshell.plotting.response_functions import ResponseFunction

    inner, outer, alpha, end = sizes["--inner-radius"], sizes["--outer-radius"], sizes["--slowness"], float(times[-1])
    if region == "exterior":
        at = 1.0 if radius is None else radius
        return [ResponseFunction(f"exterior, $r$ = {at:g}", times, exterior(orders, times, radius=at), 0.0, [(at - 1.0, False)])]
    if region == "interior":
        values = interior(orders, times, radius=radius, disc_radius=inner, slowness=alpha)
        fronts = arrivals(0.0, inner, inner if radius is None else radius, "outer", alpha, end)
        title = f"interior of $r_1$ = {inner:g}, $r$ = {inner if radius is None else radius:g}"
        return [ResponseFunction(title, times, values, 2.0 / (inner * alpha**2), fronts)]
    functions = []
    walls: tuple[tuple[Literal["inner", "outer"], float, float], ...] = (("inner", -1.0, inner), ("outer", 1.0, outer))
    for driven, sign, wall in walls:
        at = wall if radius is None else radius
        values = gap(orders, times, inner=inner, outer=outer, radius=at, driven=driven, slowness=alpha)
        growth = 2.0 * sign * wall / ((outer**2 - inner**2) * alpha**2)
        title = f"{driven} wall moves, $r$ = {at:g}"
        functions.append(ResponseFunction(title, times, values, growth, arrivals(inner, outer, at, driven, alpha, end)))
    return functions


def _write(target: Path, orders: list[int], found: list[ResponseFunction]) -> None:
    import numpy as np

    prefixes = [""] if len(found) == 1 else ["inner_", "outer_"]
    names = ["time", *(f"{prefix}m{order}" for prefix in prefixes for order in orders)]
    columns = np.concatenate([found[0].time[None], *(each.values for each in found)]).T
    from coaxshell.numerics.files import replacing

    with replacing(target) as made:
        np.savetxt(made, columns, delimiter=",", header=",".join(names), comments="", fmt="%.12g")
