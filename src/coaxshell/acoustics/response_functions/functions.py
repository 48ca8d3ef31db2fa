"""The public response functions xi of the three kinds of fluid region, in dimensionless time t = c_e tau/a, and those at the walls.

All are the pressure at a radius after a unit impulse of a wall's acceleration: with w positive inward, the pressure over
rho_e c_e^2 is (rho/rho_e) times the convolution of w'' with the function (with its negative for the exterior one, as the paper defines it).

Those at the walls are what the direct engine convolves with the walls' accelerations. Each is the inverse Laplace transform of the entry
of :mod:`coaxshell.acoustics.operators` of the same name, signs included: its convolution with the inward acceleration w'' of the wall,
times rho/rho_e, is the dimensionless pressure at the wall.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, NamedTuple

import numpy as np
import numpy.typing as npt

from coaxshell.acoustics.response_functions.cavity import cavity
from coaxshell.acoustics.response_functions.echoes import CavityResponse, logarithms
from coaxshell.acoustics.response_functions.exterior_response import exterior_at_wall, exterior_field
from coaxshell.errors import InputError
from coaxshell.numerics.arrays import FloatArray

HIGHEST_ORDER = 2000


def checked_orders(orders: int | Sequence[int] | npt.NDArray[np.int64]) -> npt.NDArray[np.int64]:
    """Return the orders as an array; an integer M stands for 0..M."""
    given = np.arange(orders + 1) if isinstance(orders, int | np.integer) else np.atleast_1d(np.asarray(orders))
    wrong = given.ndim != 1 or given.size == 0 or not np.issubdtype(given.dtype, np.integer)
    if wrong or given.min() < 0 or given.max() > HIGHEST_ORDER:
        raise InputError("orders", f"{orders!r} is not allowed", f"give whole numbers from 0 to {HIGHEST_ORDER}, each once or in a list")
    return np.asarray(given, dtype=np.int64)


def checked_times(times: npt.ArrayLike) -> FloatArray:
    """Return the times as a new one-dimensional array of finite numbers."""
    try:
        given = np.array(times, dtype=np.float64, ndmin=1)
    except (TypeError, ValueError):
        raise InputError("times", f"{times!r} is not a list of numbers", "give finite numbers") from None
    if given.ndim != 1:
        raise InputError("times", f"an array of shape {given.shape} is not allowed", "give one number or a list of them")
    if not np.all(np.isfinite(given)):
        raise InputError("times", f"{given[~np.isfinite(given)][0]} is not finite", "give finite numbers")
    return given


def checked_positive(name: str, value: float) -> float:
    """Return a finite number above 0."""
    if not (np.isfinite(value) and value > 0):
        raise InputError(name, f"{value!r} is not allowed", "give a number above 0")
    return float(value)


def checked_radius(value: float, low: float, high: float, name: str = "radius", *, open_below: bool = False) -> float:
    """Return a radius in its range."""
    if not np.isfinite(value) or not low <= value <= high or (open_below and value == low):
        least = f"above {low:.6g}" if open_below else f"{low:.6g} or more"
        most = "" if np.isinf(high) else f", at most {high:.6g}"
        raise InputError(name, f"{value!r} is out of range", f"give a radius {least}{most}")
    return float(value)


Orders = int | Sequence[int] | npt.NDArray[np.int64]


def exterior(orders: Orders, times: npt.ArrayLike, *, radius: float = 1.0) -> FloatArray:
    """Return xi_e <-> -K_m(rs)/(s K_m'(s)) of the unbounded fluid outside r = 1.

    It is 1 at r = 1, t = 0; elsewhere it starts with a front of height 1/sqrt(r) at t = r - 1.

    Parameters
    ----------
    orders : int or sequence of int
        Circumferential orders; an integer M stands for 0..M.
    times : array_like, shape (T,)
        Any times; the function is 0 before its front.
    radius : float
        r >= 1.

    Returns
    -------
    ndarray, shape (orders, T)

    Raises
    ------
    InputError
        An argument is out of range.
    """
    m, t = checked_orders(orders), checked_times(times)
    late = t - (checked_radius(radius, 1.0, np.inf) - 1.0)
    late[np.abs(late) < 1e-12 * np.maximum(1.0, t)] = 0.0
    result = np.zeros((m.size, t.size))
    on = np.flatnonzero(late >= 0.0)
    if radius > 1.0 and on.size:
        result[:, on] = -exterior_field(m, late[on], radius)
    elif on.size:
        result[:, on] = -exterior_at_wall(m, late[on])
    return result


def interior(
    orders: Orders, times: npt.ArrayLike, *, radius: float | None = None, disc_radius: float = 1.0, slowness: float = 1.0
) -> FloatArray:
    """Return xi_i <-> I_m(k r)/(k I_m'(k r1)), k = slowness s, of a fluid that fills a circle of radius r1.

    A front leaves the wall at t = 0 with height sqrt(r1/r)/slowness and crosses the centre again and again. Each passage
    turns its phase by a quarter: after two it is a jump again, in between a logarithm, whose instants give inf or -inf.

    Parameters
    ----------
    orders, times
        As for :func:`exterior`.
    radius : float, optional
        r, 0 or from r1/100 to r1; the wall r1 when left out.
    disc_radius : float
        r1.
    slowness : float
        alpha = c_e/c of the fluid.

    Returns
    -------
    ndarray, shape (orders, T)

    Raises
    ------
    InputError
        An argument is out of range.
    """
    m, t = checked_orders(orders), checked_times(times)
    alpha, r1 = checked_positive("slowness", slowness), checked_positive("disc_radius", disc_radius)
    at = r1 if radius is None or radius == r1 else radius
    if at != 0.0:
        checked_radius(at, 0.01 * r1, r1)
    response = CavityResponse(0.0, r1, at, False)
    result = _inside(m, t / alpha, response) / alpha
    return logarithms(result, m, t / alpha, response)


def gap(
    orders: Orders,
    times: npt.ArrayLike,
    *,
    inner: float,
    outer: float,
    radius: float | None = None,
    driven: Literal["inner", "outer"] = "inner",
    slowness: float = 1.0,
) -> FloatArray:
    """Return the pressure at r in the annulus ra <= r <= rb after a unit impulse of one wall's inward acceleration.

    An inner wall that moves inward makes room: its own function is -1/slowness at t = 0; the outer one's is +1/slowness. These are
    ``aa``, ``ba`` (driven inside, r = ra, rb) and ``ab``, ``bb`` (driven outside) of ``operators.annulus``. The jumps
    at the echoes' fronts are given by their right-hand limits.

    Parameters
    ----------
    orders, times
        As for :func:`exterior`.
    inner, outer : float
        ra < rb.
    radius : float, optional
        r; the driven wall when left out.
    driven : "inner" or "outer"
        Which wall moves.
    slowness : float
        alpha = c_e/c of the fluid.

    Returns
    -------
    ndarray, shape (orders, T)

    Raises
    ------
    InputError
        An argument is out of range.
    """
    m, t = checked_orders(orders), checked_times(times)
    alpha, ra = checked_positive("slowness", slowness), checked_positive("inner", inner)
    rb = checked_radius(outer, ra, np.inf, "outer", open_below=True)
    at = (ra if driven == "inner" else rb) if radius is None else checked_radius(radius, ra, rb)
    return _inside(m, t / alpha, CavityResponse(ra, rb, at, driven == "inner")) / alpha


def _inside(orders: npt.NDArray[np.int64], times: FloatArray, response: CavityResponse) -> FloatArray:
    result = np.zeros((orders.size, times.size))
    on = np.flatnonzero(times >= response.offsets[0] - 1e-12 * response.period)
    if on.size:
        (result[:, on],) = cavity(orders, times[on], [response])
    return result


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
    response = CavityResponse(0.0, radius, radius, False)
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
    walls = [CavityResponse(inner, outer, at, inside) for at, inside in ((inner, True), (inner, False), (outer, False))]
    aa, ab, bb = cavity(orders, scaled, walls) / slowness
    return AnnulusWalls(aa, ab, -ab * (inner / outer), bb)


class WallFunctions(NamedTuple):
    """Wall functions of the three fluids of two shells, each of shape (M + 1, times): outside, in the gap, inside; None for a vacuum."""

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
