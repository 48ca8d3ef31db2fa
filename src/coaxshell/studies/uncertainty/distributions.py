"""Uncertain properties of a system, and the fixed points at which a study samples them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields, replace
from typing import Any

from coaxshell.errors import InputError
from coaxshell.model.system import System
from coaxshell.model.units import DIMENSIONS, to_si
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.late import stats
from coaxshell.numerics.scalars import plain
from coaxshell.studies.uncertainty.laws import ENTRIES, Distribution, LogNormal, Normal, Uniform, check, law_of
from coaxshell.studies.varied_fields import Field, field_of, varied

__all__ = ["Coordinate", "Distribution", "LogNormal", "Normal", "Uncertain", "Uniform", "coordinates_of", "uncertain_of", "unit_points"]

LARGEST_CUT = 0.01
"""Share of a distribution that may lie beyond a field's limits; it is cut off and the rest scaled up."""
MOST_SAMPLES = 2**16
_CLOSEST = 2.0**-32  # to 0 and 1, where a normal distribution has no value; Sobol points are multiples of 2^-30


@dataclass(frozen=True)
class Coordinate:
    """One uncertain field with its distribution in SI (or in factors)."""

    field: Field
    distribution: Distribution

    @property
    def labelled(self) -> Field:
        """The field as which drawn numbers are labelled: itself, or a factor of it."""
        if not self.distribution.relative:
            return self.field
        return replace(self.field, units="1", long_name=f"factor of {self.field.path}", quantity=None)

    def limits(self, present: float) -> tuple[float, float]:
        """Return the smallest and the largest number that the field allows, as factors if the distribution is relative."""
        quantity = self.field.quantity
        assert quantity is not None  # coordinates_of refuses other fields
        ends = [max(x for x in (quantity.above, quantity.least, -math.inf) if x is not None)]
        ends += [min(x for x in (quantity.below, quantity.most, math.inf) if x is not None)]
        if self.distribution.relative:
            ends = sorted(end / present for end in ends)
        return ends[0], ends[1]

    def quantile(self, share: float, present: float) -> float:
        """Return the number below which a share of the distribution lies, what is beyond the field's limits cut off.

        Parameters
        ----------
        share : float
            From 0 to 1.
        present : float
            Nominal value of the field, of which a relative distribution gives factors.
        """
        low, high = (self.distribution.share(end) for end in self.limits(present))
        return self.distribution.quantile(low + min(max(share, _CLOSEST), 1.0 - _CLOSEST) * (high - low))


@dataclass(frozen=True)
class Uncertain:
    """Uncertain properties, and the points of the unit cube at which every design of a study is run (common random numbers).

    Attributes
    ----------
    coordinates : tuple of Coordinate
    points : tuple of tuple of float
    """

    coordinates: tuple[Coordinate, ...]
    points: tuple[tuple[float, ...], ...]

    def scenarios(self, system: System) -> list[System | InputError]:
        """Return a system and, after it, its samples."""
        return [system, *(self.sample(system, point) for point in self.points)]

    def drawn(self, system: System, point: tuple[float, ...]) -> list[float]:
        """Return the number (or factor) of every coordinate at a point of the unit cube."""
        return [
            coordinate.quantile(share, field_of(system, coordinate.field.path).present if coordinate.distribution.relative else 1.0)
            for coordinate, share in zip(self.coordinates, point, strict=True)
        ]

    def sample(self, system: System, point: tuple[float, ...]) -> System | InputError:
        """Return a system with its uncertain properties at a point of the unit cube, or the reason why there is none."""
        changes: dict[str, Any] = {}
        try:
            for coordinate, number in zip(self.coordinates, self.drawn(system, point), strict=True):
                changes |= _changes(system, coordinate, number)
            return varied(system, changes)
        except InputError as error:
            return error

    def identity(self) -> list[Any]:
        """Return what tells it from another, as plain data."""
        laws: list[Any] = [[one.field.path, type(one.distribution).__name__, asdict(one.distribution)] for one in self.coordinates]
        return laws + [list(point) for point in self.points]


def _changes(system: System, coordinate: Coordinate, drawn: float) -> dict[str, Any]:
    path, relative = coordinate.field.path, coordinate.distribution.relative
    name = path.removeprefix("absorbers.")
    if relative and name != path and isinstance(system.absorbers, tuple) and hasattr(next(iter(system.absorbers), None), name):
        return {f"absorbers[{i}].{name}": drawn * getattr(absorber, name) for i, absorber in enumerate(system.absorbers)}
    return {path: drawn * field_of(system, path).present if relative else drawn}


