"""What control and absorbers have to do: voltages against limits, strokes and forces."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from coaxshell.apps.report.answers import ENDS, _columns
from coaxshell.apps.report.parts import Item, Section, Subject, Table, drawn, lower
from coaxshell.model.prefixes import engineering
from coaxshell.response import Response

_MOST_ABSORBERS = 8
"""Absorbers that the table holds: those that move most."""


def control(subject: Subject, summaries: Mapping[str, Any]) -> Section | None:
    """Return the section on what the actuators are asked for, None without control."""
    from coaxshell.plotting import figure_curves

    led = {name: response for name, response in subject.labelled.items() if response.system.control is not None}
    if not led:
        return None
    rows = [row for name, response in led.items() for row in _voltages(name, response, summaries[name or subject.name].to_dict())]
    caption = "Voltage on the actuators at head (0°) and tail (180°), at points of the wall."
    said = "; ".join(f"{row[0]}: largest mean {row[1]}, limit {row[3]}" for row in rows)
    runs = Subject(led, subject.shells)
    figure = figure_curves(led, "actuator_voltage", [i for i in runs.of(runs.run) if i in runs.run.system.controlled_shells], ENDS)
    lower(figure, 0.75 + 1.6 * len(figure.axes))
    head = ("shell", "largest asked for", "at", "limit", "share of the limit", "mean over")
    table = Table("Control effort: means over a segment of the wall, which converge with the orders", head, rows)
    picture = drawn(figure, "actuator-voltage", f"{caption} {said}.", caption, _voltage_columns(runs))
    return Section("Control effort", [picture, table])


def _voltage_columns(subject: Subject) -> Any:
    controlled = set(subject.run.system.controlled_shells)
    return _columns(Subject(subject.runs, [shell for shell in subject.shells if shell in controlled]), "actuator_voltage")


def _voltages(name: str, response: Response, summary: Mapping[str, Any]) -> Iterator[tuple[str, ...]]:
    for shell in summary["largest"] if "largest" in summary else summary["shells"]:
        voltage = shell.get("actuator_voltage")
        if voltage is None:
            continue
        of_run = next(one for one in _all_shells(summary) if one["name"] == shell["name"])
        limit, segment = of_run["actuator_limit"], of_run["segment"]
        label = " ".join(filter(None, [name, shell["name"]]))
        place = f"{voltage['angle']:.4g}°, t = {voltage['time']:.4g}"
        share = f"{100.0 * voltage['value'] / limit:.3g} %" if limit else ""
        over = engineering(segment, "m") if segment else "points"
        yield label, engineering(voltage["value"], "V"), place, engineering(limit, "V") if limit else "none", share, over


def _all_shells(summary: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    return list(summary["stations"][0]["shells"] if "stations" in summary else summary["shells"])


def absorbers(subject: Subject) -> Section | None:
    """Return the section on the absorbers of the run: how far they move and what they exert; None without any."""
    response = subject.run
    system = response.system
    if not (system.absorber_list or system.point_absorbers):
        return None
    return Section("Absorbers", _of_lines(response) if response.stations is None else _of_space(response))


def _of_lines(response: Response) -> list[Item]:
    from coaxshell.plotting.strokes import figure_strokes

    strokes = response.absorber_stroke()
    read = (response.absorber_force(), response.absorber_displacement(), strokes)
    forces, moved, largest = (np.nan_to_num(np.abs(found.to_numpy()).max(axis=-1)) for found in read)  # of no link there is none
    order = np.argsort(-largest.max(axis=1), kind="stable")
    angles = np.asarray(strokes["angle"])
    rows = [
        (
            *(f"{angles[n]:g}°", f"{response.system.absorber_list[n].mass:.4g} kg/m", engineering(moved[n], "m")),
            *(engineering(largest[n, 0], "m"), engineering(largest[n, 1], "m"), engineering(forces[n].max(), "N/m")),
        )
        for n in order[:_MOST_ABSORBERS]
    ]
    caption = "Largest strokes (motion of the mass relative to a shell) around the shells, and the history of the largest."
    said = f"{caption} Largest: {engineering(float(largest.max()), 'm')} at {angles[order[0]]:g}°."
    data = {"time (a/c_e)": strokes["time"].to_numpy()} | {
        f"absorber at {angles[n]:g} deg against the {side} shell (m)": strokes.to_numpy()[n, j]
        for n in order[:_MOST_ABSORBERS]
        for j, side in enumerate(("inner", "outer"))
    }
    most = f"the {_MOST_ABSORBERS} that move most of {len(order)}" if len(order) > _MOST_ABSORBERS else "all of them"
    head = ("angle", "mass", "largest motion", "stroke, inner shell", "stroke, outer shell", "force on a shell")
    return [drawn(figure_strokes(strokes), "strokes", said, caption, data), Table(f"Absorbers, {most}", head, rows)]


def _of_space(response: Response) -> list[Item]:
    moved, force = response.absorber_displacement(), response.absorber_force()
    rows = []
    for n in range(moved.sizes["absorber"]):
        at = f"{float(moved['angle'][n]):g}°" + (f", z = {float(moved['z'][n]):g} m" if "z" in moved.coords else "")
        largest = [engineering(float(np.abs(one.isel(absorber=n)).max()), one.attrs["units"]) for one in (moved, force)]
        rows.append((at, *largest))
    rows = rows[:_MOST_ABSORBERS]
    return [Table("Absorbers", ("place", "largest motion", "force on a shell"), rows)]
