"""An interval of a field's values: its ends, how it is divided, on which scale."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Annotated, Any, ClassVar, Literal, Self

import numpy as np
from pydantic import ConfigDict
from pydantic import Field as Entry

from coaxshell.errors import InputError
from coaxshell.model.base import Described, shown
from coaxshell.model.paths import within
from coaxshell.studies.varied_fields import Field

MOST_VALUES = 1_000_000
"""Values of one field."""


class Span(Described):
    """Describe an interval: ``{from = 0, to = 50, step = 1}`` or ``{from = "1 kg", to = "20 kg", count = 20, scale = "log"}``."""

    model_config = ConfigDict(populate_by_name=True, validate_by_name=True)
    _called: ClassVar[str] = "a range"

    start: Annotated[Any, Entry(alias="from")]
    """Lower end, a number in SI or text with a unit."""
    to: Any
    """Upper end."""
    count: int | None = None
    """How many values, both ends included."""
    step: Any = None
    """Or the distance between neighbours."""
    scale: Literal["linear", "log"] = "linear"
    """Whether values are spread evenly, or their logarithms."""

    @classmethod
    def of(cls, given: Any, where: str) -> Self | None:
        """Return the span of a table (or a span), None for anything else; InputError when an entry is wrong."""
        if isinstance(given, cls):
            return given
        if not isinstance(given, Mapping):
            return None
        try:
            return cls.model_validate(dict(given))
        except InputError as error:
            raise within(where, InputError(error.where.replace("start", "from"), error.problem, error.remedy)) from None

    @classmethod
    def between(cls, given: Any, where: str) -> Self:
        """Return the span of two ends, or of a table without count and step."""
        span = cls.of(given, where)
        if span is None:
            if isinstance(given, str) or not isinstance(given, Sequence) or len(given) != 2:
                raise InputError(where, f"{shown(given)} are not two ends", "give (low, high), or a table with from and to")
            span = cls(start=given[0], to=given[1])
        if span.count is not None or span.step is not None:
            raise InputError(where, "count and step have no effect on sampled points", "leave them out and give samples")
        return span

    def ends(self, field: Field, where: str) -> tuple[float, float]:
        """Return both ends in SI; InputError if they are not numbers of the field's kind, or no interval."""
        if field.quantity is None and not field.integer:
            raise InputError(where, "is not a number and has no interval", "give a list of values")
        low, high = field.value(self.start, f"{where}.from"), field.value(self.to, f"{where}.to")
        if not low < high:
            raise InputError(where, f"the range from {low!r} to {high!r} is empty", "the first must be less than the second")
        if self.scale == "log" and low <= 0:
            raise InputError(f"{where}.from", f"{low!r} has no logarithm", 'must be greater than 0 with scale = "log"')
        return float(low), float(high)

    def values(self, field: Field, where: str) -> tuple[Any, ...]:
        """Return the values of the span, ends included."""
        low, high = self.ends(field, where)
        if (self.count is None) == (self.step is None):
            raise InputError(where, "needs either count or step", "give one of them")
        if self.count is not None:
            if not 2 <= self.count <= MOST_VALUES:
                raise InputError(f"{where}.count", f"{shown(self.count)} is not allowed", f"give 2 to {MOST_VALUES:,}")
            raw = np.geomspace(low, high, self.count) if self.scale == "log" else np.linspace(low, high, self.count)
        else:
            if self.scale == "log":
                raise InputError(f"{where}.step", 'has no meaning with scale = "log"', "give count")
            step = field.value(self.step, f"{where}.step")
            if not step > 0:
                raise InputError(f"{where}.step", f"{step!r} is not allowed", "must be greater than 0")
            if not (high - low) / step < MOST_VALUES:
                raise InputError(
                    f"{where}.step", f"{step!r} makes {(high - low) / step:.3g} values", f"at most {MOST_VALUES:,} are allowed"
                )
            raw = low + step * np.arange(math.floor((high - low) / step * (1 + 1e-12) + 1e-9) + 1)
        if field.integer:
            return tuple(dict.fromkeys(round(float(value)) for value in raw))
        return tuple(float(value) for value in raw)

    def at(self, shares: Iterable[float], field: Field, where: str) -> tuple[Any, ...]:
        """Return the values at shares from 0 to 1 of the span, whole for a count (each with equal chance)."""
        low, high = self.ends(field, where)
        if field.integer:
            return tuple(min(int(high), math.floor(low + share * (high - low + 1))) for share in shares)
        if self.scale == "log":
            return tuple(low * (high / low) ** share for share in shares)
        return tuple(low + share * (high - low) for share in shares)
