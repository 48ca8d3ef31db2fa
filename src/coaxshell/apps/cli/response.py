"""``coaxshell response``: what a system does at given frequencies, without any time step."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from coaxshell.apps.cli import options
from coaxshell.apps.cli.modes import orders_of
from coaxshell.apps.cli.output import Outputs, echo, print_document, write_figure
from coaxshell.errors import InputError

if TYPE_CHECKING:
    import xarray as xr

    from coaxshell.model import System

_MOST = 20_000
_SHOWN = 12
"""Curves that are printed at most."""
_OWN = (
    *("frequency", "quantity", "shell", "angle", "radius", "component", "depth"),
    *("region", "z", "source", "per", "length", "against", "modes"),
)
_RENAMED = {name: name for name in (*_OWN, "dimensions")} | {"force": "line-force"}


def response(
    scenario: Annotated[str, typer.Argument(metavar="SCENARIO", help="A .toml file, a preset, or - for standard input.")],
    changes: options.SetOption = None,
    frequency: Annotated[
        str, typer.Option("--frequency", metavar="FREQUENCY,...", help="Hz: 100,200,1 kHz, or 10:5000:500, so many from here to there.")
    ] = "10:1000:500",
    quantity: Annotated[
        str, typer.Option("--quantity", metavar="NAME", help="As target-strength, transmission-loss, stress, pressure, receptance.")
    ] = "target-strength",
    shell: Annotated[str | None, typer.Option("--shell", metavar="NAME", help="inner, outer or a number.", show_default="outer")] = None,
    angle: Annotated[
        str | None, typer.Option("--angle", metavar="ANGLE,...", help="Degrees: 0,90,180 or 0:360:361.", show_default="of the quantity")
    ] = None,
    radius: Annotated[str | None, typer.Option("--radius", metavar="LENGTH,...", help="Of a pressure, in outermost radii a.")] = None,
    component: Annotated[str | None, typer.Option("--component", metavar="NAME", help="Of a stress or a motion.")] = None,
    depth: Annotated[str | None, typer.Option("--depth", metavar="LENGTH", help="Of a stress, m outward, or inner or outer.")] = None,
    region: Annotated[str | None, typer.Option("--region", metavar="NAME", help="Fluid over which a loss takes its mean.")] = None,
    z: Annotated[str | None, typer.Option("--z", metavar="LENGTH", help="Along the axis, in three dimensions.", show_default="0")] = None,
    line_force: Annotated[
        str | None, typer.Option("--line-force", metavar="NAME,...", help="A shell and an angle where 1 N/m acts, not the sources.")
    ] = None,
    source: Annotated[str | None, typer.Option("--source", metavar="N", help="The one that is meant, of several, from 0.")] = None,
    per: Annotated[str | None, typer.Option("--per", metavar="incident|absolute", help="What amplitudes are per.")] = None,
    length: Annotated[str | None, typer.Option("--length", metavar="LENGTH", help="Of a cylinder seen broadside.")] = None,
    against: Annotated[str | None, typer.Option("--against", metavar="SCENARIO", help="What an insertion loss compares with.")] = None,
    compare: Annotated[str | None, typer.Option("--compare", metavar="SCENARIO", help="Second system, in the same figure.")] = None,
    modes: Annotated[str | None, typer.Option("--modes", metavar="N", help="Highest order.", show_default="by the frequency")] = None,
    dimensions: options.DimensionsOption = options.DIMENSIONS,
    resonances: Annotated[str | None, typer.Option("--resonances", metavar="N,...", help="Mark those of these orders: 0-6.")] = None,
    polar: Annotated[bool, typer.Option("--polar", help="Draw over the angle, a curve a frequency.")] = False,
    output: options.FigureOrTableOption = None,
    as_json: options.JsonOption = False,
    force: options.ForceOption = False,
) -> None:
    """Compute what a system does at given frequencies.

    Echo, sound that gets in, motion and stress per incident pressure, without any time step: with feedback, losses and linear absorbers.
    Prints the largest and the smallest value of each curve, over the angle where there are many; a .csv holds all of them, a figure draws
    them.
    """
    from coaxshell.apps.cli.documents import frequency_document
    from coaxshell.apps.cli.running import load_system

    target = Outputs(force).figure_or_table(output)
    if compare and target is not None and (polar or target.suffix == ".csv"):
        raise InputError("--compare", "has two systems, which neither a table nor a polar figure holds", "ask for one at a time")
    given: dict[str, Any] = {
        "shell": shell,
        "component": component,
        "depth": _number_or_text(depth),
        "region": region,
        "per": per,
        "z": _number_or_text(z),
    }
    given |= {"length": length, "angle": _numbers("--angle", angle), "radius": _numbers("--radius", radius), "force": _force(line_force)}
    given |= {name: None if text is None else options.whole(f"--{name}", text) for name, text in (("source", source), ("modes", modes))}
    given["dimensions"] = options.whole("--dimensions", dimensions)
    if against is not None:
        given["against"] = load_system(against, where="--against")
    asked = {name: value for name, value in given.items() if value is not None}
    systems = [load_system(scenario, changes or ()), *([load_system(compare, where="--compare")] if compare else [])]
    hertz, name = _frequencies(frequency), quantity.strip().replace("-", "_")
    found = _found(systems, hertz, name, asked)
    if target is not None:
        _write(found, systems, target, resonances, polar=polar)
    if as_json:
        print_document(frequency_document(found))
    else:
        _print(found, polar=polar)
    if target is not None:
        echo(f"wrote {target}", aside=as_json)


def _found(systems: list[System], hertz: list[Any], name: str, asked: dict[str, Any]) -> dict[str, xr.DataArray]:
    from coaxshell.response import frequency_response

    found: dict[str, xr.DataArray] = {}
    for number, system in enumerate(systems):
        with options.named_as_options(**_RENAMED):
            answer = frequency_response(system, hertz, name, **asked)
        label = system.name or f"system {number + 1}"
        found[label if label not in found else f"{label} ({number + 1})"] = answer
    return found


def _write(found: Mapping[str, xr.DataArray], systems: list[System], target: Path, resonances: str | None, *, polar: bool) -> None:
    """Write the answers as a table, or draw them."""
    from coaxshell.export import export_frequency_response_csv
    from coaxshell.plotting import figure_directivity, figure_frequency_response
    from coaxshell.response import natural_frequencies

    first = next(iter(found.values()))
    if target.suffix == ".csv" or polar:
        if target.suffix == ".csv":
            export_frequency_response_csv(first, target)
            return
        with options.named_as_options(found="angle", frequency="frequency"):
            write_figure(figure_directivity(first), target, "--output")
        return
    marks = None
    if resonances is not None:
        with options.named_as_options(order="resonances"):
            marks = natural_frequencies(systems[0], orders_of(resonances, "--resonances"), up_to=float(first["frequency"].max()))
    with options.named_as_options(found="angle"):
        write_figure(figure_frequency_response(found if len(found) > 1 else first, marks), target, "--output")


def _print(found: Mapping[str, xr.DataArray], *, polar: bool) -> None:
    """Print the largest and the smallest value of each curve, with their frequencies; over the angle those of each frequency."""
    import numpy as np

    from coaxshell.response.frequency.curves import curves_of
    from coaxshell.response.summary_text import aligned

    for name, answer in found.items():
        unit, hertz, angles = answer.attrs["units"], answer["frequency"].to_numpy(), answer.sizes.get("angle", 1)
        over = "angle" if angles > 1 and (polar or angles > max(_SHOWN, hertz.size)) else "frequency"
        at, where = answer[over].to_numpy(), f"at ({'Hz' if over == 'frequency' else 'deg'})"
        shown = "" if unit == "1" else f" ({unit})"
        echo(f"{answer.attrs['long_name']}{shown} of {name}, {hertz.size} frequencies, orders up to {answer.attrs['modes']}\n")
        rows = [["", "largest", where, "smallest", where]]
        for curve in curves_of(answer, over):
            values = np.abs(curve.values) if np.iscomplexobj(curve.values) else np.asarray(curve.values)
            if not np.any(np.isfinite(values)):
                rows.append([curve.label, "no fluid there", "", "", ""])
                continue
            top, low = int(np.nanargmax(values)), int(np.nanargmin(values))
            rows.append([curve.label, f"{values[top]:.4g}", f"{at[top]:.4g}", f"{values[low]:.4g}", f"{at[low]:.4g}"])
        for line in aligned(rows[: _SHOWN + 1]):
            echo(line)
        if len(rows) > _SHOWN + 1:
            echo(f"... and {len(rows) - 1 - _SHOWN} more curves; --json and a .csv hold all of them")


def _frequencies(text: str) -> list[Any]:
    """Return the frequencies of "100,1 kHz", "10:5000:500", or both mixed."""
    found: list[Any] = []
    for item in text.split(","):
        found += _spread("--frequency", item, "frequency") if ":" in item else [_number_or_text(item.strip())]
    return found


def _numbers(option: str, text: str | None) -> list[float] | float | None:
    """Return the numbers of "0,90", "0:360:361", or both mixed; one alone as such."""
    if text is None:
        return None
    found: list[float] = []
    for item in text.split(","):
        found += _spread(option, item, None) if ":" in item else [options.number(option, item)]
    return found if len(found) > 1 else found[0]


def _spread(option: str, item: str, dimension: str | None) -> list[float]:
    """Return so many values from here to there, "from:to:count"."""
    from coaxshell.model.units import to_si

    remedy = "write from:to:how many, as in 10:5000:500"
    parts = item.split(":")
    if len(parts) != 3 or not parts[2].strip().isdecimal():
        raise InputError(option, f"{item.strip()!r} is not a range", remedy)
    count = int(parts[2])
    if not 2 <= count <= _MOST:
        raise InputError(option, f"{item.strip()!r} asks for {count}", f"2 to {_MOST} are allowed")
    ends = []
    for part in parts[:2]:
        value = _number_or_text(part.strip())
        try:
            ends.append(to_si(value, dimension) if dimension else float(value))
        except (InputError, ValueError):
            raise InputError(option, f"{item.strip()!r} is not a range", remedy) from None
    return [ends[0] + (ends[1] - ends[0]) * i / (count - 1) for i in range(count)]


def _number_or_text(text: str | None) -> Any:
    if text is None:
        return None
    try:
        return float(text)
    except ValueError:
        return text


def _force(text: str | None) -> tuple[Any, float] | None:
    if text is None:
        return None
    shell, comma, angle = text.rpartition(",")
    if not comma:
        raise InputError("--line-force", f"{text!r} is not a shell and an angle", "write them as in outer,0")
    return shell.strip(), options.number("--line-force", angle)
