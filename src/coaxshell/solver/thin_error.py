"""How far thin walls are from exact ones, whose layers are elastic solids wetted at their faces.

Straight normals err as the thickness does, and so does a wetted mid-surface. A wall with fluid on both sides errs however thin it is:
thin theory takes no stress across it, where the pressure stands, which Poisson's ratio turns into hoop stress.

The map beside this file holds, for a steel tube and for the paper's two shells with walls of many thicknesses under a plane shock, the
difference between both answers by the thickness, the pulse's decay and the duration of the run; the ranges of other systems'
differences over it are what is told as its spread. ``python -m coaxshell.apps.paper.thickness map`` makes it again.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any

import numpy as np

from coaxshell.model.fluids import Vacuum
from coaxshell.model.shells import Shell
from coaxshell.model.system import System
from coaxshell.numerics.arrays import FloatArray
from coaxshell.solver.scaling import Problem
from coaxshell.solver.slice_error import between, equivalent_decay

DATA = "thin_error.json"
WALLS = ("dry", "inner", "outer")
"""Walls of the map: the tube's, dry on one side, and the paper's inner and outer one, with water on both."""
DRY = 0.01
"""Impedance of the fluid inside over that of the exterior below which a wall is dry there."""
WETTED = ("mid-surface", "faces")
ARRAYS = ("stress", "displacement", "peaks")


@dataclass(frozen=True)
class ThinMap:
    """Hold the differences between thin and exact walls at head and tail.

    Attributes
    ----------
    thickness : ndarray, shape (3, thicknesses)
        h/R of each of :data:`WALLS`; each row rises.
    decay, duration : ndarray
        Of the pulse and of the run in transits; each rises.
    stress, displacement : ndarray, shape (3, 2, thicknesses, decays, durations)
        ||thin - exact||/||exact|| over time, head and tail together, of walls and of what thin ones wet, :data:`WETTED`: hoop stress in the
        middle of the core, and normal displacement there.
    peaks : ndarray, same shape
        Largest magnitude of the hoop stress at head and tail over that of exact walls.
    spread : ndarray, shape (2, durations, 2)
        Smallest and largest of other systems' errors of the stress over the map's.
    """

    thickness: FloatArray
    decay: FloatArray
    duration: FloatArray
    stress: FloatArray
    displacement: FloatArray
    peaks: FloatArray
    spread: FloatArray

    def estimate(self, wall: str, wetted: str, thickness: float, decay: float, duration: float) -> float:
        """Return the error of the hoop stress by linear interpolation of logarithms.

        In runs shorter than the map's it goes on with the duration; at its other edges the edge's value stands.

        Parameters
        ----------
        wall, wetted : str
            Of :data:`WALLS` and :data:`WETTED`.
        thickness : float
            h/R.
        decay, duration : float
            Transits.
        """
        number = WALLS.index(wall)
        values = np.log(self.stress[number, WETTED.index(wetted)])
        for axis, asked in zip((self.thickness[number], self.decay, self.duration), (thickness, decay, duration), strict=True):
            values = between(np.log(axis), values, float(np.log(np.clip(asked, axis[0], axis[-1]))))
        return float(np.exp(values) * min(1.0, duration / self.duration[0]))

    def range(self, wetted: str, duration: float) -> tuple[float, float]:
        """Return by what factors other systems' errors lay below and above the map's, in runs of *duration* transits."""
        sides = self.spread[WETTED.index(wetted)].T
        low, high = (float(np.interp(np.log(duration), np.log(self.duration), side)) for side in sides)
        return low, high


def thin_map() -> ThinMap:
    """Return the map that is part of the package."""
    return _stored()


@cache
def _stored() -> ThinMap:
    return from_table(json.loads(files("coaxshell.solver").joinpath(DATA).read_text(encoding="utf-8")))


def from_table(table: dict[str, Any]) -> ThinMap:
    """Return the map that a table of lists holds."""
    return ThinMap(**{name: np.array(table[name], dtype=np.float64) for name in ThinMap.__dataclass_fields__})


@dataclass(frozen=True)
class ThinError:
    """Hold the estimated error of the hoop stress of a thin wall, relative (L2).

    Attributes
    ----------
    shell : int
    wetted : str
        What the fluids wet in the run.
    value, low, high : float
        The error, and its range as systems differ.
    at_faces : float
        What it would be with fluids at the faces.
    """

    shell: int
    wetted: str
    value: float
    low: float
    high: float
    at_faces: float


def kind_of_wall(system: System, number: int) -> str:
    """Return which of :data:`WALLS` a wall is like; within another one it is no dry one, as the front reaches it through the gap."""
    exterior, within = system.exterior, system.fluids[number]
    if number < len(system.shells) - 1:
        return "inner"
    dry = isinstance(within, Vacuum) or within.density * within.sound_speed < DRY * exterior.density * exterior.sound_speed
    return "dry" if dry else "outer"


def thin_errors(problem: Problem, duration: float) -> list[ThinError]:
    """Return the estimated errors of all thin walls of a run in two dimensions, each by the source that is worst.

    Parameters
    ----------
    problem : Problem
    duration : float
        Transits.
    """
    system, known, found = problem.system, thin_map(), []
    if problem.dimensions == 3:
        return []
    for number, shell in enumerate(system.shells):
        if not isinstance(shell, Shell) or shell.theory != "thin":
            continue
        kind, ratio = kind_of_wall(system, number), shell.thickness / shell.radius
        worst, lasting = dict.fromkeys(WETTED, 0.0), 0.0
        for source in system.sources:
            lasts = duration - source.delay / problem.scales.time
            if lasts <= 0.0:
                continue
            decay = equivalent_decay(source.pulse) / problem.scales.time
            errors = {wetted: known.estimate(kind, wetted, ratio, decay, lasts) for wetted in WETTED}
            if errors[shell.wetted] > worst[shell.wetted]:
                worst, lasting = errors, lasts
        if lasting > 0.0:
            value, (low, high) = worst[shell.wetted], known.range(shell.wetted, lasting)
            found.append(ThinError(number, shell.wetted, value, low * value, high * value, worst["faces"]))
    return found
