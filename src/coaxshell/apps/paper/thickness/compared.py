"""The same system with thin walls, wetted at their mid-surfaces or at their faces, and with exact elastic ones: histories and peaks."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from coaxshell.model.places import shell_name
from coaxshell.model.shells import Shell
from coaxshell.numerics.arrays import FloatArray
from coaxshell.solver.settings import Settings

if TYPE_CHECKING:
    from coaxshell.model import System

EXACT = "exact"
THIN: Mapping[str, Mapping[str, str]] = MappingProxyType({"mid-surface": {"wetted": "mid-surface"}, "faces": {"wetted": "faces"}})
"""Thin walls by what the fluids wet, and how a shell says so."""
QUANTITIES = ("stress", "displacement")
"""Hoop stress in the middle of the core, and normal displacement there."""
SIDES: Mapping[str, float] = MappingProxyType({"head": 0.0, "tail": 180.0})
_ARRIVED = 0.01
"""Of the largest root mean square, below which a point counts as not reached yet."""


@dataclass(frozen=True)
class Compared:
    """Histories at head and tail of a system's walls under each theory.

    Attributes
    ----------
    time : ndarray, shape (T,)
        Transits.
    points : tuple of str
        "inner head" and so on, wall by wall.
    histories : mapping of (str, str) to ndarray, shape (points, T)
        By theory, "exact" or one of :data:`THIN`, and by quantity; SI.
    """

    time: FloatArray
    points: tuple[str, ...]
    histories: Mapping[tuple[str, str], FloatArray]

    def up_to(self, duration: float) -> Compared:
        """Return its instants until *duration* transits."""
        kept = self.time <= duration * (1.0 + 1e-9)
        return replace(self, time=self.time[kept], histories={key: values[:, kept] for key, values in self.histories.items()})

    def difference(self, theory: str, quantity: str = "stress") -> FloatArray:
        """Return ||thin - exact||/||exact|| over time at each point; NaN where nothing has arrived."""
        exact = self.histories[EXACT, quantity]
        return self._relative(np.linalg.norm(self.histories[theory, quantity] - exact, axis=1), np.linalg.norm(exact, axis=1), quantity)

    def of_walls(self, theory: str, quantity: str = "stress") -> FloatArray:
        """Return the same over time, head and tail of each wall together."""
        exact = self.histories[EXACT, quantity]
        apart = self.histories[theory, quantity] - exact
        both = [np.linalg.norm(values.reshape(-1, 2 * values.shape[-1]), axis=1) for values in (apart, exact)]
        return np.asarray(both[0] / both[1])

    def peaks(self, theory: str, quantity: str = "stress") -> FloatArray:
        """Return the largest magnitude at each point."""
        return np.asarray(np.abs(self.histories[theory, quantity]).max(axis=1))

    def peak_ratio(self, theory: str, quantity: str = "stress") -> FloatArray:
        """Return the largest magnitude over that of exact walls at each point; NaN where nothing has arrived."""
        return self._relative(self.peaks(theory, quantity), self.peaks(EXACT, quantity), quantity)

    def _relative(self, part: FloatArray, whole: FloatArray, quantity: str) -> FloatArray:
        arrived = np.linalg.norm(self.histories[EXACT, quantity], axis=1)
        there = arrived > _ARRIVED * arrived.max()
        return np.asarray(np.where(there, part / np.where(there, whole, 1.0), np.nan))


def with_walls(system: System, **described: str) -> System:
    """Return a system all of whose walls, but for rigid ones, have a theory or wetted surfaces."""
    return system.replace(shells=[shell.replace(**described) if isinstance(shell, Shell) else shell for shell in system.shells])


def compare(system: System, resolution: Settings, theories: tuple[str, ...] = tuple(THIN)) -> Compared:
    """Solve a system with exact walls and with thin ones.

    Raises
    ------
    InputError
        Elastic walls do not know the system: its actuators saturate, or a ceramic has no c44 or e15.
    """
    from coaxshell.response import simulate

    described = {EXACT: {"theory": "elastic"}, **{name: THIN[name] for name in theories}}
    walls = system.shell_indices()
    turns = [system.sources[0].angle + turn for turn in SIDES.values()]
    histories: dict[tuple[str, str], FloatArray] = {}
    for theory, how in described.items():
        run = simulate(with_walls(system, **how), settings=resolution)
        histories[theory, "stress"] = np.concatenate([np.asarray(run.stress(i, turns), dtype=np.float64).T for i in walls])
        histories[theory, "displacement"] = np.concatenate([np.asarray(run.displacement(i, turns), dtype=np.float64).T for i in walls])
        time = np.asarray(run.time)
    points = tuple(f"{shell_name(i, len(system.shells))} {side}" for i in walls for side in SIDES)
    return Compared(time, points, histories)
