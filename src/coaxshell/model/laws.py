"""Force laws of absorbers' links, what each exerts beside the absorber's own damper and springs.

D is the stretch of a link, positive while the mass has moved inwards from the shell; forces pull the mass back. Forces, stiffnesses and
dampings are those of an absorber at a point; of one that is a line along the axis they are per metre of length.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from itertools import pairwise
from typing import Annotated, Any, Literal, Self, get_args

from pydantic import BeforeValidator, Field, model_validator

from coaxshell.errors import InputError
from coaxshell.model.base import Described, shown
from coaxshell.model.naming import lookup
from coaxshell.model.units import Time, quantity

Stiffness = Annotated[float, quantity("link stiffness", above=0)]
AnyStiffness = Annotated[float, quantity("link stiffness", least=0)]
Force = Annotated[float, quantity("link force", above=0)]
MOST_COEFFICIENTS = 12
MOST_POINTS = 1000


class _Law(Described):
    """Take entries by position too, in the order of their explanation."""

    def __init__(self, *values: Any, **entries: Any) -> None:
        names = [name for name in type(self).model_fields if name != "type"]
        if len(values) > len(names):
            raise InputError("", f"{len(values)} values given", f"{type(self).__name__} has {', '.join(names)}")
        doubled = next((name for name in names[: len(values)] if name in entries), None)
        if doubled is not None:
            raise InputError(doubled, "is given twice", "give it by position or by name")
        super().__init__(**dict(zip(names, values, strict=False)), **entries)


class Linear(_Law):
    """Describe a spring and a damper, f = k D + c dD/dt: on one side of an absorber, or beside another law."""

    type: Literal["linear"] = "linear"
    stiffness: AnyStiffness = 0.0
    """Stiffness k (N/m)."""
    damping: Annotated[float, quantity("link damping", least=0)] = 0.0
    """Viscous damping c (N s/m)."""


class Cubic(_Law):
    """Describe the spring f = k1 D + k3 D^3."""

    type: Literal["cubic"] = "cubic"
    k1: AnyStiffness = 0.0
    """Linear stiffness (N/m)."""
    k3: Annotated[float, quantity("link cubic stiffness", least=0)] = 0.0
    """Cubic stiffness (N/m^3)."""


class Bistable(_Law):
    """Describe the spring f = k1 D + k3 D^3 with k1 < 0, which rests at D = +-(-k1/k3)^(1/2), where its stiffness is -2 k1."""

    type: Literal["bistable"] = "bistable"
    k1: Annotated[float, quantity("link stiffness", below=0)]
    """Linear stiffness at the middle, negative (N/m)."""
    k3: Annotated[float, quantity("link cubic stiffness", above=0)]
    """Cubic stiffness (N/m^3)."""
    rest: Literal["inwards", "outwards", "middle"] = "inwards"
    """Where the mass rests before the shock: in the well on the inner or the outer side of the middle, or balanced between them."""

    @property
    def well(self) -> float:
        """Distance of either well from the middle, (-k1/k3)^(1/2) (m)."""
        return math.sqrt(-self.k1 / self.k3)


class Polynomial(_Law):
    """Describe the spring f = a_1 D + a_2 D^2 + a_3 D^3 + ..."""

    type: Literal["polynomial"] = "polynomial"
    coefficients: Annotated[tuple[Annotated[float, quantity("number")], ...], Field(min_length=1, max_length=MOST_COEFFICIENTS)]
    """a_1, a_2, a_3, ... (N/m, N/m^2, N/m^3, ...); the last one of an odd power and positive, so that it holds."""

    @model_validator(mode="after")
    def _holds(self) -> Self:
        last = max((k for k, a in enumerate(self.coefficients, start=1) if a != 0.0), default=0)
        if last % 2 == 0 or self.coefficients[last - 1] < 0.0:
            problem = f"{shown(list(self.coefficients))} does not pull back at large stretches"
            raise InputError("coefficients", problem, "the last one that is not 0 must be positive, of an odd power")
        return self


class Gap(_Law):
    """Describe stops: nothing within the clearance, beyond it k (abs(D) - g), less on the way back by the coefficient of restitution.

    A mass that strikes a stop at the speed v leaves it at e v (Hunt and Crossley's contact, whatever mass and speed).
    """

    type: Literal["gap"] = "gap"
    clearance: Annotated[float, quantity("length", least=0)]
    """Clearance g on either side (m)."""
    stiffness: Stiffness
    """Stiffness k of a stop (N/m)."""
    restitution: Annotated[float, quantity("number", least=0.01, most=1)] = 1.0
    """Coefficient of restitution e, 0.01 to 1; 1 loses nothing."""
    sides: Literal["both", "inwards", "outwards"] = "both"
    """Where there are stops: on both sides, or where the mass moves inwards or outwards from its shell."""


class Friction(_Law):
    """Describe dry friction: exact, f = F sign(dD/dt), abs(f) <= F_s at rest; smoothed by a speed; or behind a spring that yields at F."""

    type: Literal["friction"] = "friction"
    force: Force
    """Friction F while it slides (N)."""
    static_force: Force | None = None
    """Friction F_s up to which it sticks (N), of exact friction; F unless given."""
    speed: Annotated[float, quantity("speed", above=0)] | None = None
    """Smooths it to F tanh(r/speed), r = dD/dt (m/s); exact unless given."""
    stiffness: Stiffness | None = None
    """Stiffness of a spring in series with the slider (N/m), hysteretic friction; none unless given."""

    @model_validator(mode="after")
    def _one_kind(self) -> Self:
        if self.speed is not None and self.stiffness is not None:
            raise InputError("speed", f"{self.speed:g} m/s has no effect beside stiffness", "give one of them")
        if self.static_force is not None and (self.speed is not None or self.stiffness is not None):
            raise InputError("static_force", f"{self.static_force:g} N belongs to exact friction", "leave out speed and stiffness")
        if self.static_force is not None and self.static_force < self.force:
            raise InputError("static_force", f"{self.static_force:g} N is less than force", f"must be at least {self.force:g} N")
        return self


class Maxwell(_Law):
    """Describe a viscoelastic branch, a spring k in series with a damper k tau: df/dt + f/tau = k dD/dt."""

    type: Literal["maxwell"] = "maxwell"
    stiffness: Stiffness
    """Stiffness k at once (N/m)."""
    relaxation_time: Time
    """Time tau in which its force falls by a factor e (s)."""


class Table(_Law):
    """Describe a spring by points of its force, straight lines between them and beyond the ends."""

    type: Literal["table"] = "table"
    stretch: Annotated[tuple[Annotated[float, quantity("length")], ...], Field(min_length=2, max_length=MOST_POINTS)]
    """Stretches D in ascending order (m)."""
    force: Annotated[tuple[Annotated[float, quantity("link force")], ...], Field(min_length=2, max_length=MOST_POINTS)]
    """Forces f at them (N); 0 at D = 0, where it rests."""

    @model_validator(mode="after")
    def _rests(self) -> Self:
        if len(self.stretch) != len(self.force):
            raise InputError("force", f"{len(self.force)} values for {len(self.stretch)} stretches", "must be as many as stretches")
        for number, (here, there) in enumerate(pairwise(self.stretch)):
            if there <= here:
                raise InputError(f"stretch[{number + 1}]", f"{there:g} m is not beyond {here:g} m", "must ascend")
        if not self.stretch[0] <= 0.0 <= self.stretch[-1] or abs(self._at_rest) > 1e-9 * max(map(abs, self.force)):
            raise InputError("force", "is not 0 at a stretch of 0, where it rests before the shock", "give a point (0, 0) within the table")
        for end, number in ((0, 0), (len(self.slopes) - 1, len(self.force) - 1)):
            if self.slopes[end] < 0.0:
                problem = f"falls off at {self.slopes[end]:g} N/m beyond the last stretch"
                raise InputError(f"force[{number}]", problem, "give a last piece that pulls back")
        return self

    @property
    def slopes(self) -> list[float]:
        """Stiffness between the points (N/m)."""
        pairs = list(zip(self.stretch, self.force, strict=True))
        return [(g - f) / (e - d) for (d, f), (e, g) in pairwise(pairs)]

    @property
    def _at_rest(self) -> float:
        number = max(k for k, d in enumerate(self.stretch[:-1]) if d <= 0.0 or k == 0)
        return self.force[number] - self.slopes[number] * self.stretch[number]


def _as_single(value: Any) -> Any:
    """Return a law from an instance or a mapping whose ``type`` names it."""
    if isinstance(value, Described):
        return value
    if isinstance(value, Mapping):
        data = dict(value)
        if "type" not in data:
            raise InputError("type", "is missing", f"must be one of {', '.join(LAWS)}")
        kind = lookup(LAWS, str(data["type"]), "law", "type")
        return kind.model_validate({**data, "type": kind.model_fields["type"].default})
    raise InputError("", f"{shown(value)} is not a law", f"give one of {', '.join(LAWS)}")


Single = Linear | Cubic | Bistable | Polynomial | Gap | Friction | Maxwell | Table


class Parallel(_Law):
    """Describe several laws side by side, whose forces add up."""

    type: Literal["parallel"] = "parallel"
    laws: Annotated[tuple[Annotated[Single, BeforeValidator(_as_single)], ...], Field(min_length=1, max_length=10)]
    """The laws."""


class Sides(_Law):
    """Describe a law of its own for the inner and the outer link; a side without one has the absorber's damper and springs alone."""

    type: Literal["sides"] = "sides"
    inner: Annotated[Single | Parallel | None, BeforeValidator(lambda value: None if value is None else _as_single(value))] = None
    """Law of the link to the inner shell."""
    outer: Annotated[Single | Parallel | None, BeforeValidator(lambda value: None if value is None else _as_single(value))] = None
    """Law of the link to the outer shell."""


Law = Single | Parallel | Sides
LAWS: dict[str, type[Law]] = {kind.model_fields["type"].default: kind for kind in get_args(Law)}
"""Kinds of law by the ``type`` that names them in a file."""

AnyLaw = Annotated[Law, BeforeValidator(_as_single)]


def of_side(law: Law | None, side: int) -> tuple[Single, ...]:
    """Return the laws of the inner (0) or the outer (1) link, none or several."""
    one = (law.inner, law.outer)[side] if isinstance(law, Sides) else law
    if one is None:
        return ()
    return one.laws if isinstance(one, Parallel) else (one,)
