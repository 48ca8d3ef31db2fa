"""Options that the commands about pressure fields share."""

from __future__ import annotations

import math
from typing import Annotated

import typer

from coaxshell.cli import values
from coaxshell.errors import InputError

SourceArgument = Annotated[
    str, typer.Argument(metavar="SOURCE", help="A preset, a .toml file, or a run saved by coaxshell run --output (.nc).")
]
CompareOption = Annotated[
    str | None, typer.Option("--compare", metavar="SOURCE", help="Second system, shown beside the first on the same scales.")
]
WidthOption = Annotated[str, typer.Option("--width", metavar="LENGTH", help="Side of the square that is seen, in outermost radii a.")]
UnitsOption = Annotated[str, typer.Option("--units", metavar="auto|Pa|kPa|MPa|relative", help="Of the pressure; relative is p/(rho c^2).")]
PressureLimitOption = Annotated[
    str | None,
    typer.Option("--pressure-limit", metavar="PRESSURE", help="End of the pressure's colour scale in Pa.", show_default="from the fields"),
]
StressLimitOption = Annotated[
    str | None,
    typer.Option("--stress-limit", metavar="PRESSURE", help="End of the stress's colour scale in Pa.", show_default="from the fields"),
]


def limit(option: str, text: str | None) -> float | None:
    """Return the end of a colour scale in Pa, None if it is left to the fields; InputError if it is not positive."""
    if text is None:
        return None
    value = values.number(option, text)
    if not (math.isfinite(value) and value > 0):
        raise InputError(option, f"{value:g} is not allowed", "give a positive number, in Pa")
    return value
