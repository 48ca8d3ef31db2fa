"""The Laplace contour s = sigma + i omega on a uniform grid, and the transforms between it and uniform time samples.

A function x(t) is recovered over [0, T] from its transform on the contour by one real FFT with an exponential window,

    x(t) ~ e^{sigma t} irfft(X(sigma + i omega_k)) / dt,    omega_k = 2 pi k / P,    P >= 2 T.

What x does after P returns to [0, T] damped by e^{-sigma P} = WRAP_AROUND; what lies above the Nyquist frequency pi/dt is lost.
A sharp cut there would leave an error that oscillates at the Nyquist frequency, spreads from every front over all times
and is amplified by e^{sigma t}; a smooth roll-off over the top fifth of the band keeps it at the fronts (measured on the
paper's bare case: outer head displacement 1.0e-5 with the sharp cut, 8e-8 with the roll-off).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Protocol

import numpy as np
from scipy import fft

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.threads import WORKERS, map_on_threads

WRAP_AROUND = 1e-10
"""e^{-sigma P}: damping of what wraps around the period; rounding is amplified by at most its inverse square root."""

ROLL_OFF = 0.2
"""Fraction of the band, at its top, over which spectra are brought smoothly to zero."""

FEWEST_SAMPLES = 512
"""Samples that a period has at least: what the band limit spreads from a front falls off with the number of steps only, and a short
period brings the next front's share within reach of the end, where e^{sigma t} amplifies it."""

_BLOCK = 2**17
"""Complex numbers that are inverted together, 2 MB: their histories have not left the processor's cache when they are weighted."""


def in_blocks(work: Callable[[int], None], starts: range) -> None:
    """Do the work that begins at each of some numbers, on all threads where there are several."""
    for _ in map(work, starts) if len(starts) == 1 else map_on_threads(work, starts):
        pass


class Nodes(Protocol):
    """Values of the Laplace variable at which something is wanted, on a uniform contour or anywhere."""

    @property
    def nodes(self) -> ComplexArray:
        """s, shape (nodes,)."""
        ...

    @property
    def nyquist(self) -> float:
        """The highest angular frequency among them."""
        ...


