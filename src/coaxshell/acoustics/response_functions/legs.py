"""What lies above the last resonance that is summed, exactly: integrals along two horizontal legs of the Laplace contour.

Let D be the echoes whose fronts have passed at time t and R = F - D all later ones. Above s = i kappa the vertical contour
is turned to the right for R and to the left for D; together with the residues below kappa,

    f(t) = sum_{x_k < kappa} residues + (1/pi) Im int_{-inf}^{inf} R(i kappa + u) e^{(i kappa + u) t} du.

Both halves decay like e^{-|u| delta}, delta the time since the last or until the next front. At a front the decay is algebraic,
and the nodes, geometrically spaced up to 1e16, still serve.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cache

import numpy as np
import numpy.typing as npt

from coaxshell.acoustics.response_functions.echoes import Echoes, Response, Waves, echoes, waves
from coaxshell.acoustics.response_functions.products import product
from coaxshell.numerics.arrays import ComplexArray, FloatArray

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


def snapped(times: FloatArray, response: Response) -> FloatArray:
    """Return the times with those that are at a front but for rounding put exactly there."""
    result = times.copy()
    for offset in response.offsets:
        turns = np.round((times - offset) / response.period)
        arrivals = offset + turns * response.period
        at = np.abs(times - arrivals) <= _tolerance(times, response)
        result[at] = arrivals[at]
    return result


def fronts_passed(times: FloatArray, response: Response) -> npt.NDArray[np.int64]:
    """Return how many direct and returned fronts have passed at each time, shape (2, times)."""
    early = _tolerance(times, response)
    return np.array([np.floor((times - offset + early) / response.period) + 1 for offset in response.offsets], dtype=np.int64)


def _tolerance(times: FloatArray, response: Response) -> FloatArray:
    return np.asarray(SNAP * np.maximum(response.period, times), dtype=np.float64)


def legs(orders: npt.NDArray[np.int64], kappas: FloatArray, times: FloatArray, responses: Sequence[Response]) -> FloatArray:
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


def _response(kappas: FloatArray, u: FloatArray, weights: FloatArray, at: Waves, times: FloatArray, response: Response) -> FloatArray:
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


def _groups(times: FloatArray, response: Response) -> Iterator[tuple[npt.NDArray[np.intp], npt.NDArray[np.int64]]]:
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

    def __init__(self, kappas: FloatArray, u: FloatArray, weights: FloatArray, at: Waves, response: Response) -> None:
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
