"""What an optimisation may change: intervals and choices of fields, as coordinates of a unit cube."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np

from coaxshell.errors import InputError
from coaxshell.model.absorbers import Absorber, PointAbsorber, linked_shells
from coaxshell.model.base import shown
from coaxshell.model.system import System
from coaxshell.studies.varied_fields import Field, field_of, varied

EVERY = "absorbers[*]."
MOST_LEVELS = 1_000_000
_SAME = 1e-6  # degrees


@dataclass(frozen=True)
class Range:
    """An interval of real values (of whole ones for a field that is a count).

    Attributes
    ----------
    low, high : float or str
        Ends, in SI or text with a unit.
    scale : str
        "linear" or "log"; with "log" both ends have one sign.
    paths : tuple of str
        The fields that take the value, if the variable has a name of its own instead of a path.
    each : str
        For ``absorbers[*].FIELD``: "single" gives every absorber a value of its own, "mirror" every pair that is symmetric about
        the first source's direction.
    """

    low: Any
    high: Any
    scale: Literal["linear", "log"] = "linear"
    paths: tuple[str, ...] = ()
    each: str = ""


@dataclass(frozen=True)
class Integer:
    """A whole number from *low* to *high*, both included; *paths* as in :class:`Range`."""

    low: int
    high: int
    paths: tuple[str, ...] = ()


@dataclass(frozen=True)
class Choice:
    """One of some values, numbers in SI or text with a unit; *paths* as in :class:`Range`."""

    values: tuple[Any, ...]
    paths: tuple[str, ...] = ()


VariableLike = Range | Integer | Choice | Mapping[str, Any] | Sequence[Any]


@dataclass(frozen=True)
class Variable:
    """One coordinate of the search.

    Attributes
    ----------
    name, units, long_name : str
    paths : tuple of str
        Fields that take its value.
    mirrored : tuple of str
        Angles that take the mirror image of its value.
    low, high : float
        Ends in SI; 0 and 1 for a choice.
    log : bool
    levels : tuple
        Its values, if they can be counted; empty for an interval.
    axis : float
        Direction about which *mirrored* is reflected, degrees.
    """

    name: str
    units: str
    long_name: str
    paths: tuple[str, ...]
    low: float = 0.0
    high: float = 1.0
    log: bool = False
    levels: tuple[Any, ...] = ()
    mirrored: tuple[str, ...] = ()
    axis: float = 0.0

    def at(self, share: float) -> Any:
        """Return the value at a share from 0 to 1; countable values have equal parts of it."""
        if self.levels:
            return self.levels[min(len(self.levels) - 1, int(share * len(self.levels)))]
        if share in (0.0, 1.0):
            return self.high if share else self.low
        return self.low * (self.high / self.low) ** share if self.log else self.low + share * (self.high - self.low)

    def share(self, value: Any) -> float | None:
        """Return where a value lies from 0 to 1, None if it is outside."""
        if self.levels:
            return (self.levels.index(value) + 0.5) / len(self.levels) if value in self.levels else None
        if not isinstance(value, int | float) or not self.low <= value <= self.high:
            return None
        if self.log:
            return math.log(value / self.low) / math.log(self.high / self.low)
        return (value - self.low) / (self.high - self.low)

    def changes(self, value: Any) -> dict[str, Any]:
        """Return the changes of the system for a value."""
        image = {path: math.remainder(2.0 * self.axis - value, 360.0) for path in self.mirrored}
        return {**dict.fromkeys(self.paths, value), **image}


@dataclass(frozen=True)
class Space:
    """All variables over a base system (whose absorbers are written out where they vary one by one)."""

    base: System
    variables: tuple[Variable, ...]

    def values(self, unit: np.ndarray[Any, Any]) -> tuple[Any, ...]:
        """Return the values at a point of the unit cube."""
        return tuple(variable.at(float(share)) for variable, share in zip(self.variables, unit, strict=True))

    def system(self, values: Sequence[Any]) -> System | InputError:
        """Return the system with some values, or the reason why there is none."""
        changes: dict[str, Any] = {}
        for variable, value in zip(self.variables, values, strict=True):
            changes |= variable.changes(value)
        try:
            return varied(self.base, changes)
        except InputError as error:
            return error

    def present(self) -> tuple[Any, ...]:
        """Return the base system's own values (that of the first path of each variable)."""
        return tuple(field_of(self.base, variable.paths[0]).present for variable in self.variables)

    def start(self) -> np.ndarray[Any, Any]:
        """Return the base system's place in the unit cube, the middle for every variable that it leaves."""
        shares = [variable.share(value) for variable, value in zip(self.variables, self.present(), strict=True)]
        return np.array([0.5 if share is None else share for share in shares])


