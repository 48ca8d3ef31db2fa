"""One system under four sources with the same pressure at the head point: the sphere in three dimensions, and three in two."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from coaxshell.apps.paper.observed import SIDES
from coaxshell.errors import InputError
from coaxshell.model import LineShock, PlaneShock, SphericalShock
from coaxshell.model.places import shell_name
from coaxshell.numerics.arrays import FloatArray
from coaxshell.solver.settings import Settings

if TYPE_CHECKING:
    from coaxshell.model import System
    from coaxshell.model.sources import Source

SPHERE = "sphere"
KINDS: Mapping[str, Callable[[SphericalShock], Source]] = MappingProxyType(
    {
        "slice": lambda source: source,
        "line": lambda source: LineShock(**_shared(source), distance=source.distance),
        "plane": lambda source: PlaneShock(**_shared(source)),
    }
)
"""Sources of two dimensions that stand for a spherical shock, by name: the paper's slice, a line and a plane front."""


def _shared(source: SphericalShock) -> dict[str, Any]:
    return {name: getattr(source, name) for name in ("angle", "delay", "peak_pressure", "decay_time")}


@dataclass(frozen=True)
class Compared:
    """Hoop stress of a system's elastic shells at head and tail, in the plane of the source.

    Attributes
    ----------
    time : ndarray, shape (T,)
        Transits.
    transit_time : float
        Seconds in a transit.
    points : tuple of str
        "inner head" and so on.
    stress : mapping of str to ndarray, shape (points, T)
        Pa, by the kind of source: "sphere" and those of :data:`KINDS` that were asked for.
    """

    time: FloatArray
    transit_time: float
    points: tuple[str, ...]
    stress: Mapping[str, FloatArray]

    def up_to(self, duration: float) -> Compared:
        """Return its instants until *duration* transits."""
        kept = self.time <= duration * (1.0 + 1e-9)
        return replace(self, time=self.time[kept], stress={kind: values[:, kept] for kind, values in self.stress.items()})

    def difference(self, kind: str) -> FloatArray:
        """Return ||x - sphere||/||sphere|| over time at each point; NaN where nothing has arrived."""
        true = self.stress[SPHERE]
        return self._relative(np.linalg.norm(self.stress[kind] - true, axis=1), np.linalg.norm(true, axis=1))

    def overall(self, kind: str) -> float:
        """Return ||x - sphere||/||sphere|| over time and points together."""
        true = self.stress[SPHERE]
        return float(np.linalg.norm(self.stress[kind] - true) / np.linalg.norm(true))

    def peaks(self, kind: str) -> tuple[FloatArray, FloatArray]:
        """Return the largest magnitude at each point, Pa, and its instant, transits."""
        values = np.abs(self.stress[kind])
        return values.max(axis=1), self.time[values.argmax(axis=1)]

    def peak_ratio(self, kind: str) -> FloatArray:
        """Return the largest magnitude over the sphere's at each point; NaN where nothing has arrived."""
        return self._relative(self.peaks(kind)[0], self.peaks(SPHERE)[0])

    def _relative(self, part: FloatArray, whole: FloatArray) -> FloatArray:
        arrived = np.linalg.norm(self.stress[SPHERE], axis=1)
        there = arrived > _ARRIVED * arrived.max()
        return np.asarray(np.where(there, part / np.where(there, whole, 1.0), np.nan))


_ARRIVED = 0.01
"""Of the largest root mean square, below which a point counts as not reached yet."""


def compare(system: System, resolution: Settings, kinds: tuple[str, ...] = tuple(KINDS)) -> Compared:
    """Solve a system under its spherical shock in three dimensions, at z = 0, and under what stands for it in two.

    Parameters
    ----------
    system : System
        One spherical shock.
    resolution : Settings
        Of both; the axial wavenumbers and their period are chosen by the engine.
    kinds : tuple of str
        Of :data:`KINDS`.

    Raises
    ------
    InputError
        The source is another one, or three dimensions do not know the system.
    """
    from coaxshell.response import simulate

    source = system.sources[0]
    if len(system.sources) != 1 or not isinstance(source, SphericalShock):
        raise InputError("source", "is not one spherical shock", 'give one with type = "spherical-shock"')
    elastic = system.shell_indices()
    turns = [source.angle + turn for turn in SIDES.values()]

    def read(response: Any, **at: float) -> FloatArray:
        return np.concatenate([np.asarray(response.stress(i, angle=turns, **at), dtype=np.float64).T for i in elastic])

    true = simulate(system, settings=replace(resolution, dimensions=3, stations=(0.0,)))
    stress = {SPHERE: read(true, station=0.0)}
    for kind in kinds:
        stress[kind] = read(simulate(system.replace(source=KINDS[kind](source)), settings=resolution))
    points = tuple(f"{shell_name(i, len(system.shells))} {side}" for i in elastic for side in SIDES)
    return Compared(np.asarray(true.time), system.reference_radius / system.exterior.sound_speed, points, stress)
