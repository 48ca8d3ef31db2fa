"""All laws of the links of a system together, and what they remember from step to step."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.solver.links.friction import Sliders
from coaxshell.solver.links.law import LinkLaw, StepForce, Truths


class LawState(NamedTuple):
    """What the laws of all links remember between two steps.

    Attributes
    ----------
    stretch : ndarray, shape (links,)
        D at the end of the last step.
    internal : tuple of ndarray
        Internal variables of each law, (variables, n).
    stuck : ndarray, shape (sliders,)
        1 where nothing slipped over the last step, else 0.
    friction : ndarray, shape (sliders,)
        Of the sliders over the last step.
    """

    stretch: FloatArray
    internal: tuple[FloatArray, ...]
    stuck: FloatArray
    friction: FloatArray


@dataclass(frozen=True)
class LinkLaws:
    """The laws of some links, which add up where a link has several.

    Attributes
    ----------
    count : int
        Links.
    laws : sequence of LinkLaw
    sliders : Sliders or None
    """

    count: int
    laws: Sequence[LinkLaw]
    sliders: Sliders | None = None

    def at_rest(self) -> LawState:
        """Return the state before the first step."""
        stuck = np.ones(0 if self.sliders is None else self.sliders.links.size)
        internal = tuple(np.zeros((law.variables, law.links.size)) for law in self.laws)
        return LawState(np.zeros(self.count), internal, stuck, np.zeros_like(stuck))

    def force(self, after: FloatArray, state: LawState) -> StepForce:
        """Return the force of every link over a step that ends at the stretches *after*, sliders left out, and its slope, each (links,)."""
        value, slope = np.zeros((2, self.count))
        for law, internal in zip(self.laws, state.internal, strict=True):
            one = law.force(after[law.links], state.stretch[law.links], internal)
            value[law.links] += one.value
            slope[law.links] += one.slope
        return StepForce(value, slope)

    def bounds(self, state: LawState) -> tuple[FloatArray, FloatArray]:
        """Return the least and the largest friction of every link over the next step, 0 where it has no slider, each (links,)."""
        low, high = np.zeros((2, self.count))
        if self.sliders is not None:
            low[self.sliders.links], high[self.sliders.links] = self.sliders.bounds(state.stuck, state.friction)
        return low, high

    def advance(self, after: FloatArray, slips: Truths, friction: FloatArray, state: LawState) -> LawState:
        """Return the state after a step.

        Parameters
        ----------
        after : ndarray, shape (links,)
            D_1.
        slips : ndarray of bool, shape (links,)
            Where sliders slip over the step.
        friction : ndarray, shape (links,)
            Over the step.
        state : LawState
        """
        internal = tuple(
            law.advance(after[law.links], state.stretch[law.links], one) for law, one in zip(self.laws, state.internal, strict=True)
        )
        if self.sliders is None:
            return LawState(after, internal, state.stuck, state.friction)
        sliding = self.sliders.links
        return LawState(after, internal, np.where(slips[sliding], 0.0, 1.0), friction[sliding])

    def stored(self, state: LawState) -> FloatArray:
        """Return the energy of every link, (links,)."""
        energy = np.zeros(self.count)
        for law, internal in zip(self.laws, state.internal, strict=True):
            energy[law.links] += law.stored(state.stretch[law.links], internal)
        return energy
