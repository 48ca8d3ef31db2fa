"""Sums of undamped oscillations over the resonances at many times, and what lies above the last one summed.

How far the resonances have to be summed before the contour can be turned, for each time: an echo of order m that went n times round
arrives late or early by about a/x^2 at wavenumber x, a ~ n m^2 (1/ra - 1/rb). Above kappa the legs decay if a/kappa^2 is less than the
distance delta from the front; and even at a front they never grow beyond e^{a/2 kappa}. So kappa = sqrt(a/delta), or a/G close to a
front: a few times need many resonances, most need few.

What lies above the last resonance that is summed, exactly: integrals along two horizontal legs of the Laplace contour. Let D be the
echoes whose fronts have passed at time t and R = F - D all later ones. Above s = i kappa the vertical contour is turned to the right
for R and to the left for D; together with the residues below kappa,

    f(t) = sum_{x_k < kappa} residues + (1/pi) Im int_{-inf}^{inf} R(i kappa + u) e^{(i kappa + u) t} du.

Both legs decay like e^{-|u| delta}, delta the time since the last or until the next front. At a front the decay is algebraic,
and the nodes, geometrically spaced up to 1e16, still serve.

The thousands of small matrix products are cut into slices that BLAS computes in one thread: shared out over threads, each waits for
the slowest, which on a busy machine cost five times the whole computation.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cache

import numpy as np
import numpy.typing as npt

from coaxshell.acoustics.response_functions.echoes import CavityResponse, Echoes, Waves, echoes, waves
from coaxshell.numerics.arrays import ComplexArray, FloatArray

_ONE_THREAD = 250_000  # OpenBLAS goes to several threads above 2^18 multiplications


def product(left: FloatArray, right: FloatArray) -> FloatArray:
    """Return left @ right."""
    height = max(1, _ONE_THREAD // max(1, right.size))
    whole = left.shape[0] // height * height
    result = np.empty((left.shape[0], right.shape[1]))
    if whole:
        slices = left[:whole].reshape(-1, height, left.shape[1])
        np.matmul(slices, right, out=result[:whole].reshape(-1, height, right.shape[1]))
    if whole < left.shape[0]:
        result[whole:] = left[whole:] @ right
    return result


_BLOCK = 2_000_000
_COHERENT = 1e5  # x t above which the rounding of t_i + t_j would show at fronts, where all terms are in phase


def is_uniform(times: FloatArray) -> bool:
    """Tell whether many times are equally spaced, to rounding."""
    if times.size < 64:
        return False
    even = np.linspace(times[0], times[-1], times.size)
    return bool(np.all(np.abs(times - even) <= 4e-16 * times.size * max(abs(float(times[-1])), abs(float(times[0])))))


def sines(x: FloatArray, weights: FloatArray, times: FloatArray, cosines: FloatArray | None = None) -> FloatArray:
    """Return sum_k w_k sin(x_k t) + c_k cos(x_k t) for several sets of weights (rows), shape (sets, times).

    Equally spaced times t_i + t_j cost products of small matrices.
    """
    if x.size == 0 or not (cheap_together(float(x[-1]), times) and is_uniform(times)):
        return _one_by_one(x, weights, times, cosines)
    columns = int(np.ceil(np.sqrt(times.size)))
    rows = -(-times.size // columns)
    step = (times[-1] - times[0]) / (times.size - 1)
    coarse = np.outer(times[0] + step * columns * np.arange(rows), x)
    fine = np.outer(x, step * np.arange(columns))
    sin, cos, sin_fine, cos_fine = np.sin(coarse), np.cos(coarse), np.sin(fine), np.cos(fine)
    result = np.empty((weights.shape[0], times.size))
    for row, w, c in zip(result, weights, np.zeros_like(weights) if cosines is None else cosines, strict=True):
        whole = product(sin * w + cos * c, cos_fine) + product(cos * w - sin * c, sin_fine)
        row[:] = whole.ravel()[: times.size]
    return result


def _one_by_one(x: FloatArray, weights: FloatArray, times: FloatArray, cosines: FloatArray | None) -> FloatArray:
    result = np.empty((weights.shape[0], times.size))
    size = max(1, _BLOCK // max(1, x.size))
    for start in range(0, times.size, size):
        phase = np.outer(x, times[start : start + size])
        part = np.einsum("sk,kt->st", weights, np.sin(phase))
        if cosines is not None:
            part += np.einsum("sk,kt->st", cosines, np.cos(phase))
        result[:, start : start + size] = part
    return result


def cheap_together(kappa: float, times: FloatArray) -> bool:
    """Tell whether equally spaced times are taken together for wavenumbers up to *kappa*."""
    return kappa * float(times[-1]) < _COHERENT


_GROWTH = 10.0  # the legs may grow by exp(_GROWTH/2) before they decay: two digits
_OVERFLOW = 500.0  # e^{a/2 kappa} itself has to stay a number even where the decay outweighs it
_LADDER = 2.0


def levels(order: int, times: FloatArray, responses: Sequence[CavityResponse]) -> Iterator[tuple[float, npt.NDArray[np.intp]]]:
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


def _spread(order: int, times: FloatArray, response: CavityResponse) -> FloatArray:
    square = order**2 + 1.0
    narrow = 1.0 / response.inner if response.inner > 0.0 else 2.0 / response.outer
    trip = square * (narrow - 1.0 / response.outer)
    within = square * (1.0 / response.at - 1.0 / response.outer) if response.at > 0.0 else 0.0
    return np.asarray((np.floor(times / response.period) + 2.0) * trip + within, dtype=np.float64)


def _distance(times: FloatArray, period: float) -> FloatArray:
    """Return the distance from the nearest multiple of the period."""
    return np.abs(times - period * np.round(times / period))


_STEP = 0.14
_FIRST, _LAST = -3.4, 38.0
_CLOSE = 3e-3
_DEEP = 45.0
SNAP = 1e-12
"""Times this close, relative to themselves, to a front are at the front, on its late side."""


@cache
def leg_nodes() -> tuple[FloatArray, FloatArray]:
    """Return nodes and weights of int_0^inf du: u = exp(v - exp(-v)), trapezoidal in v."""
    v = np.arange(_FIRST, _LAST, _STEP)
    u = np.exp(v - np.exp(-v))
    return u, _STEP * u * (1.0 + np.exp(-v))


def snapped(times: FloatArray, response: CavityResponse) -> FloatArray:
    """Return the times with those that are at a front but for rounding put exactly there."""
    result = times.copy()
    for offset in response.offsets:
        turns = np.round((times - offset) / response.period)
        arrivals = offset + turns * response.period
        at = np.abs(times - arrivals) <= _tolerance(times, response)
        result[at] = arrivals[at]
    return result


def fronts_passed(times: FloatArray, response: CavityResponse) -> npt.NDArray[np.int64]:
    """Return how many direct and returned fronts have passed at each time, shape (2, times)."""
    early = _tolerance(times, response)
    return np.array([np.floor((times - offset + early) / response.period) + 1 for offset in response.offsets], dtype=np.int64)


def _tolerance(times: FloatArray, response: CavityResponse) -> FloatArray:
    return np.asarray(SNAP * np.maximum(response.period, times), dtype=np.float64)


def legs(orders: npt.NDArray[np.int64], kappas: FloatArray, times: FloatArray, responses: Sequence[CavityResponse]) -> FloatArray:
    """Return the integrals, shape (responses, orders, times).

    Parameters
    ----------
    orders : ndarray
    kappas : ndarray, shape (orders,)
        kappa of each order, half-way between two resonances.
    times : ndarray
        In units of the fluid's own sound speed.
    responses : sequence of Response
        Of one cavity.
    """
    u, weights = leg_nodes()
    period = responses[0].period
    u, weights = u / period, weights / period
    at = waves(orders, kappas[:, None] - 1j * u, {radius for each in responses for radius in each[:3]})
    return np.array([_response(kappas, u, weights, at, times, response) for response in responses])


def _response(kappas: FloatArray, u: FloatArray, weights: FloatArray, at: Waves, times: FloatArray, response: CavityResponse) -> FloatArray:
    terms = _Terms(kappas, u, weights, at, response)
    integral = np.empty((kappas.size, times.size))
    for chosen, counts in _groups(times, response):
        total = np.zeros((kappas.size, chosen.size), dtype=np.complex128)
        for j, (count, offset) in enumerate(zip(counts, response.offsets, strict=True)):
            for side in (0, 1):
                rows = terms.rows(j, side, int(count))
                delays = times[chosen] - (offset + (count - side) * response.period)
                delays[np.abs(delays) <= _tolerance(times[chosen], response)] = 0.0
                total += _decaying(delays, u, rows, kappas, response.period)
        integral[:, chosen] = total.imag / np.pi
    return integral


def _groups(times: FloatArray, response: CavityResponse) -> Iterator[tuple[npt.NDArray[np.intp], npt.NDArray[np.int64]]]:
    """Yield the times between the same fronts, those close to one of them apart."""
    fronts = fronts_passed(times, response)
    phases = [(times - offset) / response.period for offset in response.offsets]
    close = np.any([np.abs(phase - np.round(phase)) < _CLOSE for phase in phases], axis=0)
    labels = np.concatenate([fronts, close[None]])
    for label in np.unique(labels, axis=1).T:
        yield np.flatnonzero(np.all(labels == label[:, None], axis=0)), label[:2]


def _decaying(delays: FloatArray, u: FloatArray, rows: ComplexArray, kappas: FloatArray, period: float) -> ComplexArray:
    """Return sum over the nodes of rows e^{-u |delay|}, times e^{i kappa delay}, shape (orders, times)."""
    lengths = np.abs(delays)
    shortest = float(lengths.min())
    used = u.size if shortest < _CLOSE * period else int(np.searchsorted(u, _DEEP / shortest))
    decay = np.exp(-np.outer(lengths, u[:used]))
    both = product(decay, np.concatenate([rows.real[:, :used], rows.imag[:, :used]]).T.copy()).T
    values = both[: rows.shape[0]] + 1j * both[rows.shape[0] :]
    return np.asarray(values * np.exp(1j * np.outer(kappas, delays)), dtype=np.complex128)


class _Terms:
    """The integrands of all orders without their dependence on time: side 0 is the leg to the right, 1 the one to the left."""

    def __init__(self, kappas: FloatArray, u: FloatArray, weights: FloatArray, at: Waves, response: CavityResponse) -> None:
        self._sides: tuple[Echoes, Echoes] = echoes(at, response)
        right, left = self._sides
        turn, shrink = np.exp(1j * kappas[:, None] * response.period), np.exp(-u * response.period)
        self._logs = (np.log(right.trip), np.log(left.trip))
        self._sums = (weights / (1.0 - right.trip * shrink / turn), -weights / (1.0 - turn * shrink / left.trip))

    def rows(self, j: int, side: int, count: int) -> ComplexArray:
        """Return P_j Q^n/(1 - Q) on the right, n = *count*, and -P_j Q^{n-1}/(1 - 1/Q) on the left, without delays."""
        echo = self._sides[side]
        first = echo.direct if j == 0 else echo.returned
        return np.asarray(first * np.exp((count - side) * self._logs[side]) * self._sums[side], dtype=np.complex128)
