"""The fields of a three-dimensional run on cuts across the axis and along it, and in volumes: pressure, particle velocity, intensity."""

from __future__ import annotations

from typing import TypedDict

import numpy as np
import numpy.typing as npt

from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.late import xarray as xr
from coaxshell.numerics.progress import Progress
from coaxshell.response.fields.cut_field import CutField
from coaxshell.response.fields.cuts import Cut, cut_of
from coaxshell.response.fields.evaluate import ALONG_AXES, LONG_NAMES, OUTWARD
from coaxshell.response.fields.grids import MEANINGS, labelled
from coaxshell.response.fields.request import FieldRequest, request, require_room, when_of
from coaxshell.response.fields.spatial_waves import SpatialQuantity
from coaxshell.solver.axial.solution import SpatialSolution
from coaxshell.solver.axial.solve import laplace_grid
from coaxshell.solver.scaling import Scales

_FINEST = 1.0
"""Default time resolution times the highest order: the band's window halves frequencies 1.35 times those of waves of that order."""

FLOW: tuple[SpatialQuantity, ...] = ("radial", "angular", "axial")
"""The three components of the particle velocity."""


class SpatialFieldOptions(TypedDict, total=False):
    """Keyword arguments of a field on a cut beside its axes; see :func:`coaxshell.response.fields.spatial_pressure.spatial_pressure`."""

    radius: npt.ArrayLike | None
    angle: npt.ArrayLike | None
    time: npt.ArrayLike | None
    filter: str | None
    time_resolution: float | None
    memory: float
    progress: Progress | None


class SpatialPartOptions(SpatialFieldOptions, total=False):
    """Keyword arguments of a velocity on a cut: those of any field, and which part of it."""

    part: str


class SpatialPressureOptions(SpatialPartOptions, total=False):
    """Keyword arguments of a pressure on a cut: those of a velocity, and how sharp the incident front is."""

    front: str


def spatial_pressure(
    spatial: SpatialSolution,
    x: npt.ArrayLike | None = None,
    y: npt.ArrayLike | None = None,
    z: npt.ArrayLike | None = None,
    *,
    radius: npt.ArrayLike | None = None,
    angle: npt.ArrayLike | None = None,
    time: npt.ArrayLike | None = None,
    part: str = "total",
    front: str = "sharp",
    filter: str | None = None,
    time_resolution: float | None = None,
    memory: float = 1e9,
    progress: Progress | None = None,
) -> xr.DataArray:
    """Return the pressure of a three-dimensional run, Pa, on a cut across the axis or along it, or in a volume.

    dims (time, y, x) or (time, radius, angle) at one z; (time, z, x) at one y; (time, z, radius, angle) of a volume; no time dimension for
    a single instant. All wavenumbers of the run are solved once more (theory manual, section "Axial wavenumber"): one pass, whatever the
    number of points and instants.

    Parameters
    ----------
    spatial : SpatialSolution
    x, y, z : array_like, optional
        In units of a, z too (not in m as stations are): x and y of a plane across the axis at one z, 0 unless given; or x and z of a plane
        along it at one y, 0 unless given. The source lies towards x; z of the run's stations need not be among them.
    radius, angle : array_like, optional
        Instead of x and y, in units of a and degrees; with several z they make a volume.
    time : float or array_like
        Instants in transits within the run, or as durations (timedelta64).
    part, front, filter, memory, progress
        As in two dimensions, see :func:`coaxshell.response.fields.evaluate.pressure`. Filters weigh by sqrt((m/M)^2 + (k/k_max)^2).
    time_resolution : float, optional
        Transits; frequencies up to pi/time_resolution make up the scattered part. By default 1/M, or the run's step if that is coarser:
        finer waves than those of order M are not all there.

    Raises
    ------
    InputError
        If an argument is not allowed; it names the argument.
    """
    asked = spatial_request(spatial, time_resolution, part=part, filter=filter, memory=memory, progress=progress, front=front)
    when = _when(spatial, time)
    require_room("pressure", (x, y, z, radius, angle), when)
    cut = cut_of(x, y, z, radius, angle)
    (values,) = _solved(spatial, cut, asked, when, ("pressure",))
    values *= spatial.problem.scales.pressure
    told = {"name": "pressure", "long_name": LONG_NAMES[part], "units": "Pa", "sign": "positive in compression"}
    return _labelled(spatial.problem.scales, cut, when, values, asked, told)


