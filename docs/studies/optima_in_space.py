"""Repeat the optima of the design study in three dimensions: the sphere itself instead of its slice.

Absorbers are lines along the axis, as in two dimensions. Every row is written as soon as it is known, and one that is there already is
not computed again. Run: python optima_in_space.py FILE.csv
"""

from __future__ import annotations

import csv
import sys
from pathlib import Path

import numpy as np

import coaxshell as cx
from coaxshell.studies.reading import MetricSource

RESULTS = Path(__file__).parent / "results"
STATIONS = (0.0, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0)
"""Axial positions (m) at which the peak is looked for; the source lies at 0, and nothing tells z from -z."""
SYSTEMS = (
    ("bare", "bare"),
    ("the paper's absorbers", "absorbers"),
    ("the paper's hybrid", "hybrid"),
    ("25 free", "b-25-free"),
    ("60 free", "b-60-free"),
)
RESOLUTIONS = ((30, 8e-3), (60, 4e-3))
"""Orders, which are k_max a too, and time step."""
FINER = (("25 free", "b-25-free", 76, 4e-3),)
"""What is repeated with more of both, to see how far it has converged."""
NAMES = ("system", "dimensions", "modes", "time step", "inner.peak_stress (Pa)", "z (m)", "at z = 0 (Pa)")


def system_of(name: str) -> cx.System:
    """Return a preset, or the best system of a study."""
    stored = RESULTS / name / "best.toml"
    return cx.System.from_toml(stored) if stored.exists() else cx.presets.load(name)


def peak(name: str, dimensions: int, modes: int, time_step: float) -> tuple[float, float, float]:
    """Return the largest hoop stress of the inner shell's core (Pa), where along the axis, and that at z = 0."""
    run = {"modes": modes, "time_step": time_step, "duration": 5.0}
    if dimensions == 2:
        found = MetricSource(cx.simulate(system_of(name), **run)).number("peak_stress", 0)
        return found, 0.0, found
    response = cx.simulate(system_of(name), **run, dimensions=3, stations=list(STATIONS))
    each = [MetricSource(response.at(z)).number("peak_stress", 0) for z in STATIONS]
    return max(each), STATIONS[int(np.argmax(each))], each[0]


def rows_of(target: Path) -> dict[tuple[str, ...], list[str]]:
    """Return the rows that are there, by system, dimensions, modes and time step."""
    if not target.exists():
        return {}
    with target.open() as file:
        return {tuple(row[:4]): row for row in list(csv.reader(file))[1:]}


def main(target: Path) -> None:
    """Compute what is missing and write it."""
    found = rows_of(target)
    asked = [(*system, *resolution) for resolution in RESOLUTIONS for system in SYSTEMS]
    for label, name, modes, time_step in (*asked, *FINER):
        for dimensions in (2, 3):
            key = (label, str(dimensions), str(modes), str(time_step))
            if key in found:
                continue
            found[key] = [*key, *(f"{x:.6g}" for x in peak(name, dimensions, modes, time_step))]
            sys.stdout.write(f"{found[key]}\n")
            sys.stdout.flush()
            with target.open("w", newline="") as file:
                writer = csv.writer(file)
                writer.writerow(NAMES)
                writer.writerows(found.values())


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "optima-in-space.csv"))
