"""Travelling waves in a cavity: every echo of a front as one term of a geometric series (the Debye series).

With s = ix on the right of the imaginary axis, H1_m(xr) is a wave that runs inward and H2_m(xr) one that runs outward. A
response is (P_1 + P_2)/(1 - Q) = sum_n (P_1 + P_2) Q^n: P_1 the direct wave, P_2 the one after its first reflection, Q one
round trip. Each is kept without its delay: P_j = p_j e^{-s offset_j}, Q = q e^{-s period}.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from coaxshell.acoustics.response_functions.debye import Expansion, expand
from coaxshell.numerics.arrays import ComplexArray


class Response(NamedTuple):
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
    """p_1, p_2 and q at complex wavenumbers."""

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


def echoes(at: Waves, response: Response) -> tuple[Echoes, Echoes]:
    """Return the echoes to the right and to the left."""
    return _echoes(at.x, at.right, response), _echoes(np.conj(at.x), at.left, response)


def _echoes(x: ComplexArray, at: dict[float, _Pair], response: Response) -> Echoes:
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
