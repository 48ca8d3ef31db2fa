"""Electrodes cut into segments around a wall, and into belts along the axis, as a control law describes them."""

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
Length = Annotated[float, quantity("length", above=0)]
Dead = Annotated[tuple[int, ...], BeforeValidator(_dead)]


def require_segments(law: Any) -> None:
    """Raise InputError if what a law says of segments does not go together."""
    _require_belts(law.segment_pitch, law.segment_length, law.transducers)
    segments, gap, dead, transducers = law.segments, law.segment_gap, law.dead, law.transducers
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


def _require_belts(pitch: float | None, length: float | None, transducers: str) -> None:
    """Raise InputError if what is said of electrodes that are cut along the axis does not go together."""
    if pitch is None:
        if length is not None:
            told = "is said of electrodes that are not cut along the axis"
            raise InputError("segment_length", told, "give segment_pitch too, from middle to middle, or leave segment_length out")
        return
    if transducers != "electrodes":
        told = f"{pitch:g} m: electrodes cut along the axis are not known to the paper's law"
        raise InputError("segment_pitch", told, 'use transducers = "electrodes"')
    if length is not None and length > pitch:
        told = f"{length:g} m is more than the {pitch:g} m from middle to middle"
        raise InputError("segment_length", told, f"must be at most segment_pitch, {pitch:g} m, which leaves no gap")
