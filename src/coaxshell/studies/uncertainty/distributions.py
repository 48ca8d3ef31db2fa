"""Uncertain properties of a system as distributions, and the fixed points at which a study samples them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, is_dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.stats import norm, qmc

from coaxshell.errors import InputError
from coaxshell.model.base import shown
from coaxshell.model.system import System
from coaxshell.model.units import DIMENSIONS, to_si
from coaxshell.studies.paths import Field, field_of, varied

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Uniform:
    """Equally likely between two ends, in SI or text with a unit; with ``relative=True`` factors of the nominal value."""

    low: Any
    high: Any
    relative: bool = False


@dataclass(frozen=True)
class Normal:
    """Normal with a mean and a standard deviation; with ``relative=True`` factors of the nominal value, as ``Normal(1, 0.05, True)``."""

    mean: Any
    deviation: Any
    relative: bool = False


@dataclass(frozen=True)
class LogNormal:
    """The logarithm is normal: *median*, and *factor* > 1 within which (times or over) 68 % lie; may be relative."""

    median: Any
    factor: float
    relative: bool = False


Distribution = Uniform | Normal | LogNormal


@dataclass(frozen=True)
class Coordinate:
    """One uncertain field with its distribution in SI (or in factors)."""

    field: Field
    distribution: Distribution

    def quantile(self, share: float) -> float:
        """Return the value (or factor) below which a share of the distribution lies."""
        law = self.distribution
        if isinstance(law, Uniform):
            return float(law.low + share * (law.high - law.low))
        score = float(norm.ppf(share))
        return float(law.mean + score * law.deviation) if isinstance(law, Normal) else float(law.median * law.factor**score)


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

    def sample(self, system: System, point: tuple[float, ...]) -> System | InputError:
        """Return a system with its uncertain properties at a point of the unit cube, or the reason why there is none."""
        changes: dict[str, Any] = {}
        try:
            for coordinate, share in zip(self.coordinates, point, strict=True):
                changes |= _changes(system, coordinate, coordinate.quantile(share))
            return varied(system, changes)
        except InputError as error:
            return error

    def identity(self) -> list[Any]:
        """Return what tells it from another, as plain data."""
        return [[one.field.path, type(one.distribution).__name__, asdict(one.distribution)] for one in self.coordinates] + [
            list(p) for p in self.points
        ]


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
    given : mapping of path to Uniform, Normal, LogNormal, or a table such as ``{normal = [1, 0.05], relative = true}``
    samples : int
    seed : int

    Raises
    ------
    InputError
        An unknown path, no such distribution, a wrong unit, an empty or a degenerate distribution.
    """
    if not given:
        return Uncertain((), ())
    if isinstance(samples, bool) or not isinstance(samples, int) or not 2 <= samples <= 2**16:
        raise InputError("samples", f"{samples!r} is not allowed", "give a whole number from 2 to 65536")
    coordinates = coordinates_of(system, given, "uncertain")
    unit = qmc.Sobol(len(coordinates), rng=seed).random(2 ** math.ceil(math.log2(samples)))[:samples]
    return Uncertain(coordinates, tuple(tuple(map(float, point)) for point in unit))


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
        if field.quantity is None:
            raise InputError(place, "is not a real number", "only real numbers can be uncertain")
        found.append(Coordinate(field, _in_si(field, _distribution(law, place), place)))
    return tuple(found)


_KINDS: dict[str, type[Distribution]] = {"uniform": Uniform, "normal": Normal, "lognormal": LogNormal}


def _distribution(given: Any, where: str) -> Distribution:
    if isinstance(given, Uniform | Normal | LogNormal):
        return given
    if isinstance(given, Mapping) and len(kinds := [key for key in given if key in _KINDS]) == 1 and not set(given) - {*kinds, "relative"}:
        numbers = given[kinds[0]]
        if isinstance(numbers, list | tuple) and len(numbers) == 2:
            return _KINDS[kinds[0]](numbers[0], numbers[1], bool(given.get("relative", False)))
    remedy = (
        "write {uniform = [low, high]}, {normal = [mean, deviation]} or {lognormal = [median, factor]}, with relative = true for factors"
    )
    raise InputError(where, f"{shown(given)} is not a distribution", remedy)


def _in_si(field: Field, law: Distribution, where: str) -> Distribution:
    assert is_dataclass(law)
    names = list(asdict(law))[:2]
    plain = DIMENSIONS["number"]
    assert field.quantity is not None
    kinds = (
        [plain, plain] if law.relative else [field.quantity.dimension, plain if isinstance(law, LogNormal) else field.quantity.dimension]
    )
    try:
        first, second = (to_si(getattr(law, name), kind) for name, kind in zip(names, kinds, strict=True))
    except InputError as error:
        raise InputError(where, error.problem, error.remedy) from None
    if isinstance(law, Uniform) and not first < second:
        raise InputError(where, f"the range from {first!r} to {second!r} is empty", "the first must be less than the second")
    if isinstance(law, Normal) and not second > 0:
        raise InputError(where, f"a standard deviation of {second!r} is not allowed", "must be greater than 0")
    if isinstance(law, LogNormal) and not (first > 0 and second > 1):
        raise InputError(
            where,
            f"a median of {first!r} with a factor of {second!r} is not allowed",
            "the median must be greater than 0, the factor than 1",
        )
    return type(law)(first, second, law.relative)
