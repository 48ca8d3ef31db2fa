"""Where a field of three dimensions is read: on planes across the axis or along it, and in volumes around it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from coaxshell.errors import InputError
from coaxshell.numerics.arrays import FloatArray
from coaxshell.response.fields.grids import Grid, grid_of
from coaxshell.response.fields.request import axis

Kind = Literal["across", "along", "volume"]


@dataclass(frozen=True)
class Cut:
    """Points of a plane across the axis or along it, or of a volume.

    Attributes
    ----------
    kind : "across", "along" or "volume"
    grid : Grid
        Of a plane along the axis, and of a volume, the points across it at its first z alone, in axes of all.
    z : ndarray
        Axial positions, in a; one across the axis.
    fixed : tuple of str and float, or None
        The coordinate that is the same everywhere.
    """

    kind: Kind
    grid: Grid
    z: FloatArray
    fixed: tuple[str, float] | None

    @property
    def points(self) -> int:
        """How many points there are at one z."""
        return int(self.grid.radius.size)


def cut_of(x: object, y: object, z: object, radius: object, angle: object) -> Cut:
    """Return the cut or the volume that a user asks for; InputError if it is none."""
    if np.ndim(z) == 0 and not (z is not None and y is None and radius is None and angle is None):  # type: ignore[arg-type]
        position = _number("z", z)
        return Cut("across", grid_of(x, y, radius, angle), np.array([position]), ("z", position))
    if radius is not None or angle is not None:
        positions = axis("z", z)
        return Cut("volume", replace(grid_of(x, y, radius, angle), levels=positions), positions, None)
    if np.ndim(y) > 0:  # type: ignore[arg-type]
        remedy = "give one number for y (a cut along the axis) or for z (a cut across it), or a volume by radius, angle and z"
        raise InputError("y", "is a list, and so is z", remedy)
    if x is None:
        raise InputError("x", "is missing", "give x and z")
    height, positions, across = _number("y", y), axis("z", z), axis("x", x)
    grid = Grid(False, (positions, across), np.hypot(across, height), np.degrees(np.arctan2(height, across)), "z")
    return Cut("along", grid, positions, ("y", height))


def _number(name: str, value: object) -> float:
    return 0.0 if value is None else float(axis(name, value)[0])
