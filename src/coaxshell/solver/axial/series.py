"""Functions along an axial period as sums of cosines and sines, and products of them taken point by point without aliasing.

    f(z) = a_0 + sum_{j=1}^{J} [a_j cos k_j (z - z_0) + b_j sin k_j (z - z_0)],      k_j = 2 pi j/L.

The cube of such a sum, and its square times another, reach 3J. On more than 4J points of a period none of that is folded back onto what
lies up to J: projecting the values of a law of third degree on the sum is then exact, and keeps the energy of a potential.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import fft

from coaxshell.numerics.arrays import FloatArray


@dataclass(frozen=True)
class AxialSeries:
    """Sums up to a highest wavenumber, even about z_0 or of both kinds.

    Attributes
    ----------
    waves : int
        J + 1.
    parities : int
        1 for cosines alone, else 2. Coefficients have the shape (waves, n, parities).
    """

    waves: int
    parities: int

    @cached_property
    def samples(self) -> int:
        """Number of points of a period, even and above 4J; 1 where nothing changes along the axis."""
        return 1 if self.waves == 1 else 2 * int(fft.next_fast_len(2 * self.waves - 1))

    @property
    def points(self) -> int:
        """Points at which values are taken: of an even sum those of half the period, both ends included."""
        return self.samples // 2 + 1 if self.parities == 1 and self.waves > 1 else self.samples

    @cached_property
    def weights(self) -> FloatArray:
        """Share of each point in the mean over a period, shape (points,)."""
        found = np.full(self.points, 1.0 / self.samples)
        if self.points < self.samples:
            found[1:-1] *= 2.0
        return found

    def values(self, coefficients: FloatArray) -> FloatArray:
        """Return a sum at the points: (points, n) from coefficients (waves, n, parities)."""
        if self.waves == 1:
            return np.asarray(coefficients[..., 0])
        if self.parities == 1:
            padded = np.zeros((self.points, coefficients.shape[1]))
            padded[: self.waves] = 0.5 * coefficients[..., 0]
            padded[0] *= 2.0
            return np.asarray(fft.dct(padded, type=1, axis=0, overwrite_x=True))
        spectrum = np.zeros((self.samples // 2 + 1, coefficients.shape[1]), np.complex128)
        spectrum[: self.waves] = (0.5 * self.samples) * (coefficients[..., 0] - 1j * coefficients[..., 1])
        spectrum[0] = self.samples * coefficients[0, :, 0]
        return np.asarray(fft.irfft(spectrum, self.samples, axis=0, overwrite_x=True))

    def coefficients(self, values: FloatArray) -> FloatArray:
        """Return the coefficients (waves, n, parities) of what values at the points, (points, n), have of the sum."""
        if self.waves == 1:
            return values[..., None]
        if self.parities == 1:
            cosines = fft.dct(values, type=1, axis=0)[: self.waves] * (2.0 / self.samples)
            cosines[0] *= 0.5
            return np.asarray(cosines[..., None])
        spectrum = fft.rfft(values, axis=0)[: self.waves] * (2.0 / self.samples)
        spectrum[0] *= 0.5
        return np.stack([spectrum.real, -spectrum.imag], axis=-1)
