"""Vibration absorbers between two shells (paper's Eqs. 6 and 7), neighbours or any other, one by one or as a ring of equal ones.

Those of two dimensions are lines along the axis, with their properties per metre of length; those of three are points of it.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import lru_cache
from typing import Annotated, Any, Literal, Self, overload

from pydantic import model_validator

from coaxshell.errors import InputError
from coaxshell.limits import RING
from coaxshell.model.base import Described, shown
from coaxshell.model.laws import AnyLaw
from coaxshell.model.units import Angle, Count, Length, Position, quantity
from coaxshell.numerics.scalars import plain

LineMass = Annotated[float, quantity("line mass", least=0)]
LineDamping = Annotated[float, quantity("line damping", least=0)]
LineStiffness = Annotated[float, quantity("line stiffness", least=0)]
LineCubicStiffness = Annotated[float, quantity("line cubic stiffness", least=0)]


PointMass = Annotated[float, quantity("mass", least=0)]
PointDamping = Annotated[float, quantity("damping", least=0)]
PointStiffness = Annotated[float, quantity("stiffness", least=0)]
PointCubicStiffness = Annotated[float, quantity("cubic stiffness", least=0)]


Links = Literal["both", "inner", "outer"]


def _require_determined(one: _Link | PointAbsorber, unit: str) -> None:
    """Raise InputError if nothing determines where the mass is, or what it holds."""
    if one.grounded and one.links == "both":
        raise InputError("grounded", "true beside links = 'both' leaves no link for the core", 'must go with links = "inner" or "outer"')
    loose = not (one.damping or one.linear_stiffness or one.cubic_stiffness)
    if one.mass == 0 and loose and one.law is None:
        raise InputError(
            "mass",
            f"0.0 {unit} with neither damping nor stiffness leaves the absorber undetermined",
            "must be greater than 0, or give it a stiffness",
        )
    if one.mass == 0 and (one.law is not None or one.inertance) and not (one.damping or one.linear_stiffness):
        problem = f"0.0 {unit} with a law or an inertance alone leaves the absorber undetermined"
        raise InputError("mass", problem, "must be greater than 0, or give it damping or linear_stiffness, however small")
    if one.mass == 0 and one.links != "both" and not one.grounded:
        raise InputError("mass", f"0.0 {unit} on one shell alone does nothing", "must be greater than 0")


def _require_known_pair(entries: Any) -> Any:
    """Return the entries of an absorber; InputError if they name its two shells by one entry."""
    given = entries if isinstance(entries, Mapping) else {}
    for name in ("shells", "between"):
        if name in given:
            problem = f"{shown(given[name])} is no entry: the two shells of an absorber have one each"
            raise InputError(name, problem, "give inner_shell and outer_shell, such as inner_shell = 0 and outer_shell = 2")
    return entries


def _require_outside(one: _Link | PointAbsorber) -> None:
    """Raise InputError if the outer one of the two shells does not lie outside the other."""
    if one.outer_shell is not None and one.outer_shell <= one.inner_shell:
        problem = f"{one.outer_shell} does not lie outside inner_shell = {one.inner_shell}"
        raise InputError("outer_shell", problem, f"must be at least {one.inner_shell + 1}, or leave it out for the next one out")


def linked_shells(one: _Link | PointAbsorber) -> tuple[int, int]:
    """Return the numbers of the two shells between which an absorber is described, the outer one the next one out unless given."""
    return one.inner_shell, one.inner_shell + 1 if one.outer_shell is None else one.outer_shell


def gaps_of(one: _Link | PointAbsorber) -> range:
    """Return the gaps through which an absorber runs, gap i between the shells i and i + 1; of a mass on one shell alone that beside it."""
    inner, outer = linked_shells(one)
    if one.links == "both" or one.grounded:
        return range(inner, outer)
    return range(inner, inner + 1) if one.links == "inner" else range(outer - 1, outer)


def drawn_radii(one: _Link | PointAbsorber, inside: Sequence[float], outside: Sequence[float]) -> tuple[float, float, float]:
    """Return the radii between which an absorber is drawn, and in the middle that of its mass: half-way through the outermost gap it is in.

    A link that there is not ends at the mass, and the core of one shell alone is drawn at half its radius.

    Parameters
    ----------
    inside, outside : sequence of float
        Radii of the inner and the outer faces of all shells as they are drawn.
    """
    if len(inside) < 2:
        inner, mass, outer = 0.5 * inside[0], 0.75 * inside[0], inside[0]
        return (inner if one.grounded else mass), mass, outer
    first, last = linked_shells(one)
    gap = gaps_of(one)[-1]
    mass = (outside[gap] + inside[gap + 1]) / 2
    held = one.links if not one.grounded else "both"
    return (mass if held == "outer" else outside[first]), mass, (mass if held == "inner" else inside[last])


class _Link(Described):
    """Hold one absorber: f = c dD/dt + k_l D + k_nl D^3 on each side, D the stretch, and what a law adds; all per metre of length."""

    mass: LineMass
    """Moving mass (kg per metre of length); 0 leaves two links in series."""
    damping: LineDamping = 0.0
    """Viscous damping c of each link (N s/m per metre of length)."""
    linear_stiffness: LineStiffness = 0.0
    """Linear stiffness k_l of each link (N/m per metre of length)."""
    cubic_stiffness: LineCubicStiffness = 0.0
    """Cubic stiffness k_nl of each link (N/m^3 per metre of length)."""
    inner_shell: Count = 0
    """The inner one of the two shells it links, counted from 0 inside."""
    outer_shell: Count | None = None
    """The outer one of the two; unless given the next one out. It passes those between through holes, without touching them."""
    footprint: Length | None = None
    """Arc of each wall that it holds (m); unless given the wall's thickness on exact walls, a line on thin ones."""
    links: Links = "both"
    """Which shells it holds: "both", or its mass hangs on the "inner" or the "outer" one alone, as a tuned mass damper."""
    grounded: bool = False
    """Of a mass on one shell: whether its other link holds a rigid core, which does not move, instead of nothing."""
    law: AnyLaw | None = None
    """What each link exerts besides: linear, cubic, bistable, polynomial, gap, friction, maxwell, table; parallel; sides."""
    inertance: LineMass = 0.0
    """Inertance b of each link (kg per metre of length): f = b d^2D/dt^2 besides, of an inerter."""

    _known_pair = model_validator(mode="before")(_require_known_pair)

    @model_validator(mode="after")
    def _determined(self) -> Self:
        _require_outside(self)
        _require_determined(self, "kg/m")
        return self


