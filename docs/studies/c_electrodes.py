"""Absorbers with control as it can be built: electrodes within 590 V/mm, walls of 1 % loss, 5 us of delay, an amplifier of 100 kHz.

The absorbers of study b (25 free ones) on the walls of the preset "electrodes-hybrid"; the gain of a derivative law that feeds the orders
up to some highest one back. Run: python c_electrodes.py FOLDER
"""

from __future__ import annotations

import csv
import sys
from pathlib import Path

import coaxshell as cx
from coaxshell.studies.reading import MetricSource

RUN = {"modes": 60, "time_step": 4e-3, "duration": 5.0}
HIGHEST = (1, 2, 3, 5)
GAINS = (0.3, 1.0, 3.0, 10.0)


def walls(absorbers: tuple[cx.Absorber, ...]) -> cx.System:
    """Return the system without control: every layer with a loss factor of 1 % around 1 kHz."""
    system = cx.presets.load("electrodes-hybrid").replace(control=None, absorbers=absorbers)
    lossy = {
        f"shells[{i}].layers[{j}].material.{name}": value
        for i, shell in enumerate(system.shells)
        for j in range(len(shell.layers))
        for name, value in (("loss_factor", 0.01), ("reference_frequency", "1 kHz"))
    }
    return system.with_overrides(lossy)


def law(system: cx.System, gain: float, highest: int) -> cx.Feedback:
    """Return u = k_d dphi/dt of the orders up to the highest, late and band-limited."""
    return cx.Feedback(
        numerator=[gain * system.transit_time, 0],
        delay="5 us",
        amplifier_corner="100 kHz",
        weights=highest,
        transducers="electrodes",
    )


def stress(system: cx.System, **run: float) -> tuple[float, float]:
    """Return the largest hoop stress of the inner shell's core (Pa), and the largest field over its limit."""
    read = MetricSource(cx.simulate(system, **{**RUN, **run}))
    field = max(read.number("actuator_field_ratio", i) for i in (0, 1)) if system.control is not None else 0.0
    return read.number("peak_stress", 0), field


def main(folder: Path) -> None:
    """Try all pairs, then the best gain between neighbours, and write ``trials.csv`` and the best system."""
    folder.mkdir(exist_ok=True)
    here = Path(__file__).parent
    base = walls(cx.System.from_toml(here / "results" / "b-25-free" / "best.toml").absorber_list)
    rows = [("none", 0.0, *stress(base))]
    bare = [("bare", 0.0, *stress(base.replace(absorbers=()))), ("paper", 0.0, *stress(walls(cx.presets.load("absorbers").absorber_list)))]
    sys.stdout.write(f"{bare} {rows}\n")
    for highest in HIGHEST:
        for gain in GAINS:
            try:
                found = stress(base.replace(control=law(base, gain, highest)))
            except cx.InputError as error:
                sys.stdout.write(f"{highest} {gain} {error}\n")
                continue
            rows.append((highest, gain, *found))
            sys.stdout.write(f"{rows[-1]}\n")
    kept = [row for row in rows[1:] if row[3] <= 1.0]
    if kept:
        highest, gain, *_ = min(kept, key=lambda row: row[2])
        for factor in (0.6, 1.6):
            try:
                rows.append((highest, factor * gain, *stress(base.replace(control=law(base, factor * gain, highest)))))
            except cx.InputError:
                continue
        highest, gain, *_ = min((row for row in rows[1:] if row[3] <= 1.0), key=lambda row: row[2])
        best = base.replace(control=law(base, gain, highest), name="electrodes and 25 free absorbers")
        best.to_toml(folder / "best.toml")
        rows.append((f"{highest} at M = 120, dt = 2e-3", gain, *stress(best, modes=120, time_step=2e-3)))
    with (folder / "trials.csv").open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["highest order fed back", "gain (transits)", "inner.peak_stress (Pa)", "field over its limit"])
        writer.writerows([*bare, *rows])


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "c-electrodes"))