def space_of(system: System, variables: Mapping[str, VariableLike]) -> Space:
    """Return the space of an optimisation, checked against its base system.

    Parameters
    ----------
    system : System
    variables : mapping of path or name to Range, Integer, Choice, a table with ``from`` and ``to``, or a list of choices

    Raises
    ------
    InputError
        None given, an unknown path, an empty range, a wrong unit, one field twice, an absorber without its mirror image.
    """
    if not isinstance(variables, Mapping) or not variables:
        raise InputError("variables", "there are none", 'give at least one, as in {"absorbers.mass": Range(1, 20)}')
    single = any(name.startswith(EVERY) for name in variables)
    base = system.replace(absorbers=system.absorber_list or system.point_absorbers) if single else system
    found: list[Variable] = []
    for name, given in variables.items():
        where = f"variables.{name}"
        wanted = _wanted(given, where)
        if name.startswith(EVERY):
            found += _each(base, name.removeprefix(EVERY), wanted, where)
        else:
            found.append(_variable(base, name, wanted.paths or (name,), wanted, where))
    paths = [path for variable in found for path in (*variable.paths, *variable.mirrored)]
    twice = next((path for path in paths if paths.count(path) > 1), None)
    if twice is not None:
        raise InputError(f"variables.{twice}", "is varied twice", "give each field once")
    return Space(base, tuple(found))


def _wanted(given: VariableLike, where: str) -> Range | Integer | Choice:
    if isinstance(given, Range | Integer | Choice):
        return replace(given, paths=tuple(given.paths))
    if isinstance(given, Mapping):
        entries = dict(given)
        unknown = set(entries) - {"from", "to", "scale", "paths", "each", "values"}
        if unknown:
            raise InputError(f"{where}.{min(unknown)}", "is not an entry of a variable", "allowed: from, to, scale, each, paths, values")
        paths = entries.get("paths", ())
        if isinstance(paths, str) or not all(isinstance(path, str) for path in paths):
            raise InputError(f"{where}.paths", f"{shown(paths)} is not a list of paths", 'give one such as ["control.proportional"]')
        if "values" in entries:
            return Choice(tuple(entries["values"]), tuple(paths))
        if not {"from", "to"} <= set(entries):
            raise InputError(where, "needs both from and to", "give {from = 1, to = 20}, or a list of choices")
        return Range(entries["from"], entries["to"], entries.get("scale", "linear"), tuple(paths), entries.get("each", ""))
    if isinstance(given, Sequence) and not isinstance(given, str):
        return Choice(tuple(given))
    raise InputError(where, f"{shown(given)} is neither a range nor choices", "give Range(low, high), Integer(low, high) or Choice(values)")


def _variable(base: System, name: str, paths: Sequence[str], wanted: Range | Integer | Choice, where: str) -> Variable:
    if isinstance(wanted, Range) and wanted.each:
        raise InputError(where, f"each = {wanted.each!r} has no meaning for one field", f"write it for {EVERY}FIELD")
    fields = [_field(base, path, where) for path in paths]
    written = tuple(one for path in paths for one in _written_out(base, path))
    return _of_field(Variable(name, fields[0].units, fields[0].long_name, written), fields[0], wanted, where)


def _field(base: System, path: str, where: str) -> Field:
    try:
        return field_of(base, path)
    except InputError as error:
        raise InputError(where if error.where in path else f"{where}: {error.where}", error.problem, error.remedy) from None