def uncertain_of(system: System, given: Mapping[str, Any], samples: int, seed: int) -> Uncertain:
    """Return the uncertain properties of a system, checked, with scrambled Sobol points to sample them.

    Parameters
    ----------
    system : System
    given : mapping of path to distribution
        :class:`Uniform`, :class:`Normal`, :class:`LogNormal`, or a table (:func:`coaxshell.studies.uncertainty.laws.law_of`).
    samples : int
    seed : int

    Raises
    ------
    InputError
        An unknown path, no such distribution, a wrong unit, an empty, a degenerate or an impossible distribution.
    """
    if not given:
        return Uncertain((), ())
    coordinates = coordinates_of(system, given, "uncertain")
    return Uncertain(coordinates, tuple(tuple(map(float, point)) for point in unit_points(len(coordinates), samples, seed)))


def unit_points(dimensions: int, samples: int, seed: int) -> FloatArray:
    """Return scrambled Sobol points of the unit cube, shape (samples, dimensions); InputError if *samples* or *seed* is not allowed."""
    samples, seed = plain(samples), plain(seed)
    if isinstance(samples, bool) or not isinstance(samples, int) or not 2 <= samples <= MOST_SAMPLES:
        raise InputError("samples", f"{samples!r} is not allowed", f"give a whole number from 2 to {MOST_SAMPLES}")
    if isinstance(seed, bool) or not isinstance(seed, int) or seed < 0:
        raise InputError("seed", f"{seed!r} is not allowed", "give a whole number of 0 or more")
    return stats.qmc.Sobol(dimensions, rng=seed).random(2 ** math.ceil(math.log2(samples)))[:samples]


def coordinates_of(system: System, given: Mapping[str, Any], where: str) -> tuple[Coordinate, ...]:
    """Return the fields with their distributions in SI; InputError as for :func:`uncertain_of`."""
    if not isinstance(given, Mapping) or not given:
        raise InputError(where, "there are none", 'give at least one, as in {"source.distance": Uniform(4, 6)}')
    found = []
    for path, law in given.items():
        place = f"{where}.{path}"
        try:
            field = field_of(system, path)
        except InputError as error:
            raise InputError(place, error.problem, error.remedy) from None
        if field.quantity is None or not isinstance(field.present, float):
            raise InputError(place, "is not a real number", "only real numbers can be uncertain")
        coordinate = Coordinate(field, _in_si(field, law_of(law, place), place))
        _possible(coordinate, place)
        found.append(coordinate)
    return tuple(found)


def _in_si(field: Field, law: Distribution, where: str) -> Distribution:
    """Return a distribution with its numbers in SI."""
    assert field.quantity is not None
    plain = DIMENSIONS["number"]
    own = plain if law.relative else field.quantity.dimension
    numbers = []
    words = next(words for kind, words in ENTRIES.values() if isinstance(law, kind))
    for entry, word, kind in zip(fields(law), words, (own, plain if isinstance(law, LogNormal) else own), strict=False):
        try:
            numbers.append(to_si(getattr(law, entry.name), kind))
        except InputError as error:
            raise InputError(f"{where}.{word}", error.problem, error.remedy) from None
    first, second = numbers
    made = Uniform(first, second, law.relative, law.log) if isinstance(law, Uniform) else type(law)(first, second, law.relative)
    check(made, where)
    return made


def _possible(coordinate: Coordinate, where: str) -> None:
    """Refuse a distribution that asks for values which the field does not allow, or whose limits would cut off much of it."""
    law, present = coordinate.distribution, coordinate.field.present
    if law.relative and present == 0:
        raise InputError(where, "its nominal value is 0, of which all factors are 0", "give a distribution of the value itself")
    for number in (law.low, law.high) if isinstance(law, Uniform) else (law.quantile(0.5),):
        coordinate.field.value(number * present if law.relative else number, where)
    low, high = (law.share(end) for end in coordinate.limits(present))
    cut = 1.0 - (high - low)
    if cut > LARGEST_CUT:
        problem = f"{100 * cut:.3g} % of this distribution are values that are not allowed"
        raise InputError(
            where, problem, f"at most {100 * LARGEST_CUT:g} % are cut off: give a smaller spread, or a uniform or lognormal one"
        )
