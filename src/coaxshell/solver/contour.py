"""The contour along which poles are counted, and how far a determinant turns along it.

Re s = sigma_0 is walked at an even step as far as each order resonates, then by a growing one to where feedback fades. Bands in which
feedback takes energy alone (:mod:`coaxshell.solver.taking_bands`) are left out: what the determinant turns by in one is the difference of
the argument, followed as the gain grows from 0, between its ends.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.modes import Modes
from coaxshell.numerics.winding import turning
from coaxshell.solver.scaling import Problem

_MAX_NODES = 8192
SPACING = 0.8
"""Node spacing over sigma_0: the phase of a pole on the imaginary axis turns by less than a radian between nodes."""
_BLOCK = 512
_HALVINGS = 8
"""Times that the distance of nodes is halved where the ratio turns by more than SPACING radians, beyond the resonances."""


def highest_frequency(problem: Problem, max_order: int, wavenumber: float | ComplexArray = 0.0) -> float:
    """Return a power of two above which feedback is less than half of every controlled shell's inertia."""
    highest = max(1.0, *(wall.feedback_frequency(Modes.up_to(max_order, wavenumber)) for wall in problem.shells))
    return float(2.0 ** np.ceil(np.log2(highest)))  # the same for gains that differ little, whose nodes can be shared


def along_alone(problem: Problem, modes: Modes) -> Problem:
    """Return the problem whose elastic walls bend and stretch along themselves alone, each order as fast as it resonates.

    Voltages find no inertia in motions through the thickness (:func:`coaxshell.structure.solid_transducers.along_wall`).
    """
    if not problem.two_faced:
        return problem
    first = Modes(np.ones(1), modes.wavenumber)  # all low orders breathe as fast as order 1 stretches
    highest = ((modes.orders, 1.1 * np.hypot(wall.highest_frequency(modes), wall.highest_frequency(first))) for wall in problem.shells)
    return replace(problem, shells=tuple(wall.along_alone(np.stack(own)) for wall, own in zip(problem.shells, highest, strict=True)))


class Contour(NamedTuple):
    """Where Re s = shift is walked: at an even step as far as each order resonates, then by a growing one to where feedback fades."""

    shift: float
    even: FloatArray
    limits: FloatArray
    fades: float
    delay: float

    @classmethod
    def of(cls, problem: Problem, modes: Modes, least: float) -> Contour:
        """Return it for some orders; the shift is the *least* growth that counts, or more where as many nodes cannot tell it from none."""
        first = Modes(np.ones(1), modes.wavenumber)  # all low orders breathe as fast as order 1 stretches
        limits = np.stack([1.2 * np.hypot(wall.highest_frequency(modes), wall.highest_frequency(first)) for wall in problem.shells])
        limits = limits.max(axis=0)
        shift = max(least, float(limits.max()) / (SPACING * _MAX_NODES))
        even = np.arange(0.0, limits.max() + SPACING * shift, SPACING * shift)
        delay = max((wall.gains.delay for wall in problem.shells if wall.gains is not None), default=0.0)
        return cls(shift, even, limits, highest_frequency(problem, modes.max_order, modes.wavenumber), delay)

    @property
    def nodes(self) -> ComplexArray:
        """All nodes, ascending, an even step as far as any order resonates."""
        return np.concatenate([self.shift + 1j * self.even[:-1], self.beyond(float(self.even[-1]))])

    def beyond(self, *starts: float) -> ComplexArray:
        """Return the nodes from the lowest of some frequencies, all among them, to where feedback fades; a delay turns it in 2 pi/delay."""
        last = max(self.fades, 1.02 * max(starts))
        nodes = np.union1d(starts, np.geomspace(min(starts), last, 200)[1:])
        if self.delay > 0.0:
            nodes = np.union1d(nodes, np.arange(min(starts), last, SPACING / self.delay))
        return np.asarray(self.shift + 1j * nodes, dtype=np.complex128)


def fed_orders(problem: Problem, modes: Modes) -> FloatArray:
    """Return the orders that some law weighs at all: of any other D_m is D0_m."""
    weights = [wall.gains.weight(modes.orders) for wall in problem.shells if wall.gains is not None]
    return modes.orders[np.any([np.broadcast_to(one, modes.count) != 0.0 for one in weights], axis=0)]