class Absorber(_Link):
    """Describe one absorber at an angle."""

    angle: Angle = 0.0
    """Where it sits, from the direction theta = 0 (degrees)."""


class PointAbsorber(Described):
    """Describe one absorber at a point of the axis and an angle, for runs in three dimensions: each link exerts c dD/dt + k_l D + k_nl D^3.

    It holds each wall over a small square patch, since a force at a point without extent meets no finite velocity of a wall.
    """

    mass: PointMass
    """Moving mass (kg); 0 leaves two links in series."""
    damping: PointDamping = 0.0
    """Viscous damping c of each link (N s/m)."""
    linear_stiffness: PointStiffness = 0.0
    """Linear stiffness k_l of each link (N/m)."""
    cubic_stiffness: PointCubicStiffness = 0.0
    """Cubic stiffness k_nl of each link (N/m^3)."""
    inner_shell: Count = 0
    """The inner one of the two shells it links, counted from 0 inside."""
    outer_shell: Count | None = None
    """The outer one of the two; unless given the next one out. It passes those between through holes, without touching them."""
    links: Links = "both"
    """Which shells it holds: "both", or its mass hangs on the "inner" or the "outer" one alone, as a tuned mass damper."""
    grounded: bool = False
    """Of a mass on one shell: whether its other link holds a rigid core, which does not move, instead of nothing."""
    law: AnyLaw | None = None
    """What each link exerts besides: linear, cubic, bistable, polynomial, gap, friction, maxwell, table; parallel; sides."""
    inertance: PointMass = 0.0
    """Inertance b of each link (kg): f = b d^2D/dt^2 besides, of an inerter."""
    angle: Angle = 0.0
    """Where it sits, from the direction theta = 0 (degrees)."""
    z: Position
    """Where it sits along the axis (m)."""
    footprint: Length | None = None
    """Side of the patch of each wall that it holds (m); the wall's thickness unless given."""

    _known_pair = model_validator(mode="before")(_require_known_pair)

    @model_validator(mode="after")
    def _determined(self) -> Self:
        _require_outside(self)
        _require_determined(self, "kg")
        return self


