"""Single belts, or single segments of them, at ground: what ties the classes of waves to each other (theory manual, "Belts").

With g_c = 1 where c and -c are the same class, else 2, a voltage e on belt n' of which no loop knows is (g_c/P) e cos 2 pi c n'/P in U_c
and (g_c/P) e sin 2 pi c n'/P in U'_c, so that belt n has of it

    G(n - n') e,      G(n) = sum_c (g_c/P) cos(2 pi c n/P) (1 - H K C_c)^-1.

Dead ones are those on which such voltages leave nothing of what healthy loops give, e = -(G on the dead)^-1 u0 there. As of dead segments
the loops of those that live have the poles of the complementary minor, |G on the dead| times the product of |1 - H K C_c| over all classes.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.solver.electrode_loops import ElectrodeLoops
from coaxshell.solver.electrode_patterns import Patterns
from coaxshell.structure.belts import BeltClasses


@dataclass(frozen=True, eq=False)
class DeadElectrodes:
    """Electrodes of one period that are dead by themselves; those of segments that are dead in every belt are so in the loops.

    Where whole belts alone are dead each pattern around is by itself, else they are points, a belt and a segment each.

    Attributes
    ----------
    classes : BeltClasses
    patterns : Patterns
    """

    classes: BeltClasses
    patterns: Patterns

    @property
    def _by_pattern(self) -> bool:
        return not self.patterns.cut or not (self.patterns.dead or self.classes.belts.dead_electrodes)

    @cached_property
    def _points(self) -> list[tuple[int, int]]:
        """Belt and segment of each, each once; of patterns the segment is 0."""
        belts, count = self.classes.belts, self.classes.count
        if self._by_pattern:
            return sorted({(belt % count, 0) for belt in belts.dead_belts})
        every = [(belt, segment) for belt in belts.dead_belts for segment in range(len(self.patterns.evaluate))]
        found = {(belt % count, segment) for belt, segment in (*every, *belts.dead_electrodes)}
        return sorted(one for one in found if one[1] not in self.patterns.dead)

    @cached_property
    def _segments(self) -> list[int]:
        return sorted({segment for _, segment in self._points})

    @cached_property
    def _place(self) -> list[int]:
        """Where the segment of each point stands among the segments."""
        return [self._segments.index(segment) for _, segment in self._points]

    @cached_property
    def _phases(self) -> FloatArray:
        """Cosines and sines, (2, points, classes)."""
        return self.classes.patterns(np.array([float(belt) for belt, _ in self._points]))

    @cached_property
    def _weights(self) -> FloatArray:
        """g_c/P, (classes,)."""
        number = np.arange(self.classes.classes)
        return np.where(2 * number % self.classes.count == 0, 1.0, 2.0) / self.classes.count

    def voltages(self, loops: Sequence[ElectrodeLoops], healthy: Sequence[ComplexArray]) -> list[ComplexArray]:
        """Return U_c and U'_c of all classes in patterns, (1 or 2, walls, patterns, nodes) each, from those with every belt alive."""
        if not self._points:
            return list(healthy)
        shares = [
            (share, one) for number, volts in enumerate(healthy) for share, one in zip(self._phases[..., number], volts, strict=False)
        ]
        each = [share[:, None] * np.moveaxis(self._local(one), 1, 2)[:, self._place] for share, one in shares]
        left: ComplexArray = np.asarray(np.sum(each, axis=0), dtype=np.complex128)
        between = self._between(loops)
        solved = np.linalg.solve(between, left.reshape(len(left), -1, 1))
        further: ComplexArray = np.asarray(-solved, dtype=np.complex128).reshape(left.shape)
        return [volts + self._moved(loops[number], number, further, len(volts)) for number, volts in enumerate(healthy)]

    def _moved(self, loops: ElectrodeLoops, number: int, further: ComplexArray, along: int) -> ComplexArray:
        """Return what voltages e on the points, (batch, points, walls), add to a class."""
        found = []
        for share in self._weights[number] * self._phases[:along, :, number]:
            held = np.zeros((len(further), further.shape[2], len(self._segments)), np.complex128)
            for point, place in enumerate(self._place):
                held[:, :, place] += share[point] * further[:, point]
            found.append(loops.given(self._spread(held, loops.law.shape)))
        return np.stack(found)

    def determinants(self, loops: Sequence[ElectrodeLoops]) -> ComplexArray:
        """Return |G| on what is dead, (patterns or 1, nodes)."""
        nodes = loops[0].law.shape[-1]
        if not self._points:
            return np.ones((1, nodes), np.complex128)
        return np.asarray(np.linalg.det(self._between(loops)).reshape(-1, nodes))

    def _between(self, loops: Sequence[ElectrodeLoops]) -> ComplexArray:
        """Return G on the points, (batch, n, n), n points times walls."""
        belts, place = np.array([float(belt) for belt, _ in self._points]), self._place
        turn = 2.0 * np.pi / self.classes.count * np.arange(self.classes.classes)
        apart = np.cos(np.multiply.outer(np.subtract.outer(belts, belts), turn))
        size = len(place) * len(loops[0].law)
        found = np.zeros((1, size, size), np.complex128)
        for number, one in enumerate(loops):
            answer = np.moveaxis(self._answer(one)[:, :, place][..., place], (2, 4), (1, 3))  # (batch, points, walls, points, walls)
            share = (self._weights[number] * apart[..., number])[:, None, :, None]
            found = found + (share * answer).reshape(len(answer), size, size)
        return found

    def _answer(self, loops: ElectrodeLoops) -> ComplexArray:
        """Return (1 - H K C_c)^-1 between segments with those dead in every belt at ground: (batch, walls, segments, walls, segments)."""
        inverse = loops.inverse
        if self._by_pattern:
            walls = inverse.shape[-1]
            return inverse.reshape(-1, walls, 1, walls, 1)
        some, dead = self._segments, list(self.patterns.dead)
        whole = loops.between([*some, *dead], inverse)
        own, rest = slice(len(some)), slice(len(some), None)
        found = whole[:, :, own, :, own]
        if dead:
            size = whole.shape[1] * len(dead)
            back = whole[:, :, rest][..., own].reshape(len(whole), size, -1)
            held = np.linalg.solve(whole[:, :, rest][..., rest].reshape(len(whole), size, size), back)
            ahead = whole[:, :, own][..., rest].reshape(len(whole), -1, size)
            found = found - (ahead @ held).reshape(found.shape)
        return np.asarray(found)

    def _local(self, volts: ComplexArray) -> ComplexArray:
        """Return voltages in patterns, (walls, patterns, nodes), on the segments: (batch, walls, segments)."""
        if self._by_pattern:
            return np.moveaxis(volts, 0, -1).reshape(-1, len(volts), 1)
        return np.asarray(np.einsum("dq,iqk->kid", self.patterns.evaluate[self._segments], volts))

    def _spread(self, volts: ComplexArray, shape: tuple[int, ...]) -> ComplexArray:
        """Return voltages on the segments, (batch, walls, segments), in patterns: *shape*, (walls, patterns, nodes)."""
        if self._by_pattern:
            return np.ascontiguousarray(np.moveaxis(volts.reshape(*shape[1:], shape[0]), -1, 0))
        return np.asarray(np.einsum("qd,kid->iqk", self.patterns.project[:, self._segments], volts))
