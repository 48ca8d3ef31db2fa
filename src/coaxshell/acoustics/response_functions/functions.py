"""The response functions xi of the three kinds of fluid region, in dimensionless time t = c_e tau/a.

All are the pressure at a radius after a unit impulse of a wall's acceleration: with w positive inward, the pressure over
rho_e c_e^2 is (rho/rho_e) times the convolution of w'' with the function (with its negative for the exterior one, as the paper defines it).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np
import numpy.typing as npt

from coaxshell.acoustics.response_functions.arguments import checked_orders, checked_positive, checked_radius, checked_times
from coaxshell.acoustics.response_functions.cavity import cavity
from coaxshell.acoustics.response_functions.echoes import Response
from coaxshell.acoustics.response_functions.exterior_field import exterior_field
from coaxshell.acoustics.response_functions.exterior_wall import exterior_at_wall
from coaxshell.acoustics.response_functions.fronts import logarithms
from coaxshell.numerics.arrays import FloatArray

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
    response = Response(0.0, r1, at, False)
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
    return _inside(m, t / alpha, Response(ra, rb, at, driven == "inner")) / alpha


def _inside(orders: npt.NDArray[np.int64], times: FloatArray, response: Response) -> FloatArray:
    result = np.zeros((orders.size, times.size))
    on = np.flatnonzero(times >= response.offsets[0] - 1e-12 * response.period)
    if on.size:
        (result[:, on],) = cavity(orders, times[on], [response])
    return result
