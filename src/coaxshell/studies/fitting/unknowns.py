"""What a fit looks for: properties of the system and clocks of records, as coordinates of one size."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from coaxshell.errors import InputError
from coaxshell.model.base import shown
from coaxshell.model.system import System
from coaxshell.numerics.arrays import FloatArray
from coaxshell.studies.fitting.measurement import FREE, Measurement
from coaxshell.studies.optimisation.variables import Variable, space_of
from coaxshell.studies.varied_fields import Field, field_of, varied

STEP = 1e-4
"""Of the coordinate of a property, for central differences: their own error and that of rounding are about 1e-8 of a slope then."""


@dataclass(frozen=True)
class Unknown:
    """One property, or one clock.

    Attributes
    ----------
    name, unit, long_name : str
    paths : tuple of str
        Fields of the system that take its value; none of a clock.
    records : tuple of int
        Of a clock: the numbers of the records that it times.
    start : float
        Where the search begins, SI.
    low, high : float
        Its limits, which may be infinite.
    size : float
        How large a change of it is one that matters, SI: 1 of its coordinate.
    log : bool
        Whether its coordinate is a logarithm.
    """

    name: str
    unit: str
    long_name: str
    paths: tuple[str, ...] = ()
    records: tuple[int, ...] = ()
    start: float = 0.0
    low: float = -math.inf
    high: float = math.inf
    size: float = 1.0
    log: bool = False

    def value(self, x: float) -> float:
        """Return the value at a coordinate, 0 at the start."""
        found = self.start * math.exp(x) if self.log else self.start + self.size * x
        return min(max(found, self.low), self.high)

    def coordinate(self, value: float) -> float:
        """Return the coordinate of a value."""
        if math.isinf(value):
            return value
        if self.log:
            return math.log(value / self.start) if value / self.start > 0 else -math.inf
        return (value - self.start) / self.size


@dataclass(frozen=True)
class Unknowns:
    """All that a fit looks for: properties first, then clocks."""

    system: System
    properties: tuple[Unknown, ...]
    clocks: tuple[Unknown, ...]

    @property
    def all(self) -> tuple[Unknown, ...]:
        """Properties, then clocks."""
        return (*self.properties, *self.clocks)

    @property
    def bounds(self) -> tuple[FloatArray, FloatArray]:
        """Limits of the coordinates."""
        ends = np.array([[one.coordinate(one.low), one.coordinate(one.high)] for one in self.all])
        return ends.min(axis=1), ends.max(axis=1)

    def values(self, x: FloatArray) -> list[float]:
        """Return the values at coordinates."""
        return [one.value(float(at)) for one, at in zip(self.all, x, strict=True)]

    def at(self, x: FloatArray) -> System | InputError:
        """Return the system at coordinates, or the reason why there is none."""
        changes = {path: one.value(float(at)) for one, at in zip(self.properties, x, strict=False) for path in one.paths}
        try:
            return varied(self.system, changes)
        except InputError as error:
            return error

    def offsets(self, x: FloatArray, records: Sequence[Measurement]) -> FloatArray:
        """Return what the clock of each record shows when the run begins, s."""
        found = np.array([one.clock if isinstance(one.clock, float) else 0.0 for one in records])
        for one, at in zip(self.clocks, x[len(self.properties) :], strict=True):
            found[list(one.records)] = one.value(float(at))
        return found


def unknowns_of(system: System, variables: Any, records: Sequence[Measurement]) -> Unknowns:
    """Return what a fit looks for, checked.

    Parameters
    ----------
    system : System
    variables : list of paths, or mapping of path (or name) to :class:`Range`
    records : sequence of Measurement

    Raises
    ------
    InputError
        There is no variable, a path is unknown, or not of a number that varies continuously, or a range does not hold the present value.
    """
    if isinstance(variables, str):
        variables = [variables]
    if isinstance(variables, Mapping):
        space = space_of(system, {name: given for name, given in variables.items() if given is not None})
        base, ranged = space.base, {variable.paths[0]: _of_range(space.base, variable) for variable in space.variables}
        free = [name for name, given in variables.items() if given is None]
    elif isinstance(variables, Sequence):
        base, ranged, free = system, {}, list(variables)
    else:
        raise InputError("variables", f"{shown(variables)} is neither a list nor a table", 'give ["source.decay_time"], say')
    found = [*ranged.values(), *(_of_field(base, path) for path in free)]
    if not found:
        raise InputError("variables", "there are none", 'give at least one, as in ["source.pulse.decay_time"]')
    paths = [path for one in found for path in one.paths]
    twice = next((path for path in paths if paths.count(path) > 1), None)
    if twice is not None:
        raise InputError(f"variables.{twice}", "is looked for twice", "give each field once")
    return Unknowns(base, tuple(found), _clocks(records))


def _of_field(system: System, path: Any) -> Unknown:
    if not isinstance(path, str):
        raise InputError("variables", f"{shown(path)} is no path", "give one such as source.distance")
    try:
        field = field_of(system, path)
    except InputError as error:
        raise InputError(f"variables.{error.where or path}", error.problem, error.remedy) from None
    value = _number(field)
    quantity = field.quantity
    assert quantity is not None
    if value == 0.0:
        raise InputError(f"variables.{path}", "begins at 0, which does not tell how large it may be", "give a range, or begin elsewhere")
    ends = [max(x for x in (quantity.above, quantity.least, -math.inf) if x is not None)]
    ends += [min(x for x in (quantity.below, quantity.most, math.inf) if x is not None)]
    positive = ends[0] >= 0.0 and value > 0.0
    low = value * 1e-6 if positive and quantity.above is not None else ends[0]
    name = path.strip()
    return Unknown(name, field.units, field.long_name, (name,), (), value, low, ends[1], abs(value))


def _of_range(system: System, variable: Variable) -> Unknown:
    value = _number(field_of(system, variable.paths[0]))
    if variable.levels or variable.mirrored:
        problem = "is a count or a choice" if variable.levels else "is mirrored"
        raise InputError(f"variables.{variable.name}", f"{problem}, and a fit looks for numbers that vary continuously", "give a range")
    if not variable.low <= value <= variable.high:
        problem = f"begins at {value:g} in the system, outside its range from {variable.low:g} to {variable.high:g}"
        raise InputError(f"variables.{variable.name}", problem, "widen the range, or change the system")
    size = abs(value) or 0.5 * (variable.high - variable.low)
    told = (variable.name, variable.units, variable.long_name, variable.paths, ())
    return Unknown(*told, value, variable.low, variable.high, size, variable.log)


def _number(field: Field) -> float:
    if field.quantity is None or not isinstance(field.present, int | float) or not math.isfinite(field.present):
        raise InputError(f"variables.{field.path}", "is not a number that varies continuously", "give one such as source.distance")
    return float(field.present)


def _clocks(records: Sequence[Measurement]) -> tuple[Unknown, ...]:
    """Return the clocks that are not known: one a record, or one for all records of a name."""
    groups: dict[str, list[int]] = {}
    for number, one in enumerate(records):
        if isinstance(one.clock, str):
            name = f"clock of {one.name}" if one.clock == FREE else f"clock {one.clock}"
            groups.setdefault(name, []).append(number)
    made = []
    for name, members in groups.items():
        first = records[members[0]]
        reach = max(_reach(records[k]) for k in members)
        guess = first.clock_guess
        told = "what the clock of the record shows when the run begins"
        made.append(Unknown(name, "s", told, (), tuple(members), guess, guess - reach, guess + reach, reach))
    return tuple(made)


def _reach(one: Measurement) -> float:
    return one.clock_range if one.clock_range is not None else 0.25 * (one.time[-1] - one.time[0])
