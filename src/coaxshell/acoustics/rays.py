"""Paths from a distant source to points near the axis, without the cancellation of R - S: smooth up to a plane wave's infinite distance.

With e = 1/R0 for the source at R0 (0 for a plane wave), b the distance of the head point from the axis, S = R0 - b, h = sin^2(theta/2) and
rho = R/R0 = sqrt((1 - e b)^2 + 4 e b h), at r = b

    R - S = 4 b h/(rho + 1 - e b),    S/R = (1 - e b)/rho,    dR/dr = (e b - cos theta)/rho,    1/R = e/rho.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import FloatArray


class SurfaceRays(NamedTuple):
    """What a front from the source does at points of the surface on which the head point lies.

    Attributes
    ----------
    path : ndarray
        R - S, its arrival.
    spread : ndarray
        S/R, its pressure.
    slope : ndarray
        dR/dr.
    curvature : ndarray
        1/R.
    """

    path: FloatArray
    spread: FloatArray
    slope: FloatArray
    curvature: FloatArray


def surface_rays(theta: FloatArray, distance: float | None, head: float = 1.0) -> SurfaceRays:
    """Return the rays from a source at a distance from the axis (None: a plane wave) to angles (radians) of the surface r = head."""
    near = 0.0 if distance is None else 1.0 / distance
    lateral, half = near * head, np.sin(0.5 * theta) ** 2
    relative = np.sqrt((1.0 - lateral) ** 2 + 4.0 * lateral * half)
    path = 4.0 * head * half / (relative + (1.0 - lateral))
    return SurfaceRays(path, (1.0 - lateral) / relative, (lateral - np.cos(theta)) / relative, near / relative)


def front_angle(since: FloatArray, distance: float | None) -> FloatArray:
    """Return the angle up to which a front has passed the surface r = 1, some time after it reached the head."""
    near, since = 0.0 if distance is None else 1.0 / distance, np.maximum(since, 0.0)
    half = 0.25 * since * (2.0 * (1.0 - near) + near * since)
    return np.asarray(2.0 * np.arcsin(np.sqrt(np.clip(half, 0.0, 1.0))), dtype=np.float64)


def path_to(distance: float, x: FloatArray, y: FloatArray, nearest: float, head: float = 1.0) -> FloatArray:
    """Return R - S from a source at (distance, 0), S = distance - head, to points; no nearer to it than ``nearest``."""
    near = 1.0 / distance
    range_ = np.hypot(near * x - 1.0, near * y)
    path = (near * (x * x + y * y - head * head) + 2.0 * (head - x)) / (range_ + (1.0 - near * head))
    return np.asarray(np.where(distance * range_ < nearest, nearest - (distance - head), path), dtype=np.float64)
