"""What must hold of a system as a whole, one check a function; every message names the numbers that clash."""

from __future__ import annotations

import math
from itertools import pairwise

from coaxshell.errors import InputError
from coaxshell.model.absorbers import Absorber, AbsorberRing, PointAbsorber, linked_shells
from coaxshell.model.control import PDControl
from coaxshell.model.feedback import Feedback
from coaxshell.model.fluids import Vacuum
from coaxshell.model.gains import wired
from coaxshell.model.layers import Shell, serves
from coaxshell.model.parts import SystemParts, laws_of, shells_under
from coaxshell.model.sea import require_possible
from coaxshell.model.shells import RigidShell
from coaxshell.model.sources import UnderwaterExplosion

_SAME_DEPTH = 0.02
"""Share of a depth by which two statements of it may differ."""


def check(system: SystemParts) -> None:
    """Check the whole; InputError on the first thing that does not fit."""
    _shells(system)
    _fluids(system)
    _sources(system)
    _absorbers(system)
    _control(system)
    _sea(system)


def _shells(system: SystemParts) -> None:
    if not system.shells:
        raise InputError("shells", "the list is empty", "give at least 1 shell")
    for number, (inner, outer) in enumerate(pairwise(system.shells)):
        if inner.outer_radius >= outer.inner_radius:
            raise InputError(
                f"shells[{number + 1}].radius",
                f"its inner face at {outer.inner_radius:g} m is not outside the outer face of shells[{number}] at {inner.outer_radius:g} m",
                "list the shells from the inside out, without overlap",
            )


def _fluids(system: SystemParts) -> None:
    wanted = len(system.shells) + 1
    if len(system.fluids) != wanted:
        raise InputError(
            "fluids",
            f"the list has {len(system.fluids)} for {len(system.shells)} shell(s)",
            f"must be {wanted}, from the innermost to the exterior",
        )
    if isinstance(system.fluids[-1], Vacuum):
        raise InputError(f"fluids[{wanted - 1}]", "'vacuum' is not allowed for the exterior", "must be a fluid, since it carries the shock")


def _sources(system: SystemParts) -> None:
    if not system.sources:
        raise InputError("source", "the list is empty", "give at least 1 source")
    radius = system.shells[-1].outer_radius
    several = isinstance(system.source, tuple)
    for number, (source, distance) in enumerate(zip(system.sources, system.source_distances, strict=True)):
        where = f"source[{number}]" if several else "source"
        if isinstance(source, UnderwaterExplosion):
            thickness = radius - system.head_radius
            if source.stand_off <= thickness:
                raise InputError(
                    f"{where}.stand_off", f"{source.stand_off!r} m is within the wall", f"must be greater than {thickness:g} m"
                )
        elif distance is not None and distance <= radius:
            raise InputError(
                f"{where}.distance",
                f"{distance!r} m is not outside the outermost shell",
                f"must be greater than its outer radius {radius:g} m",
            )


def _sea(system: SystemParts) -> None:
    if system.sea is None:
        return
    several = isinstance(system.source, tuple)
    placed = [
        (f"source[{number}]" if several else "source", distance, source.angle, source.geometry == "plane")
        for number, (source, distance) in enumerate(zip(system.sources, system.source_distances, strict=True))
    ]
    require_possible(system.sea, system.shells[-1].outer_radius, placed)
    for (where, distance, angle, _), source in zip(placed, system.sources, strict=True):
        depth = getattr(source, "charge_depth", None)
        below = system.sea.depth - system.sea.height_of(distance, angle)
        if depth is not None and abs(depth - below) > _SAME_DEPTH * below:
            found = f"{depth:g} m, but with the sea's depth, its stand-off and its angle it lies {below:.4g} m below the surface"
            raise InputError(f"{where}.charge_depth", found, f"give {below:.4g} m, or change the others")


