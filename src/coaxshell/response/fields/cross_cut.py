"""The scattered field of three dimensions in a cross-section, at one axial position z.

    p(r, theta, z, t) = sum over m of cos m theta [inverse transform of the sum over k of e_k(z) p_m(r, k, s)](t) :

the sum over wavenumbers comes first, at radii, then instants, angles and points as in two dimensions: at the points' own radii where these
are few, else by interpolation from a polar raster of each region. The particle velocity,

    rho s v = (-dp/dr, -(1/r) dp/dtheta, sum over k of k o_k(z) p),

needs no more of a wave than its pressure, by e and by k o, and its slope: one pass gives all.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.response.fields.grids import Grid
from coaxshell.response.fields.inversion import direct_sums
from coaxshell.response.fields.modal_field import CENTRE
from coaxshell.response.fields.request import FieldRequest, Members, Region, Tell, reach, split
from coaxshell.response.fields.scattered import STEPS_PER_RESOLUTION, Points, Raster, compensation, raster_of, raster_radii, to_points
from coaxshell.response.fields.spatial_waves import SpatialQuantity, SpatialWaves, each_block, share
from coaxshell.response.synthesis import angle_basis
from coaxshell.solver.scaling import Problem

Modal = dict[SpatialQuantity, FloatArray]
"""Modal histories of quantities at some radii, each (radii, parities, M + 1, T)."""


class Circles(NamedTuple):
    """Radii of one region at which a field is needed."""

    region: Region
    radii: FloatArray


def is_exact(problem: Problem, asked: FieldRequest, grid: Grid, points: Points) -> bool:
    """Return whether to take the points' own radii: in polar coordinates, and where they are fewer than those of a raster."""
    return grid.polar or points.radius.size <= raster_radii(problem, asked, points.radius)


def reached(waves: SpatialWaves, asked: FieldRequest, radius: FloatArray, times: FloatArray) -> list[Members]:
    """Return the radii that a scattered wave reaches by the last of some instants, by regions that hold a fluid."""
    most = reach(waves.problem, times, asked.resolution)
    kept = [Members(region, at[radius[at] <= most] if region.exterior else at) for region, at in split(waves.problem, radius)]
    return [members for members in kept if members.at.size and members.region.fluid is not None]


@dataclass(frozen=True, eq=False)
class CircleField:
    """The scattered field of a cross-section at points grouped by radius."""

    points: Points
    at: list[np.ndarray]
    modal: list[Modal]

    @classmethod
    def solved(
        cls, waves: SpatialWaves, asked: FieldRequest, points: Points, times: FloatArray, quantities: Sequence[SpatialQuantity], tell: Tell
    ) -> CircleField:
        """Return the field at some instants."""
        kept = reached(waves, asked, points.radius, times)
        circles = [Circles(region, points.radius[at]) for region, at in kept]
        return cls(points, [at for _, at in kept], modal_histories(waves, circles, times, quantities, tell))

    def add(self, out: FloatArray, quantity: SpatialQuantity, chosen: slice) -> None:
        """Add a quantity at a slice of the instants to ``out``, (instants, 1, points)."""
        for at, modal in zip(self.at, self.modal, strict=True):
            for i, amplitudes in zip(at, modal[quantity], strict=True):
                here, taken = self.points.members[i], amplitudes[..., chosen]
                basis = angle_basis(self.points.angle[here], taken.shape[1], taken.shape[0])
                out[:, 0, here] += (basis.reshape(here.size, -1) @ taken.reshape(-1, taken.shape[-1])).T


@dataclass(frozen=True, eq=False)
class RasterField:
    """The scattered field of a cross-section at the points of a grid, interpolated from a raster of each region."""

    grid: Grid
    memory: float
    at: list[np.ndarray]
    rasters: list[Raster]
    modal: list[dict[SpatialQuantity, np.ndarray]]

    @classmethod
    def solved(
        cls, waves: SpatialWaves, asked: FieldRequest, grid: Grid, times: FloatArray, quantities: Sequence[SpatialQuantity], tell: Tell
    ) -> RasterField:
        """Return the field at some instants."""
        top, kept = waves.sampling.max_order, reached(waves, asked, grid.radius, times)
        spacing = STEPS_PER_RESOLUTION * waves.grid.time_step
        rasters = [raster_of(region, grid.radius[at], spacing * region.spacing, top) for region, at in kept]
        circles = [Circles(region, raster.radii) for (region, _), raster in zip(kept, rasters, strict=True)]
        found = modal_histories(waves, circles, times, quantities, tell)
        for modal, raster in zip(found, rasters, strict=True):
            for values in modal.values():
                values *= compensation(top, raster.angles)[:, None]
        single = [{name: values.astype(np.float32) for name, values in modal.items()} for modal in found]
        return cls(grid, asked.memory, [at for _, at in kept], rasters, single)

    def add(self, out: FloatArray, quantity: SpatialQuantity, chosen: slice) -> None:
        """Add a quantity at a slice of the instants to ``out``, (instants, 1, points)."""
        odd = quantity in ("radial", "angular")
        for at, raster, modal in zip(self.at, self.rasters, self.modal, strict=True):
            place = self.grid.radius[at], self.grid.angle[at]
            to_points(out[:, 0], np.ascontiguousarray(modal[quantity][..., chosen]), raster, place, at, self.memory, odd=odd)