class AbsorberRing(_Link):
    """Describe *count* equal absorbers at equal spacing: angle_k = offset + 360 k / count."""

    count: Count
    """How many absorbers; 0 is an empty ring."""
    offset: Angle = 0.0
    """Angle of the first absorber (degrees)."""

    @model_validator(mode="after")
    def _bounded(self) -> Self:
        RING.check(self.count, "count")  # it will be written out
        return self

    @property
    def absorbers(self) -> tuple[Absorber, ...]:
        """The single absorbers of the ring."""
        return _written_out(self)

    @property
    def angles(self) -> tuple[float, ...]:
        """Angles of the absorbers, offset + 360 k / count (degrees), kept below 360."""
        raw = (self.offset + 360.0 * k / self.count for k in range(self.count))
        return tuple(angle - 360.0 if angle >= 360.0 else angle for angle in raw)

    def __len__(self) -> int:
        return self.count

    def __bool__(self) -> bool:
        return True  # an empty ring is still a ring, whose count a study may change


@lru_cache(maxsize=64)
def _written_out(ring: AbsorberRing) -> tuple[Absorber, ...]:
    """Return the absorbers of a ring; kept by its value, since each of them is checked anew and a run asks for them many times."""
    shared = {name: getattr(ring, name) for name in _Link.model_fields}
    return tuple(Absorber(angle=angle, **shared) for angle in ring.angles)


@overload
def absorber_ring(count: int, *, z: None = None, **properties: Any) -> AbsorberRing: ...
@overload
def absorber_ring(count: int, *, z: Any, offset: Any = 0.0, **properties: Any) -> tuple[PointAbsorber, ...]: ...
def absorber_ring(count: int, *, z: Any = None, **properties: Any) -> AbsorberRing | tuple[PointAbsorber, ...]:
    """Return a ring of *count* equal absorbers, or rings of point absorbers at one or several axial positions.

    Parameters
    ----------
    count : int
    z : length or list of lengths, optional
        Axial positions of the rings (m), in three dimensions; without it absorbers are lines.
    **properties
        As those of :class:`AbsorberRing`, with *z* as those of :class:`PointAbsorber` and *offset*, the angle of the first (degrees).

    Raises
    ------
    InputError
        If a property is not allowed.
    """
    if z is None:
        return AbsorberRing(count=count, **properties)
    if "angle" in properties:
        raise InputError("angle", "belongs to a single absorber", "for rings give offset, the angle of the first absorber of each")
    ring = AbsorberRing(count=count, offset=properties.pop("offset", 0.0), mass=1.0)
    places = _places(z)
    RING.check(ring.count * len(places), "count")
    return tuple(PointAbsorber(angle=angle, z=place, **properties) for place in places for angle in ring.angles)


def _places(z: Any) -> list[Any]:
    """Return the axial positions of rings as a list; InputError if there is none, or one stands there twice."""
    given = plain(z)
    listed = list(given) if isinstance(given, Iterable) and not isinstance(given, str | bytes | Mapping) else [given]
    if not listed:
        raise InputError("z", "there is none", "give the axial position of a ring, or a list of them, or leave z out for line absorbers")
    if len(set(map(str, listed))) < len(listed):
        raise InputError("z", f"{shown(listed)} names a position twice", "give each axial position once")
    return listed