def few_of(modes: Modes, orders: FloatArray) -> Modes:
    """Return some of the orders of modes."""
    return modes if orders.size == modes.count else Modes(orders, modes.wavenumber, modes.sparse or 2 * orders.size < modes.count)


@dataclass(frozen=True)
class Bands:
    """Closed intervals of frequency, ascending, each longer than a few even steps of the contour that they are on.

    Attributes
    ----------
    lows, highs : ndarray, shape (bands,)
    """

    lows: FloatArray
    highs: FloatArray

    def hold(self, one: FloatArray, other: FloatArray) -> npt.NDArray[np.bool_]:
        """Return whether one band holds all from one frequency to another, ascending, for each pair."""
        if not self.lows.size:
            return np.zeros(np.shape(one), dtype=np.bool_)
        place = np.searchsorted(self.lows, one, side="right") - 1
        return np.asarray((place >= 0) & (other <= self.highs[np.maximum(place, 0)]))

    def hold_all(self, contour: Contour) -> bool:
        """Return whether they hold all of a contour."""
        return bool(self.hold(np.zeros(1), contour.nodes[-1:].imag)[0])

    def between(self, nodes: ComplexArray) -> npt.NDArray[np.bool_]:
        """Return whether one band holds all between each of some ascending nodes and the next."""
        return self.hold(nodes.imag[:-1], nodes.imag[1:])

    def left(self, frequency: FloatArray) -> list[FloatArray]:
        """Return the runs of ascending frequencies between which no band holds all."""
        kept = np.concatenate([[False], ~self.hold(frequency[:-1], frequency[1:]), [False]])
        turns = np.flatnonzero(np.diff(kept.astype(int)))
        return [frequency[start : end + 1] for start, end in zip(turns[::2], turns[1::2], strict=True)]


NOWHERE = Bands(np.zeros(0), np.zeros(0))
RatioAt = Callable[[ComplexArray, Modes], ComplexArray]
"""Of nodes and modes D_m/D0_m, shape (orders, nodes)."""


class Walk:
    """A walk along a contour on which D_m/D0_m of some orders is followed.

    Parameters
    ----------
    contour : Contour
    modes : Modes
    ratio_at : callable
    bands : Bands
        What is left out.
    angle_at : callable
        Of nodes in bands and modes, the argument of D_m/D0_m as it is followed from a gain of 0, shape (orders, nodes).

    Attributes
    ----------
    turns : ndarray, shape (orders,)
        By how much each order has turned.
    nearest : float
        The least |D_m/D0_m| met.
    """

    def __init__(self, contour: Contour, modes: Modes, ratio_at: RatioAt, bands: Bands, angle_at: Callable[..., FloatArray]) -> None:
        self._contour, self._modes, self._ratio_at, self._bands, self._angle_at = contour, modes, ratio_at, bands, angle_at
        self.turns, self.nearest, self._reached = np.zeros(modes.count), np.inf, np.zeros(modes.count)

    def evenly(self, limits: FloatArray, every: bool) -> None:
        """Walk as far as each order resonates at an even step; *every* order as far as any."""
        modes, left = self._modes, np.arange(self._modes.count)
        for run in self._bands.left(self._contour.even):
            ahead = limits[left] <= run[0]
            self._reached[left[ahead]] = run[0]
            left = left[~ahead]
            for start in range(0, run.size - 1, _BLOCK):
                if not left.size:
                    return
                block = np.asarray(self._contour.shift + 1j * run[start : start + _BLOCK + 1], dtype=np.complex128)
                some = modes if every else Modes(modes.orders[left], modes.wavenumber, modes.sparse)
                ratio = self._ratio_at(block, some)
                self.turns[left] += turning(ratio) + self._ends(block, some, start == 0, start + _BLOCK + 1 >= run.size)
                self.nearest = min(self.nearest, float(np.abs(ratio).min()))
                self._reached[left] = block[-1].imag
                left = left[limits[left] > block[-1].imag]
        self._reached[left] = self._contour.even[-1]

    def _ends(self, block: ComplexArray, modes: Modes, begins: bool, ends: bool) -> FloatArray | float:
        """Return what a band turns by before a block that begins a run of nodes, from where its own began, and after one that ends it."""
        asked = [-1] * ends + [0] * begins
        places = [place for place in asked if self._bands.hold(block[[place]].imag, block[[place]].imag)[0]]
        if not places:
            return 0.0
        return np.asarray(self._angle_at(block[places], modes) @ np.array([1.0 if place == 0 else -1.0 for place in places]))

    def beyond(self) -> None:
        """Walk on to where feedback fades, closer where the ratio turns fast: a pole of strong feedback may lie there, close by."""
        ends = np.unique(self._reached)
        runs = self._bands.left(self._contour.beyond(*ends.tolist()).imag)
        if not runs:
            return
        nodes = np.asarray(self._contour.shift + 1j * np.unique(np.concatenate(runs)), dtype=np.complex128)
        ratio = self._ratio_at(nodes, self._modes)
        for _ in range(_HALVINGS):
            turns_on = (np.abs(np.angle(ratio[:, 1:] / ratio[:, :-1])) > SPACING) & (nodes.imag[:-1] >= self._reached[:, None])
            quick = turns_on.any(axis=0) & ~self._bands.between(nodes)  # of orders whose even nodes end there
            if not quick.any():
                break
            between = 0.5 * (nodes[1:] + nodes[:-1])[quick]
            nodes, ratio = np.append(nodes, between), np.append(ratio, self._ratio_at(between, self._modes), axis=1)
            ascending = np.argsort(nodes.imag)
            nodes, ratio = nodes[ascending], ratio[:, ascending]
        self.nearest = min(self.nearest, float(np.abs(ratio).min()))
        self._beyond(nodes, ratio, ends)

    def _beyond(self, nodes: ComplexArray, ratio: ComplexArray, ends: FloatArray) -> None:
        """Add what each order turns by from where its even nodes end."""
        for end in ends:
            rows, start = np.flatnonzero(self._reached == end), int(np.searchsorted(nodes.imag, end))
            if start < nodes.size:
                some = partial(self._rows_of_angle, rows)
                self.turns[rows] += turned_outside(nodes[start:], ratio[rows, start:], self._bands, some)

    def _rows_of_angle(self, rows: npt.NDArray[np.int_], nodes: ComplexArray) -> FloatArray:
        return self._angle_at(nodes, self._modes)[rows]


