"""What the shells do: in brief, histories, where the stress is largest, shock spectra."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from coaxshell.apps.report.parts import Columns, Item, Listed, Section, Subject, Table, drawn, lower
from coaxshell.errors import InputError
from coaxshell.model.places import shell_name, shell_phrase
from coaxshell.model.prefixes import against, engineering
from coaxshell.response.components import component_words
from coaxshell.response.quantities import summary_rows
from coaxshell.response.run_comparison import comparison_rows
from coaxshell.response.summary_text import depth_phrase, when

if TYPE_CHECKING:
    from coaxshell.plotting.wall_stress import MappedWall
    from coaxshell.response import Response
    from coaxshell.response.wall_stress import WallPeak

ENDS = (0.0, 180.0)
_HISTORIES = ("stress", "relative_displacement")
_NOUNS = {"stress": "hoop stress of the core", "relative_displacement": "normal displacement relative to the section's translation"}


def in_brief(subject: Subject, summaries: Mapping[str, Any]) -> Section:
    """Return the section of what came out: findings in sentences, and the table of largest magnitudes."""
    first, *others = summaries.values()
    items: list[Item] = [Listed(list(_findings(subject, summaries)))]
    if others:
        names = list(subject.runs)
        head = ("shell", "largest magnitude", *names, "the first is")
        items.append(Table("Largest magnitudes of both runs", head, comparison_rows(first, others[0]), 2))
    else:
        items.append(_peaks(subject.run, first.to_dict()))
    return Section("In brief", items)


def _findings(subject: Subject, summaries: Mapping[str, Any]) -> Iterator[str]:
    """Yield sentences: the core's hoop stress and the largest stress of each shell, the control's effort, errors, warnings."""
    others = list(subject.runs)[1:]
    for shell in subject.shells:
        name = shell_name(shell, subject.run.shells)
        phrase = shell_phrase(shell, subject.run.shells)
        cores = [found for summary in summaries.values() if (found := _of_shell(summary.to_dict(), name)) is not None]
        text = f"{phrase[:1].upper()}{phrase[1:]}: hoop stress of the core up to {engineering(cores[0]['stress']['value'], 'Pa')}"
        if len(cores) > 1:
            text += f", {_against(cores[0]['stress']['value'], cores[1]['stress']['value'], others[0])}"
        peaks = [_peak(response, shell) for response in subject.runs.values()]
        peak = peaks[0]
        if peak is None:
            yield text + "."
            continue
        place = f"{peak.angle:.4g}°" + (f", z = {peak.station:g} m" if peak.station is not None else "")
        text += f"; largest {component_words(peak.component)} stress anywhere in the wall {engineering(peak.value, 'Pa')}"
        text += f" (its layer of {peak.material}, {depth_phrase(peak.depth)}, at {place}, t = {when(vars(peak))} transits)"
        if len(peaks) > 1 and peaks[1] is not None:
            text += f", {_against(peak.value, peaks[1].value, others[0])}"
        if peak.margin is not None:
            text += f"; the weakest layer stands {peak.margin:.3g} times its largest stress"
        yield text + "."
    yield from _effort(next(iter(summaries.values())).to_dict())
    combined = subject.run.errors().sel(quantity="stress", cause="combined").to_numpy()
    known = combined[np.isfinite(combined)]
    if known.size:
        yield f"Estimated relative error of the stress (RMS over surface and time): {known.max():.1e} at most."
    count = len(subject.run.warnings)
    yield f"{count} {'warning' if count == 1 else 'warnings'}: see the section on warnings." if count else "No warnings."


def _of_shell(summary: Mapping[str, Any], name: str) -> Mapping[str, Any] | None:
    shells = summary["largest"] if "largest" in summary else summary["shells"]
    return next((shell for shell in shells if shell["name"] == name), None)


def _against(value: float, reference: float, name: str) -> str:
    words = against(value, reference)
    return f"{words} {'as' if 'times' in words or 'the same' in words else 'than'} in {name}"


def _effort(summary: Mapping[str, Any]) -> Iterator[str]:
    """Yield how the largest voltage asked for stands to what the actuators stand."""
    shells = summary["stations"][0]["shells"] if "stations" in summary else summary["shells"]
    limits = {shell["name"]: shell["actuator_limit"] for shell in shells}
    asked = [
        (shell["actuator_voltage"]["value"] / limits[shell["name"]], shell)
        for shell in summary.get("largest", shells)
        if shell.get("actuator_voltage") and limits.get(shell["name"])
    ]
    if asked:
        share, shell = max(asked, key=lambda one: one[0])
        voltage, limit = engineering(shell["actuator_voltage"]["value"], "V"), engineering(limits[shell["name"]], "V")
        yield f"Control asks for {voltage} at most ({shell['name']}), {100.0 * share:.3g} % of the {limit} that the actuator stands."


def _peak(response: Response, shell: int) -> WallPeak | None:
    """Return the largest stress of a wall, None where a run has no such wall, or does not tell it."""
    from coaxshell.response.wall_stress import usual_component

    if shell not in response.system.shell_indices(None):
        return None
    try:
        return response.peak_stress(shell, usual_component(response.solution, shell))
    except InputError:
        return None


def _peaks(response: Response, summary: Mapping[str, Any]) -> Table:
    spatial = "largest" in summary
    rows = []
    for shell in summary["largest"] if spatial else summary["shells"]:
        for key, label, unit in summary_rows(3):
            value = shell.get(key)
            if not isinstance(value, Mapping):
                continue
            place = (when(value), f"{value['angle']:.4g}°") if "time" in value else ("", "")
            rows.append((shell["name"], label, engineering(value["value"], unit), *place, *([f"{value['station']:g}"] if spatial else [])))
    head = ("shell", "largest magnitude", "value", "t (a/c)", "angle", *(["z (m)"] if spatial else []))
    return Table("Largest magnitudes", head, rows, 2)


def histories(subject: Subject) -> Section:
    """Return the section of histories at head and tail."""
    from coaxshell.plotting import figure_curves

    items: list[Item] = []
    for quantity in _HISTORIES:
        noun = _NOUNS[quantity]
        told = _told(subject, quantity)
        caption = f"{noun[:1].upper()}{noun[1:]} at head (0°) and tail (180°); circles mark the largest magnitudes."
        figure = figure_curves(subject.labelled, quantity, list(subject.shells), ENDS)
        lower(figure, 0.75 + _panel_height(subject) * len(figure.axes))
        items.append(drawn(figure, quantity.replace("_", "-"), f"{caption} {told}", caption, _columns(subject, quantity)))
    return Section("Histories", items)


def _panel_height(subject: Subject) -> float:
    """Return the height of a panel of curves, inches, so that two figures of all shells fit on a page."""
    return 1.75 if len(subject.shells) <= 2 else 1.3


def _told(subject: Subject, quantity: str) -> str:
    """Return what curves show for who cannot see them: the largest magnitude of each shell and run."""
    from coaxshell.response.quantities import QUANTITIES

    texts = []
    for name, response in subject.runs.items():
        for shell in subject.of(response):
            values = np.abs(response.history(shell, ENDS, quantity)).max()
            where = shell_phrase(shell, response.shells)
            texts.append(f"{name}, {where}: up to {engineering(float(values), QUANTITIES[quantity].unit)}")
    return "; ".join(texts) + "."


def _columns(subject: Subject, quantity: str) -> Columns:
    """Return the histories as columns, those of runs with other instants brought to the first run's."""
    time = np.asarray(subject.run.time)
    table: dict[str, Any] = {"time (a/c_e)": time, "time (s)": np.asarray(subject.run.time_seconds)}
    for name, response in subject.labelled.items():
        for shell in subject.of(response):
            found = response.history(shell, ENDS, quantity)
            for angle in ENDS:
                for place, values in _stations(found.sel(angle=angle)):
                    words = " ".join(filter(None, [name, shell_name(shell, response.shells), quantity, f"{angle:g} deg", place]))
                    table[f"{words} ({found.attrs['units']})"] = np.interp(time, np.asarray(response.time), values)
    return table


