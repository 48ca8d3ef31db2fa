"""The scattered field at points, by either of two ways.

Order by order at the points' own radii: exact but for the number of orders and the band of frequencies. Or, for many points, once per
radius of a polar raster of each region, once around it by FFT, then to the points by interpolation that is local and never crosses a wall.

Along theta the field is a finite Fourier series and a Kaiser-Bessel kernel, undone beforehand in the coefficients, is exact to
1e-6; along r eight-point polynomials are used on a raster that continues analytically a little beyond the walls (and through the
centre, where (-r, theta) is (r, theta + 180 degrees)), so that every stencil is centred.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import numpy.typing as npt
from scipy import fft, sparse
from scipy.special import i0

from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.threads import WORKERS, map_on_threads
from coaxshell.response.fields.inversion import band, few_offsets
from coaxshell.response.fields.modal_field import Quantity, modal_field
from coaxshell.response.fields.request import FieldRequest, Region, Tell, mode_filter, reach, split
from coaxshell.response.synthesis import angle_basis
from coaxshell.solver.scaling import Problem
from coaxshell.solver.solved_spectra import SolvedSpectra


@dataclass(frozen=True)
class Points:
    """Points grouped by radius: ``members[i]`` are the positions of those at ``radius[i]``, ``angle`` is in degrees."""

    radius: FloatArray
    angle: FloatArray
    members: list[np.ndarray]


def grouped(radius: FloatArray, angle: FloatArray) -> Points:
    """Return points grouped by their radius to 12 digits."""
    _, first, inverse = np.unique(np.round(radius, 12), return_index=True, return_inverse=True)
    order = np.argsort(inverse, kind="stable")
    edges = np.concatenate([[0], np.cumsum(np.bincount(inverse))])
    return Points(radius[first], angle, [order[a:b] for a, b in pairwise(edges)])


def add_exact(
    out: FloatArray, spectra: SolvedSpectra, request: FieldRequest, points: Points, times: FloatArray, quantity: Quantity, tell: Tell
) -> None:
    """Add the scattered field of a part at points to ``out``, shape (times, points)."""
    weight = mode_filter(request.filter, spectra.modes.max_order)
    done = 0
    grid = band(spectra.grid, request.resolution)
    for region, at in split(spectra.problem, points.radius):
        field = modal_field(spectra, grid, region, request.part)
        if region.exterior:
            at = at[points.radius[at] <= reach(spectra.problem, times, request.resolution)]
        if field is not None:
            for block, span in _blocks(at, times, field.parities * weight.size, grid, request.memory):
                values = field.histories(points.radius[block], times[span], quantity)
                for i, modal in zip(block, values, strict=True):
                    here = points.members[i]
                    basis = angle_basis(points.angle[here], weight.size, modal.shape[0]) * weight
                    out[span, here] += (basis.reshape(here.size, -1) @ modal.reshape(-1, modal.shape[-1])).T
                tell((done + block.size) / points.radius.size)
        done += at.size


def _blocks(at: np.ndarray, times: FloatArray, rows: int, grid: LaplaceGrid, memory: float) -> Iterator[tuple[np.ndarray, slice]]:
    """Yield blocks of radii and of instants whose modal histories fill about a third of the memory, and their direct sums a sixth."""
    width = max(1, min(times.size, int(memory / 3 / (16 * rows * WORKERS))))
    if not few_offsets(grid, times):
        width = max(1, min(width, int(memory / 6 / (32 * grid.nodes.size))))
    count = max(1, int(memory / 3 / (16 * rows * width)))
    for first in range(0, times.size, width):
        for start in range(0, at.size, count):
            yield at[start : start + count], slice(first, min(first + width, times.size))


Single = npt.NDArray[np.float32]

OVERSAMPLING = 2.3
TAPS_THETA = 6
TAPS_RADIUS = 8
_SHAPE = np.pi * np.sqrt((TAPS_THETA * (1.0 - 0.5 / OVERSAMPLING)) ** 2 - 0.8)
_CONTINUATION = 6.0
"""Largest growth, as the logarithm of r^M, that a field may show on its continuation beyond a wall."""
_DEEPEST = 0.5
"""Share of its inner wall's radius by which a fluid's field may be continued inward: at the axis, where few orders would let it go, it is
infinite."""


@dataclass(frozen=True)
class Raster:
    """Radii first + i spacing, i = 0..count - 1 (i = -1, -2, ... too through the centre of a disc), and ``angles`` angles from 0."""

    first: float
    spacing: float
    count: int
    angles: int
    through_centre: bool

    @property
    def radii(self) -> FloatArray:
        """The radii."""
        return np.asarray(self.first + self.spacing * np.arange(self.count), dtype=np.float64)


def raster_of(region: Region, radius: FloatArray, spacing: float, max_order: int) -> Raster:
    """Return the raster for points at given radii of a region."""
    low, high, margin = float(radius.min()), float(radius.max()), 0.5 * TAPS_RADIUS * spacing
    reach = _CONTINUATION / max(1, max_order)
    bottom = max(low - margin, region.inner * (1.0 - min(_DEEPEST, reach)))
    top = min(high + margin, region.outer * (1.0 + reach))
    angles = int(fft.next_fast_len(int(np.ceil(OVERSAMPLING * (2 * max_order + 2) / 4)), real=True)) * 4
    if region.index == 0 and bottom <= margin:
        return Raster(0.5 * spacing, spacing, max(TAPS_RADIUS, int(np.ceil(top / spacing - 0.5)) + 1), angles, True)
    count = max(TAPS_RADIUS, int(np.ceil((top - bottom) / spacing)) + 1)
    return Raster(bottom, (top - bottom) / (count - 1), count, angles, False)


def compensation(max_order: int, angles: int) -> FloatArray:
    """Return the inverse of the kernel's transform at every order."""
    root = np.sqrt(_SHAPE**2 - (np.pi * TAPS_THETA * np.arange(max_order + 1) / angles) ** 2)
    return np.asarray(root * i0(_SHAPE) / (TAPS_THETA * np.sinh(root)), dtype=np.float64)