def turned_outside(nodes: ComplexArray, ratio: ComplexArray, bands: Bands, angle_at: Callable[[ComplexArray], FloatArray]) -> FloatArray:
    """Return what D/D0 turns by from the first of some ascending nodes to where it is 1, far beyond the last one.

    Parameters
    ----------
    nodes : ndarray, shape (nodes,)
        Where one is the last before a band, the next one is the first after it; so are the first and the last of all.
    ratio : ndarray, shape (orders, nodes)
        D/D0.
    bands : Bands
    angle_at : callable
        Of nodes in bands, the argument as it is followed from no gain, shape (orders, nodes).
    """
    gaps, held = bands.between(nodes), bands.hold(nodes.imag, nodes.imag)
    starts, ends = np.append(True, gaps), np.append(gaps, True)
    signs = np.where(held, starts.astype(float) - ends, 0.0)
    borders = signs != 0.0
    turns = np.zeros(len(ratio))
    if borders.any():
        turns += angle_at(nodes[borders]) @ signs[borders]
    bounds = [0, *(np.flatnonzero(gaps) + 1), nodes.size]
    for one, other in pairwise(bounds):
        turns += turning(ratio[:, one:other])
    return turns if held[-1] else turns + np.angle(1.0 / ratio[:, -1])


def turned(
    problem: Problem,
    modes: Modes,
    contour: Contour,
    ratio_at: RatioAt,
    bands: Bands = NOWHERE,
    angle_at: Callable[[ComplexArray, Modes], FloatArray] = lambda *_: np.zeros((1, 1)),
) -> tuple[FloatArray, float]:
    """Return how far D_m/D0_m, given at nodes and orders, turns along a contour, of each order, and how near the nearest comes to 0.

    Where *bands* are left out ``angle_at`` gives the argument at nodes in them, as :class:`Walk` takes it; near is what is followed.
    """
    walk = Walk(contour, modes, ratio_at, bands, angle_at)
    faced = problem.two_faced  # shapes of all orders are made once
    walk.evenly(np.full(modes.count, contour.limits.max()) if faced else contour.limits, faced)
    walk.beyond()
    return walk.turns, walk.nearest
