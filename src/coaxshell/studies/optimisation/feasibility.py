"""Limits that nothing can keep, found before any run."""

from __future__ import annotations

import math

import numpy as np

from coaxshell.errors import InputError
from coaxshell.model.absorbers import gaps_of
from coaxshell.model.system import System
from coaxshell.studies.optimisation.targets import Limit, Targets
from coaxshell.studies.optimisation.variables import Space
from coaxshell.studies.reading import DesignReading


def require_possible(space: Space, targets: Targets, *, insist: bool = False) -> None:
    """Refuse constraints on masses, counts and spacing that no design can keep, and, if asked, a base system that is no start.

    Masses and counts grow with every variable on which they depend, so that their smallest and largest values lie at the two ends of all
    ranges. The spacing of N absorbers on a circle is at most its circumference over N.

    Raises
    ------
    InputError
        With the limit and the nearest value that there is, or with the value of the base system outside its range.
    """
    limits = [limit for limit in targets.limits if limit.target.metric.of_design and not limit.target.statistic]
    if limits:
        ends = [space.system(space.values(np.full(len(space.variables), share))) for share in (0.0, 1.0)]
        systems = [system for system in ends if isinstance(system, System)] or [space.base]
        for limit in limits:
            nearest = _nearest(limit, systems)
            if limit.excess(nearest) > 0:
                side = "largest" if limit.least else "smallest"
                value = f"{nearest:g} {limit.target.metric.units}".removesuffix(" 1")
                raise InputError(
                    "constraints", f"{limit.text} is impossible: the {side} within the ranges is {value}", "widen the ranges, or the limit"
                )
    if insist:
        _require_start(space, limits)


def _nearest(limit: Limit, systems: list[System]) -> float:
    """Return the value nearest to keeping a limit."""
    if limit.target.metric.quantity == "absorber_spacing":
        return max(_widest(system) for system in systems) if limit.least else 0.0
    values = [limit.target.metric(DesignReading(system)) for system in systems]
    return max(values) if limit.least else min(values)


def _widest(system: System) -> float:
    """Return the largest possible smallest spacing of a system's absorbers."""
    gaps = [gap for absorber in system.absorber_list for gap in gaps_of(absorber)]
    circles = [math.tau * system.shells[i].radius / gaps.count(i) for i in set(gaps)]
    return min([math.tau * system.reference_radius, *circles])


def _require_start(space: Space, limits: list[Limit]) -> None:
    for variable, value in zip(space.variables, space.present(), strict=True):
        if variable.share(value) is None:
            inside = f"{variable.low:g} to {variable.high:g}" if not variable.levels else "its choices"
            raise InputError(
                "start", f"{variable.name} = {value!r} of the system is not within {inside}", 'use start="auto", or widen the range'
            )
    for limit in limits:
        value = limit.target.metric(DesignReading(space.base))
        if limit.excess(value) > 0:
            raise InputError("start", f"the system breaks {limit.text} with {value:g}", 'use start="auto", or change the system')
