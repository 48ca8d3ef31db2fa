"""Interpolation from a polar raster of one region to points: local, never across a wall.

Along theta the field is a finite Fourier series and a Kaiser-Bessel kernel, undone beforehand in the coefficients, is exact to
1e-6; along r eight-point polynomials are used on a raster that continues analytically a little beyond the walls (and through the
centre, where (-r, theta) is (r, theta + 180 degrees)), so that every stencil is centred.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy import fft, sparse
from scipy.special import i0

from coaxshell.numerics.arrays import FloatArray
from coaxshell.response.fields.regions import Region

Single = npt.NDArray[np.float32]

OVERSAMPLING = 2.3
TAPS_THETA = 6
TAPS_RADIUS = 8
_SHAPE = np.pi * np.sqrt((TAPS_THETA * (1.0 - 0.5 / OVERSAMPLING)) ** 2 - 0.8)
_CONTINUATION = 6.0
"""Largest growth, as the logarithm of r^M, that a field may show on its continuation beyond a wall."""


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
    bottom = max(low - margin, region.inner * (1.0 - min(1.0, reach)))
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
    """Return the sum of all orders at equally spaced angles, (radii, angles, times), from compensated (radii, halves, M + 1, times)."""
    radii, halves, orders, times = modal.shape
    spectrum = np.zeros((radii, angles // 2 + 1, times), np.complex64)
    spectrum.real[:, :orders] = modal[:, 0]
    if halves == 2:
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