def around(modal: Single, angles: int) -> Single:
    """Return the sum of all orders at equally spaced angles, (radii, angles, times), from compensated (radii, parities, M + 1, times)."""
    radii, parities, orders, times = modal.shape
    spectrum = np.zeros((radii, angles // 2 + 1, times), np.complex64)
    spectrum.real[:, :orders] = modal[:, 0]
    if parities == 2:
        spectrum.imag[:, 1:orders] = -modal[:, 1, 1:]
    spectrum[:, 1:] *= 0.5
    return np.asarray(fft.irfft(spectrum, angles, axis=1, norm="forward", overwrite_x=True), dtype=np.float32)


def operator(raster: Raster, radius: FloatArray, angle: FloatArray, *, odd: bool) -> sparse.csr_array:
    """Return the matrix from the raster, rows of angles one radius after another, to points.

    Parameters
    ----------
    raster : Raster
    radius, angle : ndarray, shape (points,)
        Angles in degrees.
    odd : bool
        Whether the field is a component along r or theta, which changes its sign through the centre.
    """
    row, across = _polynomial(raster, radius)
    column, along = _kernel(raster, angle)
    turned = row < 0
    if odd:
        across = np.where(turned, -across, across)
    row = np.where(turned, -1 - row, row)
    turn = np.where(turned, raster.angles // 2, 0)
    columns = np.mod(column[:, None, :] + turn[:, :, None], raster.angles) + (row * raster.angles)[:, :, None]
    values = (across[:, :, None] * along[:, None, :]).astype(np.float32)
    start = np.arange(radius.size + 1, dtype=np.int32) * (TAPS_RADIUS * TAPS_THETA)
    shape = (radius.size, raster.count * raster.angles)
    return sparse.csr_array((values.ravel(), columns.astype(np.int32).ravel(), start), shape=shape)


def _polynomial(raster: Raster, radius: FloatArray) -> tuple[npt.NDArray[np.int64], FloatArray]:
    """Return the raster rows and Lagrange weights of every point, each of shape (points, taps)."""
    position = (radius - raster.first) / raster.spacing
    least = -TAPS_RADIUS // 2 if raster.through_centre else 0
    start = np.clip(np.floor(position).astype(np.int64) - TAPS_RADIUS // 2 + 1, least, raster.count - TAPS_RADIUS)
    offset = position - start
    taps = np.arange(TAPS_RADIUS)
    weights = np.ones((radius.size, TAPS_RADIUS))
    for i in taps:
        for j in taps[taps != i]:
            weights[:, i] *= (offset - j) / (i - j)
    return start[:, None] + taps, weights


def _kernel(raster: Raster, angle: FloatArray) -> tuple[npt.NDArray[np.int64], FloatArray]:
    """Return the raster columns and Kaiser-Bessel weights of every point, each of shape (points, taps)."""
    position = np.mod(angle, 360.0) * (raster.angles / 360.0)
    column = np.floor(position).astype(np.int64)[:, None] - TAPS_THETA // 2 + 1 + np.arange(TAPS_THETA)
    offset = (column - position[:, None]) / (0.5 * TAPS_THETA)
    return column, i0(_SHAPE * np.sqrt(np.maximum(0.0, 1.0 - offset**2))) / i0(_SHAPE)


STEPS_PER_RESOLUTION = 0.8
"""Radial raster spacing per shortest half wave: the window leaves little at the band's end (measured, see the theory manual)."""

_POINTS = 16 * 1024
_BYTES_PER_POINT = 8 * TAPS_RADIUS * TAPS_THETA


def add_gridded(
    out: FloatArray,
    spectra: SolvedSpectra,
    asked: FieldRequest,
    place: tuple[FloatArray, FloatArray],
    times: FloatArray,
    quantity: Quantity,
    tell: Tell,
) -> None:
    """Add the scattered field of a part to ``out``, (times, points), at points (radius, angle in degrees)."""
    radius, angle = place
    grid = band(spectra.grid, asked.resolution)
    done = 0
    for region, at in split(spectra.problem, radius):
        field = modal_field(spectra, grid, region, asked.part)
        if region.exterior:
            at = at[radius[at] <= reach(spectra.problem, times, asked.resolution)]
        if field is not None and at.size:
            spacing = STEPS_PER_RESOLUTION * grid.time_step * region.spacing
            raster = raster_of(region, radius[at], spacing, spectra.modes.max_order)
            weight = mode_filter(asked.filter, spectra.modes.max_order) * compensation(spectra.modes.max_order, raster.angles)
            # Stores of modal histories, then of the field around the raster, each within a quarter of the memory.
            per_instant = 4 * raster.count * (2 * field.parities * weight.size)
            width = max(1, min(times.size, int(asked.memory / 4 / per_instant)))
            for start in range(0, times.size, width):
                span = slice(start, min(start + width, times.size))
                modal = field.histories(raster.radii, times[span], quantity, np.float32)
                modal *= weight.astype(np.float32)[:, None]
                to_points(out[span], modal, raster, (radius[at], angle[at]), at, asked.memory, odd=quantity in ("radial", "angular"))
                tell((done + at.size * span.stop / times.size) / radius.size)
        done += at.size


def to_points(
    out: FloatArray, modal: Single, raster: Raster, place: tuple[FloatArray, FloatArray], at: np.ndarray, memory: float, *, odd: bool
) -> None:
    """Add modal histories (radii, parities, M + 1, times), summed around the raster and interpolated, to ``out[:, at]``."""
    radius, angle = place
    times = modal.shape[-1]
    blocks = [slice(i, min(i + _POINTS, at.size)) for i in range(0, at.size, _POINTS)]
    keep = at.size * _BYTES_PER_POINT <= memory / 4
    operators = [operator(raster, radius[b], angle[b], odd=odd) if keep else None for b in blocks]
    width = max(1, min(times, 16, int(memory / 4 / (10 * raster.count * raster.angles))))
    for start in range(0, times, width):
        span = slice(start, min(start + width, times))
        field = around(modal[..., span], raster.angles).reshape(raster.count * raster.angles, -1)

        def work(i: int, span: slice = span, field: Single = field) -> None:
            matrix = operators[i]
            if matrix is None:
                matrix = operator(raster, radius[blocks[i]], angle[blocks[i]], odd=odd)
            out[span, at[blocks[i]]] += (matrix @ field).T

        list(map_on_threads(work, range(len(blocks))))


def raster_radii(problem: Problem, asked: FieldRequest, radius: FloatArray) -> int:
    """Return about how many radii the rasters of all regions have for points at these radii."""
    total = 0
    for region, at in split(problem, radius):
        spacing = STEPS_PER_RESOLUTION * asked.resolution * region.spacing
        total += int(np.ptp(radius[at]) / spacing) + TAPS_RADIUS
    return total
