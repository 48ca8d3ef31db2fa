"""Sums over the orders of what surfaces yield under pressures on them, from as few orders as tell all of them.

The trapezoidal rule at a third of a step has two thirds of its nodes far above all resonances along the walls and around the fluids. There
a tenth to a half of the orders tell what all do (:mod:`coaxshell.numerics.order_samples`), and a sum over all is one over these with other
weights. At each node orders are added until those before foretell them; where feedback chooses among orders all are solved.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cached_property

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray, real_product
from coaxshell.numerics.modes import Modes
from coaxshell.numerics.order_samples import SampleRound, sample_rounds
from coaxshell.solver.scaling import Problem

Pair = tuple[int, int]
"""Numbers of a surface and of one that is pressed on."""

Compliance = Callable[[Problem, ComplexArray, Modes], ComplexArray]
"""Displacement of every surface per pressure on every other, (surfaces, surfaces, orders, nodes)."""

_ABOVE = 3.5
"""Times the highest frequency at which any order stretches along a wall, from where fewer orders than all are tried."""


class ComplianceSums:
    """Sums over orders 0 to M of the plane problem, for some pairs of surfaces.

    Parameters
    ----------
    problem : Problem
        Its walls resolve the waves of the nodes.
    modes : Modes
    shares : dict of (int, int) to ndarray, shape (rows, M + 1)
        Weights of the orders, of each pair.
    compliance : callable
        Solves for some of the orders at a block of nodes.
    """

    def __init__(self, problem: Problem, modes: Modes, shares: Mapping[Pair, FloatArray], compliance: Compliance) -> None:
        self._problem, self._modes, self._shares, self._compliance = problem, modes, shares, compliance
        free = all(wall.gains is None and not wall.shows_control for wall in problem.shells)
        whole = modes.two_dimensional and np.array_equal(modes.orders, np.arange(modes.count))
        self._rounds = sample_rounds(modes) if free and whole else []
        self._folded = [{pair: rows @ one.spread for pair, rows in shares.items()} for one in self._rounds]

    @cached_property
    def _lowest(self) -> float:
        """Frequency from which fewer orders are tried."""
        if len(self._rounds) < 2:
            return np.inf
        return _ABOVE * max(float(wall.highest_frequency(self._modes).max(initial=0.0)) for wall in self._problem.shells)

    def prepare(self, s: ComplexArray) -> None:
        """Make what all blocks of nodes share, before all threads ask for it; *s* are all nodes."""
        samples = [] if np.abs(s).max() < self._lowest else [one.added for one in self._rounds]
        for modes in (self._modes, *samples):
            for wall in self._problem.shells:
                wall.receptance(modes, s[-1:])

    def at(self, s: ComplexArray) -> dict[Pair, ComplexArray]:
        """Return the sums at a block of nodes, each (rows, nodes)."""
        if float(np.abs(s).min()) < self._lowest:
            values = self._compliance(self._problem, s, self._modes)
            return {pair: real_product(rows, values[pair]) for pair, rows in self._shares.items()}
        found = {pair: np.empty((len(rows), s.size), np.complex128) for pair, rows in self._shares.items()}
        left, known = np.arange(s.size), None
        for one, folded in zip(self._rounds, self._folded, strict=True):
            new = self._compliance(self._problem, s[left], one.added)
            known = new if known is None else np.concatenate([known, new], axis=2)
            told = self._told(one, known)
            for pair, rows in folded.items():
                found[pair][:, left[told]] = real_product(rows, known[pair][:, told])
            left, known = left[~told], known[..., ~told]
            if not left.size:
                break
        return found

    def _told(self, one: SampleRound, known: ComplexArray) -> np.ndarray[tuple[int, ...], np.dtype[np.bool_]]:
        return one.tells(np.stack([known[pair] for pair in self._shares]))
