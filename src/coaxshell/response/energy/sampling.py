"""Every K-th instant of many modal histories from their transforms, without computing the instants between.

A sum over the nodes at the times n K dt does not see multiples of the frequency 2 pi/(K dt): nodes that differ by one are added
up first, and a short FFT does the rest. K need not divide the number of samples; its greatest common divisor with it does.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from scipy import fft

from coaxshell.acoustics.laplace_grid import LaplaceGrid
from coaxshell.numerics.arrays import ComplexArray, FloatArray


class Sampler:
    """The instants 0, K, 2 K, ... of histories whose transforms are known at the lowest nodes of a grid.

    Parameters
    ----------
    grid : LaplaceGrid
    every : int
        K.
    """

    def __init__(self, grid: LaplaceGrid, every: int) -> None:
        divisor = math.gcd(every, grid.samples)
        self.length = grid.samples // divisor
        times = grid.time[::every]
        self._gain = np.exp(grid.shift * times) / (grid.time_step * divisor)
        self._instants = slice(0, 1 + (times.size - 1) * (every // divisor), every // divisor)

    def blocks(self, count: int, width: int) -> Iterator[slice]:
        """Yield slices of the nodes 0..count - 1 of at most *width*, none of them across a multiple of the short length."""
        start = 0
        while start < count:
            stop = min(start + width, count, (start // self.length + 1) * self.length)
            yield slice(start, stop)
            start = stop

    def add(self, total: ComplexArray, spectrum: ComplexArray, block: slice) -> None:
        """Add the transforms at one block of nodes to the sums (..., length), in place."""
        start = block.start % self.length
        total[..., start : start + spectrum.shape[-1]] += spectrum

    def finish(self, total: ComplexArray) -> FloatArray:
        """Return the histories at the instants; nodes above the lowest must have been counted twice, for their conjugates."""
        mirrored = total[..., -np.arange(self.length // 2 + 1)]
        hermitian = 0.5 * (total[..., : self.length // 2 + 1] + mirrored.conj())  # real part of the sum, by a real transform
        samples = fft.irfft(hermitian, self.length, axis=-1, overwrite_x=True)[..., self._instants]
        return np.asarray(samples * self._gain, dtype=np.float64)