def _stations(found: Any) -> list[tuple[str, np.ndarray]]:
    if "station" not in found.dims:
        return [("", found.to_numpy())]
    return [(f"z = {float(z):g} m", found.sel(station=z).to_numpy()) for z in found["station"]]


def largest_stress(subject: Subject) -> Section:
    """Return the section on where the stress is largest: maps over angle and depth, and the largest of each layer."""
    from coaxshell.plotting.wall_stress import draw_walls, mapped_walls

    readable = [shell for shell in subject.shells if _peak(subject.run, shell) is not None]
    if not readable:
        subject.run.peak_stress(subject.shells[0])  # which says why it is not told
    subject = Subject(subject.runs, readable)
    told = _rows_of_layers(subject)
    caption = "Largest von Mises stress over time by angle and depth; the star is the largest of all. Layers are told apart by lines."
    worst = max(told, key=lambda row: row[-1], default=None)
    said = f"{caption} Largest: {worst[0][0]}, {worst[0][3]} in {worst[0][1]} at {worst[0][5]}." if worst else caption
    walls = mapped_walls(subject.labelled, list(subject.shells), "von_mises")
    maps = drawn(draw_walls(walls), "largest-stress", said, caption, _over_depths(walls))
    head = ("shell", "layer", "strength", "largest stress", "t (a/c)", "angle", "strength over stress")
    table = Table("Largest von Mises stress of each layer", head, [row for row, _ in told], 2)
    return Section("Where the stress is largest", [maps, table])