def _written_out(base: System, path: str) -> tuple[str, ...]:
    """Return a path, or one for each of the absorbers that are listed one by one."""
    name = path.removeprefix("absorbers.")
    if name != path and isinstance(base.absorbers, tuple) and base.absorbers and name in type(base.absorbers[0]).model_fields:
        return tuple(f"absorbers[{i}].{name}" for i in range(len(base.absorbers)))
    return (path,)


def _of_field(variable: Variable, field: Field, wanted: Range | Integer | Choice, where: str) -> Variable:
    if isinstance(wanted, Choice):
        if len(set(map(repr, wanted.values))) < 2:
            raise InputError(where, f"{len(wanted.values)} choices are given", "give at least two different ones")
        return replace(variable, levels=tuple(field.value(value, f"{where}[{i}]") for i, value in enumerate(wanted.values)))
    if field.quantity is None and not field.integer:
        raise InputError(where, "is not a number and has no interval", "give a list of choices")
    low, high = field.value(wanted.low, f"{where}.from"), field.value(wanted.high, f"{where}.to")
    if not low < high:
        raise InputError(where, f"the range from {low!r} to {high!r} is empty", "the first must be less than the second")
    if field.integer or isinstance(wanted, Integer):
        if high - low > MOST_LEVELS:
            raise InputError(where, f"the range from {low!r} to {high!r} has too many whole numbers", f"at most {MOST_LEVELS:,}")
        return replace(variable, low=low, high=high, levels=tuple(range(math.ceil(low), math.floor(high) + 1)))
    if wanted.scale not in ("linear", "log"):
        raise InputError(f"{where}.scale", f"{wanted.scale!r} is not allowed", 'must be "linear" or "log"')
    if wanted.scale == "log" and not low * high > 0:
        raise InputError(where, f"the range from {low!r} to {high!r} has no logarithm", 'both ends must have one sign with scale = "log"')
    return replace(variable, low=float(low), high=float(high), log=wanted.scale == "log")


def _each(base: System, name: str, wanted: Range | Integer | Choice, where: str) -> list[Variable]:
    """Return one variable an absorber, or a pair of mirror images."""
    mode = getattr(wanted, "each", "") or "single"
    if mode not in ("single", "mirror"):
        raise InputError(f"{where}.each", f"{mode!r} is not allowed", 'must be "single" or "mirror"')
    assert isinstance(base.absorbers, tuple)
    if not base.absorbers:
        raise InputError(where, "this system has no absorbers", "describe a ring of them first")
    plain = replace(wanted, each="") if isinstance(wanted, Range) else wanted
    made = []
    for one, image in _pairs(base, where) if mode == "mirror" else [(i, i) for i in range(len(base.absorbers))]:
        if name == "angle" and mode == "mirror" and one == image:
            continue  # it sits on the axis and stays there
        paths = [f"absorbers[{i}].{name}" for i in dict.fromkeys((one, image))]
        variable = _variable(base, paths[0], paths, plain, where)
        if name == "angle" and mode == "mirror":
            variable = replace(variable, paths=variable.paths[:1], mirrored=variable.paths[1:], axis=base.sources[0].angle)
        made.append(variable)
    return made


def _pairs(base: System, where: str) -> list[tuple[int, int]]:
    """Return (absorber, its mirror image about the first source's direction), each pair once."""
    axis = base.sources[0].angle
    absorbers: tuple[Absorber | PointAbsorber, ...] = base.absorber_list or base.point_absorbers

    def images(a: Absorber | PointAbsorber, b: Absorber | PointAbsorber) -> bool:
        at_one_z = getattr(a, "z", 0.0) == getattr(b, "z", 0.0)
        return at_one_z and linked_shells(a) == linked_shells(b) and abs(math.remainder(a.angle + b.angle - 2.0 * axis, 360.0)) < _SAME

    pairs = []
    for i, absorber in enumerate(absorbers):
        image = next((j for j, other in enumerate(absorbers) if images(absorber, other)), None)
        if image is None:
            remedy = 'give each = "single", or a symmetric layout'
            raise InputError(where, f"absorbers[{i}] at {absorber.angle:g} deg has no mirror image about {axis:g} deg", remedy)
        if i <= image:
            pairs.append((i, image))
    return pairs
