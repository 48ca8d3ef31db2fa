"""The scattered field of three dimensions in a cross-section, at one axial position z.

    p(r, theta, z, t) = sum over m of cos m theta [inverse transform of the sum over k of e_k(z) p_m(r, k, s)](t) :

the sum over wavenumbers comes first, at radii, then instants, angles and points as in two dimensions: at the points' own radii where these
are few, else by interpolation from a polar raster of each region.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.response.fields.grids import Grid
from coaxshell.response.fields.inversion import direct_sums
from coaxshell.response.fields.request import FieldRequest, Region, Tell, reach, split
from coaxshell.response.fields.scattered import STEPS_PER_RESOLUTION, Points, compensation, raster_of, raster_radii, to_points
from coaxshell.response.fields.spatial_waves import SpatialWaves, each_block
from coaxshell.response.synthesis import angle_basis
from coaxshell.solver.scaling import Problem


class Circles(NamedTuple):
    """Radii of one region at which a field is needed."""

    region: Region
    radii: FloatArray


def is_exact(problem: Problem, asked: FieldRequest, grid: Grid, points: Points) -> bool:
    """Return whether to take the points' own radii: in polar coordinates, and where they are fewer than those of a raster."""
    return grid.polar or points.radius.size <= raster_radii(problem, asked, points.radius)


def add_on_circles(out: FloatArray, waves: SpatialWaves, asked: FieldRequest, points: Points, times: FloatArray, tell: Tell) -> None:
    """Add the scattered field at points grouped by radius to ``out``, (times, points)."""
    most = reach(waves.problem, times, asked.resolution)
    kept = [(region, at[points.radius[at] <= most] if region.exterior else at) for region, at in split(waves.problem, points.radius)]
    kept = [(region, at) for region, at in kept if at.size and region.fluid is not None]
    found = modal_histories(waves, [Circles(region, points.radius[at]) for region, at in kept], times, tell)
    for (_, at), circles in zip(kept, found, strict=True):
        for i, modal in zip(at, circles, strict=True):
            here = points.members[i]
            basis = angle_basis(points.angle[here], modal.shape[1], modal.shape[0])
            out[:, here] += (basis.reshape(here.size, -1) @ modal.reshape(-1, modal.shape[-1])).T


def add_on_raster(out: FloatArray, waves: SpatialWaves, asked: FieldRequest, grid: Grid, times: FloatArray, tell: Tell) -> None:
    """Add the scattered field at the points of a grid, interpolated from rasters, to ``out``, (times, points)."""
    most, top = reach(waves.problem, times, asked.resolution), waves.sampling.max_order
    kept, rasters = [], []
    for region, members in split(waves.problem, grid.radius):
        at = members[grid.radius[members] <= most] if region.exterior else members
        if at.size and region.fluid is not None:
            kept.append((region, at))
            rasters.append(raster_of(region, grid.radius[at], STEPS_PER_RESOLUTION * waves.grid.time_step * region.spacing, top))
    circles = [Circles(region, raster.radii) for (region, _), raster in zip(kept, rasters, strict=True)]
    for (_, at), raster, modal in zip(kept, rasters, modal_histories(waves, circles, times, tell), strict=True):
        modal *= compensation(top, raster.angles)[:, None]
        to_points(out, modal.astype(np.float32), raster, (grid.radius[at], grid.angle[at]), at, asked.memory, odd=False)


def modal_histories(waves: SpatialWaves, circles: Sequence[Circles], times: FloatArray, tell: Tell) -> list[FloatArray]:
    """Return the modal pressure at the circles of each region, (radii, parities, M + 1, T), all wavenumbers added up at the position z."""
    matrix, total = waves.inverse(times), sum(one.radii.size for one in circles)
    found = [np.zeros((one.radii.size, waves.parities, waves.sampling.max_order + 1, times.size)) for one in circles]

    def work(block: slice) -> list[FloatArray]:
        rows = matrix[2 * block.start : 2 * block.stop]
        return [direct_sums(rows, spectra) for spectra in _summed(waves, circles, block)]

    for parts in each_block(waves, total, work, tell):
        for whole, part in zip(found, parts, strict=True):
            whole += part.transpose(2, 0, 1, 3)
    return found


def _summed(waves: SpatialWaves, circles: Sequence[Circles], block: slice) -> list[ComplexArray]:
    """Return the transforms at a block of nodes, (parities, M + 1, radii, nodes) of each region."""
    each = waves.parities, waves.sampling.max_order + 1
    totals = [np.zeros((*each, one.radii.size, block.stop - block.start), np.complex128) for one in circles]
    for some in waves.sets(block):
        for j in range(len(some.modes)):
            shares = np.stack([family.even[0, j] for family in some.families]).reshape(len(some.families), -1)
            drive = waves.drive(some, j, block).added_up(shares)
            for one, total in zip(circles, totals, strict=True):
                transfer = drive.transfer(one.region, waves.part)
                if transfer is not None:
                    for m, pressure in transfer.pressure(one.radii, np.ones(1)):
                        total[:, m] += pressure
    return totals