def _over_depths(walls: Mapping[str, Sequence[MappedWall]]) -> Columns:
    """Return the maps of walls as columns over the angles of the first, one a depth of each layer."""
    table: dict[str, Any] = {}
    for name, of_run in walls.items():
        for wall in of_run:
            label = " ".join(filter(None, [name, shell_name(wall.shell, wall.response.shells)]))
            for number, ((angles, depths, values), material) in enumerate(zip(wall.maps, wall.layers, strict=False)):
                around = table.setdefault("angle (deg)", angles)
                for depth, row in zip(depths, values, strict=True):
                    column = f"{label} layer {number} ({material}) {1e3 * depth:.4g} mm outside the middle (Pa)"
                    table[column] = np.interp(around, angles, row)
    return table


def _rows_of_layers(subject: Subject) -> list[tuple[tuple[str, ...], float]]:
    rows: list[tuple[tuple[str, ...], float]] = []
    for name, response in subject.labelled.items():
        for shell in subject.of(response):
            described: Any = response.system.shells[shell]
            label = " ".join(filter(None, [name, shell_name(shell, response.shells)]))
            for peak in response.layer_peaks(shell):
                strength = described.layers[peak.layer].material.strength
                row = (
                    *(label, peak.material, engineering(strength, "Pa") if strength else "not given", engineering(peak.value, "Pa")),
                    *(when(vars(peak)), f"{peak.angle:.4g}°", f"{strength / peak.value:.3g}" if strength and peak.value else ""),
                )
                rows.append((row, peak.value))
    return rows


def spectra(subject: Subject) -> Section:
    """Return the section of shock spectra: what equipment on the shells feels."""
    from coaxshell.plotting import figure_shock_spectra

    table: dict[str, Any] = {}
    texts = []
    for name, response in subject.labelled.items():
        for shell in subject.of(response):
            hertz = table.get("natural frequency (Hz)")
            found = response.shock_spectrum(shell, ENDS, hertz)
            table["natural frequency (Hz)"] = found["frequency"].to_numpy()
            label = " ".join(filter(None, [name, shell_name(shell, response.shells)]))
            texts.append(f"{label}: up to {engineering(float(found.max()), 'm/s')}")
            for angle in ENDS:
                for place, column in _stations(found.sel(angle=angle)):
                    table[" ".join(filter(None, [label, f"{angle:g} deg", place, "pseudo-velocity (m/s)"]))] = column
    caption = "Pseudo-velocity of light oscillators on the shells by their natural frequency, Q = 10; grey: largest all around."
    figure = figure_shock_spectra(subject.labelled, list(subject.shells))
    return Section(
        "Shock spectra: what equipment feels", [drawn(figure, "shock-spectra", f"{caption} {'; '.join(texts)}.", caption, table)]
    )
