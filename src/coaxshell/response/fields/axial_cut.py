"""The scattered field of three dimensions along the axis: in a plane at one distance y from it, and in volumes.

Each wave is added up over what lies across the axis first, then come the instants, and last the sum over wavenumbers:

    p(x, z, t) = sum over k of e_k(z) [inverse transform of the sum over m of p_m(r, k, s) cos m theta](t).

In a plane the sum over orders m comes before, at each point's own radius and angle. In a volume, of many angles at each radius, it comes
after everything else. The velocity along z goes by k o_k(z) instead. An inclined plane wave goes along the axis by another function at
each node, which the inverse transform takes in.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
import numpy.typing as npt

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.response.fields.cross_cut import reached
from coaxshell.response.fields.grids import Grid
from coaxshell.response.fields.inversion import direct_sums
from coaxshell.response.fields.modal_field import CENTRE, Transfer
from coaxshell.response.fields.request import FieldRequest, Region, Tell
from coaxshell.response.fields.scattered import grouped
from coaxshell.response.fields.spatial_waves import SpatialQuantity, SpatialWaves, each_block, share
from coaxshell.response.synthesis import angle_basis
from coaxshell.solver.axial.families import WaveSet

Transforms = dict[SpatialQuantity, ComplexArray]
"""Of quantities of a wave, each (families, rows, nodes); the axial velocity yet without its k o."""
Order = tuple[int, ComplexArray, ComplexArray | None]


class Section(Protocol):
    """What is kept of a wave in one region across the axis: a row a value."""

    @property
    def region(self) -> Region:
        """The region."""
        ...

    @property
    def radii(self) -> FloatArray:
        """At which it is evaluated."""
        ...

    @property
    def rows(self) -> slice | npt.NDArray[np.int64]:
        """The numbers of its rows among those of all regions."""
        ...

    @property
    def height(self) -> int:
        """How many rows it has."""
        ...

    def add(self, out: Transforms, order: Order) -> None:
        """Add what an order, (m, pressure, slope) at the radii, contributes to the rows; pressures and slopes, not yet velocities."""
        ...


@dataclass(frozen=True, eq=False)
class Line:
    """Points of one region across the axis.

    Attributes
    ----------
    region : Region
    rows : ndarray of int, shape (points,)
        Their numbers among all.
    radii : ndarray
    circle : ndarray of int, shape (points,)
        The number of each one's radius.
    basis, turned : ndarray, shape (points, parities, M + 1)
        Of the pressure at their angles, and m/r times that of what is odd where it is even.
    """

    region: Region
    rows: npt.NDArray[np.int64]
    radii: FloatArray
    circle: npt.NDArray[np.int64]
    basis: FloatArray
    turned: FloatArray

    @property
    def height(self) -> int:
        """Number of points."""
        return int(self.rows.size)

    def add(self, out: Transforms, order: Order) -> None:
        """Add an order at every point's own angle."""
        m, pressure, slope = order
        for quantity, total in out.items():
            values = slope if quantity == "radial" else pressure
            assert values is not None
            modal = values.reshape(-1, self.basis.shape[1], *values.shape[1:])
            basis = self.turned if quantity == "angular" else self.basis
            for parity in range(basis.shape[1]):
                total += modal[:, parity, self.circle] * basis[:, parity, m, None]


def lines_of(waves: SpatialWaves, asked: FieldRequest, grid: Grid, times: FloatArray) -> list[Line]:
    """Return the points of a plane along the axis that a scattered wave reaches, by region."""
    found = []
    for region, at in reached(waves, asked, grid.radius, times):
        radius, angle = grid.radius[at], grid.angle[at]
        points = grouped(radius, angle)
        circle = np.empty(at.size, np.int64)
        for number, here in enumerate(points.members):
            circle[here] = number
        orders = np.arange(waves.sampling.max_order + 1)
        basis, turned = (angle_basis(angle, orders.size, waves.parities, component) for component in ("normal", "tangential"))
        turned *= orders / np.maximum(radius, CENTRE)[:, None, None]
        found.append(Line(region, at, points.radius, circle, basis, turned))
    return found


@dataclass(frozen=True, eq=False)
class Rings:
    """All orders at radii of one region, from a row on: (parities, M + 1, radii).

    Attributes
    ----------
    region : Region
    at : ndarray of int
        The numbers of the radii among all.
    radii : ndarray
    first : int
    parities, orders : int
    """

    region: Region
    at: npt.NDArray[np.int64]
    radii: FloatArray
    first: int
    parities: int
    orders: int

    @property
    def height(self) -> int:
        """Number of rows."""
        return self.parities * self.orders * self.radii.size

    @property
    def rows(self) -> slice:
        """Numbers of the rows among those of all regions."""
        return slice(self.first, self.first + self.height)

    def add(self, out: Transforms, order: Order) -> None:
        """Add an order to its own rows."""
        m, pressure, slope = order
        for quantity, total in out.items():
            values = slope if quantity == "radial" else pressure
            assert values is not None
            modal = values.reshape(-1, self.parities, *values.shape[1:])
            turning = m / np.maximum(self.radii, CENTRE)[:, None] if quantity == "angular" else 1.0
            total.reshape(-1, self.parities, self.orders, *values.shape[1:])[:, :, m] += modal * turning


def rings_of(waves: SpatialWaves, asked: FieldRequest, radii: FloatArray, times: FloatArray) -> list[Rings]:
    """Return the radii of a volume that a scattered wave reaches, by region."""
    found: list[Rings] = []
    for region, at in reached(waves, asked, radii, times):
        first = found[-1].rows.stop if found else 0
        found.append(Rings(region, at, radii[at], first, waves.parities, waves.sampling.max_order + 1))
    return found


