"""Checks of what a user passes to a response: angles, time windows, depths, names of components."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import numpy as np
import numpy.typing as npt

from coaxshell.errors import InputError
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.scalars import plain


def angles(angle: npt.ArrayLike) -> FloatArray:
    """Return the angles in degrees, shape () or (A,); InputError if they are not finite numbers in at most one dimension."""
    try:
        values = np.asarray(angle, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError("angle", f"{angle!r} is not a number or a list of numbers", "give degrees from the source direction") from None
    if values.ndim > 1 or values.size == 0:
        raise InputError("angle", f"an array of shape {values.shape} is not allowed", "give one number or a list of them, in degrees")
    if not np.all(np.isfinite(values)):
        raise InputError("angle", f"{values[~np.isfinite(values)].flat[0]} is not finite", "give degrees from the source direction")
    return values


def one_of(name: str, value: object, allowed: Iterable[str]) -> str:
    """Return the value if it is one of the allowed names; InputError naming them otherwise."""
    options = tuple(allowed)
    if not isinstance(value, str) or value not in options:
        raise InputError(name, f"{value!r} is unknown", f"allowed: {', '.join(options)}")
    return value


def depth_of(faces: tuple[float, float], depth: object) -> float:
    """Return z in metres from a number, or from "inner" or "outer" for the faces of the wall, whose z are given.

    Raises
    ------
    InputError
        If it is neither, or lies outside the wall; the message names the range.
    """
    inner, outer = faces
    if isinstance(depth, str):
        return inner if one_of("depth", depth, ("inner", "outer")) == "inner" else outer
    depth = plain(depth)
    if isinstance(depth, bool) or not isinstance(depth, (int, float, np.floating, np.integer)) or not math.isfinite(depth):
        raise InputError("depth", f"{depth!r} is not allowed", 'give z in metres (positive outward), "inner" or "outer"')
    slack = 1e-9 * (outer - inner)  # forgives the rounding of sums of thicknesses
    if not inner - slack <= depth <= outer + slack:
        raise InputError(
            "depth", f"{depth:g} m is outside the wall", f'give z from {inner:g} to {outer:g} m (positive outward), "inner" or "outer"'
        )
    return min(max(float(depth), inner), outer)


def time_window(time: FloatArray, window: Sequence[float] | None) -> slice:
    """Return the time indices of a window (start, end) in transits, both ends included; all of them for None.

    Raises
    ------
    InputError
        If the window is not a pair of increasing finite numbers or holds no instant of the run.
    """
    if window is None:
        return slice(0, len(time))
    try:
        start, end = (float(value) for value in window)
    except (TypeError, ValueError):
        raise InputError("window", f"{window!r} is not a pair (start, end)", "give two times in transits") from None
    slack = 1e-9 * float(time[-1])  # so that a window given as 1.2 keeps the instant 1200 * 1e-3
    first, last = np.searchsorted(time, [start - slack, end + slack])
    if not start <= end or last <= first:  # also refuses NaN
        raise InputError("window", f"({start:g}, {end:g}) holds no instant of the run", f"give times from 0 to {time[-1]:g} transits")
    return slice(int(first), int(last))
