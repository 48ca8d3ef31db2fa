"""The scattered field of three dimensions in a plane along the axis, at one distance y from it.

At each x the sum over orders comes first, at the point's own radius and angle, then the instants, and last the sum over wavenumbers:

    p(x, z, t) = sum over k of e_k(z) [inverse transform of the sum over m of p_m(r, k, s) cos m theta](t).

An inclined plane wave goes along the axis by another function at each node, which the inverse transform takes in.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.response.fields.inversion import direct_sums
from coaxshell.response.fields.request import FieldRequest, Region, Tell, reach, split
from coaxshell.response.fields.scattered import grouped
from coaxshell.response.fields.spatial_waves import SpatialWaves, each_block
from coaxshell.response.synthesis import angle_basis
from coaxshell.solver.axial.families import WaveSet


@dataclass(frozen=True, eq=False)
class Line:
    """Points of one region across the axis.

    Attributes
    ----------
    region : Region
    at : ndarray of int, shape (points,)
        Their numbers among all.
    radii : ndarray
    circle : ndarray of int, shape (points,)
        The number of each one's radius.
    basis : ndarray, shape (points, parities, M + 1)
        Cosines and sines at their angles.
    """

    region: Region
    at: npt.NDArray[np.int64]
    radii: FloatArray
    circle: npt.NDArray[np.int64]
    basis: FloatArray


def lines_of(waves: SpatialWaves, asked: FieldRequest, radius: FloatArray, angle: FloatArray, times: FloatArray) -> list[Line]:
    """Return the points (radius in a, angle in degrees) that a scattered wave reaches by region."""
    most, found = reach(waves.problem, times, asked.resolution), []
    for region, members in split(waves.problem, radius):
        at = members[radius[members] <= most] if region.exterior else members
        if at.size and region.fluid is not None:
            points = grouped(radius[at], angle[at])
            circle = np.empty(at.size, np.int64)
            for number, here in enumerate(points.members):
                circle[here] = number
            found.append(Line(region, at, points.radius, circle, angle_basis(angle[at], waves.sampling.max_order + 1, waves.parities)))
    return found


def along_axis(waves: SpatialWaves, lines: list[Line], points: int, times: FloatArray, tell: Tell) -> FloatArray:
    """Return the scattered field at all z of the waves and all points across, shape (T, z, points)."""
    matrix = waves.inverse(times)
    sets = waves.sets(slice(0, 1))
    sums = [np.zeros(_shape(waves, some, points, times.size)) for some in sets]

    def work(block: slice) -> list[FloatArray]:
        rows = matrix[2 * block.start : 2 * block.stop]
        return [_of_set(waves, some, lines, points, rows, block) for some in waves.sets(block)]

    for parts in each_block(waves, sum(line.radii.size for line in lines), work, tell):
        for whole, part in zip(sums, parts, strict=True):
            whole += part
    result = np.zeros((times.size, waves.z.size, points))
    for some, whole in zip(sets, sums, strict=True):
        if _travels(some):
            result += whole.transpose(2, 0, 1)
            continue
        for family, waved in zip(some.families, whole, strict=True):
            result += np.einsum("zj,jpt->tzp", family.even, waved, optimize=True)
    return result


def _travels(some: WaveSet) -> bool:
    """Return whether a set is a wave that runs along the axis: of one complex wavenumber a node."""
    return bool(np.iscomplexobj(some.families[0].even))


def _shape(waves: SpatialWaves, some: WaveSet, points: int, times: int) -> tuple[int, ...]:
    if _travels(some):
        return (waves.z.size, points, times)
    return (len(some.families), len(some.modes), points, times)


def _of_set(waves: SpatialWaves, some: WaveSet, lines: list[Line], points: int, rows: FloatArray, block: slice) -> FloatArray:
    """Return what a block of nodes gives at the points and instants, wave by wave, or, of a travelling wave, at all z."""
    found = np.zeros(_shape(waves, some, points, rows.shape[1]))
    for j in range(len(some.modes)):
        drive = waves.drive(some, j, block)
        for line in lines:
            transfer = drive.transfer(line.region, waves.part)
            if transfer is None:
                continue
            total = np.zeros((len(some.families), line.at.size, block.stop - block.start), np.complex128)
            for m, pressure in transfer.pressure(line.radii, np.ones(1)):
                _add_order(total, pressure, line, m)
            if _travels(some):
                for number, even in enumerate(some.families[0].even[:, 0]):
                    found[number, line.at] += direct_sums(rows, total[0] * even)
            else:
                found[:, j, line.at] += direct_sums(rows, total)
    return found


def _add_order(total: ComplexArray, pressure: ComplexArray, line: Line, m: int) -> None:
    """Add order m, (families and parities, radii, nodes), to the values at the points, (families, points, nodes)."""
    parities = line.basis.shape[1]
    modal = pressure.reshape(-1, parities, *pressure.shape[1:])
    for parity in range(parities):
        total += modal[:, parity, line.circle] * line.basis[:, parity, m, None]
