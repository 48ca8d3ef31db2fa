"""What was understood of the pressure records in a description: few points to draw, peak, decay, impulse, remarks."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt

from coaxshell.model import Sampled, System
from coaxshell.model.records.remarks import remarks

FloatArray = npt.NDArray[np.float64]

INTERVALS = 150
"""Equal intervals of the picture, in each of which the lowest and the highest sample are kept."""


def viewed(system: System) -> list[dict[str, Any]]:
    """Return a view of each sampled pulse: its path, the curve that is solved thinned for a picture, and its numbers in SI."""
    several = isinstance(system.source, tuple)
    return [
        {"path": f"source[{index}].pulse" if several else "source.pulse", **_view(source.pulse)}
        for index, source in enumerate(system.sources)
        if isinstance(source.pulse, Sampled)
    ]


def _view(pulse: Sampled) -> dict[str, Any]:
    time, pressure = (np.asarray(values, dtype=np.float64) for values in pulse.curve)
    at = int(np.argmax(np.abs(pressure)))
    kept = thinned(time, pressure)
    return {
        "recorded": len(pulse.time),
        "samples": len(time),
        "duration": float(time[-1] - time[0]),
        "peak": float(pressure[at]),
        "peak_time": float(time[at]),
        "decay_time": decay_time(time, pressure),
        "impulse": float(np.trapezoid(pressure, time)),
        "remarks": list(remarks(pulse)),
        "time": [float(value) for value in time[kept]],
        "pressure": [float(value) for value in pressure[kept]],
    }


def decay_time(time: FloatArray, pressure: FloatArray) -> float | None:
    """Return the time (s) from the largest magnitude until the pressure has fallen to 1/e of it, between samples; None if it never does."""
    at = int(np.argmax(np.abs(pressure)))
    share = pressure[at:] / pressure[at] if pressure[at] else np.ones(1)
    below = np.flatnonzero(share <= 1 / math.e)
    if not below.size:
        return None
    after = int(below[0])
    before = share[after - 1]
    part = (before - 1 / math.e) / (before - share[after])
    start, end = time[at + after - 1], time[at + after]
    return float(start + part * (end - start) - time[at])


def thinned(time: FloatArray, pressure: FloatArray) -> npt.NDArray[np.intp]:
    """Return the numbers of the first and last sample and of the lowest and highest of each interval, in order."""
    if len(time) <= 4 * INTERVALS:
        return np.arange(len(time))
    edges = np.searchsorted(time, np.linspace(time[0], time[-1], INTERVALS + 1))
    kept = {0, len(time) - 1}
    for start, end in pairwise(edges):
        if end > start:
            kept |= {int(start + np.argmin(pressure[start:end])), int(start + np.argmax(pressure[start:end]))}
    return np.array(sorted(kept))