def _absorbers(system: SystemParts) -> None:
    single = isinstance(system.absorbers, tuple)
    listed: tuple[Absorber | AbsorberRing | PointAbsorber, ...] = (
        system.absorbers if isinstance(system.absorbers, tuple) else (system.absorbers,)
    )
    if len(system.shells) < 2 and len(system.absorbers) == 0:
        return  # an empty ring fits any system
    for number, absorber in enumerate(listed):
        where = f"absorbers[{number}]" if single else "absorbers"
        alone = len(system.shells) < 2
        if alone and absorber.links == "both":
            remedy = 'add a shell, give links = "outer" for a mass on this one alone, or leave the absorbers out'
            raise InputError(where, "an absorber links two shells, and this system has 1", remedy)
        inner, most = absorber.inner_shell, max(len(system.shells) - 2, 0)
        if inner > most:
            raise InputError(
                f"{where}.inner_shell",
                f"{inner} has no shell outside it",
                f"must be at most {most} in a system of {len(system.shells)} shells",
            )
        _outer_shell(where, absorber, len(system.shells))
        outer = inner if alone else linked_shells(absorber)[1]
        ends = {"both": [inner, outer], "inner": [inner], "outer": [outer]}[absorber.links]
        if all(isinstance(system.shells[end], RigidShell) for end in ends):
            found = " and ".join(f"shells[{end}]" for end in ends)
            are = "are" if len(ends) > 1 else "is"
            raise InputError(f"{where}.inner_shell", f"{inner} links {found}, which {are} rigid", "must link an elastic shell")
        if absorber.footprint is not None:
            around = 2.0 * math.pi * system.shells[inner].radius
            if absorber.footprint > around:
                found = f"{absorber.footprint:g} m is more than the circumference of shells[{inner}]"
                raise InputError(f"{where}.footprint", found, f"must be at most {around:.4g} m")


def _outer_shell(where: str, absorber: Absorber | AbsorberRing | PointAbsorber, shells: int) -> None:
    """Raise InputError if the outer shell that an absorber names is none of a system."""
    outer = absorber.outer_shell
    if outer is not None and outer >= shells:
        of = "1 shell" if shells == 1 else f"{shells} shells"
        remedy = f"must be at most {shells - 1}, or leave it out for the next one out" if shells > 1 else "leave it out"
        raise InputError(f"{where}.outer_shell", f"{outer} is no shell of this system of {of}", remedy)


def _control(system: SystemParts) -> None:
    several = isinstance(system.control, tuple)
    owner: dict[int, str] = {}
    for place, law in enumerate(laws_of(system)):
        where = f"control[{place}]" if several else "control"
        _law(system, law, where)
        for number in shells_under(system, law):
            if number in owner:
                told = f"shells[{number}] is under {owner[number]} already"
                raise InputError(f"{where}.shells", told, "name other shells: each has one law")
            owner[number] = where
        first = laws_of(system)[0]
        if (law.segments, law.dead) != (first.segments, first.dead):
            found = "other walls are cut otherwise, and segments are known of walls that are cut at the same angles"
            raise InputError(f"{where}.segments", found, "give all laws the same segments and the same dead ones")
        if (law.segment_pitch, law.segment_length) != (first.segment_pitch, first.segment_length):
            found = "other walls are cut otherwise along the axis, where electrodes are known to lie over each other"
            raise InputError(f"{where}.segment_pitch", found, "give all laws the same segment_pitch and the same segment_length")
        for single in ("dead_belts", "dead_electrodes"):
            if (getattr(law, single) or ()) != (getattr(first, single) or ()):
                found = "other walls have others, and electrodes that lie over each other are known to be dead together"
                raise InputError(f"{where}.{single}", found, f"give all laws the same {single}")
        name = "current_saturation" if law.current_saturation else "saturation"
        if several and getattr(law, name):
            remedy = f"use {name} = false and compare what is asked for and its limit, or one law with a list of gains"
            raise InputError(f"{where}.{name}", "several laws are not known to saturate", remedy)


