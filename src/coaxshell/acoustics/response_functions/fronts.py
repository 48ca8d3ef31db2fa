"""When fronts arrive, and what they are: jumps, or logarithms after an odd number of passages through the centre."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from coaxshell.acoustics.response_functions.echoes import Response
from coaxshell.numerics.arrays import FloatArray


def arrivals(inner: float, outer: float, radius: float, driven: str, slowness: float, duration: float) -> list[tuple[float, bool]]:
    """Return (time, whether a logarithm) of all fronts at a radius of an annulus, or of a disc (inner = 0), up to *duration*."""
    response = Response(inner, outer, radius, driven == "inner")
    return [(time * slowness, inner == 0.0 and passages % 2 == 1) for time, passages in front_times(response, duration / slowness)]


def front_times(response: Response, duration: float) -> list[tuple[float, int]]:
    """Return (time, passages through the centre, or reflections) of all fronts up to *duration*, in the fluid's own time."""
    found: dict[float, int] = {}
    trips = int(duration / response.period) + 1
    for n in range(trips + 1):
        for passages, offset in zip((n, n + 1), response.offsets, strict=True):
            arrival = offset + n * response.period
            if arrival <= duration:
                found.setdefault(round(arrival, 12), passages)
    return sorted(found.items())


def logarithms(values: FloatArray, orders: npt.NDArray[np.int64], times: FloatArray, response: Response) -> FloatArray:
    """Return the response of a disc with inf or -inf where a front comes after an odd number k of passages.

    After k passages the front is proportional to i^k (-1)^{mk}/s; the imaginary part is a logarithm, -Im(...) ln|t - t_k|/pi. At the
    centre itself, which every wave of order 0 meets as 1/sqrt(s), it is infinite on its late side only.
    """
    if times.size == 0 or times.max() < 0.0:
        return values
    for arrival, passages in front_times(response, float(times.max()) + response.period):
        hit = np.flatnonzero(np.abs(times - arrival) <= 1e-12 * max(response.period, arrival))
        if response.at == 0.0:
            values[np.ix_(orders == 0, hit)] = np.inf if passages % 2 == 0 else -np.inf
        elif passages % 2:
            sign = (1.0 - 2.0 * (orders % 2)) * (1.0 - 2.0 * ((passages - 1) // 2 % 2))
            values[:, hit] = (sign * np.inf)[:, None]
    return values
