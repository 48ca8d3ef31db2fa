"""Fields of a system that a study varies: by dotted path, each with its unit and what it means."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import Any, get_args

from coaxshell.errors import InputError
from coaxshell.model.absorbers import Absorber, AbsorberRing, PointAbsorber
from coaxshell.model.base import Described, shown
from coaxshell.model.control import PDControl
from coaxshell.model.explanations import explanations
from coaxshell.model.overrides import entry
from coaxshell.model.paths import EXAMPLE, parsed
from coaxshell.model.system import System
from coaxshell.model.units import Quantity, whole

_GAINS = ("proportional", "derivative")


@dataclass(frozen=True)
class Field:
    """A field that can be varied.

    Attributes
    ----------
    path : str
    units, long_name : str
        From the model's own description; units "1" for a plain number or a count.
    quantity : Quantity, optional
        Its dimension and limits, None for what is not a real number.
    integer : bool
        Whether it is a count.
    present : object
        Its value in the base system.
    """

    path: str
    units: str
    long_name: str
    quantity: Quantity | None
    integer: bool
    present: Any

    def value(self, given: Any, where: str) -> Any:
        """Return a value in SI, as a float, a whole number, or as it is if the field is neither; InputError names *where*."""
        try:
            if self.quantity is not None:
                return self.quantity.validate(given)
            if self.integer:
                return _whole(given)
        except InputError as error:
            raise InputError(where, error.problem, error.remedy) from None
        return given


def varied(system: System, changes: Mapping[str, Any]) -> System:
    """Return a system with the fields at the given paths changed, all at once; InputError says which and why not.

    Beyond :meth:`System.with_overrides`: a gain may be set where there is no control yet (the other one is then 0), and a property
    of absorbers that are listed one by one (``absorbers.mass``) is set on each of them; where there are none, ``absorbers.count``,
    ``absorbers.mass`` and so on together describe a ring.
    """
    plain_changes: dict[str, Any] = {}
    controls: dict[str, Any] = {}
    absorbers: dict[str, Any] = {}
    for path, value in changes.items():
        head, *rest = parsed(path)
        field = ".".join(rest)
        if head == "control" and system.control is None and field:
            controls[field] = value
        elif head == "absorbers" and isinstance(system.absorbers, tuple) and field in _settable(system.absorbers):
            absorbers[field] = value
        else:
            plain_changes[path] = value
    if controls:
        plain_changes["control"] = _new_control(controls)
    if absorbers:
        plain_changes["absorbers"] = _each(system, absorbers)
    return system.with_overrides(plain_changes) if plain_changes else system


def field_of(system: System, path: str) -> Field:
    """Return the field at a path of a system; InputError, with the nearest that exists, if there is none."""
    *way, last = parsed(path, "over")
    path = path.strip()
    if way == ["control"] and system.control is None and last in _GAINS:
        return _described(path, PDControl, last, 0.0)
    if way == ["absorbers"] and isinstance(system.absorbers, tuple) and system.absorbers and last in _settable(system.absorbers):
        return _described(path, type(system.absorbers[0]), last, getattr(system.absorbers[0], last))
    node = entry(system, way)
    if isinstance(node, Described) and last in type(node).model_fields:
        return _described(path, type(node), last, getattr(node, last))
    if isinstance(node, tuple) and (item := entry(system, [*way, last])) is not None:
        quantity = _item_quantity(system, way) if isinstance(item, float) else None
        return Field(path, (quantity.dimension.unit if quantity else "") or "1", path, quantity, False, item)
    system.with_overrides({path: 1.0})  # raises the error that names what is allowed there
    raise InputError(path, "is not a field of this system", EXAMPLE)


def _item_quantity(system: System, way: list[str]) -> Quantity | None:
    """Return what the numbers of a list are, such as those of a law's coefficients."""
    owner = entry(system, way[:-1])
    waiting = [type(owner).model_fields[way[-1]].annotation] if isinstance(owner, Described) and way[-1] in type(owner).model_fields else []
    while waiting:
        kind: Any = waiting.pop()
        found = next((mark for mark in getattr(kind, "__metadata__", ()) if isinstance(mark, Quantity)), None)
        if found is not None:
            return found
        waiting += get_args(kind)
    return None


def _described(path: str, kind: type[Described], name: str, present: Any) -> Field:
    info = kind.model_fields[name]
    marks = [*info.metadata, *(mark for part in get_args(info.annotation) for mark in getattr(part, "__metadata__", ()))]
    quantity = next((mark for mark in marks if isinstance(mark, Quantity)), None)
    integer = quantity is None and info.annotation is int
    long_name = re.sub(r"\s*\([^()]*\)", "", explanations(kind).get(name, name).split(". ")[0].split("; ")[0]).rstrip(".")
    units = (quantity.dimension.unit if quantity is not None else "") or "1"
    return Field(path, units, f"{long_name} ({path})", quantity, integer, present)


def _whole(given: Any) -> int:
    number = whole(given)
    if isinstance(number, float) and number.is_integer():
        number = int(number)
    if not isinstance(number, int) or number < 0:
        raise InputError("", f"{shown(given)} is not a count", "give a whole number of 0 or more")
    return number


def _new_control(entries: Mapping[str, Any]) -> PDControl:
    try:
        return PDControl(**{"proportional": 0.0, "derivative": 0.0, **entries})
    except InputError as error:
        raise InputError(f"control.{error.where}", error.problem, error.remedy) from None


def _settable(absorbers: tuple[Absorber | PointAbsorber, ...]) -> Collection[str]:
    return type(absorbers[0]).model_fields if absorbers else AbsorberRing.model_fields


def _each(system: System, entries: Mapping[str, Any]) -> AbsorberRing | tuple[Absorber | PointAbsorber, ...]:
    assert not isinstance(system.absorbers, AbsorberRing)
    try:
        if not system.absorbers and "count" in entries:
            return AbsorberRing(**entries)
        if not system.absorbers:
            raise InputError(next(iter(entries)), "this system has no absorbers", "give absorbers.count and absorbers.mass too, at least")
        return tuple(absorber.replace(**entries) for absorber in system.absorbers)
    except InputError as error:
        raise InputError(f"absorbers.{error.where}", error.problem, error.remedy) from None
