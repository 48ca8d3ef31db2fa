"""``coaxshell control``: how far the feedback of a system is from making it unstable."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from coaxshell.apps.cli import options
from coaxshell.apps.cli.output import Outputs, echo, print_document, write_figure

if TYPE_CHECKING:
    from coaxshell.numerics.late import xarray as xr


def control(
    scenario: Annotated[str, typer.Argument(metavar="SCENARIO", help="A .toml file, a preset, or - for standard input.")],
    changes: options.SetOption = None,
    duration: options.DurationOption = options.DURATION,
    modes: options.ModesOption = options.MODES,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", metavar="FILE", help="Where to draw Bode and Nyquist plots; .png, .pdf or .svg.")
    ] = None,
    as_json: options.JsonOption = False,
    force: options.ForceOption = False,
) -> None:
    """Tell how much delay and gain the feedback stands.

    By shell, the loops of the others closed, the least of all orders and where it is. A system whose loop is unstable is refused with the
    orders that grow.
    """
    from coaxshell.apps.cli.running import load_system
    from coaxshell.plotting import FIGURE_SUFFIXES
    from coaxshell.plotting.margins import figure_margins
    from coaxshell.response.margins import worst_loops
    from coaxshell.solver.settings import Settings

    target = None if output is None else Outputs(force).file(output, "--output", FIGURE_SUFFIXES)
    system = load_system(scenario, changes or ())
    with options.named_as_options(duration="duration", modes="modes"):
        settings = Settings.asked(system, {"duration": duration, "modes": modes})
        margins, worst = worst_loops(system, settings)
    rows = _rows(margins)
    if as_json:
        print_document({"system": system.name, "margins": rows})
    else:
        _print(system.name, rows)
    if target is not None:
        write_figure(figure_margins(margins, worst), target, "--output")
        echo(f"wrote {target}", aside=as_json)


_KINDS = (("gain_margin", "min"), ("lesser_gain_margin", "max"), ("phase_margin", "min"), ("delay_margin", "min"))


def _rows(margins: xr.Dataset) -> list[dict[str, Any]]:
    """Return the worst of all orders of each margin and shell; None where no order has one."""
    import numpy as np

    rows = []
    for place, name in enumerate(margins["shell"].values):
        for kind, which in _KINDS:
            values = margins[kind].values[place]
            order = int(values.argmin() if which == "min" else values.argmax())
            none = not np.isfinite(values[order]) or values[order] == 0.0
            frequency = f"{kind}_frequency"
            hertz = None if none or frequency not in margins else float(margins[frequency].values[place, order])
            value = None if none else float(values[order])
            unit = margins[kind].attrs["units"]
            rows.append(
                {"shell": str(name), "margin": kind, "value": value, "unit": unit, "order": None if none else order, "frequency": hertz}
            )
    return rows


def _print(name: str, rows: list[dict[str, Any]]) -> None:
    from coaxshell.model.prefixes import engineering
    from coaxshell.response.summary_text import aligned

    echo(f"What the feedback of {name} stands\n")
    table = [["shell", "margin", "least", "order", "at"]]
    for row in rows:
        if row["margin"] == "lesser_gain_margin" and row["value"] is None:
            continue
        value, hertz = row["value"], row["frequency"]
        kind = "less gain" if row["margin"] == "lesser_gain_margin" else row["margin"].removesuffix("_margin")
        if value is None:
            table.append([row["shell"], kind, "10 times or more" if kind == "gain" else "any", "", ""])  # loops are followed so far
            continue
        shown = {"s": engineering(value, "s"), "deg": f"{value:.3g} deg"}.get(row["unit"], f"{value:.3g} times")
        table.append([row["shell"], kind, shown, str(row["order"]), "" if hertz is None else engineering(hertz, "Hz")])
    for line in aligned(table):
        echo(line.rstrip())
