"""What is nonlinear: the links of the absorbers and, if the controller saturates, the voltage at a row of angles.

All modes, shells, fluids and absorbers make one system M x'' + C x' + K x = g(t) + B f(P x, P x'), f diagonal.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from coaxshell.apps.verification.independent.assembly import Assembly
from coaxshell.apps.verification.independent.springs import force_of
from coaxshell.model.absorbers import linked_shells
from coaxshell.model.gains import gains_of
from coaxshell.model.laws import of_side
from coaxshell.numerics.arrays import FloatArray


def shape(parity: int, m: int, angle: float) -> float:
    """Return cos(m angle) or sin(m angle), angle in radians."""
    return float(np.cos(m * angle) if parity == 0 else np.sin(m * angle))


@dataclass(frozen=True)
class Places:
    """Where things stand in the vector of unknowns: (parity, order) and start of each block, start of the absorbers' masses, size."""

    blocks: Sequence[tuple[int, int]]
    starts: Sequence[int]
    masses: int
    size: int
    shells: int


class Links:
    """P, B and the force law, dimensionless.

    Parameters
    ----------
    assembly : Assembly
    places : Places
    angles : int
        Number of angles in [0, 180) degrees at which a saturating controller's voltage is taken.
    """

    def __init__(self, assembly: Assembly, places: Places, angles: int) -> None:
        self._assembly, self._places, system = assembly, places, assembly.system
        self._rows: list[tuple[FloatArray, FloatArray]] = []
        self._absorbers()
        absorbers = system.absorber_list
        per_metre = assembly.pressure * assembly.length
        there = np.array([x.links in ("both", side) or x.grounded for x in absorbers for side in ("inner", "outer")], dtype=float)
        self._c = np.repeat([x.damping for x in absorbers], 2) * (assembly.length / assembly.transit) / per_metre * there
        self._k_l = np.repeat([x.linear_stiffness for x in absorbers], 2) / assembly.pressure * there
        self._k_nl = np.repeat([x.cubic_stiffness for x in absorbers], 2) * assembly.length**2 / assembly.pressure * there
        self.inertance = np.repeat([x.inertance for x in absorbers], 2) / (assembly.system.exterior.density * assembly.length**2) * there
        self._laws = [of_side(x.law, side) if there[2 * k + side] else () for k, x in enumerate(absorbers) for side in (0, 1)]
        self._links = len(self._rows)
        self._limit = np.array(self._voltages(angles))
        controlled = system.controlled_shells if assembly.saturates else ()
        self._gains = np.repeat([gains_of(system, i) for i in controlled], angles, axis=0).T
        self.read = np.array([p for p, _ in self._rows]).reshape(-1, places.size)
        self.apply = np.array([b for _, b in self._rows]).reshape(-1, places.size).T

    @property
    def count(self) -> int:
        """Number of links and voltages."""
        return len(self._rows)

    def _absorbers(self) -> None:
        places = self._places
        for k, x in enumerate(self._assembly.system.absorber_list):
            for side, i in zip(("inner", "outer"), linked_shells(x), strict=True):
                p, b = np.zeros(places.size), np.zeros(places.size)
                p[places.masses + k], b[places.masses + k] = 1.0, -1.0
                if x.links not in ("both", side):
                    self._rows.append((p, b))  # nothing, or a core that does not move
                    continue
                for start, (parity, m) in zip(places.starts, places.blocks, strict=True):
                    value = shape(parity, m, np.radians(x.angle))
                    p[start + places.shells + i] = -value
                    b[start + places.shells + i] = value / (np.pi * (2 if m == 0 else 1))  # the row is multiplied by R, the load f/R
                self._rows.append((p, b))

    def _voltages(self, angles: int) -> list[float]:
        assembly, places, limits = self._assembly, self._places, []
        for i in assembly.system.controlled_shells if assembly.saturates else ():
            wall, inward = assembly.walls[i], assembly.inward(i)
            for angle in np.pi * (np.arange(angles) + 0.5) / angles:
                p, b = np.zeros(places.size), np.zeros(places.size)
                for start, (parity, m) in zip(places.starts, places.blocks, strict=True):
                    if parity:
                        raise NotImplementedError("saturation is written for symmetric systems in the independent solver")
                    p[start + np.array(assembly.displacements(i))] = assembly.volts(i, m) * np.cos(m * angle)
                    b[start + places.shells + i] = inward * (1 if m == 0 else 2) / angles * np.cos(m * angle)
                self._rows.append((p, b))
                limits.append(wall.actuator.limit)
        return limits

    def law(self, y: FloatArray, dy: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return (f, df/dy, df/ddy) of all links at both stages, y and dy of shape (2 * count,)."""
        y, dy = y.reshape(2, self.count), dy.reshape(2, self.count)
        a, s = slice(0, self._links), slice(self._links, self.count)
        f, by, bd = np.zeros_like(y), np.zeros_like(y), np.zeros_like(y)
        f[:, a] = self._c * dy[:, a] + self._k_l * y[:, a] + self._k_nl * y[:, a] ** 3
        by[:, a], bd[:, a] = self._k_l + 3 * self._k_nl * y[:, a] ** 2, self._c
        length, speed = self._assembly.length, self._assembly.length / self._assembly.transit
        per_metre = self._assembly.pressure * length
        for link, several in enumerate(self._laws):
            for law in several:
                found = force_of(law, y[:, link] * length, dy[:, link] * speed)
                f[:, link] += found[0] / per_metre
                by[:, link] += found[1] * length / per_metre
                bd[:, link] += found[2] * speed / per_metre
        if self._limit.size:
            proportional, derivative = self._gains
            asked = proportional * y[:, s] + derivative * dy[:, s]
            free = np.abs(asked) < self._limit
            f[:, s] = np.clip(asked, -self._limit, self._limit)
            by[:, s], bd[:, s] = proportional * free, derivative * free
        return f.ravel(), by.ravel(), bd.ravel()
