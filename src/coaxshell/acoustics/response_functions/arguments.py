"""Checks of the arguments of the public functions."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

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
