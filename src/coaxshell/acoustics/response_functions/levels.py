"""How far the resonances have to be summed before the contour can be turned, for each time.

An echo of order m that went n times round arrives late or early by about a/x^2 at wavenumber x, a ~ n m^2 (1/ra - 1/rb). Above
kappa the legs decay if a/kappa^2 is less than the distance delta from the front; and even at a front they never grow beyond
e^{a/2 kappa}. So kappa = sqrt(a/delta), or a/G close to a front: a few times need many resonances, most need few.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import numpy.typing as npt

from coaxshell.acoustics.response_functions.echoes import Response
from coaxshell.numerics.arrays import FloatArray

_GROWTH = 10.0  # the legs may grow by exp(_GROWTH/2) before they decay: two digits
_OVERFLOW = 500.0  # e^{a/2 kappa} itself has to stay a number even where the decay outweighs it
_LADDER = 2.0


def levels(order: int, times: FloatArray, responses: Sequence[Response]) -> Iterator[tuple[float, npt.NDArray[np.intp]]]:
    """Yield (kappa, indices of the times that it serves), from low to high kappa, for orders up to *order*."""
    least = lowest(order) / min(radius for each in responses for radius in each[:3] if radius > 0.0)
    spreads = [_spread(order, times, response) for response in responses]
    distances = [np.min([_distance(times - offset, each.period) for offset in each.offsets], axis=0) for each in responses]
    return ladder(least, [needed(*pair) for pair in zip(spreads, distances, strict=True)])


def lowest(order: int) -> float:
    """Return the least x r at which the contour may be turned: well above the turning point x r = m."""
    return 1.6 * order + 30.0


def needed(spread: FloatArray, distance: FloatArray) -> FloatArray:
    """Return kappa for a dispersion a and a distance delta from the front."""
    return np.maximum(spread / _OVERFLOW, np.minimum(spread / _GROWTH, np.sqrt(spread / np.maximum(distance, 1e-300))))


def ladder(least: float, needs: Sequence[FloatArray]) -> Iterator[tuple[float, npt.NDArray[np.intp]]]:
    """Yield (kappa, indices of the times that it serves), kappa in geometric steps from *least*."""
    highest = np.max(needs, axis=0, initial=least)
    steps = np.ceil(np.log(highest / least) / np.log(_LADDER) - 1e-9).astype(np.int64)
    for step in np.unique(steps):
        yield min(least * _LADDER ** int(step), float(highest.max())), np.flatnonzero(steps == step)


def _spread(order: int, times: FloatArray, response: Response) -> FloatArray:
    square = order**2 + 1.0
    narrow = 1.0 / response.inner if response.inner > 0.0 else 2.0 / response.outer
    trip = square * (narrow - 1.0 / response.outer)
    within = square * (1.0 / response.at - 1.0 / response.outer) if response.at > 0.0 else 0.0
    return np.asarray((np.floor(times / response.period) + 2.0) * trip + within, dtype=np.float64)


def _distance(times: FloatArray, period: float) -> FloatArray:
    """Return the distance from the nearest multiple of the period."""
    return np.abs(times - period * np.round(times / period))
