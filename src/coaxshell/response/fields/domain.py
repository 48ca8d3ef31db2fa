"""The domain of a mean: which region, up to which radius, at which instants, by which quadrature."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coaxshell.errors import InputError
from coaxshell.numerics.arrays import FloatArray
from coaxshell.response.fields.regions import Region, regions
from coaxshell.response.fields.request import positive
from coaxshell.solver.scaling import Problem

EXTERIOR_RADIUS = 3.0
"""Default outer radius of the exterior, in a."""

INSTANTS = 500
"""Intervals between the default instants, at most twice as many."""


@dataclass(frozen=True)
class Domain:
    """An annulus (or disc) of one fluid."""

    region: Region
    outer: float

    def rule(self, resolution: float) -> tuple[FloatArray, FloatArray]:
        """Return Gauss radii and weights of the mean over the area, enough for squares of waves resolved in time by *resolution*."""
        inner, width = self.region.inner, self.outer - self.region.inner
        count = int(0.5 * np.pi / (resolution * self.region.spacing) * width) + 24
        x, w = np.polynomial.legendre.leggauss(count)
        radii = inner + 0.5 * width * (1.0 + x)
        return radii, w * radii / (self.outer + inner)


def domain_of(problem: Problem, name: str | int, radius: float | None) -> Domain:
    """Return the domain of a region named by a user, the exterior up to *radius*; InputError if either is not allowed."""
    region = _region(problem, name)
    if not region.exterior:
        if radius is not None:
            raise InputError("radius", f"{radius!r} is not allowed for the region {name!r}", "only the exterior has a radius to choose")
        return Domain(region, region.outer)
    outer = EXTERIOR_RADIUS if radius is None else positive("radius", radius, "a")
    if outer <= region.inner:
        raise InputError("radius", f"{outer:g} is not outside the outermost shell", f"give more than {region.inner:g}")
    return Domain(region, outer)


def _region(problem: Problem, name: str | int) -> Region:
    known = regions(problem)
    gaps = known[1:-1]
    if name == "interior":
        return known[0]
    if name == "exterior":
        return known[-1]
    if name == "gap":
        if len(gaps) == 1:
            return gaps[0]
        remedy = f"name the fluid by its number, 1 to {len(gaps)} from the inside" if gaps else 'use "interior" or "exterior"'
        raise InputError("region", f"{len(gaps) or 'no'} gaps lie between {len(problem.shells)} shells", remedy)
    if isinstance(name, int) and not isinstance(name, bool) and 0 <= name < len(known):
        return known[name]
    raise InputError("region", f"{name!r} is unknown", f'allowed: "interior", "gap", "exterior" or a number from 0 to {len(known) - 1}')


def default_instants(time: FloatArray) -> FloatArray:
    """Return every k-th instant of a run, k the largest number that leaves at least 500 intervals."""
    return time[:: max(1, (time.size - 1) // INSTANTS)]
