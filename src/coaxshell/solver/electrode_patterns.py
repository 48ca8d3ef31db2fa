"""In what terms the voltages on electrodes are independent loops: orders where electrodes vary freely, patterns where they are cut.

A pattern q of voltages is pushed by and reads orders alone: u_m = L_mq u_q and phi_q = R_qm phi_m (:mod:`coaxshell.structure.segments`);
where nothing is cut both are 1. On points around the circle, or on the segments, patterns are sums that limits cut.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.modes import Modes
from coaxshell.solver.interface.saturation import circle
from coaxshell.solver.scaling import Problem
from coaxshell.structure.segments import Segments


class Patterns(ABC):
    """Patterns of the voltages of all walls under control."""

    @property
    @abstractmethod
    def numbers(self) -> Modes:
        """The order by which the law weighs each pattern."""

    @abstractmethod
    def responses(self, read: ComplexArray) -> ComplexArray:
        """Return C_q, what patterns read per volt of themselves, (walls, walls, patterns, nodes), from that of orders."""

    @abstractmethod
    def readings(self, phi: ComplexArray) -> ComplexArray:
        """Return phi_q, (walls, patterns, nodes), from orders (walls, parities, orders, nodes); parities that are missing are 0."""

    @abstractmethod
    def in_orders(self, voltage: ComplexArray) -> ComplexArray:
        """Return u_m, (walls, parities, orders, nodes), of voltages in patterns (walls, patterns, nodes)."""

    @property
    @abstractmethod
    def evaluate(self) -> FloatArray:
        """Values at the points, (points, patterns)."""

    @property
    @abstractmethod
    def project(self) -> FloatArray:
        """Patterns of values at the points, (patterns, points)."""

    @property
    def dead(self) -> tuple[int, ...]:
        """Points that are held at ground."""
        return ()

    @property
    def cut(self) -> bool:
        """Whether points are segments."""
        return False


@dataclass(frozen=True, eq=False)
class CutPatterns(Patterns):
    """Patterns cos q theta_k and sin q theta_k of equal segments.

    Attributes
    ----------
    walls : tuple of Segments
        Of each wall under control; all of one number, at the same angles.
    orders : ndarray, shape (orders,)
    parities : int
    """

    walls: tuple[Segments, ...]
    orders: FloatArray
    parities: int

    @cached_property
    def numbers(self) -> Modes:
        """q."""
        return Modes(self.walls[0].numbers(self.parities))

    @cached_property
    def _read(self) -> list[FloatArray]:
        return [one.readings(self.orders, self.parities) for one in self.walls]

    @cached_property
    def _push(self) -> list[FloatArray]:
        return [one.loads(self.orders, self.parities) for one in self.walls]

    @cached_property
    def _shares(self) -> list[list[FloatArray]]:
        return [[np.einsum("qhm,hmq->qm", read, push) for push in self._push] for read in self._read]

    def responses(self, read: ComplexArray) -> ComplexArray:
        """Return the sum of R_qm L_mq C_m."""
        return np.stack([np.stack([share @ one for share, one in zip(*row, strict=True)]) for row in zip(self._shares, read, strict=True)])

    def readings(self, phi: ComplexArray) -> ComplexArray:
        """Return the sum of R_qm phi_m."""
        return np.stack([np.einsum("qhm,hmk->qk", one[:, : len(wall)], wall) for one, wall in zip(self._read, phi, strict=True)])

    def in_orders(self, voltage: ComplexArray) -> ComplexArray:
        """Return the sum of L_mq u_q."""
        return np.stack([np.einsum("hmq,qk->hmk", one, wall) for one, wall in zip(self._push, voltage, strict=True)])

    @cached_property
    def evaluate(self) -> FloatArray:
        """Values on the segments."""
        return self.walls[0].patterns(self.parities)

    @cached_property
    def project(self) -> FloatArray:
        """Patterns of values on the segments."""
        return self.walls[0].amplitudes(self.parities)

    @property
    def dead(self) -> tuple[int, ...]:
        """Dead segments."""
        return self.walls[0].dead

    @property
    def cut(self) -> bool:
        """True."""
        return True


@dataclass(frozen=True, eq=False)
class OrderPatterns(Patterns):
    """Orders themselves, cosines first, then sines.

    Attributes
    ----------
    orders : ndarray, shape (orders,)
        0 to M.
    parities : int
    """

    orders: FloatArray
    parities: int

    @cached_property
    def numbers(self) -> Modes:
        """m."""
        return Modes(np.tile(self.orders, self.parities))

    def responses(self, read: ComplexArray) -> ComplexArray:
        """Return C_m, for each parity."""
        return np.concatenate([read] * self.parities, axis=2)

    def readings(self, phi: ComplexArray) -> ComplexArray:
        """Return phi_m."""
        flat = phi.reshape(len(phi), -1, phi.shape[-1])
        missing = self.numbers.count - flat.shape[1]
        return np.concatenate([flat, np.zeros((len(flat), missing, flat.shape[2]))], axis=1) if missing else flat

    def in_orders(self, voltage: ComplexArray) -> ComplexArray:
        """Return u_m."""
        return voltage.reshape(len(voltage), self.parities, self.orders.size, -1)

    @cached_property
    def _circle(self) -> tuple[FloatArray, FloatArray]:
        return circle(self.orders.size, self.parities)

    @property
    def evaluate(self) -> FloatArray:
        """Values at points of a circle."""
        return self._circle[0]

    @property
    def project(self) -> FloatArray:
        """Orders of values there."""
        return self._circle[1]


def segments_of(problem: Problem, shells: tuple[int, ...]) -> tuple[Segments, ...]:
    """Return the segments of walls under control; none where nothing is cut."""
    each = (problem.shells[i].electrode_segments for i in shells)
    return tuple(one for one in each if one is not None)


def patterns_of(problem: Problem, shells: tuple[int, ...], orders: FloatArray, parities: int) -> Patterns:
    """Return the patterns of the voltages of some walls; dead segments excite both parities."""
    cut = segments_of(problem, shells)
    if not cut:
        return OrderPatterns(orders, parities)
    return CutPatterns(cut, orders, 2 if uneven(problem, shells) else parities)


def uneven(problem: Problem, shells: tuple[int, ...]) -> bool:
    """Return whether segments of some walls are dead, in every belt or in one, which excites both parities."""
    cut = segments_of(problem, shells)
    single = problem.belts is not None and bool(problem.belts.dead_electrodes)
    return bool(cut) and (bool(cut[0].dead) or single)
