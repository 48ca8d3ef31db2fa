"""Mirror images in the planes of the sea: a surface that releases the pressure, and a rigid bottom.

With h the height above the axis, the surface at h = d and the bottom at h = -b, what is at h has images at

    2 d - h (sign -1),      -2 b - h (sign +1),

and with both planes the images of those again: h + 2 n (d + b), sign (-1)^n, and 2 d + 2 n (d + b) - h, sign -(-1)^n. All planes are
parallel to the axis; lengths are in a.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import FloatArray


class Image(NamedTuple):
    """One image of everything: where a height h is found, shift - h where mirrored, else shift + h, and the sign of its pressure."""

    shift: float
    mirrored: bool
    sign: float

    def height(self, h: float) -> float:
        """Return the height of the image of a point."""
        return self.shift - h if self.mirrored else self.shift + h


@dataclass(frozen=True)
class Planes:
    """The reflecting planes around the shells.

    Attributes
    ----------
    surface, bottom : float or None
        Distances d and b from the axis, in a; None where nothing reflects.
    up : float
        Direction from the axis to the surface, degrees.
    """

    surface: float | None
    bottom: float | None
    up: float = 90.0

    @property
    def nearest(self) -> float:
        """Distance of the nearer plane from the axis."""
        return min(plane for plane in (self.surface, self.bottom) if plane is not None)

    @property
    def furthest(self) -> float:
        """Distance of the further plane from the axis."""
        return max(plane for plane in (self.surface, self.bottom) if plane is not None)

    @property
    def symmetric(self) -> bool:
        """Whether cosines alone stay so: the planes are at right angles to theta = 0."""
        return self.up % 180.0 == 0.0

    def images(self, reach: float) -> Iterator[Image]:
        """Yield all images whose shift is at most *reach*, and a few beyond, without the thing itself; of a single plane its one image."""
        if self.surface is None or self.bottom is None:
            if self.surface is not None:
                yield Image(2.0 * self.surface, True, -1.0)
            if self.bottom is not None:
                yield Image(-2.0 * self.bottom, True, 1.0)
            return
        period = 2.0 * (self.surface + self.bottom)
        most = int(reach / period) + 1
        for n in range(-most, most + 1):
            sign = -1.0 if n % 2 else 1.0
            if n:
                yield Image(n * period, False, sign)
            yield Image(2.0 * self.surface + n * period, True, -sign)

    def beyond(self, h: float) -> float:
        """Return how far an image at a height lies from the water between the planes."""
        above = h - self.surface if self.surface is not None else -np.inf
        below = -self.bottom - h if self.bottom is not None else -np.inf
        return float(max(above, below, 0.0))

    def heights(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Return the heights of points above the axis."""
        cos, sin = self.direction
        return np.asarray(cos * x + sin * y, dtype=np.float64)

    def in_water(self, x: FloatArray, y: FloatArray) -> np.ndarray:
        """Return whether points are in the water: neither above the surface nor within the bottom."""
        h = self.heights(x, y)
        inside = np.ones(h.shape, dtype=bool)
        if self.surface is not None:
            inside &= h <= self.surface * (1 + 1e-12)
        if self.bottom is not None:
            inside &= h >= -self.bottom * (1 + 1e-12)
        return inside

    @property
    def direction(self) -> tuple[float, float]:
        """The unit vector from the axis to the surface; exact at multiples of 90 degrees."""
        turn = self.up % 360.0
        exact = {0.0: (1.0, 0.0), 90.0: (0.0, 1.0), 180.0: (-1.0, 0.0), 270.0: (0.0, -1.0)}
        return exact.get(turn, (float(np.cos(np.radians(turn))), float(np.sin(np.radians(turn)))))
