"""Delayed control laws: what they asked for a delay ago is a known load, interpolated between the steps by cubics."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from coaxshell.apps.verification.independent.assembly import Assembly, Block
from coaxshell.apps.verification.independent.limits import Limits
from coaxshell.numerics.arrays import FloatArray

_NODES = 0.5 + np.array([-1.0, 1.0]) * np.sqrt(3.0) / 6.0
"""Of Gauss's method of two stages, in steps."""
_FEWEST = 2.0
"""Steps that a delay has at least: the cubic needs a point on either side of two."""


@dataclass
class Late:
    """The laws of all blocks: where their unknowns y are, which displacements they read, and their loads.

    Attributes
    ----------
    law : tuple of ndarray
        See :attr:`Assembly.law`.
    delay : float
        Transits; 0 leaves nothing to do.
    places : ndarray of int, shape (laws,)
    read : ndarray, shape (laws, size)
        phi per unknown.
    loads : ndarray, shape (laws, size)
        Per volt.
    limits : Limits or None
        What amplifiers give of what is asked for.
    """

    law: tuple[FloatArray, FloatArray]
    delay: float
    places: np.ndarray[tuple[int], np.dtype[np.intp]]
    read: FloatArray
    loads: FloatArray
    step: float = 0.0
    volts: FloatArray = field(default_factory=lambda: np.zeros((0, 0)))
    limits: Limits | None = None

    @classmethod
    def of(cls, assembly: Assembly, parts: Sequence[Block], size: int, blocks: Sequence[tuple[int, int]]) -> Late:
        """Return it for the blocks of an assembly, (parity, order) each, one after another in a vector of unknowns."""
        assert assembly.rational is not None
        rows = sum(len(part.late) for part in parts)
        places, read, loads = np.zeros(rows, dtype=np.intp), np.zeros((rows, size)), np.zeros((rows, size))
        start = row = 0
        for part in parts:
            count, wide = part.late.shape
            here = slice(start, start + wide)
            for law in range(count):
                place = wide - count + law
                places[row], loads[row, here] = start + place, part.late[law]
                read[row, here] = -part.stiffness[place]
                read[row, start + place] = 0.0
                row += 1
            start += wide
        limits = Limits.of(assembly, blocks)
        if limits is not None and not assembly.rational.delay:
            raise NotImplementedError("segments and limits are written for delayed laws in the independent solver")
        return cls(assembly.law, assembly.rational.delay / assembly.transit, places, read, loads, limits=limits)

    def beginning(self, step: float, steps: int) -> Late | None:
        """Return it with room for a run's voltages, at rest; None without a delay."""
        if not self.delay:
            return None
        if self.delay < _FEWEST * step:
            raise NotImplementedError("a delay of less than two steps is not written in the independent solver")
        return replace(self, step=step, volts=np.zeros((self.places.size, steps + 1)))

    def keep(self, instant: int, x: FloatArray, v: FloatArray) -> None:
        """Keep the voltages at an instant, u = b_0 y'' + b_1 y' + b_2 y with y'' from the law."""
        (b0, b1, b2), (a0, a1, a2) = self.law
        y, rate = x[self.places], v[self.places]
        self.volts[:, instant] = b0 * (self.read @ x - a1 * rate - a2 * y) / a0 + b1 * rate + b2 * y

    def load(self, step: int) -> FloatArray:
        """Return the loads at both stages of a step, shape (2, size)."""
        return np.stack([self._volts(step + node - self.delay / self.step) @ self.loads for node in _NODES])

    def _volts(self, place: float) -> FloatArray:
        """Return the voltages at an instant in steps, by the cubic through the two on either side; 0 before the start."""
        first = int(np.floor(place)) - 1
        points = np.arange(first, first + 4)
        part, total = place - points, np.zeros(self.places.size)
        for i, point in enumerate(points):
            others = [j for j in range(4) if j != i]
            weight = np.prod([part[j] / (points[i] - points[j]) for j in others])
            if point >= 0:
                total += weight * self.volts[:, point]
        return total if self.limits is None else self.limits.given(total)
