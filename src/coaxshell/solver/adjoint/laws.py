"""Laws of links backwards: what lambda becomes through what they remember, and what each of their numbers changes.

With small changes of the stretch after and before a step and of what a law remembers, dh = h_1 dD_1 + h_0 dD_0 + h_s ds and
ds_1 = a_1 dD_1 + a_0 dD_0 + a_s ds, the transpose runs from the last step to the first: alpha of the variables after step n,

    alpha_n = h_s lambda_{n+1} + a_s^T alpha_{n+1},
    y_n = h_1 lambda_n + a_1^T alpha_n + [h_0 lambda + a_0^T alpha]_{n+1},        psi_n = psi_{n+1} + dt y_n,

for D_n = D_{n-1} + dt r_n: y is what a stretch at an instant changes, psi what the rate over a step does. A number p of a law changes
sum_n lambda_n dh_n/dp + alpha_n ds_n/dp.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from coaxshell.errors import InputError
from coaxshell.numerics.arrays import FloatArray
from coaxshell.solver.adjoint.backward import Forces
from coaxshell.solver.interface.absorbers import AbsorberSet
from coaxshell.solver.links.described import Element, LawGroup, grouped
from coaxshell.solver.links.law import LawSlopes, LinkLaw

_STEP = 1e-6
"""Relative step by which a law, evaluated along what it did, is differenced by a number of its own."""
_PROPORTIONAL = frozenset({"spring and damper", "polynomial", "inerter"})
"""Kinds whose force is a sum of their numbers, each times something."""


def all_elements(absorbers: AbsorberSet) -> list[tuple[Element, ...]]:
    """Return the elements of each of 2N links, the absorbers' own damper and springs first: (k, c), then (0, 0, k_nl), if it is there."""
    assert absorbers.elements is not None
    own = zip(*(np.tile(x, 2).tolist() for x in (absorbers.linear, absorbers.damping, absorbers.cubic)), strict=True)
    return [
        (Element("spring and damper", (k, c)), Element("polynomial", (0.0, 0.0, cubic)), *more) if there else ()
        for (k, c, cubic), more, there in zip(own, absorbers.elements.elements, absorbers.elements.present, strict=True)
    ]


class _Tape:
    """One law along a march: its states before the steps, and its slopes at them.

    Parameters
    ----------
    group : LawGroup
    stretch : ndarray, shape (T, n)
    time_step : float
    """

    def __init__(self, group: LawGroup, stretch: FloatArray, time_step: float) -> None:
        self.group, self.stretch, self._step = group, stretch, time_step
        law = group.made(time_step)
        steps, n = stretch.shape
        self.states = np.zeros((steps, law.variables, n))
        for k in range(1, steps - 1) if law.variables else ():
            self.states[k + 1] = law.advance(stretch[k], stretch[k - 1], self.states[k])
        parts = [law.slopes(stretch[k], stretch[k - 1], self.states[k]) for k in range(1, steps)]
        self.slopes: list[LawSlopes | None] = [None, *parts]
        self.alpha = np.zeros((steps, law.variables, n))

    def by_number(self, law: FloatArray) -> list[FloatArray]:
        """Return what each number of the elements changes, in their order, of every link of the group, from lambda (T, n)."""
        sizes = [len(one.numbers) + 2 * len(one.corners) for one in self.group.elements]
        found = [np.zeros(size) for size in sizes]
        for number in range(max(sizes)):
            change = self._changed(number, law)
            for k, size in enumerate(sizes):
                if number < size:
                    found[k][number] = change[k]
        return found

    def _changed(self, number: int, law: FloatArray) -> FloatArray:
        """Return what one number changes, for every element that has it; what is differenced are forces and states along the march."""
        ends: list[LinkLaw] = []
        at = np.array([_number(one, number) for one in self.group.elements])
        if self.group.kind in _PROPORTIONAL:
            steps = np.ones_like(at)
            ends.append(self._law([_only(one, number) for one in self.group.elements]))
        else:
            steps = _STEP * np.where(at != 0.0, np.abs(at), float(np.abs(self.stretch).max()) or 1.0)
            for sign in (1.0, -1.0):
                moved = [_moved(one, number, sign * step) for one, step in zip(self.group.elements, steps, strict=True)]
                ends.append(self._law(moved))
            steps = 2.0 * steps
        total = np.zeros(len(at))
        for end, sign in zip(ends, (1.0, -1.0), strict=False):
            for k in range(1, len(law)):
                after, before, state = self.stretch[k], self.stretch[k - 1], self.states[k]
                total += sign * law[k] * end.force(after, before, state).value
                if end.variables and self.group.kind not in _PROPORTIONAL:
                    total += sign * (self.alpha[k] * end.advance(after, before, state)).sum(axis=0)
        return np.asarray(total / steps)

    def _law(self, elements: list[Element]) -> LinkLaw:
        return LawGroup(self.group.kind, self.group.links, elements).made(self._step)


def _number(one: Element, number: int) -> float:
    if number < len(one.numbers):
        return one.numbers[number]
    corner, which = divmod(number - len(one.numbers), 2)
    return one.corners[corner][which] if corner < len(one.corners) else 0.0


