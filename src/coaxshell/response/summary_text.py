"""The summary as an aligned table of text."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from html import escape
from typing import Any

from coaxshell.model.prefixes import engineering
from coaxshell.response.components import component_words
from coaxshell.response.quantities import summary_rows

_HEADING = ("shell", "largest magnitude", "value", "t [a/c_e]", "angle [deg]")
GROWING = "still growing"
"""Said of a largest value beyond which the quantity goes on when the window ends."""


def aligned(rows: Sequence[Sequence[str]], left: int = 1) -> list[str]:
    """Return rows of cells as lines with columns of equal width, the first *left* ones to the left and the others to the right."""
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]

    def line(row: Sequence[str]) -> str:
        cells = (cell.ljust(w) if i < left else cell.rjust(w) for i, (cell, w) in enumerate(zip(row, widths, strict=True)))
        return "  ".join(cells).rstrip()

    return [line(row) for row in rows]


def summary_text(summary: Mapping[str, Any]) -> str:
    """Return the table of a summary in its plain-dict form."""
    rows = [row for shell in summary["shells"] for row in _shell_rows(shell)]
    warnings = (f"warning: {text}" for text in summary["warnings"])
    return "\n".join([*title_lines(summary), "", *aligned([_HEADING, *rows], left=2), "", *notes(summary), *warnings])


def summary_html(summary: Mapping[str, Any]) -> str:
    """Return the same as an HTML table for a notebook."""
    title, run = (escape(line) for line in title_lines(summary))
    rows = [row for shell in summary["shells"] for row in _shell_rows(shell)]
    left, right = (f'style="text-align:{side}; padding:0 0.8em 0 0; font-variant-numeric:tabular-nums"' for side in ("left", "right"))

    def cells(row: Sequence[str], tag: str) -> str:
        return "".join(f"<{tag} {left if number < 2 else right}>{escape(cell)}</{tag}>" for number, cell in enumerate(row))

    body = "".join(f"<tr>{cells(row, 'td')}</tr>" for row in rows)
    below = f"<pre>{escape(chr(10).join(notes(summary)))}</pre>"
    below += "".join(f"<div>warning: {escape(text)}</div>" for text in summary["warnings"])
    head = f"<thead><tr>{cells(_HEADING, 'th')}</tr></thead>"
    table = f'<table style="border-collapse:collapse; margin:0.5em 0">{head}<tbody>{body}</tbody></table>'
    return f"<div><b>{title}</b><br>{run}</div>{table}{below}"


def title_lines(summary: Mapping[str, Any]) -> tuple[str, str]:
    """Return the title, and the line that says what was run."""
    settings = summary["settings"]
    start, end = summary["window"]
    return (
        summary["title"] or "unnamed system",
        f"{settings['engine']} engine, {settings['modes']} modes, time step {settings['time_step']:g}, "
        f"t = {start:g} to {end:g} transits ({engineering(start * summary['transit_time'], 's')} to "
        f"{engineering(end * summary['transit_time'], 's')})",
    )


def notes(summary: Mapping[str, Any]) -> list[str]:
    """Return the lines below the table: absorbers, where walls are stressed most, what the voltages are, estimated errors."""
    return [*_absorbers(summary), *_walls(summary), *_voltages(summary), *_errors(summary)]


def when(peak: Mapping[str, Any]) -> str:
    """Return the time of a peak, and whether it still grows there."""
    return f"{peak['time']:.4g}" + (f", {GROWING}" if peak["growing"] else "")


def depth_phrase(depth: float) -> str:
    """Return in words how far (m) a place is outward from the middle of its wall: z would be taken for the axis in three dimensions."""
    if abs(depth) < 1e-12:
        return "at the middle of the wall"
    return f"{engineering(abs(depth), 'm')} {'outside' if depth > 0 else 'inside'} its middle"


def _absorbers(summary: Mapping[str, Any]) -> list[str]:
    found = (
        ("absorber_displacement", "largest absorber displacement", "m"),
        ("absorber_force", "largest absorber force", "N/m"),
    )
    return [f"{label}: {engineering(summary[key], unit)}" for key, label, unit in found if summary[key] is not None]


def _walls(summary: Mapping[str, Any]) -> list[str]:
    """Return a line for each shell: in which layer and at which depth its largest stress is, and what is left to the strength."""
    found = []
    for shell in summary["shells"]:
        peak = shell.get("wall_stress")
        if peak is None:
            continue
        where = f"{component_words(peak['component'])}, in layer {peak['layer']} ({peak['material']}), {depth_phrase(peak['depth'])}"
        margin = "" if peak["margin"] is None else f"; strength of layer {peak['weakest']} over its stress: {peak['margin']:.3g}"
        found.append(f"stress in the wall, {shell['name']}: {where}{margin}")
    return found


def _voltages(summary: Mapping[str, Any]) -> list[str]:
    """Return the line that says over what the voltages are means, and how far half the orders are from them."""
    sensed = [shell for shell in summary["shells"] if shell["segment"] is not None]
    if not sensed:
        return []
    lengths = [engineering(shell["segment"], "m") for shell in sensed]
    each = [f"{shell['name']} {length}" for shell, length in zip(sensed, lengths, strict=True)]
    over = lengths[0] if len(set(lengths)) == 1 else ", ".join(each)
    what = f"means over {over} of the wall" if sensed[0]["segment"] else "at points, where they grow with the orders"
    changes = (f"{shell['name']} {_change(shell['actuator_voltage'] or shell['sensor_voltage']):.1e}" for shell in sensed)
    return [f"voltages: {what}; half the orders change them by {', '.join(changes)}"]


def _change(peak: Mapping[str, Any]) -> float:
    return abs(peak["lower_half"] / peak["value"] - 1.0) if peak["value"] else 0.0


def _shell_rows(shell: Mapping[str, Any]) -> list[tuple[str, ...]]:
    rows: list[tuple[str, ...]] = []
    for key, label, unit in summary_rows(3):
        value = shell.get(key)  # two dimensions lack some
        if isinstance(value, Mapping):
            rows.append((shell["name"], label, engineering(value["value"], unit), when(value), f"{value['angle']:.4g}"))
        elif value is not None:
            rows.append((shell["name"], label, engineering(value, unit), "", ""))
    return rows


def _errors(summary: Mapping[str, Any]) -> list[str]:
    """Return the table of the estimated errors, one line a shell and quantity."""
    rows: list[tuple[str, ...]] = []
    for shell in summary["shells"]:
        for quantity, causes in shell["errors"].items():
            if not rows:
                rows.append(("estimated relative errors", "", *causes))
            rows.append((shell["name"], quantity, *("unknown" if one is None else f"{one:.1e}" for one in causes.values())))
    return aligned(rows, left=2) if rows else []
