"""The map of the slice's error: the paper's bare shells at many distances, every decay of the pulse from the same runs.

All is linear and the pulses differ in their decay alone, f^ = 1/(s + 1/decay), so that the answer to another one is

    y_b = y_a + (1/a - 1/b) int_0^t e^{-(t - x)/b} y_a(x) dx

for decays a and b, whatever the source's geometry.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.signal import lfilter

from coaxshell.apps.paper.claims.systems import preset
from coaxshell.apps.paper.sphere.compared import Compared, compare
from coaxshell.model import SphericalShock
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.progress import Progress
from coaxshell.solver.settings import Settings
from coaxshell.solver.slice_error import ARRAYS, AXES, SliceMap

if TYPE_CHECKING:
    from coaxshell.model import System

DISTANCES = (1.5, 2.0, 3.0, 5.0, 8.0, 12.0, 20.0, 35.0, 60.0, 100.0)
"""From the axis, in outer radii."""
DECAYS = (0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 20.0)
"""Transits; the paper's is 0.18."""
DURATIONS = (0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 8.0)
"""Transits."""
SOLVED = 0.2
"""Decay (transits) of the pulse that is solved."""
RESOLUTION = Settings(duration=max(DURATIONS), time_step=8e-3, modes=30)
OTHERS = ("active", "iakovlev-evacuated", "iakovlev-filled", "iakovlev-double", "steel-tube")
"""Presets whose errors are laid beside the map, under the paper's shock."""
OTHER_DISTANCES = (2.0, 5.0, 20.0)
OTHER_DECAYS = (0.05, 0.2, 1.0, 5.0)
OTHER_DURATION = 4.0
"""Transits; longer runs are taken to spread as much."""


def decayed(values: FloatArray, step: float, solved: float, decay: float) -> FloatArray:
    """Return the histories under a pulse of another decay (transits), shape (..., T); exact for values linear between instants."""
    rate, kept = 1.0 / decay, np.exp(-step / decay)
    present = 1.0 / rate - (1.0 - kept) / (rate**2 * step)
    past = (1.0 - kept) / rate - present
    remembered = lfilter([present, past], [1.0, -kept], values, axis=-1)
    return np.asarray(values + (1.0 / solved - rate) * remembered)


def with_decay(found: Compared, solved: float, decay: float) -> Compared:
    """Return what a comparison is under a pulse of another decay (transits)."""
    step = float(found.time[1] - found.time[0])
    return replace(found, stress={kind: decayed(values, step, solved, decay) for kind, values in found.stress.items()})


def shocked(system: System, distance: float, decay: float) -> System:
    """Return a system under a spherical shock from so many outer radii, its decay in transits."""
    transit = system.reference_radius / system.exterior.sound_speed
    shock = SphericalShock(peak_pressure=25e3, decay_time=decay * transit, distance=distance * system.reference_radius)
    return system.replace(source=shock)


def error_map(
    resolution: Settings = RESOLUTION,
    distances: tuple[float, ...] = DISTANCES,
    others: tuple[str, ...] = OTHERS,
    progress: Progress | None = None,
) -> SliceMap:
    """Return the map, made by one run in three dimensions a distance, and three in two.

    Parameters
    ----------
    resolution : Settings
        Its duration bounds the map's.
    distances : tuple of float
        Outer radii.
    others : tuple of str
        Presets that the spread is taken from.
    progress : callable, optional
    """
    durations = tuple(value for value in DURATIONS if value <= resolution.duration)
    tables: dict[str, list[Any]] = {name: [] for name in ARRAYS}
    for done, distance in enumerate(distances):
        found = compare(shocked(preset("bare"), distance, SOLVED), resolution)
        each = [[with_decay(found, SOLVED, decay).up_to(duration) for duration in durations] for decay in DECAYS]
        tables["error"].append([[one.overall("slice") for one in row] for row in each])
        tables["at_points"].append([[one.difference("slice") for one in row] for row in each])
        tables["peaks"].append([[one.peak_ratio("slice") for one in row] for row in each])
        for kind in ("line", "plane"):
            tables[kind].append([[one.overall(kind) for one in row] for row in each])
        if progress:
            progress((done + 1) / (len(distances) + len(others)), f"{distance:g} radii")
    axes = (np.array(distances), np.array(DECAYS), np.array(durations))
    made = SliceMap(*axes, **{name: np.array(table) for name, table in tables.items()}, spread=np.ones((len(durations), 2)))
    ratios = np.ones((0, len(durations)))
    for done, name in enumerate(others):
        ratios = np.vstack([ratios, *_beside(made, preset(name), resolution.up_to(OTHER_DURATION))])
        if progress:
            progress((len(distances) + done + 1) / (len(distances) + len(others)), name)
    return replace(made, spread=np.stack([ratios.min(axis=0, initial=1.0), ratios.max(axis=0, initial=1.0)], axis=1))


def _beside(made: SliceMap, system: System, resolution: Settings) -> Iterator[FloatArray]:
    """Yield a system's errors over the map's at its durations, for some distances and decays."""
    durations = np.minimum(made.duration, resolution.duration)
    for distance in OTHER_DISTANCES:
        found = compare(shocked(system, distance, SOLVED), resolution, ("slice",))
        for decay in OTHER_DECAYS:
            under = with_decay(found, SOLVED, decay)
            yield np.array([under.up_to(time).overall("slice") / made.estimate(distance, decay, time) for time in durations])


def as_table(made: SliceMap) -> dict[str, Any]:
    """Return a map as lists of numbers with three digits, null for NaN."""
    about = "Error of the slice in two dimensions against the sphere; made by python -m coaxshell.apps.paper.sphere map"
    table = {name: _listed(getattr(made, name)) for name in (*AXES, *ARRAYS, "spread")}
    return {"about": about, **table}


def _listed(values: FloatArray) -> Any:
    if values.ndim:
        return [_listed(one) for one in values]
    return float(f"{float(values):.3g}") if np.isfinite(values) else None