@dataclass(frozen=True, eq=False)
class AxialHistories:
    """Histories of all waves at the rows of some sections.

    Attributes
    ----------
    waves : SpatialWaves
    sets : list of WaveSet
        Without their nodes.
    sums : list of dict of quantity to ndarray
        Of each set (families, waves, rows, T), or, of a wave that travels, (z, rows, T).
    """

    waves: SpatialWaves
    sets: list[WaveSet]
    sums: list[dict[SpatialQuantity, FloatArray]]

    def at(self, quantity: SpatialQuantity, chosen: slice) -> FloatArray:
        """Return a quantity at a slice of the instants, shape (instants, z, rows)."""
        total: FloatArray = np.zeros(())
        for some, sums in zip(self.sets, self.sums, strict=True):
            whole = sums[quantity][..., chosen]
            if _travels(some):
                total = total + whole.transpose(2, 0, 1)
                continue
            for family, waved in zip(some.families, whole, strict=True):
                goes = np.asarray(share(some, family, quantity), dtype=np.float64)
                total = total + (goes @ waved.reshape(waved.shape[0], -1)).reshape(-1, *waved.shape[1:]).transpose(2, 0, 1)
        return total


def axial_histories(
    waves: SpatialWaves,
    sections: Sequence[Section],
    rows: int,
    times: FloatArray,
    quantities: Sequence[SpatialQuantity],
    tell: Tell,
) -> AxialHistories:
    """Return the histories of all waves at so many rows, those of some sections among them."""
    matrix, sets = waves.inverse(times), waves.sets(slice(0, 1))
    sums = [{name: np.zeros((*_shape(waves, some), rows, times.size)) for name in quantities} for some in sets]

    def work(block: slice) -> list[dict[SpatialQuantity, FloatArray]]:
        columns = matrix[2 * block.start : 2 * block.stop]
        return [_of_set(waves, some, sections, (rows, quantities), columns, block) for some in waves.sets(block)]

    for parts in each_block(waves, sum(section.radii.size for section in sections), work, tell):
        for whole, part in zip(sums, parts, strict=True):
            for name, values in part.items():
                whole[name] += values
    return AxialHistories(waves, sets, sums)


def _travels(some: WaveSet) -> bool:
    """Return whether a set is a wave that runs along the axis: of one complex wavenumber a node."""
    return bool(np.iscomplexobj(some.families[0].even))


def _shape(waves: SpatialWaves, some: WaveSet) -> tuple[int, ...]:
    return (waves.z.size,) if _travels(some) else (len(some.families), len(some.modes))


def _of_set(
    waves: SpatialWaves,
    some: WaveSet,
    sections: Sequence[Section],
    wanted: tuple[int, Sequence[SpatialQuantity]],
    columns: FloatArray,
    block: slice,
) -> dict[SpatialQuantity, FloatArray]:
    """Return what a block of nodes gives at the rows and instants, wave by wave, or, of a travelling wave, at all z."""
    rows, quantities = wanted
    found = {name: np.zeros((*_shape(waves, some), rows, columns.shape[1])) for name in quantities}
    for j in range(len(some.modes)):
        drive = waves.drive(some, j, block)
        for section in sections:
            transfer = drive.transfer(section.region, waves.part)
            if transfer is None:
                continue
            for name, total in _transforms(transfer, section, len(some.families), quantities).items():
                if _travels(some):
                    for number, goes in enumerate(share(some, some.families[0], name)[:, 0]):
                        found[name][number, section.rows] += direct_sums(columns, total[0] * goes)
                else:
                    found[name][:, j, section.rows] += direct_sums(columns, total)
    return found


def _transforms(transfer: Transfer, section: Section, families: int, quantities: Sequence[SpatialQuantity]) -> Transforms:
    """Return the transforms of quantities of a wave at the rows of a section."""
    assert section.region.fluid is not None
    shape, twice = (families, section.height, transfer.s.size), {"pressure", "axial"} <= set(quantities)
    found = {name: np.zeros(shape, np.complex128) for name in quantities if not (twice and name == "axial")}
    orders: Iterator[Order] = transfer.both(section.radii, slope="radial" in quantities)
    for order in orders:
        section.add(found, order)
    if twice:
        found["axial"] = found["pressure"].copy()
    mobility = 1.0 / (section.region.fluid.density * transfer.s)
    for name, total in found.items():
        if name != "pressure":
            total *= -mobility if name == "radial" else mobility
    return found


@dataclass(frozen=True, eq=False)
class PlaneField:
    """The scattered field of a plane along the axis."""

    histories: AxialHistories

    def add(self, out: FloatArray, quantity: SpatialQuantity, chosen: slice) -> None:
        """Add a quantity at a slice of the instants to ``out``, (instants, z, points)."""
        out += self.histories.at(quantity, chosen)


@dataclass(frozen=True, eq=False)
class VolumeField:
    """The scattered field of a volume: radii, angles (degrees) and axial positions."""

    histories: AxialHistories
    rings: list[Rings]
    angles: FloatArray

    def add(self, out: FloatArray, quantity: SpatialQuantity, chosen: slice) -> None:
        """Add a quantity at a slice of the instants to ``out``, (instants, z, radii and angles)."""
        if not self.rings:
            return
        values, around = self.histories.at(quantity, chosen), out.reshape(*out.shape[:2], -1, self.angles.size)
        for ring in self.rings:
            modal = values[..., ring.rows].reshape(*values.shape[:2], ring.parities * ring.orders, ring.radii.size)
            basis = angle_basis(self.angles, ring.orders, ring.parities, "tangential" if quantity == "angular" else "normal")
            around[:, :, ring.at] += modal.swapaxes(2, 3) @ basis.reshape(self.angles.size, -1).T
