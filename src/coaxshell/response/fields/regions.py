"""The fluid regions between the mid-surfaces, and which one a radius lies in."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from coaxshell.numerics.arrays import FloatArray
from coaxshell.solver.scaling import FluidRegion, Problem

SMEAR = 20
"""Resolutions by which the band limit smears a front, to about 1e-4."""


@dataclass(frozen=True)
class Region:
    """One fluid between two mid-surfaces.

    Attributes
    ----------
    index : int
        Counted from the inside; the exterior is the last.
    inner, outer : float
        Radii of its walls in units of a: 0 inside a disc, infinity outside.
    fluid : FluidRegion or None
        None is a vacuum.
    exterior : bool
    """

    index: int
    inner: float
    outer: float
    fluid: FluidRegion | None
    exterior: bool

    @property
    def spacing(self) -> float:
        """Radial distance per time that a wave needs at least to be resolved alike: 1 in the exterior, less in slower fluids."""
        return 1.0 if self.fluid is None else 1.0 / max(1.0, self.fluid.slowness)


class Members(NamedTuple):
    """A region and the positions of the radii that lie in it."""

    region: Region
    at: npt.NDArray[np.int64]


def regions(problem: Problem) -> tuple[Region, ...]:
    """Return the fluid regions from the inside out."""
    edges = [0.0, *(shell.radius for shell in problem.shells), np.inf]
    last = len(problem.fluids) - 1
    return tuple(Region(i, edges[i], edges[i + 1], fluid, i == last) for i, fluid in enumerate(problem.fluids))


def split(problem: Problem, radius: FloatArray) -> list[Members]:
    """Return the regions that hold some of the radii; walls have no thickness, and a radius on a mid-surface lies outside of it."""
    edges = np.array([shell.radius for shell in problem.shells])
    index = np.searchsorted(edges, radius, side="right")
    return [Members(region, np.flatnonzero(index == region.index)) for region in regions(problem) if np.any(index == region.index)]


def reach(problem: Problem, times: FloatArray, resolution: float) -> float:
    """Return the radius beyond which there is no scattered wave yet at any of the times: 1 + t after the first front, and its smear."""
    first = min(source.delay for source in problem.system.sources) / problem.scales.time
    return float(1.0 + times.max() - first + SMEAR * resolution)
