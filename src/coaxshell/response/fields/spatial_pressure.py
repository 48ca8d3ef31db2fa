"""The pressure of a three-dimensional run on cuts across the axis and along it."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from typing import TypedDict

import numpy as np
import numpy.typing as npt

from coaxshell.errors import InputError
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.cost import Cost
from coaxshell.numerics.laplace_grid import WORKERS, LaplaceGrid
from coaxshell.numerics.late import xarray as xr
from coaxshell.numerics.progress import Progress
from coaxshell.response.fields.axial_cut import along_axis, lines_of
from coaxshell.response.fields.cross_cut import add_on_circles, add_on_raster, is_exact
from coaxshell.response.fields.evaluate import LONG_NAMES, points_of
from coaxshell.response.fields.grids import MEANINGS, Grid, grid_of, labelled
from coaxshell.response.fields.inversion import band
from coaxshell.response.fields.request import FieldRequest, Tell, axis, request, require_room, when_of
from coaxshell.response.fields.scattered import raster_radii
from coaxshell.response.fields.spatial_incident import SpatialIncident
from coaxshell.response.fields.spatial_waves import SpatialWaves, cut_waves
from coaxshell.solver.axial.solution import SpatialSolution
from coaxshell.solver.axial.solve import laplace_grid, require_known
from coaxshell.solver.scaling import Problem

_FINEST = 1.0
"""Default time resolution times the highest order: the band's window halves frequencies 1.35 times those of waves of that order."""
_SECONDS = 90e-9
"""Of a processor's core, for an order at a wave, a node and a radius."""


class SpatialPressureOptions(TypedDict, total=False):
    """Keyword arguments of a cut beside its axes; see :func:`coaxshell.response.fields.spatial_pressure.spatial_pressure`."""

    radius: npt.ArrayLike | None
    angle: npt.ArrayLike | None
    time: npt.ArrayLike | None
    part: str
    front: str
    filter: str | None
    time_resolution: float | None
    memory: float
    progress: Progress | None


@dataclass(frozen=True)
class Cut:
    """Points of a plane across the axis or along it.

    Attributes
    ----------
    grid : Grid
        Of a plane along the axis the points at all x of its first z alone.
    z : ndarray
        Axial positions, in a; one across the axis.
    along : bool
    fixed : tuple of str and float
        The coordinate that is the same everywhere.
    """

    grid: Grid
    z: FloatArray
    along: bool
    fixed: tuple[str, float]


def cut_of(x: object, y: object, z: object, radius: object, angle: object) -> Cut:
    """Return the cut that a user asks for; InputError if it is neither across the axis nor along it."""
    if np.ndim(z) == 0 and not (z is not None and y is None and radius is None and angle is None):  # type: ignore[arg-type]
        position = _number("z", z)
        return Cut(grid_of(x, y, radius, angle), np.array([position]), False, ("z", position))
    if radius is not None or angle is not None:
        raise InputError("z", "several positions go with x alone", "give radius and angle at one z, or x and z at one y")
    if np.ndim(y) > 0:  # type: ignore[arg-type]
        raise InputError("y", "is a list, and so is z", "give one number for y (a cut along the axis) or for z (a cut across it)")
    if x is None:
        raise InputError("x", "is missing", "give x and z")
    height, positions, across = _number("y", y), axis("z", z), axis("x", x)
    grid = Grid(False, (positions, across), np.hypot(across, height), np.degrees(np.arctan2(height, across)), "z")
    return Cut(grid, positions, True, ("y", height))