def modal_histories(
    waves: SpatialWaves, circles: Sequence[Circles], times: FloatArray, quantities: Sequence[SpatialQuantity], tell: Tell
) -> list[Modal]:
    """Return the modal histories at the circles of each region, all wavenumbers added up at the position z.

    Those of the angular velocity have two parities: it is odd in theta where the pressure is even.
    """
    matrix, total = waves.inverse(times), sum(one.radii.size for one in circles)
    orders = waves.sampling.max_order + 1

    def empty(one: Circles, quantity: SpatialQuantity) -> FloatArray:
        return np.zeros((one.radii.size, 2 if quantity == "angular" else waves.parities, orders, times.size))

    found = [{quantity: empty(one, quantity) for quantity in quantities} for one in circles]

    def work(block: slice) -> list[Modal]:
        rows, nodes = matrix[2 * block.start : 2 * block.stop], waves.grid.nodes[block]
        return [
            {quantity: direct_sums(rows, _of_quantity(quantity, sums, one, nodes)) for quantity in quantities}
            for one, sums in zip(circles, _summed(waves, circles, quantities, block), strict=True)
        ]

    for parts in each_block(waves, total, work, tell):
        for whole, part in zip(found, parts, strict=True):
            for quantity, values in part.items():
                whole[quantity] += values.transpose(2, 0, 1, 3)
    return found


class _Sums(NamedTuple):
    """Sums over k of the transforms at the circles of a region, each (parities, M + 1, radii, nodes), or None where nobody asks."""

    level: ComplexArray | None
    """Of e p."""
    slope: ComplexArray | None
    """Of e dp/dr."""
    along: ComplexArray | None
    """Of k o p."""


def _of_quantity(quantity: SpatialQuantity, sums: _Sums, circles: Circles, nodes: ComplexArray) -> ComplexArray:
    """Return the transforms of a quantity, (parities, M + 1, radii, nodes)."""
    assert circles.region.fluid is not None
    level, slope, along = sums
    momentum = circles.region.fluid.density * nodes
    match quantity:
        case "radial":
            assert slope is not None
            return -slope / momentum
        case "axial":
            assert along is not None
            return along / momentum
        case "angular":
            assert level is not None
            turning = np.arange(level.shape[1])[:, None, None] / np.maximum(circles.radii, CENTRE)[:, None] * level / momentum
            return np.stack([-turning[1] if turning.shape[0] == 2 else np.zeros_like(turning[0]), turning[0]])
    assert level is not None
    return level


def _summed(waves: SpatialWaves, circles: Sequence[Circles], quantities: Sequence[SpatialQuantity], block: slice) -> list[_Sums]:
    """Return the sums of all waves at a block of nodes, those that the quantities need, one a region."""
    needed = "pressure" in quantities or "angular" in quantities, "radial" in quantities, "axial" in quantities
    functions: list[SpatialQuantity] = []
    if any(needed[:2]):
        functions.append("pressure")
    if needed[2]:
        functions.append("axial")
    each = waves.parities, waves.sampling.max_order + 1

    def empty(one: Circles) -> _Sums:
        return _Sums(*(np.zeros((*each, one.radii.size, block.stop - block.start), np.complex128) if want else None for want in needed))

    totals = [empty(one) for one in circles]
    for some in waves.sets(block):
        goes = [[share(some, family, function)[0] for family in some.families] for function in functions]
        for j in range(len(some.modes)):
            shares = np.array([[np.atleast_1d(along[j]) for along in families] for families in goes])
            drive = waves.drive(some, j, block).added_up(shares)
            for one, (level, slope, along) in zip(circles, totals, strict=True):
                transfer = drive.transfer(one.region, waves.part)
                if transfer is None:
                    continue
                for m, pressure, steep in transfer.both(one.radii, slope=slope is not None):
                    if level is not None:
                        level[:, m] += pressure[: each[0]]
                    if slope is not None and steep is not None:
                        slope[:, m] += steep[: each[0]]
                    if along is not None:
                        along[:, m] += pressure[-each[0] :]
    return totals
