"""Draw the house from its own imports: floors with their rooms, an arc for each floor that imports from another."""

from __future__ import annotations

import ast
from collections import Counter
from pathlib import Path
from typing import NamedTuple

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Arc, Rectangle

FLOORS = (
    *("numerics", "model", "structure", "acoustics", "solver", "response", "studies", "plotting", "export"),
    *("apps.verification", "apps.paper", "apps.report", "apps.studio", "apps.cli"),
)
"""Lowest first; each imports from those below it."""


class House(NamedTuple):
    """What is drawn.

    Attributes
    ----------
    lines : Counter
        Lines of source by floor.
    rooms : dict
        Rooms (folders) inside each floor, in alphabetical order.
    imports : Counter
        Import statements by (floor that imports, floor imported).
    """

    lines: Counter[str]
    rooms: dict[str, list[str]]
    imports: Counter[tuple[str, str]]


def read(package: Path) -> House:
    """Return the house that the source files of a package make."""
    lines: Counter[str] = Counter()
    imports: Counter[tuple[str, str]] = Counter()
    for path in package.rglob("*.py"):
        place = ".".join(path.relative_to(package).with_suffix("").parts)
        here = _floor(place)
        if here is None:
            continue
        text = path.read_text(encoding="utf-8")
        lines[here] += text.count("\n")
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("coaxshell."):
                there = _floor((node.module or "").removeprefix("coaxshell."))
                if there is not None and there != here:
                    imports[here, there] += 1
    rooms = {floor: _rooms(package / floor.replace(".", "/")) for floor in FLOORS}
    return House(lines, rooms, imports)


def _floor(place: str) -> str | None:
    return next((floor for floor in FLOORS if place == floor or place.startswith(f"{floor}.")), None)


def _rooms(folder: Path) -> list[str]:
    return sorted(one.name for one in folder.iterdir() if one.is_dir() and any(one.glob("*.py")))


def draw(house: House) -> Figure:
    """Return the picture: the lowest floor at the bottom, widths of floors as the lines of their source."""
    figure, axes = plt.subplots(figsize=(9.5, 7.5), layout="constrained")
    widest = max(house.lines.values())
    for level, floor in enumerate(FLOORS):
        width = 1.5 + 4.0 * house.lines[floor] / widest
        axes.add_patch(Rectangle((-width, level - 0.36), width, 0.72, facecolor="#dce8f5", edgecolor="#33608c"))
        axes.text(-0.12, level + 0.08, floor.replace(".", "/"), ha="right", va="center", weight="bold")
        axes.text(-0.12, level - 0.2, f"{house.lines[floor]:,} lines", ha="right", va="center", size=7, color="#444444")
        rooms = house.rooms[floor]
        told = ", ".join(rooms[:5]) + (f" and {len(rooms) - 5} more" if len(rooms) > 5 else "")
        axes.text(-width - 0.12, level, told, ha="right", va="center", size=7, color="#444444")
    most = max(house.imports.values())
    for (upper, lower), count in house.imports.items():
        high, low = FLOORS.index(upper), FLOORS.index(lower)
        span = high - low
        colour = "#33608c" if span > 0 else "#c0392b"
        arc = Arc((0.08, 0.5 * (high + low)), 0.62 * abs(span), abs(span), theta1=-90, theta2=90)
        arc.set(linewidth=0.4 + 4.0 * np.sqrt(count / most), color=colour, alpha=0.5)
        axes.add_patch(arc)
    axes.set(xlim=(-9.6, 4.6), ylim=(-0.7, len(FLOORS) - 0.3))
    axes.set_axis_off()
    return figure


def write_picture(package: Path, path: Path) -> None:
    """Write the picture of a package as SVG."""
    with plt.rc_context({"svg.hashsalt": "house", "svg.fonttype": "none"}):
        figure = draw(read(package))
        figure.savefig(path, metadata={"Date": None})
        plt.close(figure)