@dataclass(frozen=True)
class LaplaceGrid:
    """Uniform nodes of the Laplace contour matched to a uniform time axis.

    Attributes
    ----------
    time_step : float
        dt, dimensionless.
    steps : int
        The time axis is 0, dt, ..., steps * dt.
    wrap_around : float
        e^{-sigma P}.
    fewest : int
        Samples that a period has at least.
    """

    time_step: float
    steps: int
    wrap_around: float = WRAP_AROUND
    fewest: int = FEWEST_SAMPLES

    @cached_property
    def samples(self) -> int:
        """Number of time samples in one period P, at least twice those asked for."""
        return int(fft.next_fast_len(max(2 * (self.steps + 1), self.fewest), real=True))

    @property
    def period(self) -> float:
        """P = samples * dt."""
        return self.samples * self.time_step

    @property
    def shift(self) -> float:
        """sigma = -ln(wrap_around)/P, the distance of the contour from the imaginary axis."""
        return -float(np.log(self.wrap_around)) / self.period

    @property
    def frequency_step(self) -> float:
        """2 pi/P."""
        return 2 * np.pi / self.period

    @property
    def nyquist(self) -> float:
        """pi/dt, the highest angular frequency on the grid."""
        return np.pi / self.time_step

    @cached_property
    def nodes(self) -> ComplexArray:
        """s_k = sigma + i omega_k for k = 0..samples//2."""
        return np.asarray(self.shift + 1j * self.frequency_step * np.arange(self.samples // 2 + 1), dtype=np.complex128)

    def sparser(self, every: int) -> LaplaceGrid:
        """Return the grid of every so many of the nodes, the first of them its own; its period is as many times shorter."""
        count = -(-self.nodes.size // every)
        short = LaplaceGrid(self.period / every, count - 2, self.wrap_around ** (1.0 / every), 1)
        return replace(short, time_step=short.time_step / short.samples)

    @cached_property
    def time(self) -> FloatArray:
        """0, dt, ..., steps * dt."""
        return np.asarray(self.time_step * np.arange(self.steps + 1), dtype=np.float64)

    def taper(self, roll_off: float = ROLL_OFF) -> FloatArray:
        """Return 1 over the band and a cos^2 descent to 0 over its top fraction ``roll_off``, at ``nodes``."""
        return _descent(self.nodes.size, roll_off)

    def lanczos(self) -> FloatArray:
        """Return sinc(omega/omega_max) at ``nodes``: for spectra that decay slowly (pressures, accelerations)."""
        window: FloatArray = np.sinc(np.linspace(0.0, 1.0, self.nodes.size))
        return window

    def invert(self, spectrum: ComplexArray, window: FloatArray | None = None) -> FloatArray:
        """Return time histories on ``time`` from their transforms at ``nodes`` (last axis).

        ``window`` weights the spectrum; by default ``taper()``. A stronger one costs accuracy in smooth quantities.
        """
        window = self.taper() if window is None else window
        growth = np.exp(self.shift * self.time) / self.time_step
        rows, stop = spectrum.reshape(-1, self.nodes.size), self.steps + 1
        blocks = max(1, -(-rows.size // _BLOCK))
        width = max(1, -(-len(rows) // blocks))
        result = np.empty((len(rows), stop))

        def invert_some(first: int) -> None:
            some = slice(first, first + width)
            histories = fft.irfft(rows[some] * window, self.samples, axis=-1, overwrite_x=True)
            np.multiply(histories[:, :stop], growth, out=result[some])

        in_blocks(invert_some, range(0, len(rows), width))
        return result.reshape(*spectrum.shape[:-1], stop)

    def beyond(self, spectrum: ComplexArray) -> FloatArray:
        """Return what :meth:`invert` leaves out: the rest of the period after ``time``, of which wrap_around returns to its beginning.

        Rounding is amplified there by up to 1/wrap_around.
        """
        histories = fft.irfft(spectrum * self.taper(), self.samples, axis=-1, workers=WORKERS, overwrite_x=True)[..., self.steps + 1 :]
        rest = self.time_step * np.arange(self.steps + 1, self.samples)
        result: FloatArray = histories * (np.exp(self.shift * rest) / self.time_step)
        return result

    def transform(self, histories: FloatArray) -> ComplexArray:
        """Return dt * sum_n x(t_n) e^{-s t_n} at ``nodes`` (last axis): the transform of samples, the partner of ``invert``."""
        damped = histories * (np.exp(-self.shift * self.time) * self.time_step)
        spectrum: ComplexArray = fft.rfft(damped, self.samples, axis=-1, workers=WORKERS)
        return spectrum

    def invert_transposed(self, histories: FloatArray, window: FloatArray | None = None) -> ComplexArray:
        """Return the transpose of :meth:`invert`: X with Re sum_k X_k S_k = sum_n x_n invert(S)_n for every S (last axis).

        No complex conjugate is taken of S: X_k = taper_k c_k/(P dt) sum_n x_n e^{(sigma + i omega_k) t_n}, P the samples of a period and
        c_k the times that a node counts in a real transform; ``window`` is that of the inverse.
        """
        grown = histories * np.exp(self.shift * self.time)
        spectrum: ComplexArray = fft.rfft(grown, self.samples, axis=-1, workers=WORKERS)
        spectrum *= (self.taper() if window is None else window) * self._counts / self.period
        return spectrum.conj()

    def transform_linear_transposed(self, spectrum: ComplexArray) -> FloatArray:
        """Return the transpose of :meth:`transform_linear`: x with sum_n x_n y_n = Re sum_k X_k transform_linear(y)_k for every y."""
        weighted = np.conjugate(spectrum * self.hat) * (self.samples / self._counts)
        histories = fft.irfft(weighted, self.samples, axis=-1, workers=WORKERS, overwrite_x=True)[..., : self.steps + 1]
        result: FloatArray = histories * (np.exp(-self.shift * self.time) * self.time_step)
        return result

    @cached_property
    def _counts(self) -> FloatArray:
        """How often each node counts in a real transform: once at its ends, else twice, for itself and its conjugate."""
        counts = np.full(self.nodes.size, 2.0)
        counts[0] = 1.0
        if self.samples % 2 == 0:
            counts[-1] = 1.0
        return counts

    @cached_property
    def hat(self) -> ComplexArray:
        """(sinh(s dt/2)/(s dt/2))^2 at ``nodes``: transform of the hat, two steps wide, that joins samples by straight lines."""
        half = 0.5 * self.time_step * self.nodes
        return np.asarray((np.sinh(half) / half) ** 2, dtype=np.complex128)

    def transform_linear(self, histories: FloatArray) -> ComplexArray:
        """Return the transforms at ``nodes`` of functions that are linear between their samples (last axis)."""
        spectrum = self.transform(histories)
        spectrum *= self.hat
        return spectrum

    def continuation(self, histories: FloatArray) -> ComplexArray:
        """Return the transforms of what follows histories after their last instant: value and slope, faded by cos^2 over half a run.

        What acts after the end moves nothing before it; but what is cut off there jumps, and the band limit spreads half of the jump and
        its overshoot over the last instants.
        """
        value, slope = self._beyond_end
        rate = 3.0 * histories[..., -1:] - 4.0 * histories[..., -2:-1] + histories[..., -3:-2]
        return np.asarray(histories[..., -1:] * value + rate / (2.0 * self.time_step) * slope)

    def transform_continued(self, histories: FloatArray) -> ComplexArray:
        """Return :meth:`transform_linear` of histories that go on after their last instant (:meth:`continuation`)."""
        spectrum = self.transform_linear(histories)
        spectrum += self.continuation(histories)
        return spectrum

    @cached_property
    def _beyond_end(self) -> ComplexArray:
        """The transforms of 1 and t - T after the last instant T, each faded over half a run and linear between the steps, (2, nodes)."""
        count = max(1, min(self.samples - self.time.size, self.steps // 2))
        later = np.arange(1, count + 1)
        fade = np.cos(0.5 * np.pi * later / (count + 1)) ** 2
        samples = np.zeros((2, self.samples))
        samples[:, self.steps + later] = fade * np.stack([np.ones(count), self.time_step * later])
        samples *= self.time_step * np.exp(-self.shift * self.time_step * np.arange(self.samples))
        return np.asarray(self.hat * np.fft.rfft(samples, axis=-1))


@lru_cache(maxsize=64)
def _descent(nodes: int, roll_off: float) -> FloatArray:
    """Return the taper of a band of some nodes; it is shared, and not to be changed."""
    position = np.linspace(0.0, 1.0, nodes)
    descent: FloatArray = np.cos(0.5 * np.pi * np.maximum(0.0, position - (1.0 - roll_off)) / roll_off) ** 2
    descent.flags.writeable = False
    return descent
