"""From absorbers as they are described to the laws of their links, dimensionless."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple, cast

import numpy as np
import numpy.typing as npt

from coaxshell.model import laws as model
from coaxshell.model.absorbers import Absorber, PointAbsorber, linked_shells
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.solver.links.branches import Inerters, MaxwellBranches, SpringDampers
from coaxshell.solver.links.friction import DryFriction, HystereticFriction, SmoothedFriction
from coaxshell.solver.links.law import LinearLaw, LinkLaw, Links
from coaxshell.solver.links.laws import LinkLaws
from coaxshell.solver.links.springs import BrokenLines, Polynomials
from coaxshell.solver.links.stops import Stops


class LinkScales(NamedTuple):
    """SI value of one dimensionless stretch, force (of points N, of lines N/m) and time."""

    length: float
    force: float
    time: float


class Element(NamedTuple):
    """One law of one link: its kind, and its dimensionless numbers."""

    kind: str
    numbers: tuple[float, ...] = ()
    corners: tuple[tuple[float, float, float], ...] = ()
    """Of broken lines: (d, k, sigma) each."""


LINEAR = frozenset({"spring and damper", "maxwell", "inerter"})


@dataclass(frozen=True, eq=False)
class LinkElements:
    """What the links of N absorbers exert beside the common dampers and springs, where they are not all alike.

    Attributes
    ----------
    elements : tuple of tuple of Element
        Of each of the 2N links, inner sides first.
    present : ndarray of bool, shape (2N,)
        Which links there are.
    held : ndarray of bool, shape (2N,)
        Which of their shells move; the others' ends are held by a core.
    """

    elements: tuple[tuple[Element, ...], ...]
    present: npt.NDArray[np.bool_]
    held: npt.NDArray[np.bool_]

    @cached_property
    def is_linear(self) -> bool:
        """Whether all laws are linear."""
        return all(one.kind in LINEAR for link in self.elements for one in link)

    def linear(self) -> LinkElements:
        """Return what is linear of it."""
        return LinkElements(tuple(tuple(one for one in link if one.kind in LINEAR) for link in self.elements), self.present, self.held)

    def with_springs(self, stiffness: FloatArray, damping: FloatArray, cubic: npt.NDArray[np.bool_]) -> LinkElements:
        """Return springs and dampers, all of shape (2N,), in place of all laws of the links that have one that is not linear.

        ``cubic`` tells which links have a cubic spring besides.
        """
        found = []
        for link, k, c, bent, there in zip(self.elements, stiffness, damping, cubic, self.present, strict=True):
            nonlinear = there and (bent or any(one.kind not in LINEAR for one in link))
            found.append((Element("spring and damper", (float(k), float(c))),) if nonlinear else link)
        return LinkElements(tuple(found), self.present, self.held)

    def impedance(self, s: ComplexArray) -> ComplexArray:
        """Return force per stretch of the linear laws of every link at nodes s, shape (nodes, 2N)."""
        found = np.zeros((s.size, len(self.elements)), np.complex128)
        for law in assembled(self.linear().elements, 1.0).laws:
            found[:, law.links] += cast(LinearLaw, law).impedance(s)
        return found


def link_elements(absorbers: Sequence[Absorber | PointAbsorber], moving: Sequence[bool], scales: LinkScales) -> LinkElements | None:
    """Return what the links of some absorbers exert besides, None where each has two alike that obey the common law.

    Parameters
    ----------
    absorbers : sequence
    moving : sequence of bool
        Which shells of the system move.
    scales : LinkScales
    """
    pairs = [_pair(one, moving) for one in absorbers]
    present = np.array([[there[side] for there, _ in pairs] for side in (0, 1)], dtype=bool).reshape(-1)
    held = np.array([[moves[side] for _, moves in pairs] for side in (0, 1)], dtype=bool).reshape(-1)
    plain = all(one.law is None and not one.inertance for one in absorbers)
    if plain and present.all() and held.all():
        return None
    elements: list[tuple[Element, ...]] = []
    for side in (0, 1):
        for one, (there, _) in zip(absorbers, pairs, strict=True):
            found = [element for law in model.of_side(one.law, side) for element in _elements(law, scales)]
            if one.inertance:
                found.append(Element("inerter", (one.inertance * scales.length / (scales.force * scales.time**2),)))
            elements.append(tuple(found) if there[side] else ())
    return LinkElements(tuple(elements), present, held)


def shells_between(one: Absorber | PointAbsorber, shells: int) -> tuple[int, int]:
    """Return the numbers of the two shells between which an absorber is counted; -1 and 0 in a system of one shell."""
    return linked_shells(one) if shells > 1 else (-1, 0)


def _pair(one: Absorber | PointAbsorber, moving: Sequence[bool]) -> tuple[tuple[bool, bool], tuple[bool, bool]]:
    """Return which of an absorber's two links there are, and whose shell moves."""
    alone, (inner, outer) = len(moving) < 2, linked_shells(one)
    on = (one.links == "both" or (one.links == "inner" and not alone), one.links == "both" or one.links == "outer" or alone)
    moves = (on[0] and moving[inner], on[1] and moving[inner if alone else outer])
    return (on[0] or one.grounded, on[1] or one.grounded), moves


