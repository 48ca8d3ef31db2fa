"""Cartesian and polar grids of points, and the labels of what is computed on them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coaxshell.errors import InputError
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.finite import first_bad, require_finite
from coaxshell.numerics.late import xarray as xr
from coaxshell.response.fields.request import FieldRequest, axis
from coaxshell.response.labels import TRANSIT
from coaxshell.solver.scaling import Scales

MEANINGS = {"x": "towards theta = 0", "y": "towards theta = 90 degrees", "z": "along the axis", "radius": "distance from the axis"}


@dataclass(frozen=True)
class Grid:
    """Points as a flat list: radius in a, angle in degrees.

    Attributes
    ----------
    polar : bool
    axes : tuple of ndarray
        (radius, angle), (y, x) or (z, x), the slow one first.
    across : str
        Name of the slow axis of a Cartesian grid.
    levels : ndarray, optional
        Axial positions, in a, of a volume, which has these points at each of them.
    """

    polar: bool
    axes: tuple[FloatArray, FloatArray]
    radius: FloatArray
    angle: FloatArray
    across: str = "y"
    levels: FloatArray | None = None

    @property
    def radii(self) -> FloatArray:
        """The radii of a polar grid."""
        return self.axes[0]

    @property
    def members(self) -> list[np.ndarray]:
        """Positions of the points at every radius of a polar grid."""
        return list(np.arange(self.radius.size).reshape(self.axes[0].size, self.axes[1].size))

    @property
    def dims(self) -> tuple[str, ...]:
        """Names of the dimensions."""
        across = ("radius", "angle") if self.polar else (self.across, "x")
        return across if self.levels is None else ("z", *across)

    @property
    def along(self) -> tuple[FloatArray, ...]:
        """Coordinates along the dimensions."""
        return self.axes if self.levels is None else (self.levels, *self.axes)


def grid_of(x: object, y: object, radius: object, angle: object) -> Grid:
    """Return the grid that a user asks for; InputError if it is neither Cartesian nor polar."""
    cartesian, polar = (x is not None, y is not None), (radius is not None, angle is not None)
    if any(cartesian) and any(polar):
        raise InputError("x" if cartesian[0] else "y", "is given together with radius or angle", "give x and y, or radius and angle")
    if any(cartesian) or not any(polar):
        if not all(cartesian):
            missing = "y" if cartesian[0] else "x"
            raise InputError(missing, "is missing", "give x and y, or radius and angle")
        across, along = axis("y", y), axis("x", x)
        ys, xs = (array.ravel() for array in np.meshgrid(across, along, indexing="ij"))
        return Grid(False, (across, along), np.hypot(xs, ys), np.degrees(np.arctan2(ys, xs)))
    if not all(polar):
        raise InputError("angle" if polar[0] else "radius", "is missing", "give radius and angle, or x and y")
    radii, angles = axis("radius", radius, least=0.0), axis("angle", angle, unit="degrees")
    rs, thetas = (array.ravel() for array in np.meshgrid(radii, angles, indexing="ij"))
    return Grid(True, (radii, angles), rs, thetas)


def labelled(
    scales: Scales,
    grid: Grid,
    when: FloatArray,
    values: FloatArray,
    asked: FieldRequest,
    *,
    name: str,
    long_name: str,
    units: str,
    sign: str,
) -> xr.DataArray:
    """Return values (times, points) or (times, components, points) as a labelled array, dims (time, component, y, x) or (..., angle)."""
    shape = tuple(array.size for array in grid.along)
    components = values.shape[1:-1]
    values = values.reshape(when.shape + components + shape)
    dims = (("time",) if when.ndim else ()) + (("component",) if components else ()) + grid.dims
    attributes = {
        "units": units,
        "long_name": long_name,
        "part": asked.part,
        "filter": asked.filter or "none",
        "sign": sign,
        "time_resolution": asked.resolution,
    }
    if first_bad(values) is not None:
        along = [
            ("time", np.atleast_1d(when)),
            *(("component", np.arange(count)) for count in components),
            *zip(grid.dims, grid.along, strict=True),
        ]
        require_finite(
            values.reshape(np.atleast_1d(when).shape + components + shape), name, along, "look for extreme layers, fluids or sources"
        )
    found = coordinates(scales, grid, when)
    if components:
        names = ["radius", "angle", "z"] if grid.polar else ["x", "y", "z"]
        found["component"] = xr.Variable("component", names[: components[0]])
    return xr.DataArray(values, dims=dims, coords=found, name=name, attrs=attributes)


def coordinates(scales: Scales, grid: Grid, when: FloatArray) -> dict[str, xr.Variable]:
    """Return the coordinates of a field: times in transits and seconds, places in a and metres."""
    found = instants_of(scales, when)
    length = scales.length
    for name, values in zip(grid.dims, grid.along, strict=True):
        if name == "angle":
            found[name] = xr.Variable(name, values, {"units": "degree", "long_name": "angle from the source direction"})
            continue
        meaning = MEANINGS[name]
        found[name] = xr.Variable(name, values, {"units": "a", "long_name": meaning})
        found[f"{name}_metres"] = xr.Variable(name, values * length, {"units": "m", "long_name": meaning})
    return found


def instants_of(scales: Scales, when: FloatArray) -> dict[str, xr.Variable]:
    """Return the coordinates of instants in transits and in seconds, scalar ones for a single instant."""
    along = ("time",) if when.ndim else ()
    return {
        "time": xr.Variable(along, when, {"units": TRANSIT, "long_name": "time in acoustic transits of the outer radius"}),
        "time_seconds": xr.Variable(along, when * scales.time, {"units": "s", "long_name": "time"}),
    }