def spatial_velocity(
    spatial: SpatialSolution,
    x: npt.ArrayLike | None = None,
    y: npt.ArrayLike | None = None,
    z: npt.ArrayLike | None = None,
    *,
    radius: npt.ArrayLike | None = None,
    angle: npt.ArrayLike | None = None,
    time: npt.ArrayLike | None = None,
    part: str = "total",
    filter: str | None = None,
    time_resolution: float | None = None,
    memory: float = 1e9,
    progress: Progress | None = None,
) -> xr.DataArray:
    """Return the particle velocity of a three-dimensional run, m/s, on the same cuts as the pressure, dims (time, component, ...).

    Components are "x", "y", "z" on Cartesian cuts and "radius", "angle", "z" on polar ones and in volumes, positive along the coordinate
    (outward, unlike the displacement of a shell): v = -grad p/(rho s) of every wave. Parameters and errors are those of
    :func:`coaxshell.response.fields.spatial_pressure.spatial_pressure`.
    """
    asked = spatial_request(spatial, time_resolution, part=part, filter=filter, memory=memory, progress=progress)
    when = _when(spatial, time)
    require_room("velocity", (x, y, z, radius, angle), when, 3)
    cut = cut_of(x, y, z, radius, angle)
    values = turned(cut, _solved(spatial, cut, asked, when, FLOW))
    values *= spatial.problem.scales.velocity
    told = {"name": "velocity", "long_name": "particle velocity", "units": "m s-1", "sign": _sign(cut)}
    return _labelled(spatial.problem.scales, cut, when, values, asked, told)


def spatial_intensity(
    spatial: SpatialSolution,
    x: npt.ArrayLike | None = None,
    y: npt.ArrayLike | None = None,
    z: npt.ArrayLike | None = None,
    *,
    radius: npt.ArrayLike | None = None,
    angle: npt.ArrayLike | None = None,
    time: npt.ArrayLike | None = None,
    filter: str | None = None,
    time_resolution: float | None = None,
    memory: float = 1e9,
    progress: Progress | None = None,
) -> xr.DataArray:
    """Return the instantaneous acoustic intensity p v of the total field of a three-dimensional run, W/m^2.

    Dims and components are those of the velocity, parameters and errors those of
    :func:`coaxshell.response.fields.spatial_pressure.spatial_pressure`.
    """
    asked = spatial_request(spatial, time_resolution, filter=filter, memory=memory, progress=progress)
    when = _when(spatial, time)
    require_room("intensity", (x, y, z, radius, angle), when, 4)
    cut = cut_of(x, y, z, radius, angle)
    pressure, *flow = _solved(spatial, cut, asked, when, ("pressure", *FLOW))
    values = turned(cut, flow)
    values *= pressure[:, None] * (spatial.problem.scales.pressure * spatial.problem.scales.velocity)
    told = {"name": "intensity", "long_name": "acoustic intensity", "units": "W m-2", "sign": _sign(cut)}
    return _labelled(spatial.problem.scales, cut, when, values, asked, told)


def spatial_request(
    spatial: SpatialSolution,
    time_resolution: float | None = None,
    *,
    part: str = "total",
    filter: str | None = None,
    memory: float = 1e9,
    progress: Progress | None = None,
    front: str = "sharp",
) -> FieldRequest:
    """Return the options of a field of a run, checked, with the resolution that goes with its orders unless one is given."""
    resolution = _FINEST / spatial.sampling.max_order if time_resolution is None else time_resolution
    step = spatial.settings.time_step / spatial.settings.refinement
    return request(part=part, filter=filter, time_resolution=resolution, memory=memory, progress=progress, step=step, front=front)


def _when(spatial: SpatialSolution, time: npt.ArrayLike | None) -> FloatArray:
    return when_of(time, float(laplace_grid(spatial.settings).time[-1]), spatial.problem.scales)


def _solved(
    spatial: SpatialSolution, cut: Cut, asked: FieldRequest, when: FloatArray, quantities: tuple[SpatialQuantity, ...]
) -> list[FloatArray]:
    """Return quantities on a cut at the instants, each (instants, z and points)."""
    found = CutField(spatial, cut, asked, np.atleast_1d(when), quantities).values()
    if asked.progress is not None:
        asked.progress(1.0, "field")
    return [values.reshape(values.shape[0], -1) for values in found]


def turned(cut: Cut, flow: list[FloatArray], *, cartesian: bool = False) -> FloatArray:
    """Return polar components, or Cartesian ones if asked for or on a Cartesian grid, and that along z, stacked after the time."""
    radial, angular, axial = flow
    if cartesian or not cut.grid.polar:
        angle = np.radians(np.tile(cut.grid.angle, cut.z.size))
        cos, sin = np.cos(angle), np.sin(angle)
        radial, angular = cos * radial - sin * angular, sin * radial + cos * angular
    return np.stack([radial, angular, axial], axis=1)


def _sign(cut: Cut) -> str:
    return f"{OUTWARD}, and z" if cut.grid.polar else f"{ALONG_AXES.replace(' and', ',')} and z"


def _labelled(scales: Scales, cut: Cut, when: FloatArray, values: FloatArray, asked: FieldRequest, told: dict[str, str]) -> xr.DataArray:
    """Return values with their coordinates, the one that is the same everywhere too."""
    found = labelled(scales, cut.grid, when, values, asked, **told)
    if cut.fixed is None:
        return found
    name, position = cut.fixed
    meaning = {"units": "a", "long_name": MEANINGS[name]}
    return found.assign_coords(
        {name: xr.Variable((), position, meaning), f"{name}_metres": xr.Variable((), position * scales.length, meaning | {"units": "m"})}
    )