def _number(name: str, value: object) -> float:
    return 0.0 if value is None else float(axis(name, value)[0])


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
    """Return the pressure of a three-dimensional run, Pa, on a cut across the axis or along it.

    dims (time, y, x) or (time, radius, angle) at one z; (time, z, x) at one y; no time dimension for a single instant. All wavenumbers of
    the run are solved once more (theory manual, section "Axial wavenumber"): one pass, whatever the number of points and instants.

    Parameters
    ----------
    spatial : SpatialSolution
    x, y, z : array_like, optional
        In units of a, z too (not in m as stations are): x and y of a plane across the axis at one z, 0 unless given; or x and z of a plane
        along it at one y, 0 unless given. The source lies towards x; z of the run's stations need not be among them.
    radius, angle : array_like, optional
        Instead of x and y, in units of a and degrees.
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
    problem, settings = spatial.problem, spatial.settings
    spatial.at(0).need_every_instant("the pressure in the fluids")
    run, step = laplace_grid(settings), settings.time_step / settings.refinement
    resolution = _FINEST / spatial.sampling.max_order if time_resolution is None else time_resolution
    asked = request(part=part, filter=filter, time_resolution=resolution, memory=memory, progress=progress, step=step, front=front)
    when = when_of(time, float(run.time[-1]), problem.scales)
    require_room("pressure", (x, y, z, radius, angle), when)
    cut = cut_of(x, y, z, radius, angle)
    _require_started(problem, spatial, cut)
    times, grid = np.atleast_1d(when), band(run, asked.resolution)
    values = np.zeros((times.size, cut.z.size, cut.grid.radius.size))
    if part != "incident":
        _add_scattered(values, spatial, grid, cut, asked, times)
    if part in ("total", "incident"):
        _add_incident(values, problem, grid, cut, asked, times)
    if progress is not None:
        progress(1.0, "field")
    values *= problem.scales.pressure
    flat, sign = values.reshape(times.size, -1), "positive in compression"
    found = labelled(problem.scales, cut.grid, when, flat, asked, name="pressure", long_name=LONG_NAMES[part], units="Pa", sign=sign)
    name, position = cut.fixed
    told = {"units": "a", "long_name": MEANINGS[name]}
    return found.assign_coords(
        {name: xr.Variable((), position, told), f"{name}_metres": xr.Variable((), position * problem.scales.length, told | {"units": "m"})}
    )


def cut_cost(waves: SpatialWaves, cut: Cut, radii: int, instants: int) -> Cost:
    """Return what the scattered field at so many radii costs."""
    orders, kept = waves.parities * (waves.sampling.max_order + 1.0), 8.0 * instants * waves.parities
    blocks = 16.0 * WORKERS * waves.block_size(radii) * radii * (orders + 12.0)
    held = len(waves.sampling.modes) * cut.grid.radius.size if cut.along else (1.0 + WORKERS) * radii * orders
    return Cost(blocks + 2.0 * kept * held, 0.1 + _SECONDS / WORKERS * waves.pairs(radii) * waves.parities)


def _add_scattered(
    values: FloatArray, spatial: SpatialSolution, grid: LaplaceGrid, cut: Cut, asked: FieldRequest, times: FloatArray
) -> None:
    """Add the scattered field, shape (times, z, points)."""
    waves, felt = cut_waves(spatial, grid, cut.z, float(times.max()), asked)
    if waves is None:
        return
    points = points_of(cut.grid)
    exact = cut.along or is_exact(spatial.problem, asked, cut.grid, points)
    radii = points.radius.size if exact else raster_radii(spatial.problem, asked, points.radius)
    what = f"the pressure at {radii:,} radii of {len(waves.sampling.modes):,} axial wavenumbers and {times.size:,} instants"
    cut_cost(waves, cut, radii, times.size).require(what, "ask for some instants at a time, or for a coarser time_resolution")
    tell: Tell = (lambda share: None) if asked.progress is None else (lambda share: asked.progress(share, "field"))  # type: ignore[misc]
    if cut.along:
        lines = lines_of(waves, asked, cut.grid.radius, cut.grid.angle, times)
        values[:, felt] += along_axis(waves, lines, cut.grid.radius.size, times, tell)
    elif exact:
        add_on_circles(values[:, 0], waves, asked, points, times, tell)
    else:
        add_on_raster(values[:, 0], waves, asked, cut.grid, times, tell)


def _add_incident(values: FloatArray, problem: Problem, grid: LaplaceGrid, cut: Cut, asked: FieldRequest, times: FloatArray) -> None:
    """Add the incident waves, exact, outside the outermost shell: shape (times, z, points)."""
    at = np.flatnonzero(cut.grid.radius >= 1.0)
    radius, angle = cut.grid.radius[at], np.radians(cut.grid.angle[at])
    z, x = (each.ravel() for each in np.meshgrid(cut.z, radius * np.cos(angle), indexing="ij"))
    y = np.tile(radius * np.sin(angle), cut.z.size)
    incident = SpatialIncident(problem, x, y, z, float(times.max()), grid if asked.front == "matched" else None)

    def add(row: int) -> None:
        values[row][:, at] += incident.pressure(float(times[row])).reshape(cut.z.size, at.size)

    add(0)  # what a wave tabulates at first use is there before the threads start
    with ThreadPoolExecutor(WORKERS) as pool:
        list(pool.map(add, range(1, times.size)))


def _require_started(problem: Problem, spatial: SpatialSolution, cut: Cut) -> None:
    """Refuse positions that an inclined plane wave has passed before t = 0."""
    ends = tuple(sorted({float(cut.z.min()) * problem.scales.length, float(cut.z.max()) * problem.scales.length}))
    try:
        require_known(problem, replace(spatial.settings, stations=ends))
    except InputError as error:
        raise InputError("z", error.problem, error.remedy.replace("stations", "positions")) from None
