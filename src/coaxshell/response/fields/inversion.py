"""From a field's transforms, in the band of Laplace nodes that it needs and under a window over it, to histories at any instants.

x(t) = (1/P) Re sum_k c_k w_k X_k e^{s_k t}, c_0 = 1, else 2, is exact for every t in the run, not only at multiples of a time step: by
direct sums for a few instants, by shifted FFTs for many on a common raster.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy import fft

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid

_FEWEST = 16


def band(grid: LaplaceGrid, resolution: float) -> LaplaceGrid:
    """Return the grid of the first nodes of another one, up to pi/resolution: same contour, same period, coarser time step.

    The coarser step is a whole number of fine ones where the period allows it within a factor two, so that instants of the run lie
    on few shifted rasters.
    """
    most = int(resolution / grid.time_step * (1 + 1e-9))
    for step in range(most, most // 2, -1):
        samples, rest = divmod(grid.samples, step)
        coarse = _first_nodes(grid, samples)
        if rest == 0 and samples >= _FEWEST and coarse.samples == samples:
            return grid if step == 1 else coarse
    coarse = _first_nodes(grid, max(_FEWEST, int(np.ceil(grid.period / resolution))))
    return grid if coarse.samples >= grid.samples else _first_nodes(grid, coarse.samples)


def _first_nodes(grid: LaplaceGrid, samples: int) -> LaplaceGrid:
    """Return the grid of the same period and contour with this many samples, where that is a fast length for the FFT."""
    return LaplaceGrid(grid.period / samples, samples // 2 - 1, grid.wrap_around, fewest=0)


def window(grid: LaplaceGrid) -> FloatArray:
    """Return exp(-20 (omega/omega_max)^4) at the nodes.

    Spectra of pressures decay as slowly as 1/omega, so a band needs a window. This one leaves smooth fields alone to fourth order and
    has no edge. Measured on a plane front through massless shells (M = 300, omega_max = pi/0.005, error inside the inner shell per peak,
    more than 12 resolutions from the front): 2e-6, against 4e-4 with the Lanczos factor and 1e-3 with the roll-off for displacements.
    """
    return np.asarray(np.exp(-20.0 * np.linspace(0.0, 1.0, grid.nodes.size) ** 4), dtype=np.float64)


_SINGLE_THREADED = 2**17
"""Multiplications of one matrix product: below its library's threshold for threads, which would fight with ours (measured: 15 times
slower on a busy machine)."""

_PANEL = 16
"""Instants of one matrix product."""

_FFT_AS_INSTANTS = 100
"""Instants whose direct sums cost as much as one FFT (measured)."""


def on_raster(grid: LaplaceGrid, times: FloatArray) -> tuple[npt.NDArray[np.int64], FloatArray]:
    """Return the number of whole time steps of a grid in each instant, and what remains as a fraction of a step."""
    cell = np.floor(times / grid.time_step + 1e-6)
    return cell.astype(np.int64), np.round(times / grid.time_step - cell, 9)


def few_offsets(grid: LaplaceGrid, times: FloatArray) -> bool:
    """Return whether FFTs shifted to the instants cost less than direct sums."""
    return np.unique(on_raster(grid, times)[1]).size * _FFT_AS_INSTANTS <= times.size


class Inversion:
    """Inverse transforms of spectra to given instants.

    Parameters
    ----------
    grid : LaplaceGrid
    times : ndarray, shape (T,)
    """

    def __init__(self, grid: LaplaceGrid, times: FloatArray) -> None:
        self._grid, self._times = grid, times
        self._cell, offset = on_raster(grid, times)
        self._offsets, self._group = np.unique(offset, return_inverse=True)
        self.by_fft = few_offsets(grid, times)
        if not self.by_fft:
            self._matrix = direct_matrix(grid, times)

    @property
    def weight(self) -> FloatArray:
        """What spectra are to be multiplied by before the transform: the window, in the scale of the method."""
        return window(self._grid) / self._grid.time_step if self.by_fft else window(self._grid)

    def __call__(self, spectra: ComplexArray) -> FloatArray:
        """Return values at the instants, shape (..., T), from weighted spectra, shape (..., nodes)."""
        return self._shifted_ffts(spectra) if self.by_fft else direct_sums(self._matrix, spectra)

    def _shifted_ffts(self, spectra: ComplexArray) -> FloatArray:
        result = np.empty((*spectra.shape[:-1], self._times.size))
        for number, offset in enumerate(self._offsets):
            at = np.flatnonzero(self._group == number)
            shifted = spectra if offset == 0.0 else spectra * np.exp(1j * self._grid.nodes.imag * (offset * self._grid.time_step))
            histories = fft.irfft(shifted, self._grid.samples, axis=-1)
            result[..., at] = histories[..., self._cell[at]] * np.exp(self._grid.shift * self._times[at])
        return result


def direct_sums(matrix: FloatArray, spectra: ComplexArray) -> FloatArray:
    """Return values at the instants, shape (..., T), from weighted spectra, shape (..., nodes).

    *matrix* has the rows of these nodes of :func:`direct_matrix`: sums over some of the nodes add up to those over all.
    """
    rows, times = spectra.reshape(-1, spectra.shape[-1]).view(np.float64), matrix.shape[1]
    result = np.empty((rows.shape[0], times))
    for first in range(0, times, _PANEL):
        panel = matrix[:, first : first + _PANEL]
        height = max(1, _SINGLE_THREADED // panel.size)
        whole = rows.shape[0] // height * height
        stacked = np.matmul(rows[:whole].reshape(-1, height, rows.shape[1]), panel)
        result[:whole, first : first + _PANEL] = stacked.reshape(whole, panel.shape[1])
        if whole < rows.shape[0]:
            result[whole:, first : first + _PANEL] = rows[whole:] @ panel
    return result.reshape(*spectra.shape[:-1], times)


def direct_matrix(grid: LaplaceGrid, times: FloatArray) -> FloatArray:
    """Return the matrix of direct sums for the real view (re, im, re, im, ...) of weighted spectra, shape (2 nodes, T)."""
    waves = np.exp(np.outer(grid.nodes, times)) * (2.0 / grid.period)
    waves[0] *= 0.5
    if grid.samples % 2 == 0:
        waves[-1] *= 0.5
    matrix = np.empty((2 * grid.nodes.size, times.size))
    matrix[0::2], matrix[1::2] = waves.real, -waves.imag
    return matrix