def _law(system: SystemParts, law: PDControl | Feedback, where: str) -> None:
    """Check one control law against the shells that it names."""
    for shell in () if law.shells == "all" else law.shells:
        try:
            system.shell_index(shell)
        except InputError as error:
            raise InputError(f"{where}.shells", error.problem, error.remedy) from None
    numbers = shells_under(system, law)
    for name in ("proportional", "derivative"):
        gains = getattr(law, name, None)
        if isinstance(gains, tuple) and len(gains) != len(numbers):
            raise InputError(
                f"{where}.{name}",
                f"the list has {len(gains)} for {len(numbers)} shell(s) under control",
                f"must be 1 or {len(numbers)} gains",
            )
    if len(set(numbers)) < len(numbers):
        raise InputError(f"{where}.shells", f"{list(law.shells)!r} names a shell twice", "must name each shell once")
    matrix = getattr(law, "matrix", None)
    if matrix is not None and len(matrix) != len(numbers):
        found = f"the matrix has {len(matrix)} rows for {len(numbers)} shell(s) under control"
        raise InputError(f"{where}.matrix", found, f"must have {len(numbers)} rows of {len(numbers)} numbers")
    for number in numbers:
        shell_ = system.shells[number]
        if isinstance(shell_, RigidShell):
            raise InputError(
                f"{where}.shells", f"shells[{number}] is rigid and cannot be controlled", "name the shells to control, e.g. shells = [1]"
            )
        for role in ("sensor", "actuator"):
            if getattr(shell_, role) is None and wired(system, number, role):
                raise InputError(
                    f"{where}.shells",
                    f"shells[{number}] has no {role} layer",
                    "give it one, or name only the shells that have both, e.g. shells = ['outer']",
                )
            if law.transducers == "paper":
                _one_of_each(shell_, number, role)
        if getattr(law, "bridge_imbalance", 0.0) and not any(layer.role == "self-sensing" for layer in shell_.layers):
            told = f"shells[{number}] has no self-sensing layer, and so no bridge"
            raise InputError(f"{where}.bridge_imbalance", told, "make a layer 'self-sensing', or leave bridge_imbalance out")
        if law.segments is not None:
            _segments(law, shell_, number, where)
        if law.segments is not None or law.segment_pitch is not None:
            _collocated(shell_, number)


def _segments(law: PDControl | Feedback, shell: Shell, number: int, where: str) -> None:
    """Check that segments have room beside their gaps."""
    assert law.segments is not None
    around = 2.0 * math.pi * shell.radius / law.segments
    if law.segment_gap is not None and law.segment_gap >= around:
        found = f"{law.segment_gap:g} m leaves nothing of {law.segments} segments of shells[{number}]"
        raise InputError(f"{where}.segment_gap", found, f"must be less than {around:.4g} m")


def _collocated(shell: Shell, number: int) -> None:
    """Check that each segment senses and pushes at the same place."""
    for place, layer in enumerate(shell.layers):
        if layer.role in ("sensor", "charge-sensor", "actuator"):
            raise InputError(
                f"shells[{number}].layers[{place}].role",
                f"{layer.role!r} reads or pushes alone, and segments are known of layers that do both",
                "must be 'self-sensing' or 'passive', or leave segments out",
            )


def _one_of_each(shell: Shell, number: int, role: str) -> None:
    """Check that the paper's law, which knows one sensor and one actuator, has no choice of them."""
    of_electrodes = 'or use control.transducers = "electrodes"'
    first, *others = [i for i, layer in enumerate(shell.layers) if serves(layer.role, role)]
    if shell.layers[first].role in ("self-sensing", "charge-sensor"):
        raise InputError(
            f"shells[{number}].layers[{first}].role",
            f"{shell.layers[first].role!r} is not known to the paper's law, whose sensor has grounded faces",
            f"must be 'sensor' or 'actuator', {of_electrodes}",
        )
    if others:
        raise InputError(
            f"shells[{number}].layers[{others[0]}].role",
            f"{role!r} is already the role of layers[{first}]",
            f"the paper's law has at most one {role} a shell: make it 'passive', {of_electrodes}",
        )
