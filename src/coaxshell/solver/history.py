"""Convolution with a history that is still being made: sum_{j<n} k_{n-j} x_j, one step at a time, in O(N log^2 N).

The scheme of Hairer, Lubich and Schlichte (SIAM J. Sci. Stat. Comput. 6 (1985) 532): recent inputs are summed directly; each
time a block of 2^p steps is complete, its whole contribution to the next 2^p steps is added by one FFT.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy import fft

from coaxshell.acoustics.laplace_grid import WORKERS

FloatArray = npt.NDArray[np.float64]

BLOCK = 32
"""Steps summed directly before the FFTs take over."""


class KernelTable:
    """Kernels prepared for history sums: their transforms for every block length, computed once and shared by many marches.

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
        self.recent = np.ascontiguousarray(kernels[..., 1 : BLOCK + 1])
        self.kernels = kernels
        self._transforms: dict[int, npt.NDArray[np.complex128]] = {}

    @property
    def shape(self) -> tuple[int, int, int]:
        """(outputs, inputs, M + 1)."""
        outputs, inputs, modes, _ = self.kernels.shape
        return outputs, inputs, modes

    def transform(self, length: int) -> npt.NDArray[np.complex128]:
        """Return the transform of the first 2 * length samples, with k_0 = 0."""
        if length not in self._transforms:
            head = self.kernels[..., : 2 * length].copy()
            head[..., 0] = 0.0
            self._transforms[length] = fft.rfft(head, 2 * length, axis=-1, workers=WORKERS)
        return self._transforms[length]


class HistorySum:
    """State of one march: inputs so far and what they already promise to later steps.

    Parameters
    ----------
    table : KernelTable
    halves : int
        Independent copies (cosine and sine halves) that share the kernels.
    """

    def __init__(self, table: KernelTable, halves: int) -> None:
        outputs, inputs, modes = table.shape
        self._table = table
        self._step = 0
        self.inputs = np.zeros((inputs, halves, modes, table.steps))
        self._promised = np.zeros((outputs, halves, modes, table.steps))
        self._reversed = np.zeros((inputs, halves, modes, BLOCK))

    def present(self) -> FloatArray:
        """Return sum_{j<n} k_{n-j} x_j at the present step n, shape (outputs, halves, M + 1)."""
        total: FloatArray = self._promised[..., self._step].copy()
        recent = self._step % BLOCK
        if recent:
            products = self._table.recent[:, :, None, :, :recent] * self._reversed[None, ..., BLOCK - recent :]
            total += products.sum(axis=(1, 4))
        return total

    def push(self, values: FloatArray) -> None:
        """Append the input of the present step, shape (inputs, halves, M + 1), and advance."""
        self.inputs[..., self._step] = values
        self._reversed[..., BLOCK - 1 - self._step % BLOCK] = values
        self._step += 1
        if self._step % BLOCK == 0 and self._step < self._table.steps:
            self._promise()

    def _promise(self) -> None:
        """Add the contribution of the longest complete dyadic block that ends here to as many steps ahead."""
        length = self._step & -self._step
        start, stop = self._step - length, min(self._step + length, self._table.steps)
        block = fft.rfft(self.inputs[..., start : self._step], 2 * length, axis=-1, workers=WORKERS)
        transform = self._table.transform(length)
        total = np.einsum("ijmk,jhmk->ihmk", transform, block)
        ahead = fft.irfft(total, 2 * length, axis=-1, workers=WORKERS)[..., length : length + stop - self._step]
        self._promised[..., self._step : stop] += ahead
