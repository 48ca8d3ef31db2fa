"""Convolution with a history that is still being made: sum_{j<n} k_{n-j} x_j, a block of steps at a time, in O(N log^2 N).

The scheme of Hairer, Lubich and Schlichte (SIAM J. Sci. Stat. Comput. 6 (1985) 532): each time a dyadic number of blocks is complete,
their whole contribution to as many blocks ahead is added at once, by FFT or, where few steps are concerned, by a matrix.
"""

from __future__ import annotations

import numpy as np
from scipy import fft

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import WORKERS

_BY_MATRIX = 16
"""Steps up to which a product with the Toeplitz matrix is faster than FFTs."""


class KernelTable:
    """Kernels prepared for history sums: transforms and matrices for every length, computed once and shared by many marches.

    Parameters
    ----------
    kernels : ndarray, shape (outputs, inputs, M + 1, T)
        Step weights k_0, k_1, ...; what k_0 does within the present step is the caller's.

    Attributes
    ----------
    present : ndarray, shape (outputs, inputs, M + 1)
        k_0.
    """

    def __init__(self, kernels: FloatArray) -> None:
        self.steps = kernels.shape[-1]
        self.present = kernels[..., 0].copy()
        self.kernels = kernels
        self._transforms: dict[int, ComplexArray] = {}
        self._matrices: dict[tuple[int, int], FloatArray] = {}

    @property
    def shape(self) -> tuple[int, int, int]:
        """(outputs, inputs, M + 1)."""
        outputs, inputs, modes, _ = self.kernels.shape
        return outputs, inputs, modes

    def transform(self, length: int) -> ComplexArray:
        """Return the transform of the first 2 * length samples, with k_0 = 0."""
        if length not in self._transforms:
            head = self.kernels[..., : 2 * length].copy()
            head[..., 0] = 0.0
            self._transforms[length] = fft.rfft(head, 2 * length, axis=-1, workers=WORKERS)
        return self._transforms[length]

    def matrix(self, length: int, offset: int) -> FloatArray:
        """Return k_{offset + t - j} (0 before k_0) as matrices from (input, j) to t, both below ``length``.

        Returns
        -------
        ndarray, shape (outputs, M + 1, length, inputs * length)
        """
        key = (length, offset)
        if key not in self._matrices:
            outputs, inputs, modes = self.shape
            head = np.zeros((outputs, inputs, modes, length + 2 * max(offset, length)))
            reach = min(offset + length, self.steps)
            head[..., length : length + reach] = self.kernels[..., :reach]
            lags = length + offset + np.arange(length)[:, None] - np.arange(length)
            spread = head[..., lags].transpose(0, 2, 3, 1, 4)
            self._matrices[key] = np.ascontiguousarray(spread).reshape(outputs, modes, length, inputs * length)
        return self._matrices[key]


class HistorySum:
    """State of one march: inputs so far and what they already promise to later steps.

    Parameters
    ----------
    table : KernelTable
    parities : int
        Independent copies (cosine and sine halves) that share the kernels.
    """

    def __init__(self, table: KernelTable, parities: int) -> None:
        outputs, inputs, modes = table.shape
        self._table = table
        self._step = 0
        self.inputs = np.zeros((inputs, parities, modes, table.steps))
        self._forcing = np.zeros((outputs, parities, modes, table.steps))

    def forcing(self, count: int) -> FloatArray:
        """Return what the inputs so far, x_0 to x_{n-1}, give to the steps n to n + count - 1: (outputs, parities, M + 1, count).

        ``count`` is at most the length of the blocks pushed.
        """
        return self._forcing[..., self._step : self._step + count]

    def push(self, values: FloatArray) -> FloatArray:
        """Append the inputs of a block of steps and advance.

        All blocks have the same length; only the last may be shorter.

        Parameters
        ----------
        values : ndarray, shape (inputs, parities, M + 1, count)

        Returns
        -------
        ndarray, shape (outputs, parities, M + 1, count)
            What these inputs give to their own steps, k_0 included.
        """
        count = values.shape[-1]
        self.inputs[..., self._step : self._step + count] = values
        own = self._by_matrix(values, 0)
        self._step += count
        if self._step < self._table.steps:
            blocks = self._step // count
            self._add_forcing(count * (blocks & -blocks))
        return own

    def _by_matrix(self, values: FloatArray, offset: int) -> FloatArray:
        inputs, parities, modes, length = values.shape
        stacked = values.transpose(2, 0, 3, 1).reshape(modes, inputs * length, parities)
        return np.asarray((self._table.matrix(length, offset) @ stacked).transpose(0, 3, 1, 2))

    def _add_forcing(self, length: int) -> None:
        """Add the contribution of the last ``length`` steps to as many steps ahead."""
        start, stop = self._step - length, min(self._step + length, self._table.steps)
        recent = self.inputs[..., start : self._step]
        if length <= _BY_MATRIX:
            forcing = self._by_matrix(recent, length)
        else:
            block = fft.rfft(recent, 2 * length, axis=-1, workers=WORKERS)
            total = np.einsum("ijmk,jhmk->ihmk", self._table.transform(length), block)
            forcing = fft.irfft(total, 2 * length, axis=-1, workers=WORKERS)[..., length:]
        self._forcing[..., self._step : stop] += forcing[..., : stop - self._step]
