"""All laws of the links of a system together, and what they remember from step to step."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.solver.links.law import LinkLaw


class LawState(NamedTuple):
    """What the laws of all links remember between two steps.

    Attributes
    ----------
    stretch : ndarray, shape (links,)
        D at the end of the last step.
    internal : tuple of ndarray
        Internal variables of each law, (variables, n).
    """

    stretch: FloatArray
    internal: tuple[FloatArray, ...]


class LinkForces(NamedTuple):
    """Forces of links over a step, their slopes in D_1, and the springs' share in these; each (links,)."""

    value: FloatArray
    slope: FloatArray
    elastic: FloatArray


@dataclass(frozen=True)
class LinkLaws:
    """The laws of some links, which add up where a link has several.

    Attributes
    ----------
    count : int
        Links.
    laws : sequence of LinkLaw
        None of them holds a link twice.
    """

    count: int
    laws: Sequence[LinkLaw]

    def at_rest(self) -> LawState:
        """Return the state before the first step."""
        return LawState(np.zeros(self.count), tuple(np.zeros((law.variables, law.links.size)) for law in self.laws))

    def force(self, after: FloatArray, state: LawState) -> LinkForces:
        """Return the forces of all links over a step that ends at the stretches *after*, (links,)."""
        value, slope, elastic = np.zeros((3, self.count))
        for law, internal in zip(self.laws, state.internal, strict=True):
            one = law.force(after[law.links], state.stretch[law.links], internal)
            value[law.links] += one.value
            slope[law.links] += one.slope
            if law.swings:
                elastic[law.links] += one.slope
        return LinkForces(value, slope, elastic)

    def advance(self, after: FloatArray, state: LawState) -> LawState:
        """Return the state after a step that ends at the stretches *after*, (links,)."""
        pairs = zip(self.laws, state.internal, strict=True)
        return LawState(after, tuple(law.advance(after[law.links], state.stretch[law.links], internal) for law, internal in pairs))

    def stored(self, state: LawState) -> FloatArray:
        """Return the energy of every link, (links,)."""
        energy = np.zeros(self.count)
        for law, internal in zip(self.laws, state.internal, strict=True):
            energy[law.links] += law.stored(state.stretch[law.links], internal)
        return energy
