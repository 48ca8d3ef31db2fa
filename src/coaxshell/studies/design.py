"""Which points of which fields a sweep visits: full grids, lists side by side, Latin hypercubes, Sobol points."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any, Literal, get_args

import numpy as np

from coaxshell.errors import InputError
from coaxshell.model.base import shown
from coaxshell.model.naming import suggestion
from coaxshell.model.system import System
from coaxshell.numerics.scalars import plain
from coaxshell.studies.span import Span
from coaxshell.studies.varied_fields import Field, field_of

Points = Literal["grid", "zip", "latin-hypercube", "sobol"]
POINTS: tuple[Points, ...] = get_args(Points)
SAMPLED = ("latin-hypercube", "sobol")
MOST_CASES = 1_000_000
MOST_SEED = 2**64


@dataclass(frozen=True)
class Design:
    """The cases of a sweep.

    Attributes
    ----------
    fields : tuple of Field
    points : str
    values : tuple of tuple
        One tuple a field: its values on the axis of a grid, or its value in every case.
    scales: tuple of str
        One a field: "log" where it was asked for as a span with its logarithms spread evenly, else "linear".
    """

    fields: tuple[Field, ...]
    points: Points
    values: tuple[tuple[Any, ...], ...]
    scales: tuple[str, ...]

    @property
    def cases(self) -> list[dict[str, Any]]:
        """The values of every case by path, the last field of a grid changing fastest."""
        rows = product(*self.values) if self.points == "grid" else zip(*self.values, strict=True)
        return [dict(zip((field.path for field in self.fields), row, strict=True)) for row in rows]

    @property
    def shape(self) -> tuple[int, ...]:
        """The lengths of a grid's axes, or the number of cases."""
        lengths = tuple(len(values) for values in self.values)
        return lengths if self.points == "grid" else lengths[:1]


def design_of(system: System, over: Mapping[str, Any], points: str = "grid", samples: int | None = None, seed: int = 0) -> Design:
    """Return the cases of a sweep, checked against the base system.

    Parameters
    ----------
    system : System
    over : mapping of dotted path to values
        For "grid" and "zip" a sequence of values, or a table {from, to, count} or {from, to, step}, with scale = "log" if wanted;
        for "latin-hypercube" and "sobol" the two ends (low, high), or a table {from, to, scale}. Numbers in SI, or text with units.
    points : str
    samples : int, optional
        Number of sampled points; a power of two keeps the balance of "sobol".
    seed : int
        Of the random scrambling: the same seed gives the same points.

    Raises
    ------
    InputError
        Nothing to vary, an unknown path, an empty range, a value of the wrong unit, lists of unequal lengths, too many cases.
    """
    if points not in POINTS:
        raise InputError("points", f"{points!r} is unknown", suggestion(str(points), POINTS))
    if not isinstance(over, Mapping) or not over:
        raise InputError("over", "nothing to vary", 'name at least one path and its values, as in {"absorbers.count": range(51)}')
    fields = tuple(_field(system, path) for path in over)
    given = list(over.values())
    if points in SAMPLED:
        values = _sampled(fields, given, points, samples, seed)
    else:
        if samples is not None:
            raise InputError("samples", f"{samples!r} has no effect on points = {points!r}", "leave it out")
        values = tuple(_listed(field, item) for field, item in zip(fields, given, strict=True))
    if points == "zip" and len({len(column) for column in values}) > 1:
        lengths = ", ".join(f"{field.path}: {len(column)}" for field, column in zip(fields, values, strict=True))
        raise InputError("over", f"the lists differ in length ({lengths})", 'points = "zip" takes them side by side: make them equal')
    count = math.prod(len(column) for column in values) if points == "grid" else len(values[0])
    if count > MOST_CASES:
        raise InputError("over", f"asks for {count} cases", f"at most {MOST_CASES} are allowed")
    return Design(fields, points, values, tuple(_scale(item) for item in given))


def _scale(given: Any) -> str:
    return str(given.get("scale", "linear")) if isinstance(given, Mapping) else given.scale if isinstance(given, Span) else "linear"


def _field(system: System, path: str) -> Field:
    try:
        return field_of(system, path)
    except InputError as error:
        raise InputError(f"over.{error.where}" if error.where else "over", error.problem, error.remedy) from None


def _listed(field: Field, given: Any) -> tuple[Any, ...]:
    """Return the values of one field, each checked and in SI."""
    where = f"over.{field.path}"
    span = Span.of(given, where)
    if span is not None:
        return span.values(field, where)
    if isinstance(given, np.ndarray):
        given = given.tolist()
    if isinstance(given, (str, bytes)) or not isinstance(given, (Sequence, range)):
        raise InputError(where, f"{shown(given)} is not a list of values", "give a list, or a table with from, to and count")
    if len(given) == 0:
        raise InputError(where, "the range is empty", "give at least one value")
    return tuple(field.value(item, f"{where}[{number}]") for number, item in enumerate(given))


def _sampled(fields: Sequence[Field], given: Sequence[Any], points: str, samples: int | None, seed: int) -> tuple[tuple[Any, ...], ...]:
    """Return points that fill a box, one tuple a field."""
    from scipy.stats import qmc

    samples, seed = plain(samples), plain(seed)
    if samples is None or isinstance(samples, bool) or not isinstance(samples, int) or not 1 <= samples <= MOST_CASES:
        raise InputError("samples", f"{shown(samples)} is not allowed", f"points = {points!r} needs a whole number from 1 to {MOST_CASES}")
    if isinstance(seed, bool) or not isinstance(seed, int) or not 0 <= seed < MOST_SEED:
        raise InputError("seed", f"{shown(seed)} is not allowed", f"give a whole number from 0 to {MOST_SEED - 1}")
    spans = [Span.between(item, f"over.{field.path}") for field, item in zip(fields, given, strict=True)]
    engine = qmc.LatinHypercube(len(fields), rng=seed) if points == "latin-hypercube" else qmc.Sobol(len(fields), rng=seed)
    if points == "sobol":  # whole powers of two, of which the first are taken: the same points as drawing them one by one
        unit = engine.random(2 ** math.ceil(math.log2(samples)))[:samples]
    else:
        unit = engine.random(samples)
    return tuple(span.at(column.tolist(), field, f"over.{field.path}") for span, field, column in zip(spans, fields, unit.T, strict=True))
