"""Electrodes cut into segments around a wall, as a control law describes them."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BeforeValidator, Field

from coaxshell.errors import InputError
from coaxshell.model.units import quantity, whole
from coaxshell.numerics.scalars import plain

NUMBERS = "give a list of segments by number; segment 0 has its middle at theta = 0, the others follow counterclockwise"


def _dead(value: Any) -> tuple[int, ...]:
    """Return numbers of segments, ascending; one number alone is a list of one."""
    value = plain(value)
    listed = list(value) if isinstance(value, list | tuple | range) else [value]
    numbers = [plain(one) for one in listed]
    if any(isinstance(one, bool) or not isinstance(one, int) or one < 0 for one in numbers):
        raise InputError("", f"{value!r} is not allowed", NUMBERS)
    if len(set(numbers)) < len(numbers):
        raise InputError("", f"{value!r} names a segment twice", NUMBERS)
    return tuple(sorted(numbers))


Count = Annotated[int, Field(ge=1, le=10_000), BeforeValidator(whole)]
Gap = Annotated[float, quantity("length", above=0)]
Dead = Annotated[tuple[int, ...], BeforeValidator(_dead)]


def require_segments(segments: int | None, gap: float | None, dead: tuple[int, ...] | None, transducers: str) -> None:
    """Raise InputError if what is said of segments does not go together."""
    if segments is None:
        for name, given in (("segment_gap", gap), ("dead", dead)):
            if given is not None:
                raise InputError(name, "is said of electrodes that are not cut", f"give the number of segments too, or leave {name} out")
        return
    if transducers != "electrodes":
        raise InputError("segments", f"{segments} are not known to the paper's law", 'use transducers = "electrodes"')
    if dead and dead[-1] >= segments:
        raise InputError("dead", f"{dead[-1]} is no segment of {segments}", f"{NUMBERS}: 0 to {segments - 1}")
    if dead and len(dead) == segments:
        raise InputError("dead", f"lists all {segments} segments", "leave control out, or some segments alive")
