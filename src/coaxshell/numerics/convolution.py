"""Convolution with a history that is still being made: sum_{j<n} k_{n-j} x_j, a block of steps at a time, in O(N log^2 N).

The scheme of Hairer, Lubich and Schlichte (SIAM J. Sci. Stat. Comput. 6 (1985) 532): each time a dyadic number of blocks is complete,
their whole contribution to as many blocks ahead is added at once, by FFT or, where few steps are concerned, by a matrix.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import fft

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.threads import WORKERS

_BY_MATRIX = 16
"""Steps up to which a product with the Toeplitz matrix is faster than FFTs."""
_ALONE = 2**16
"""Numbers up to which one thread transforms them faster than several."""


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


@dataclass(frozen=True)
class History:
    """The inputs of a march so far and what they give to the steps to come; a new one at every push, the old one stays as it is.

    Attributes
    ----------
    step : int
        n, of the next step.
    inputs : tuple of ndarray, each of shape (inputs, parities, M + 1, count)
        x_0 to x_{n-1}: blocks as they were pushed, joined to as many as the binary digits of their number say.
    pending : tuple of (int, ndarray of shape (outputs, parities, M + 1, length))
        Spans of steps that reach beyond n, each within the one before it: first step, and sum of all that has been given to its steps.
    """

    step: int = 0
    inputs: tuple[FloatArray, ...] = ()
    pending: tuple[tuple[int, FloatArray], ...] = ()


class HistorySum:
    """The convolution of one table with a history; holds nothing of the march itself.

    Parameters
    ----------
    table : KernelTable
    parities : int
        Independent copies (cosine and sine) that share the kernels.
    """

    def __init__(self, table: KernelTable, parities: int) -> None:
        self._table, self._parities = table, parities

    def forcing(self, history: History, count: int) -> FloatArray:
        """Return what the inputs so far, x_0 to x_{n-1}, give to the steps n to n + count - 1: (outputs, parities, M + 1, count).

        ``count`` is at most the length of the blocks pushed.
        """
        if not history.pending:
            outputs, _, modes = self._table.shape
            return np.zeros((outputs, self._parities, modes, count))
        start, given = history.pending[-1]
        return given[..., history.step - start : history.step - start + count]

    def push(self, history: History, values: FloatArray) -> tuple[History, FloatArray]:
        """Append the inputs of a block of steps and advance.

        All blocks have the same length; only the last may be shorter.

        Parameters
        ----------
        history : History
        values : ndarray, shape (inputs, parities, M + 1, count)

        Returns
        -------
        History
        ndarray, shape (outputs, parities, M + 1, count)
            What these inputs give to their own steps, k_0 included.
        """
        count = values.shape[-1]
        step, earlier, recent = history.step + count, history.inputs, values
        pending = history.pending
        while pending and pending[-1][0] + pending[-1][1].shape[-1] <= step:
            pending = pending[:-1]
        while earlier and earlier[-1].shape[-1] == recent.shape[-1]:
            earlier, recent = earlier[:-1], np.concatenate([earlier[-1], recent], axis=-1)
        if step < self._table.steps:
            pending = (*pending, (step, self._given(recent, step, pending)))
        return History(step, (*earlier, recent), pending), self._by_matrix(values, 0)

    def _given(self, recent: FloatArray, step: int, pending: tuple[tuple[int, FloatArray], ...]) -> FloatArray:
        """Return the sum of what the last inputs and all before them give to as many steps after them."""
        made = self._contribution(recent)
        if not pending:
            return np.add(made, 0.0, order="C")  # no zero has a sign, as of any sum
        start, around = pending[-1]
        known = around[..., step - start : step - start + made.shape[-1]]
        return np.add(known, made[..., : known.shape[-1]], order="C")  # shorter only after the last block, whose length is its own

    def _by_matrix(self, values: FloatArray, offset: int) -> FloatArray:
        inputs, parities, modes, length = values.shape
        stacked = values.transpose(2, 0, 3, 1).reshape(modes, inputs * length, parities)
        return np.asarray((self._table.matrix(length, offset) @ stacked).transpose(0, 3, 1, 2))

    def _contribution(self, recent: FloatArray) -> FloatArray:
        """Return what the last inputs give to as many steps after them."""
        length = recent.shape[-1]
        if length <= _BY_MATRIX:
            return self._by_matrix(recent, length)
        workers = 1 if recent.size <= _ALONE else WORKERS
        spectrum = fft.rfft(recent, 2 * length, axis=-1, workers=workers)
        total = np.einsum("ijmk,jhmk->ihmk", self._table.transform(length), spectrum)
        return np.asarray(fft.irfft(total, 2 * length, axis=-1, workers=workers)[..., length:])


def summed_weights(weights: FloatArray, every: int, steps: int) -> FloatArray:
    """Return step weights for steps *every* times longer: a hat as wide is the sum of narrower ones."""
    whole = weights[..., : weights.shape[-1] // every * every]
    falling = 1.0 - np.arange(every) / every  # from each long step on; what lies before it rises with the rest of 1
    parts = whole.reshape(*whole.shape[:-1], -1, every) @ np.stack([falling, 1.0 - falling], axis=1)
    total = np.zeros((*weights.shape[:-1], steps))
    whole_steps = min(steps, parts.shape[-2])
    total[..., :whole_steps] = parts[..., :whole_steps, 0]
    total[..., 1:] += parts[..., : steps - 1, 1]
    rest = weights[..., whole.shape[-1] :]
    if whole_steps < steps:
        total[..., whole_steps] += rest @ falling[: rest.shape[-1]]
    return total
