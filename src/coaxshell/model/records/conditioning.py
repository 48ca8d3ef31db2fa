"""From the samples of a record to the pressure history that strikes the shells: scale, baseline, cut, shift, resample, taper.

Between samples a record is linear. The steps are taken in this order, each only if asked for:

1. p := scale p - offset, and less the mean over the baseline window;
2. only start <= t <= end is kept, with interpolated ends, and t := t + shift (by default -start, so that the history begins at 0);
3. what lies before t = 0 is left out, with the interpolated value at 0;
4. on a grid of a given interval: interpolated where the record is coarser, else the mean of the record about each instant, so that
   the impulse is kept and nothing above the new Nyquist frequency is folded down unattenuated;
5. the last part is brought to zero by half a cosine.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from coaxshell.errors import InputError
from coaxshell.limits import RECORD_SAMPLES
from coaxshell.numerics.arrays import FloatArray


def conditioned(
    recorded_time: Sequence[float],
    recorded_pressure: Sequence[float],
    *,
    scale: float,
    offset: float,
    baseline: float | str | None,
    start: float | None,
    end: float | None,
    shift: float | None,
    resample: float | None,
    taper: float,
) -> tuple[FloatArray, FloatArray]:
    """Return times (s, from 0 on) and pressures (Pa) of a record's history; options are those of :class:`coaxshell.Sampled`.

    Raises
    ------
    InputError
        An option leaves nothing of the record, or does not fit it.
    """
    time = np.asarray(recorded_time)
    with np.errstate(over="ignore"):  # told below
        pressure = scale * np.asarray(recorded_pressure) - offset
    if not np.isfinite(pressure).all():
        raise InputError("scale", f"{scale!r} makes pressures that are not finite", "give a smaller one")
    if baseline is not None:
        pressure = pressure - _baseline(time, pressure, baseline)
    time, pressure = _cut(time, pressure, start, end, shift)
    if resample is not None:
        time, pressure = _resampled(time, pressure, resample)
    if taper:
        pressure = _tapered(time, pressure, taper)
    return time, pressure


def _baseline(time: FloatArray, pressure: FloatArray, window: float | str) -> float:
    inside = time < 0 if isinstance(window, str) else time <= time[0] + window
    if isinstance(window, str) and not inside.any():
        raise InputError(
            "baseline", "there are no samples before t = 0", "give the time from the first sample over which the mean is taken"
        )
    return float(pressure[inside].mean())


def _cut(
    time: FloatArray, pressure: FloatArray, start: float | None, end: float | None, told: float | None
) -> tuple[FloatArray, FloatArray]:
    shift = told if told is not None else -start if start is not None else 0.0
    first = max(float(time[0]), -math.inf if start is None else start, 0.0 - shift)
    last = min(float(time[-1]), math.inf if end is None else end)
    if first >= last:
        where = "start" if start is not None else "end" if end is not None else "shift" if told is not None else "time"
        raise InputError(
            where,
            f"nothing of the record is left between {first:g} s and {last:g} s",
            f"it reaches from {time[0]:g} s to {time[-1]:g} s, and what comes before t = 0 is left out",
        )
    if first > time[0] or last < time[-1]:
        inside = time[(time > first) & (time < last)]
        cut = np.concatenate([[first], inside, [last]])
        time, pressure = cut, np.interp(cut, time, pressure)
    if shift:
        time = np.maximum(time + shift, 0.0)
        if not (np.diff(time) > 0).all():
            raise InputError("shift", f"{shift!r} s is so large that instants of the record coincide", "give a smaller one")
    return time, pressure


def _resampled(time: FloatArray, pressure: FloatArray, interval: float) -> tuple[FloatArray, FloatArray]:
    span = time[-1] - time[0]
    count = math.floor(span / interval * (1 + 1e-12)) + 1 if span / interval < 1e18 else 10**18
    RECORD_SAMPLES.check(count, "resample", "give a longer interval")
    if count < 2:
        raise InputError("resample", f"{interval!r} s is longer than the record, {span:.6g} s", "give a shorter interval")
    grid = time[0] + interval * np.arange(count)
    if interval <= np.diff(time).min() * (1 + 1e-9):
        return grid, np.interp(grid, time, pressure)
    edges = np.concatenate([[time[0]], (grid[1:] + grid[:-1]) / 2, [min(grid[-1] + interval / 2, time[-1])]])
    impulse = np.diff(integral(time, pressure, edges))
    width = np.diff(edges)
    return grid, np.divide(impulse, width, out=np.interp(grid, time, pressure), where=width > 0)


def integral(time: FloatArray, pressure: FloatArray, at: FloatArray) -> FloatArray:
    """Return the integral of a record from its first sample to given instants within it, exact for what is linear between samples."""
    steps = np.diff(time)
    sums = np.concatenate([[0.0], np.cumsum(steps * (pressure[1:] + pressure[:-1]) / 2)])
    k = np.clip(np.searchsorted(time, at, side="right") - 1, 0, time.size - 2)
    within = at - time[k]
    slope = (pressure[k + 1] - pressure[k]) / steps[k]
    return np.asarray(sums[k] + within * (pressure[k] + slope * within / 2))


def _tapered(time: FloatArray, pressure: FloatArray, length: float) -> FloatArray:
    span = time[-1] - time[0]
    if length > span * (1 + 1e-12):
        raise InputError("taper", f"{length!r} s is longer than the history, {span:.6g} s", "give a shorter one")
    left = np.clip((time[-1] - time) / length, 0.0, 1.0)
    return np.asarray(pressure * (1 - np.cos(np.pi * left)) / 2)
