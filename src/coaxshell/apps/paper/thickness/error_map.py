"""The map of the thin walls' error: a steel tube and the paper's shells of many thicknesses, every decay from the same runs."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from coaxshell.apps.paper.claims.systems import preset
from coaxshell.apps.paper.sphere.error_map import decayed
from coaxshell.apps.paper.thickness.compared import QUANTITIES, Compared, compare
from coaxshell.model import PlaneShock
from coaxshell.model.shells import Shell
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.progress import Progress
from coaxshell.solver.settings import Settings
from coaxshell.solver.thin_error import WALLS, WETTED, ThinMap, kind_of_wall

if TYPE_CHECKING:
    from coaxshell.model import System

THICKNESSES = (0.002, 0.004, 0.008, 0.012, 0.018, 0.024, 0.035, 0.05, 0.075)
"""h/R of the paper's outer wall; that of its inner one, as thick at half the radius, and of the tube is twice as large."""
DECAYS = (0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 20.0)
"""Transits; the paper's is 0.18."""
DURATIONS = (1.0, 1.5, 2.0, 3.0, 4.0, 8.0)
"""Transits."""
SOLVED = 0.2
"""Decay (transits) of the pulse that is solved."""
RESOLUTION = Settings(duration=max(DURATIONS), time_step=5e-3, modes=40)
TUBE, PAIR = "steel-tube", "bare"
OTHERS = ("iakovlev-evacuated", "iakovlev-filled", "iakovlev-double")
"""Presets whose errors are laid beside the map, with their own walls and twice as thick ones."""


def of_thickness(system: System, ratio: float) -> System:
    """Return a system whose outermost wall has a thickness over radius, and all others are thicker or thinner by as much."""
    outermost = [shell for shell in system.shells if isinstance(shell, Shell)][-1]
    return scaled(system, ratio * outermost.radius / outermost.thickness)


def scaled(system: System, factor: float) -> System:
    """Return a system whose layers are so many times as thick."""

    def of(shell: Shell) -> Shell:
        return shell.replace(layers=[layer.replace(thickness=factor * layer.thickness) for layer in shell.layers])

    return system.replace(shells=[of(shell) if isinstance(shell, Shell) else shell for shell in system.shells])


def shocked(system: System, decay: float) -> System:
    """Return a system under a plane shock, its decay in transits."""
    transit = system.reference_radius / system.exterior.sound_speed
    return system.replace(source=PlaneShock(peak_pressure=25e3, decay_time=decay * transit))


def with_decay(found: Compared, decay: float) -> Compared:
    """Return what a comparison is under a pulse of another decay (transits)."""
    step = float(found.time[1] - found.time[0])
    return replace(found, histories={key: decayed(values, step, SOLVED, decay) for key, values in found.histories.items()})


def error_map(
    resolution: Settings = RESOLUTION,
    thicknesses: tuple[float, ...] = THICKNESSES,
    others: tuple[str, ...] = OTHERS,
    progress: Progress | None = None,
) -> ThinMap:
    """Return the map, made by three runs of the tube and of the paper's shells for each thickness.

    Parameters
    ----------
    resolution : Settings
        Its duration bounds the map's.
    thicknesses : tuple of float
        h/R of the paper's outer wall.
    others : tuple of str
        Presets that the spread is taken from.
    progress : callable, optional
    """
    durations = tuple(value for value in DURATIONS if value <= resolution.duration)
    shape = (len(WALLS), len(WETTED), len(thicknesses), len(DECAYS), len(durations))
    arrays = {name: np.empty(shape) for name in (*QUANTITIES, "peaks")}
    for n, ratio in enumerate(thicknesses):
        for first, name, own in ((0, TUBE, 2.0 * ratio), (1, PAIR, ratio)):
            found = compare(shocked(of_thickness(preset(name), own), SOLVED), resolution)
            for d, decay in enumerate(DECAYS):
                under = with_decay(found, decay)
                for t, duration in enumerate(durations):
                    _put(arrays, under.up_to(duration), first, (n, d, t))
        if progress:
            progress((n + 1) / (len(thicknesses) + len(others)), f"{ratio:g} of the radius")
    axes = np.array([[2.0 * ratio for ratio in thicknesses]] * 2 + [list(thicknesses)])
    made = ThinMap(axes, np.array(DECAYS), np.array(durations), **arrays, spread=np.ones((len(WETTED), len(durations), 2)))
    ratios = np.ones((0, len(WETTED), len(durations)))
    for done, name in enumerate(others):
        ratios = np.concatenate([ratios, *([one] for one in _beside(made, preset(name), resolution))])
        if progress:
            progress((len(thicknesses) + done + 1) / (len(thicknesses) + len(others)), name)
    return replace(made, spread=np.stack([ratios.min(axis=0, initial=1.0), ratios.max(axis=0, initial=1.0)], axis=-1))


def _put(arrays: dict[str, FloatArray], found: Compared, first: int, at: tuple[int, int, int]) -> None:
    """Put the errors of a comparison where they belong: its walls, from the map's number *first* on, at a place of the map."""
    for w, wetted in enumerate(WETTED):
        ratios = found.peaks(wetted).reshape(-1, 2).max(axis=1) / found.peaks("exact").reshape(-1, 2).max(axis=1)
        for k, ratio in enumerate(ratios):
            arrays["peaks"][(first + k, w, *at)] = ratio
        for name in QUANTITIES:
            for k, error in enumerate(found.of_walls(wetted, name)):
                arrays[name][(first + k, w, *at)] = error


def _beside(made: ThinMap, system: System, resolution: Settings) -> Iterator[FloatArray]:
    """Yield the errors of a system's walls over the map's, (what they wet, durations), for some thicknesses and decays."""
    kinds = [kind_of_wall(system, i) for i in system.shell_indices()]
    for factor in (1.0, 2.0):
        thicker = scaled(system, factor)
        walls = [shell for shell in thicker.shells if isinstance(shell, Shell)]
        found = compare(shocked(thicker, SOLVED), resolution)
        for decay in DECAYS[1:-1:2]:
            errors = [with_decay(found, decay).up_to(time) for time in made.duration]
            for k, (kind, shell) in enumerate(zip(kinds, walls, strict=True)):
                ratio = shell.thickness / shell.radius
                yield np.array(
                    [
                        [
                            one.of_walls(wetted)[k] / made.estimate(kind, wetted, ratio, decay, time)
                            for one, time in zip(errors, made.duration, strict=True)
                        ]
                        for wetted in WETTED
                    ]
                )


def as_table(made: ThinMap) -> dict[str, Any]:
    """Return a map as lists of numbers with three digits."""
    about = "Error of thin walls against elastic solids; made by python -m coaxshell.apps.paper.thickness map"
    return {"about": about, **{one.name: _listed(getattr(made, one.name)) for one in fields(made)}}


def _listed(values: FloatArray) -> Any:
    return [_listed(one) for one in values] if values.ndim else float(f"{float(values):.3g}")
