"""The response functions at the walls, as the direct engine convolves them with the walls' accelerations.

Each is the inverse Laplace transform of the entry of :mod:`coaxshell.acoustics.operators` of the same name, signs included:
its convolution with the inward acceleration w'' of the wall, times rho/rho_e, is the dimensionless pressure at the wall.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from coaxshell.acoustics.response_functions.cavity import cavity
from coaxshell.acoustics.response_functions.echoes import Response
from coaxshell.acoustics.response_functions.exterior_wall import exterior_at_wall
from coaxshell.numerics.arrays import FloatArray


class AnnulusWalls(NamedTuple):
    """p_a = aa * w_a'' + ab * w_b'', p_b = ba * w_a'' + bb * w_b'' (convolutions), each of shape (M + 1, times)."""

    aa: FloatArray
    ab: FloatArray
    ba: FloatArray
    bb: FloatArray


def exterior_wall(max_order: int, times: FloatArray) -> FloatArray:
    """Return K_m/(s K_m') at r = 1 in time, -1 at t = 0, for m = 0..max_order; accurate to 1e-11."""
    return exterior_at_wall(np.arange(max_order + 1), np.asarray(times, dtype=np.float64))


def disc_wall(max_order: int, times: FloatArray, radius: float, slowness: float) -> FloatArray:
    """Return I_m(k r1)/(k I_m'(k r1)), k = slowness s, in time, 1/slowness at t = 0, for m = 0..max_order.

    At t = 2 r1 slowness (2 n + 1) it is logarithmically infinite. There, on equally spaced times dt apart, this is the value that
    makes the trapezoidal rule of second order: c ln|t - t_0| is sampled as c ln(dt/2 pi).
    """
    response = Response(0.0, radius, radius, False)
    orders = np.arange(max_order + 1)
    scaled = np.asarray(times, dtype=np.float64) / slowness
    values: FloatArray = cavity(orders, scaled, [response])[0]
    turns = scaled / response.period
    nearest = np.round(turns)
    singular = np.flatnonzero((np.abs(turns - nearest) <= 1e-12 * np.maximum(1.0, nearest)) & (nearest % 2 == 1))
    if singular.size and scaled.size > 1:
        aside = (scaled[1] - scaled[0]) / (2.0 * np.pi)
        both = cavity(orders, np.concatenate([scaled[singular] - aside, scaled[singular] + aside]), [response])[0]
        values[:, singular] = 0.5 * (both[:, : singular.size] + both[:, singular.size :])
    values /= slowness
    return values


def annulus_wall(max_order: int, times: FloatArray, inner: float, outer: float, slowness: float) -> AnnulusWalls:
    """Return the four wall functions of an annulus in time, right-hand limits at their jumps, for m = 0..max_order."""
    orders, scaled = np.arange(max_order + 1), np.asarray(times, dtype=np.float64) / slowness
    walls = [Response(inner, outer, at, inside) for at, inside in ((inner, True), (inner, False), (outer, False))]
    aa, ab, bb = cavity(orders, scaled, walls) / slowness
    return AnnulusWalls(aa, ab, -ab * (inner / outer), bb)


class WallFunctions(NamedTuple):
    """Those of two shells: the fluid outside, in the gap and inside; None for a vacuum."""

    exterior: FloatArray
    gap: AnnulusWalls | None
    interior: FloatArray | None


def wall_functions(
    max_order: int, times: FloatArray, *, inner_radius: float, gap_slowness: float | None, interior_slowness: float | None
) -> WallFunctions:
    """Return all wall functions of two shells, the outer one of radius 1, on equally spaced times; a slowness of None is a vacuum."""
    return WallFunctions(
        exterior_wall(max_order, times),
        None if gap_slowness is None else annulus_wall(max_order, times, inner_radius, 1.0, gap_slowness),
        None if interior_slowness is None else disc_wall(max_order, times, inner_radius, interior_slowness),
    )