def _moved(one: Element, number: int, by: float) -> Element:
    """Return an element with one of its numbers moved: of corners d and k count, not the direction."""
    if number < len(one.numbers):
        return one._replace(numbers=tuple(x + by * (j == number) for j, x in enumerate(one.numbers)))
    corner, which = divmod(number - len(one.numbers), 2)
    corners = [list(each) for each in one.corners]
    if corner < len(corners):
        corners[corner][which] += by
    return one._replace(corners=tuple((d, k, sign) for d, k, sign in corners))


def _only(one: Element, number: int) -> Element:
    return one._replace(numbers=tuple(float(j == number) for j in range(len(one.numbers))))


@dataclass(frozen=True)
class ElementSensitivity:
    """What a number changes by with the numbers of the elements of 2N links: of each link, of each element, an array."""

    elements: Sequence[Sequence[FloatArray]]

    def change(self, before: Sequence[Sequence[Element]], after: Sequence[Sequence[Element]]) -> FloatArray:
        """Return what small changes of the elements change, of every link, shape (2N,).

        Raises
        ------
        InputError
            If laws are of another kind, or a table has other corners.
        """
        total = np.zeros(len(self.elements))
        for link, (bars, first, second) in enumerate(zip(self.elements, before, after, strict=True)):
            for bar, one, other in zip(bars, first, second, strict=True):
                if one.kind != other.kind or len(one.corners) != len(other.corners) or len(one.numbers) != len(other.numbers):
                    raise InputError("absorbers", "change the kind of a law, which has no gradient", "vary its numbers")
                old, new = ([*x.numbers, *(value for d, k, _ in x.corners for value in (d, k))] for x in (one, other))
                total[link] += float(bar[: len(old)] @ (np.array(new) - np.array(old)))
        return total


class AnyBackwards:
    """The laws of all links from the last step to the first (:class:`coaxshell.solver.adjoint.backward.LawsBackwards`).

    Parameters
    ----------
    absorbers : AbsorberSet
        Whose links have laws.
    stretch : ndarray, shape (2N, T)
        D at the instants.
    time_step : float

    Raises
    ------
    InputError
        If dry friction is exact, which has no slopes.
    """

    def __init__(self, absorbers: AbsorberSet, stretch: FloatArray, time_step: float) -> None:
        self._step, self._every = time_step, all_elements(absorbers)
        groups = grouped(self._every)
        if any(one.kind == "dry friction" for one in groups):
            problem = "exact dry friction sticks or slides, which has no gradient"
            raise InputError("absorbers.law", problem, "give it a speed, which smooths it, or a stiffness")
        self._tapes = [_Tape(one, np.ascontiguousarray(stretch[one.links].T), time_step) for one in groups]
        self._number, self._psi = stretch.shape[1] - 1, np.zeros(stretch.shape[0])
        self.stretch_slope = np.zeros((stretch.shape[1], stretch.shape[0]))
        """y at every instant."""
        self._law = np.zeros_like(self.stretch_slope)

    def forces(self) -> Forces:
        """Return psi of the next step backwards."""
        n = self._number
        known, rise = np.zeros((2, self._psi.size))
        for tape in self._tapes:
            here, links = tape.slopes[n], tape.group.links
            assert here is not None
            if n + 1 < len(tape.slopes):
                later = tape.slopes[n + 1]
                assert later is not None
                law, alpha = self._law[n + 1, links], tape.alpha[n + 1]
                tape.alpha[n] = later.state * law + (later.state_state * alpha[:, None]).sum(axis=0)
                known[links] += later.before * law + (later.state_before * alpha).sum(axis=0)
            known[links] += (here.state_after * tape.alpha[n]).sum(axis=0)
            rise[links] += here.after
        self._known, self._rise = known, rise
        self._ahead = self._psi + self._step * known
        return Forces(self._ahead, self._step * rise)

    def take(self, law: FloatArray) -> None:
        """Go on with lambda of that step."""
        n = self._number
        self._law[n] = law
        self.stretch_slope[n] = self._known + self._rise * law
        self._psi = self._ahead + self._step * self._rise * law
        self._number = n - 1

    @cached_property
    def sensitivity(self) -> ElementSensitivity:
        """What the numbers of the elements change, once all steps are taken."""
        found: list[list[FloatArray]] = [[] for _ in self._every]
        by_kind: dict[tuple[int, str], list[FloatArray]] = {}
        for tape in self._tapes:
            bars = tape.by_number(np.ascontiguousarray(self._law[:, tape.group.links]))
            for link, bar in zip(tape.group.links.tolist(), bars, strict=True):
                by_kind.setdefault((link, tape.group.kind), []).append(bar)
        for link, several in enumerate(self._every):
            taken: dict[str, int] = {}
            for one in several:
                found[link].append(by_kind[link, one.kind][taken.get(one.kind, 0)])
                taken[one.kind] = taken.get(one.kind, 0) + 1
        return ElementSensitivity(found)