def _elements(law: model.Single, scales: LinkScales) -> list[Element]:
    """Return a law as elements."""
    length, force, time = scales
    stiff = length / force
    match law:
        case model.Linear():
            return [Element("spring and damper", (law.stiffness * stiff, law.damping * stiff / time))]
        case model.Cubic():
            return [Element("polynomial", (law.k1 * stiff, 0.0, law.k3 * stiff * length**2))]
        case model.Bistable():
            return [Element("polynomial", tuple(a * stiff * length**k for k, a in enumerate(_about_rest(law))))]
        case model.Polynomial():
            return [Element("polynomial", tuple(a * stiff * length**k for k, a in enumerate(law.coefficients)))]
        case model.Maxwell():
            return [Element("maxwell", (law.stiffness * stiff, law.relaxation_time / time))]
        case model.Gap():
            inwards, outwards = law.sides != "outwards", law.sides != "inwards"
            k = law.stiffness * stiff
            return [Element("stops", (law.clearance / length, k * inwards, k * outwards, law.restitution))]
        case model.Table():
            slope, corners = _broken(law)
            return [Element("broken line", (slope * stiff,), tuple((d / length, k * stiff, sign) for d, k, sign in corners))]
        case model.Friction():
            limit = law.force / force
            if law.speed is not None:
                return [Element("smoothed friction", (limit, law.speed * time / length))]
            if law.stiffness is not None:
                return [Element("hysteretic friction", (limit, law.stiffness * stiff))]
            return [Element("dry friction", (limit, (law.static_force or law.force) / force))]


def _about_rest(law: model.Bistable) -> tuple[float, float, float]:
    """Return the coefficients of f(d + D) in D, d the place of rest: (-2 k1, 3 k3 d, k3) in a well."""
    if law.rest == "middle":
        return law.k1, 0.0, law.k3
    place = law.well if law.rest == "inwards" else -law.well
    return -2.0 * law.k1, 3.0 * law.k3 * place, law.k3


def _broken(law: model.Table) -> tuple[float, list[tuple[float, float, float]]]:
    """Return the slope of a table at rest, and its corners outwards of it: (d, change of slope, direction)."""
    slopes, stretch = law.slopes, law.stretch
    first = max((k for k, d in enumerate(stretch[:-1]) if d <= 0.0), default=0)
    corners = [(stretch[k], slopes[k] - slopes[k - 1], 1.0) for k in range(first + 1, len(slopes))]
    corners += [(stretch[k], slopes[k - 1] - slopes[k], -1.0) for k in range(first, 0, -1)]
    return slopes[first], corners


Maker = Callable[[Links, list[Element], float], LinkLaw]


