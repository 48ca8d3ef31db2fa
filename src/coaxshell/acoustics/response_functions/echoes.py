"""Echoes of a front in a cavity, each one term of a geometric series (the Debye series): as travelling waves, and when each arrives.

With s = ix on the right of the imaginary axis, H1_m(xr) is a wave that runs inward and H2_m(xr) one that runs outward. A
response is (P_1 + P_2)/(1 - Q) = sum_n (P_1 + P_2) Q^n: P_1 the direct wave, P_2 the one after its first reflection, Q one
round trip. Each is kept without its delay: P_j = p_j e^{-s offset_j}, Q = q e^{-s period}.

Fronts arrive as jumps, or as logarithms after an odd number of passages through the centre.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from coaxshell.acoustics.response_functions.hankel import Expansion, expand
from coaxshell.numerics.arrays import ComplexArray, FloatArray


class CavityResponse(NamedTuple):
    """Which response: pressure at radius ``at`` per acceleration of the inner (ra) or the outer (rb) wall; ra = 0 is a disc.

    At the centre of a disc, r = 0, the direct and the returned wave are one; only m = 0 reaches it.
    """

    inner: float
    outer: float
    at: float
    driven_inside: bool

    @property
    def period(self) -> float:
        """Delay of one round trip."""
        return 2.0 * (self.outer - self.inner)

    @property
    def offsets(self) -> tuple[float, float]:
        """Delays of the direct wave and of the one after its first reflection (or its first passage through the centre)."""
        direct = self.at - self.inner if self.driven_inside else self.outer - self.at
        return direct, self.period - direct


@dataclass(frozen=True, eq=False)
class Echoes:
    """Direct wave p_1, the one after its first reflection p_2, and a round trip q, at complex wavenumbers, without their delays."""

    direct: ComplexArray
    returned: ComplexArray
    trip: ComplexArray


class _Pair(NamedTuple):
    """The inward and the outward wave at one radius."""

    inward: Expansion
    outward: Expansion


@dataclass(frozen=True, eq=False)
class Waves:
    """Inward and outward waves at several radii, at x (right of the imaginary axis of s) and at its conjugate (left)."""

    x: ComplexArray
    right: dict[float, _Pair]
    left: dict[float, _Pair]


def waves(orders: npt.NDArray[np.int64], x: ComplexArray, radii: set[float]) -> Waves:
    """Return the waves of each order along the rows of x, Im x <= 0."""
    column = orders.astype(np.float64)[:, None]
    right = {radius: _Pair(*(expand(column, x * radius, kind) for kind in (1, 2))) for radius in radii if radius > 0.0}
    return Waves(x, right, {radius: _mirrored(pair) for radius, pair in right.items()})


def echoes(at: Waves, response: CavityResponse) -> tuple[Echoes, Echoes]:
    """Return the echoes to the right and to the left."""
    return _echoes(at.x, at.right, response), _echoes(np.conj(at.x), at.left, response)


def _echoes(x: ComplexArray, at: dict[float, _Pair], response: CavityResponse) -> Echoes:
    outer = at[response.outer]
    if response.at == 0.0:
        return Echoes(2.0 / (x * outer.inward.slope), np.zeros_like(x), -outer.outward.slope / outer.inward.slope)
    here = at[response.at]
    if response.inner == 0.0:
        to_unit = 1.0 / (x * outer.inward.slope)
        return Echoes(here.inward.value * to_unit, here.outward.value * to_unit, -outer.outward.slope / outer.inward.slope)
    inner = at[response.inner]
    inward_gain = inner.inward.slope / outer.inward.slope
    outward_gain = outer.outward.slope / inner.outward.slope
    inward = here.inward.value / (x * outer.inward.slope)
    outward = here.outward.value / (x * inner.outward.slope)
    trip = inward_gain * outward_gain
    if response.driven_inside:
        return Echoes(outward, -outward_gain * inward, trip)
    return Echoes(inward, -inward_gain * outward, trip)


def _mirrored(pair: _Pair) -> _Pair:
    """Return the waves at the conjugate argument: H1(conj z) = conj H2(z)."""
    return _Pair(Expansion(*map(np.conj, pair.outward)), Expansion(*map(np.conj, pair.inward)))


def arrivals(inner: float, outer: float, radius: float, driven: str, slowness: float, duration: float) -> list[tuple[float, bool]]:
    """Return (time, whether a logarithm) of all fronts at a radius of an annulus, or of a disc (inner = 0), up to *duration*."""
    response = CavityResponse(inner, outer, radius, driven == "inner")
    return [(time * slowness, inner == 0.0 and passages % 2 == 1) for time, passages in front_times(response, duration / slowness)]


def front_times(response: CavityResponse, duration: float) -> list[tuple[float, int]]:
    """Return (time, passages through the centre, or reflections) of all fronts up to *duration*, in the fluid's own time."""
    found: dict[float, int] = {}
    trips = int(duration / response.period) + 1
    for n in range(trips + 1):
        for passages, offset in zip((n, n + 1), response.offsets, strict=True):
            arrival = offset + n * response.period
            if arrival <= duration:
                found.setdefault(round(arrival, 12), passages)
    return sorted(found.items())


def logarithms(values: FloatArray, orders: npt.NDArray[np.int64], times: FloatArray, response: CavityResponse) -> FloatArray:
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
