"""Inclined plane waves: whether anything runs ahead of the front.

A plane wave inclined by alpha runs along the axis at 1/sin alpha (in c_e) from the infinite past. What travels along the axis faster
than that gets ahead of it: then nothing is at rest before the front comes, and there is no start.

In a wall of elastic solids nothing is faster than the pressure waves of its layers. In a thin one bending waves get faster with
frequency. With b^2 = I/d11 and n = m/R, those that keep pace with the trace have

    b omega = n^2 + (k^2 = omega^2 sin^2 alpha),        omega = [b +- sqrt(b^2 - 4 n^2 sin^2 alpha)]/(2 sin^2 alpha),

and their energy travels at 2 k^2/(k^2 + n^2) times their own pace: those with the upper sign run ahead. In the Laplace domain the water
that such a wave shakes moves its pole to the right of the imaginary axis, where an inverse transform takes it for growth. A run must not
resolve them.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from coaxshell.acoustics.sources import PlaneGeometry
from coaxshell.errors import InputError
from coaxshell.model.places import region_phrase, shell_phrase
from coaxshell.solver.axial.causality import rounded_up
from coaxshell.solver.scaling import Problem
from coaxshell.solver.settings import Settings
from coaxshell.structure.shell_model import ShellModel

_SHORT = 1e9
"""A wavenumber, in 1/a, at which bending waves are the fastest of any wall that bends: 2 k/b of thin ones."""


def require_leading_fronts(problem: Problem, settings: Settings) -> None:
    """Refuse plane waves so inclined that sound or waves in a wall run ahead of them along the axis.

    Parameters
    ----------
    problem : Problem
    settings : Settings
        With ``modes`` a number; what its time step resolves counts.

    Raises
    ------
    InputError
        It names the source's inclination, with both speeds, or with the time step that does not resolve what is faster.
    """
    for number, geometry in enumerate(problem.sources):
        if isinstance(geometry, PlaneGeometry) and geometry.inclination:
            where = f"source[{number}].inclination" if isinstance(problem.system.source, tuple) else "source.inclination"
            _require_fast_trace(problem, where, geometry)
            _require_slow_bending(problem, settings, where, geometry)


def bending_ahead(wall: ShellModel, trace_slowness: float, max_order: int) -> float:
    """Return the lowest angular frequency, in c_e/a, at which bending waves of orders up to a highest one run ahead of a trace."""
    fastest = wall.fastest_wave(_SHORT)
    if fastest == 0.0:
        return math.inf
    b, square = 2.0 * _SHORT / fastest, trace_slowness**2
    apart = max(b * b - 4.0 * square * (max_order / wall.radius) ** 2, 0.0)
    return (b + math.sqrt(apart)) / (2.0 * square)


def _waves(problem: Problem) -> Iterator[tuple[str, float]]:
    """Yield what travels along the axis in fluids and walls at all frequencies, and its speed in c_e."""
    count = len(problem.shells)
    for i, fluid in enumerate(problem.fluids):
        if fluid is not None:
            yield f"sound in {region_phrase(i, count)}", 1.0 / fluid.slowness
    for i, wall in enumerate(problem.shells):
        kind = "membrane" if wall.faces_move_alike else "pressure"
        yield f"{kind} waves in the {shell_phrase(i, count)}", wall.fastest_wave(0.0)


def _require_fast_trace(problem: Problem, where: str, geometry: PlaneGeometry) -> None:
    what, fastest = max(_waves(problem), key=lambda wave: wave[1])
    if abs(geometry.trace_slowness) * fastest < 1.0:
        return
    c = problem.scales.velocity
    most = math.floor(1e3 * math.degrees(math.asin(1.0 / fastest))) / 1e3
    raise InputError(
        where,
        f"{geometry.inclination:g} degrees: the front runs along the axis at {c / abs(geometry.trace_slowness):.4g} m/s, and {what} run "
        f"ahead of it at {c * fastest:.4g} m/s",
        f"give less than {most:g} degrees, or a spherical source far away",
    )


def _require_slow_bending(problem: Problem, settings: Settings, where: str, geometry: PlaneGeometry) -> None:
    assert isinstance(settings.modes, int)
    slowest = [bending_ahead(wall, geometry.trace_slowness, settings.modes) for wall in problem.shells]
    lowest, highest = min(slowest), math.pi * settings.refinement / settings.time_step
    if lowest >= highest:
        return
    shell, time = shell_phrase(slowest.index(lowest), len(slowest)), 2.0 * math.pi * problem.scales.time
    raise InputError(
        where,
        f"{geometry.inclination:g} degrees: bending waves in the {shell} run ahead of the front above {lowest / time:.3g} Hz, and "
        f"time_step = {settings.time_step:g} resolves {highest / time:.3g} Hz",
        f"use time_step = {rounded_up(math.pi * settings.refinement / lowest):g} or more, or less inclination",
    )