def _columns(elements: list[Element]) -> FloatArray:
    return np.array([one.numbers for one in elements]).T.copy()


def _pair_of(elements: list[Element]) -> tuple[FloatArray, FloatArray]:
    first, second = _columns(elements)
    return first, second


def _polynomials(links: Links, elements: list[Element], step: float) -> LinkLaw:
    coefficients = np.zeros((max(len(one.numbers) for one in elements), len(elements)))
    for n, one in enumerate(elements):
        coefficients[: len(one.numbers), n] = one.numbers
    return Polynomials(links, coefficients)


def _broken_lines(links: Links, elements: list[Element], step: float) -> LinkLaw:
    table = np.zeros((3, max(1, max(len(one.corners) for one in elements)), len(elements)))
    table[2] = 1.0
    for n, one in enumerate(elements):
        if one.corners:
            table[:, : len(one.corners), n] = np.array(one.corners).T
    return BrokenLines(links, _columns(elements)[0], *table)


def _stops(links: Links, elements: list[Element], step: float) -> LinkLaw:
    clearance, inwards, outwards, restitution = _columns(elements)
    return Stops(links, clearance, np.stack([inwards, outwards]), restitution, step)


_MADE: Mapping[str, Maker] = {
    "spring and damper": lambda links, elements, step: SpringDampers(links, *_pair_of(elements), step),
    "maxwell": lambda links, elements, step: MaxwellBranches(links, *_pair_of(elements), step),
    "inerter": lambda links, elements, step: Inerters(links, _columns(elements)[0], step),
    "polynomial": _polynomials,
    "broken line": _broken_lines,
    "stops": _stops,
    "smoothed friction": lambda links, elements, step: SmoothedFriction(links, *_pair_of(elements), step),
    "hysteretic friction": lambda links, elements, step: HystereticFriction(links, *_pair_of(elements)),
}


class LawGroup(NamedTuple):
    """Elements of one kind, no two of one link: the links that have them, and the elements."""

    kind: str
    links: Links
    elements: list[Element]

    def made(self, time_step: float, compliance: FloatArray | None = None) -> LinkLaw:
        """Return their law, for steps of one length; dry friction needs the compliance of all links within a step."""
        if self.kind == "dry friction":
            assert compliance is not None
            return DryFriction(self.links, *_pair_of(self.elements), compliance[self.links])
        return _MADE[self.kind](self.links, self.elements, time_step)


def grouped(elements: Sequence[Sequence[Element]], cubic: FloatArray | None = None) -> list[LawGroup]:
    """Return the elements of links by laws, which hold no link twice; arguments as of :func:`assembled`."""
    found: dict[tuple[str, int], list[tuple[int, Any]]] = {}
    for link, several in enumerate(elements):
        more = [Element("polynomial", (0.0, 0.0, float(cubic[link])))] if cubic is not None and cubic[link] else []
        kinds: dict[str, int] = {}
        for one in (*several, *more):  # a second of the same kind belongs to a law of its own
            kinds[one.kind] = kinds.get(one.kind, 0) + 1
            found.setdefault((one.kind, kinds[one.kind]), []).append((link, one))
    return [
        LawGroup(kind, np.array([link for link, _ in pairs], dtype=np.int64), [one for _, one in pairs])
        for (kind, _), pairs in found.items()
    ]


def assembled(
    elements: Sequence[Sequence[Element]], time_step: float, cubic: FloatArray | None = None, compliance: FloatArray | None = None
) -> LinkLaws:
    """Return the laws of links made of elements, for steps of one length.

    Parameters
    ----------
    elements : sequence of sequence of Element
        Of each link.
    time_step : float
    cubic : ndarray, shape (links,), optional
        k_nl of springs that come to them.
    compliance : ndarray, shape (links,), optional
        A of the links within a step; dry friction needs it.
    """
    return LinkLaws(len(elements), [one.made(time_step, compliance) for one in grouped(elements, cubic)])
