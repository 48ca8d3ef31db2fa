"""What was understood of the pressure records in a description: few points to draw, peak, decay, impulse, remarks."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt

from coaxshell.model import Sampled, System
from coaxshell.numerics.arrays import FloatArray

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
    found = pulse.measures
    kept = thinned(time, pressure)
    return {
        "recorded": found.samples,
        "samples": len(time),
        **{name: getattr(found, name) for name in ("duration", "peak", "peak_time", "decay_time", "impulse")},
        "remarks": list(pulse.remarks),
        "time": [float(value) for value in time[kept]],
        "pressure": [float(value) for value in pressure[kept]],
    }


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
