"""What a record is, in numbers: peak, rise, decay, impulse, duration, sampling and the band that its energy lies in."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.fft import next_fast_len, rfft, rfftfreq

from coaxshell.limits import RECORD_SAMPLES
from coaxshell.model.records.conditioning import integral
from coaxshell.numerics.arrays import FloatArray

BAND = 0.99
"""Share of the energy that lies below the upper end of the band."""


@dataclass(frozen=True)
class Measures:
    """Measures of a history p(t); None for what it does not have.

    Attributes
    ----------
    samples : int
        Samples read; the history after cutting or resampling may have other ones.
    duration : float
        From the first to the last sample of the history (s).
    interval, largest_interval : float
        Smallest and largest interval between its samples (s).
    peak, peak_time : float
        Pressure of the largest magnitude (Pa), and when (s).
    rise_time : float
        From 10 to 90 % of the peak, before it (s); 0 for a front between two samples or before the first.
    decay_time : float, optional
        From the peak until the pressure has fallen to peak/e (s).
    impulse : float
        Integral of p (Pa s).
    largest_impulse : float
        Largest magnitude of the integral up to any sample (Pa s).
    positive_duration : float, optional
        From the peak to the first zero (s).
    band : float
        Frequency below which 99 % of the energy, the integral of p^2, lies (Hz).
    nyquist : float
        Half the sampling rate at the smallest interval (Hz).
    """

    samples: int
    duration: float
    interval: float
    largest_interval: float
    peak: float
    peak_time: float
    rise_time: float
    decay_time: float | None
    impulse: float
    largest_impulse: float
    positive_duration: float | None
    band: float
    nyquist: float


def measures(samples: int, time: FloatArray, pressure: FloatArray, frequency: FloatArray, density: FloatArray) -> Measures:
    """Return the measures of a history of which so many samples were read, and of its :func:`spectrum`."""
    steps = np.diff(time)
    at = int(np.abs(pressure).argmax())
    peak = float(pressure[at])
    relative = pressure / (peak or 1.0)
    sums = integral(time, pressure, time)
    return Measures(
        samples=samples,
        duration=float(time[-1] - time[0]),
        interval=float(steps.min()),
        largest_interval=float(steps.max()),
        peak=peak,
        peak_time=float(time[at]),
        rise_time=_rise(time[: at + 1], relative[: at + 1]),
        decay_time=_fall(time[at:], relative[at:], math.exp(-1)),
        impulse=float(sums[-1]),
        largest_impulse=float(sums[np.abs(sums).argmax()]),
        positive_duration=_fall(time[at:], relative[at:], 0.0),
        band=share_below(frequency, density, BAND),
        nyquist=0.5 / float(steps.min()),
    )


def _crossing(time: FloatArray, values: FloatArray, level: float, k: int) -> float:
    """Return when the line from sample k to k + 1 passes a level."""
    return float(time[k] + (time[k + 1] - time[k]) * (level - values[k]) / (values[k + 1] - values[k]))


def _rise(time: FloatArray, values: FloatArray) -> float:
    times = []
    for level in (0.1, 0.9):
        below = np.flatnonzero(values < level)
        times.append(_crossing(time, values, level, int(below[-1])) if below.size else float(time[0]))
    return max(0.0, times[1] - times[0])


def _fall(time: FloatArray, values: FloatArray, level: float) -> float | None:
    below = np.flatnonzero(values <= level)
    if not below.size or below[0] == 0:
        return None
    return _crossing(time, values, level, int(below[0]) - 1) - float(time[0])


def spectrum(time: FloatArray, pressure: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return frequencies (Hz) and the energy density |P(f)|^2 (Pa^2 s^2) of a history, by the transform of an even grid.

    The grid is as fine as the finest samples, within what a record may have, and at least twice as long as the history.
    """
    span = time[-1] - time[0]
    count = int(min(max(span / np.diff(time).min(), 64), RECORD_SAMPLES.value)) + 1
    grid = np.linspace(time[0], time[-1], count)
    values = np.interp(grid, time, pressure)
    values[[0, -1]] /= 2  # the trapezoidal rule, which a front in the first sample needs
    size = int(next_fast_len(2 * count, real=True))
    density = np.abs(rfft(values, size) * (grid[1] - grid[0])) ** 2
    return rfftfreq(size, grid[1] - grid[0]), density


def share_below(frequency: FloatArray, density: FloatArray, share: float) -> float:
    """Return the frequency below which a share of the energy lies (Hz)."""
    sums = np.cumsum(density) - density[0] / 2  # the first piece is half as wide
    return float(frequency[min(int(np.searchsorted(sums, share * sums[-1])), len(frequency) - 1)]) if sums[-1] > 0 else 0.0


def energy_above(found: FloatArray, density: FloatArray, frequency: float) -> float:
    """Return the share of the energy of a :func:`spectrum` that lies above a frequency (Hz)."""
    below = np.cumsum(density) - density[0] / 2  # up to the upper edge of each piece; the first is half as wide
    if below[-1] <= 0:
        return 0.0
    return float(1.0 - np.interp(frequency, found + found[1] / 2, below, left=2 * below[0] * frequency / found[1]) / below[-1])
