"""``coaxshell control``: how far the feedback of a system is from making it unstable."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from coaxshell.apps.cli import options
from coaxshell.apps.cli.output import Outputs, echo, print_document, write_figure
from coaxshell.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from coaxshell.model.system import System
    from coaxshell.numerics.late import xarray as xr


def control(
    scenario: Annotated[str, typer.Argument(metavar="SCENARIO", help="A .toml file, a preset, or - for standard input.")],
    changes: options.SetOption = None,
    duration: options.DurationOption = options.DURATION,
    modes: options.ModesOption = options.MODES,
    dimensions: options.DimensionsOption = "2",
    output: Annotated[
        Path | None, typer.Option("--output", "-o", metavar="FILE", help="Where to draw Bode and Nyquist plots; .png, .pdf or .svg.")
    ] = None,
    design: Annotated[bool, typer.Option("--design", help="Find the best law instead, and judge it.")] = False,
    delay: Annotated[str | None, typer.Option("--delay", metavar="TIME", help='With --design: of the loop, as in "5 us".')] = None,
    bandwidth: Annotated[
        str | None, typer.Option("--bandwidth", metavar="FREQUENCY", help='With --design: corner of the amplifier, as in "50 kHz".')
    ] = None,
    voltage: Annotated[
        float | None,
        typer.Option("--voltage", metavar="VOLTAGE", help="With --design: largest one.", show_default="what actuators stand"),
    ] = None,
    kind: Annotated[
        list[str] | None, typer.Option("--kind", metavar="NAME", help="With --design: rate, pd, lead-lag, resonant, positive-position.")
    ] = None,
    save: Annotated[
        Path | None, typer.Option("--save", metavar="FILE", help="With --design: the system under the law, as .toml.", show_default=False)
    ] = None,
    as_json: options.JsonOption = False,
    force: options.ForceOption = False,
) -> None:
    """Tell what margins the feedback has, or design it.

    By shell, the loops of the others closed, the least of all orders and where it is; in three dimensions of axial wavenumbers too. A
    system whose loop is unstable is refused with the orders that grow. With --design the system's own law is left out and the best for a
    delay and an amplifier is found: what it stands, what it takes off the stress and what it costs; 3 transits and 24 orders unless given.
    """
    if not design:
        _only_with_design({"--delay": delay, "--bandwidth": bandwidth, "--voltage": voltage, "--kind": kind, "--save": save})
    from coaxshell.apps.cli.running import load_system
    from coaxshell.plotting import FIGURE_SUFFIXES
    from coaxshell.plotting.margins import figure_margins
    from coaxshell.response.margins import worst_loops
    from coaxshell.solver.settings import Settings

    target = None if output is None else Outputs(force).file(output, "--output", FIGURE_SUFFIXES)
    kept = None if save is None else Outputs(force).file(save, "--save", (".toml",))
    system = load_system(scenario, changes or ())
    if design:
        if dimensions != "2":
            raise InputError("--dimensions", f"{dimensions} is not known to the design of laws", "leave it out: laws are designed in two")
        asked = {"delay": delay or 0.0, "bandwidth": bandwidth, "voltage": voltage, "kinds": kind or None}
        resolution = {
            name: x for name, x, usual in (("duration", duration, options.DURATION), ("modes", modes, options.MODES)) if x != usual
        }
        with options.named_as_options(delay="delay", bandwidth="bandwidth", voltage="voltage", kinds="kind"):
            _designed(system, {**asked, **resolution}, (target, kept), as_json)
        return
    with options.named_as_options(duration="duration", modes="modes", dimensions="dimensions"):
        settings = Settings.asked(system, {"duration": duration, "modes": modes, "dimensions": dimensions})
        margins, worst = worst_loops(system, settings)
    rows = _rows(margins)
    if as_json:
        print_document({"system": system.name, "margins": rows})
    else:
        _print(system.name, rows, margins.attrs)
    if target is not None:
        write_figure(figure_margins(margins, worst), target, "--output")
        echo(f"wrote {target}", aside=as_json)


def _only_with_design(given: dict[str, Any]) -> None:
    """Refuse options that belong to a design where none is asked for."""
    for name, value in given.items():
        if value:
            raise InputError(name, "belongs to --design", "add --design, or leave it out")


def _designed(system: System, asked: dict[str, Any], targets: tuple[Path | None, Path | None], as_json: bool) -> None:
    """Find the best law, print what it is and does, draw its loops and write the system under it."""
    from coaxshell.plotting.margins import figure_margins
    from coaxshell.response.margins import worst_loops
    from coaxshell.studies import design_control

    found, (figure, described) = design_control(system, **asked), targets
    if figure is not None:
        write_figure(figure_margins(*worst_loops(found.system, found.settings)), figure, "--output")
    if described is not None:
        found.system.to_toml(described)
    if as_json:
        print_document({"system": system.name, **found.to_dict()})
    else:
        echo(f"The best law for {system.name}\n\n{found}")
    for target in targets:
        if target is not None:
            echo(f"wrote {target}", aside=as_json)


_KINDS = (("gain_margin", "min"), ("lesser_gain_margin", "max"), ("phase_margin", "min"), ("delay_margin", "min"))


def _rows(margins: xr.Dataset) -> list[dict[str, Any]]:
    """Return the worst of all orders, and axial wavenumbers, of each margin and shell; None where no order has one."""
    import numpy as np

    rows = []
    for place, name in enumerate(margins["shell"].values):
        for kind, which in _KINDS:
            values = margins[kind].values[place]
            where = np.unravel_index(int(np.nanargmin(values) if which == "min" else np.nanargmax(values)), values.shape)
            none = not np.isfinite(values[where]) or values[where] == 0.0
            frequency = f"{kind}_frequency"
            hertz = None if none or frequency not in margins else float(margins[frequency].values[place][where])
            value, unit = None if none else float(values[where]), margins[kind].attrs["units"]
            order = None if none else int(where[-1])
            row = {"shell": str(name), "margin": kind, "value": value, "unit": unit, "order": order, "frequency": hertz}
            if "wavenumber" in margins.coords:
                row["wavenumber"] = None if none else float(margins["wavenumber"].values[where[0]])
            rows.append(row)
    return rows


def _print(name: str, rows: list[dict[str, Any]], told: Mapping[Any, Any]) -> None:
    from coaxshell.model.prefixes import engineering
    from coaxshell.response.summary_text import aligned

    echo(f"What the feedback of {name} stands\n")
    along = any("wavenumber" in row for row in rows)
    table = [["shell", "margin", "least", "order", "at", *(["k"] if along else [])]]
    for row in rows:
        if row["margin"] == "lesser_gain_margin" and row["value"] is None:
            continue
        value, hertz = row["value"], row["frequency"]
        kind = "less gain" if row["margin"] == "lesser_gain_margin" else row["margin"].removesuffix("_margin")
        if value is None:
            least = "10 times or more" if kind == "gain" else "any"  # loops are followed so far
            table.append([row["shell"], kind, least, *[""] * (len(table[0]) - 3)])
            continue
        shown = {"s": engineering(value, "s"), "deg": f"{value:.3g} deg"}.get(row["unit"], f"{value:.3g} times")
        at = "" if hertz is None else engineering(hertz, "Hz")
        table.append([row["shell"], kind, shown, str(row["order"]), at, *([f"{row['wavenumber']:.3g}/m"] if along else [])])
    for line in aligned(table):
        echo(line.rstrip())
    if "segments" in told:
        echo(f"\nOrders with those that {told['segments']} segments tie to them; all segments of a shell change together.")
    if "segment_pitch" in told:
        echo(f"\nWavenumbers k with those that electrodes {told['segment_pitch']:g} m apart along the axis tie to them.")
