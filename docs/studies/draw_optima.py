"""Draw what the optima of the design study look like: where the mass and the damping went, and the front against the added mass.

Run: python draw_optima.py FIGURE.png
"""

from __future__ import annotations

import csv
import sys
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import LogNorm

import coaxshell as cx
from coaxshell.plotting.style import COLOURS, PAGE_WIDTH, new_figure, style

RESULTS = Path(__file__).parent / "results"
SHOWN = (
    ("the paper's ring, 118.3 kPa", None),
    ("25 free, 46.9 kPa", "b-25-free"),
    ("60 free, 46.0 kPa", "b-60-free"),
    ("robust, worst of nine 133 kPa", "e-robust-free"),
)


def draw_layout(system: cx.System, ax: Any, title: str) -> Any:
    """Draw absorbers at their angles, the head above: areas as their masses, colours as their damping."""
    listed = system.absorber_list
    angle, mass = np.radians([one.angle for one in listed]), np.array([one.mass for one in listed])
    ax.set_theta_zero_location("N")
    ax.set_ylim(0.0, 1.25)
    ax.set_yticks([])
    ax.set_xticks(np.radians([0, 90, 180, 270]), ["head", "", "tail", ""])
    for radius in (0.5, 1.0):
        ax.plot(np.linspace(0.0, 2.0 * np.pi, 200), np.full(200, radius), color="0.6", linewidth=0.8)
    drawn = ax.scatter(
        angle, np.full(angle.size, 0.75), s=4.0 + 3.0 * mass, c=[one.damping for one in listed], cmap="viridis", norm=LogNorm(1e4, 1e8),
        edgecolors="black", linewidths=0.3, zorder=3,
    )  # fmt: skip
    ax.set_title(title, fontsize="small")
    return drawn


def draw_front(ax: Any) -> None:
    """Draw the front of study d beside the designs of the others."""
    with (RESULTS / "d-front" / "front.csv").open() as file:
        rows = list(csv.DictReader(file))
    mass, stress = (np.array([float(row[name]) for row in rows]) for name in ("mass (kg/m)", "inner.peak_stress (Pa)"))
    order = np.argsort(mass)
    best = np.minimum.accumulate(stress[order])
    ax.step(mass[order], 1e-3 * best, where="post", color=COLOURS["blue"], label="d, 25 free absorbers")
    ax.plot(mass, 1e-3 * stress, ".", color=COLOURS["blue"], markersize=4)
    with (RESULTS / "d-mass-front" / "front.csv").open() as file:
        old = list(csv.reader(file))
    names, values = old[0], np.array([[float(x) for x in row] for row in old[1:]])
    column = {name: k for k, name in enumerate(names)}
    m, s = (next(column[name] for name in names if part in name) for part in ("absorbers.mass", "peak_stress"))
    ax.plot(values[:, m], 1e-3 * values[:, s], ".", color=COLOURS["sky"], markersize=3, label="equal absorbers")
    ax.axhline(96.4, color=COLOURS["orange"], linestyle="--", label="the paper's hybrid, 96.4 kPa")
    ax.set_xscale("log")
    ax.set_xlabel("added mass (kg/m)")
    ax.set_ylabel("inner shell's peak stress (kPa)")
    ax.legend(fontsize="small")


def main(target: Path) -> None:
    """Draw all of it."""
    with style():
        figure = new_figure(PAGE_WIDTH, 5.6)
        grid = figure.add_gridspec(2, len(SHOWN), height_ratios=[1.0, 1.2])
        for k, (title, name) in enumerate(SHOWN):
            system = cx.presets.load("absorbers") if name is None else cx.System.from_toml(RESULTS / name / "best.toml")
            drawn = draw_layout(system, figure.add_subplot(grid[0, k], projection="polar"), title)
        figure.colorbar(drawn, ax=figure.axes[-1], label="damping (N s/m²)", shrink=0.8)
        draw_front(figure.add_subplot(grid[1, :]))
        figure.savefig(target, dpi=130)
        plt.close(figure)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
