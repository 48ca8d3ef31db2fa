"""Electrodes cut into segments around a wall, and into belts along the axis, as a control law describes them."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BeforeValidator, Field

from coaxshell.errors import InputError
from coaxshell.model.units import quantity, whole
from coaxshell.numerics.scalars import plain

FARTHEST = 10_000
"""The highest number of a belt that can be dead."""
BELTS = "give a list of belts by number; belt 0 has its middle at z = 0, n at n times segment_pitch, negative ones on the other side"
PAIRS = "give pairs of a belt and a segment of it, as in [[0, 3], [-1, 5]]"
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


def _is_belt(value: Any) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and abs(value) <= FARTHEST


def _dead_belts(value: Any) -> tuple[int, ...]:
    """Return numbers of belts, ascending; one number alone is a list of one."""
    value = plain(value)
    listed = list(value) if isinstance(value, list | tuple | range) else [value]
    numbers = [plain(one) for one in listed]
    if not all(_is_belt(one) for one in numbers):
        raise InputError("", f"{value!r} is not allowed", BELTS)
    if len(set(numbers)) < len(numbers):
        raise InputError("", f"{value!r} names a belt twice", BELTS)
    return tuple(sorted(numbers))


def _dead_electrodes(value: Any) -> tuple[tuple[int, int], ...]:
    """Return pairs of a belt and a segment, ascending."""
    value = plain(value)
    listed = [plain(one) for one in value] if isinstance(value, list | tuple) else [value]
    if not all(isinstance(pair, list | tuple) and len(pair) == 2 for pair in listed):
        raise InputError("", f"{value!r} is not allowed", PAIRS)
    pairs = [tuple(plain(one) for one in pair) for pair in listed]
    if not all(_is_belt(one) for pair in pairs for one in pair):
        raise InputError("", f"{value!r} is not allowed", PAIRS)
    if len(set(pairs)) < len(pairs):
        raise InputError("", f"{value!r} names an electrode twice", PAIRS)
    return tuple(sorted(pairs))


Count = Annotated[int, Field(ge=1, le=10_000), BeforeValidator(whole)]
Gap = Annotated[float, quantity("length", above=0)]
Length = Annotated[float, quantity("length", above=0)]
Dead = Annotated[tuple[int, ...], BeforeValidator(_dead)]
DeadBelts = Annotated[tuple[int, ...], BeforeValidator(_dead_belts)]
DeadElectrodes = Annotated[tuple[tuple[int, int], ...], BeforeValidator(_dead_electrodes)]


def require_segments(law: Any) -> None:
    """Raise InputError if what a law says of segments does not go together."""
    _require_belts(law.segment_pitch, law.segment_length, law.transducers)
    _require_single(law)
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


def _require_single(law: Any) -> None:
    """Raise InputError if the single belts and electrodes that are dead are none of those that a law cuts."""
    for name in ("dead_belts", "dead_electrodes"):
        if getattr(law, name) and law.segment_pitch is None:
            told = "is said of electrodes that are not cut along the axis"
            raise InputError(name, told, f"give segment_pitch too, from middle to middle, or leave {name} out")
    pairs, segments = law.dead_electrodes or (), law.segments
    if pairs and segments is None:
        told = "names segments of electrodes that are not cut around the wall"
        raise InputError("dead_electrodes", told, "give the number of segments too, or whole belts as dead_belts")
    for belt, segment in pairs:
        if not 0 <= segment < segments:
            told = f"[{belt}, {segment}]: {segment} is no segment of {segments}"
            raise InputError("dead_electrodes", told, f"{PAIRS}, segments 0 to {segments - 1}")


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
