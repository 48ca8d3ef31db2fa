"""Pressure, particle velocity and intensity on Cartesian and polar grids.

The scattered part is found by the cheaper of two ways, the incident one as it is.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.late import xarray as xr
from coaxshell.numerics.progress import Progress
from coaxshell.numerics.threads import map_on_threads
from coaxshell.response.fields.grids import Grid, grid_of, labelled
from coaxshell.response.fields.incident import Incident
from coaxshell.response.fields.inversion import band
from coaxshell.response.fields.mirrored import flow_back, in_water, mirrored
from coaxshell.response.fields.modal_field import Quantity
from coaxshell.response.fields.request import FieldRequest, request, require_room, when_of
from coaxshell.response.fields.scattered import Points, add_exact, add_gridded, grouped, raster_radii
from coaxshell.solver.solved_spectra import SolvedSpectra


def settled(spectra: SolvedSpectra, asked: FieldRequest, grid: Grid) -> FieldRequest:
    """Return the request with its time resolution decided: unless given, the run's step where that costs no more than a raster."""
    if asked.resolution_given:
        return asked
    fine = replace(asked, resolution=spectra.grid.time_step, resolution_given=True)
    if grid.polar:
        return fine
    radii = points_of(grid).radius
    cost = radii.size * asked.resolution / fine.resolution
    return fine if cost <= raster_radii(spectra.problem, asked, radii) else replace(asked, resolution_given=True)


def points_of(grid: Grid) -> Points:
    """Return the points of a grid by radius."""
    return Points(grid.radii, grid.angle, grid.members) if grid.polar else grouped(grid.radius, grid.angle)


def _exact(spectra: SolvedSpectra, asked: FieldRequest, grid: Grid, points: Points) -> bool:
    """Return whether to evaluate radius by radius: always in polar coordinates, otherwise if there are fewer radii than on a raster."""
    return grid.polar or points.radius.size <= raster_radii(spectra.problem, asked, points.radius)


def evaluate(
    spectra: SolvedSpectra, asked: FieldRequest, grid: Grid, times: FloatArray, quantities: tuple[Quantity, ...]
) -> list[FloatArray]:
    """Return dimensionless quantities at all points and times, each of shape (times, points); 0 above the surface of the sea."""
    points = points_of(grid)
    exact = _exact(spectra, asked, grid, points)
    results = []
    for number, quantity in enumerate(quantities):
        out = np.zeros((times.size, grid.radius.size))
        if asked.part != "incident":

            def tell(fraction: float, number: int = number) -> None:
                if asked.progress is not None:
                    asked.progress((number + fraction) / len(quantities), "field")

            if exact:
                add_exact(out, spectra, asked, points, times, quantity, tell)
            else:
                add_gridded(out, spectra, asked, (grid.radius, grid.angle), times, quantity, tell)
        results.append(out)
    if asked.part != "incident":
        _add_mirrored(results, spectra, asked, grid, times, quantities)
    if asked.part in ("total", "incident"):
        add_incident(results, spectra, asked, grid, times, quantities)
    if spectra.problem.planes is not None:
        dry = ~in_water(spectra.problem, grid.radius, grid.angle)
        for out in results:
            out[:, dry] = 0.0
    if asked.progress is not None:
        asked.progress(1.0, "field")
    return results


def _add_mirrored(
    results: list[FloatArray], spectra: SolvedSpectra, asked: FieldRequest, grid: Grid, times: FloatArray, quantities: tuple[Quantity, ...]
) -> None:
    """Add what the planes of the sea send back of the scattered wave, read where each image shows it."""
    planes = spectra.problem.planes
    for place in mirrored(spectra.problem, grid.radius, grid.angle, times, asked.resolution):
        points = grouped(place.radius, place.angle)
        exact = points.radius.size <= raster_radii(spectra.problem, asked, points.radius)
        read: dict[Quantity, FloatArray] = {}
        for quantity in quantities:
            out = read[quantity] = np.zeros((times.size, place.at.size))
            if exact:
                add_exact(out, spectra, asked, points, times, quantity, lambda _: None)
            else:
                add_gridded(out, spectra, asked, (place.radius, place.angle), times, quantity, lambda _: None)
        if "radial" in read and planes is not None:
            read["radial"], read["angular"] = flow_back(planes, place, grid.angle, (read["radial"], read["angular"]))
        for quantity, result in zip(quantities, results, strict=True):
            result[:, place.at] += place.image.sign * read[quantity]


def add_incident(
    results: list[FloatArray], spectra: SolvedSpectra, asked: FieldRequest, grid: Grid, times: FloatArray, quantities: tuple[Quantity, ...]
) -> None:
    """Add the incident waves, exact in space, and in time too unless fronts are to match the scattered part's, outside the shells."""
    outside = np.flatnonzero(grid.radius >= spectra.problem.head)
    cos, sin = np.cos(np.radians(grid.angle[outside])), np.sin(np.radians(grid.angle[outside]))
    smooth = band(spectra.grid, asked.resolution) if asked.front == "matched" else None
    incident = Incident(spectra.problem, grid.radius[outside] * cos, grid.radius[outside] * sin, float(times.max()), smooth)

    def add(row: int) -> None:
        instant = float(times[row])
        if "pressure" in quantities:
            results[quantities.index("pressure")][row, outside] += incident.pressure(instant)
        if "radial" in quantities:
            along, across = incident.velocity(instant)
            results[quantities.index("radial")][row, outside] += cos * along + sin * across
            results[quantities.index("angular")][row, outside] += cos * across - sin * along

    add(0)  # what a wave tabulates at first use is there before the threads start
    list(map_on_threads(add, range(1, times.size)))


LONG_NAMES = {
    "total": "pressure",
    "incident": "incident pressure",
    "diffracted": "rigidly diffracted pressure",
    "radiated": "pressure radiated by the shells",
    "scattered": "scattered pressure (diffracted and radiated)",
}


def pressure(
    spectra: SolvedSpectra,
    x: npt.ArrayLike | None = None,
    y: npt.ArrayLike | None = None,
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
    """Return the acoustic pressure, Pa, dims (time, y, x) or (time, radius, angle); no time dimension for a single instant.

    Walls have no thickness: a point inside a mid-surface belongs to the fluid within, one on it or beyond to the fluid without. In a
    vacuum, and inside a rigid core, the pressure is 0.

    Parameters
    ----------
    spectra : SolvedSpectra
    x, y : array_like, optional
        Axes of a Cartesian grid in units of a; x points to theta = 0 (the source), y to theta = 90 degrees.
    radius, angle : array_like, optional
        Axes of a polar grid, in units of a and degrees, instead.
    time : float or array_like
        Instants in transits within the run, or as durations (timedelta64); any, not only steps of the run.
    part : str
        "total", "incident" (the sources alone, exact in space and time), "diffracted" (scattered by the outermost surface as if rigid),
        "radiated" (by the motion of the shells) or "scattered" (the latter two). Inside the outermost shell all is radiated.
    front : str
        "sharp": incident fronts are jumps. "matched": they rise over the scattered part's time resolution, so that the two cancel in the
        shadow, where a sharp one leaves a line about a pixel wide; for pictures.
    filter : str, optional
        Weight of the circumferential orders of the scattered part against Gibbs artefacts: "lanczos", sinc(m/(M + 1)), or
        "exponential", exp(-36 (m/(M + 1))^6); none by default.
    time_resolution : float, optional
        Transits; frequencies up to pi/time_resolution make up the scattered part, under a window that halves them at 0.43 of that.
        By default the run's step on polar grids and on Cartesian ones of few distinct radii, which are evaluated radius by radius;
        0.005 (or the run's step, if coarser) on larger Cartesian grids, which are interpolated from a polar raster. The choice is
        stated in the attributes. Finer costs as the square of it on large grids.
    memory : float
        Bytes that working arrays may take beside the result, at least 64e6; what is larger is worked through in blocks.
    progress : callable, optional
        Called with the fraction done and the name of the stage.

    Raises
    ------
    InputError
        If an argument is not allowed; it names the argument.
    """
    step = spectra.grid.time_step
    asked = request(part=part, filter=filter, time_resolution=time_resolution, memory=memory, progress=progress, step=step, front=front)
    when = when_of(time, float(spectra.grid.time[-1]), spectra.problem.scales)
    require_room("pressure", (x, y, radius, angle), when)
    grid = grid_of(x, y, radius, angle)
    asked = settled(spectra, asked, grid)
    values = evaluate(spectra, asked, grid, np.atleast_1d(when), ("pressure",))[0]
    values *= spectra.problem.scales.pressure
    return labelled(
        spectra.problem.scales,
        grid,
        when,
        values,
        asked,
        name="pressure",
        long_name=LONG_NAMES[part],
        units="Pa",
        sign="positive in compression",
    )


def pressure_at(spectra: SolvedSpectra, grid: Grid, when: FloatArray) -> FloatArray:
    """Return the total pressure on a grid at some instants, Pa, (instants, points)."""
    asked = request(part="total", filter=None, time_resolution=None, memory=1e9, progress=None, step=spectra.grid.time_step)
    (values,) = evaluate(spectra, settled(spectra, asked, grid), grid, when, ("pressure",))
    values *= spectra.problem.scales.pressure
    return values


OUTWARD = "components along increasing radius and angle"
ALONG_AXES = "components along x and y"


def velocity(
    spectra: SolvedSpectra,
    x: npt.ArrayLike | None = None,
    y: npt.ArrayLike | None = None,
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
    """Return the particle velocity, m/s, dims (time, component, y, x) or (time, component, radius, angle).

    Components are "x", "y" on a Cartesian grid and "radius", "angle" on a polar one, positive along the coordinate (outward, unlike
    the displacement of a shell). Parameters and errors are those of :func:`coaxshell.response.fields.evaluate.pressure`.
    """
    step = spectra.grid.time_step
    asked = request(part=part, filter=filter, time_resolution=time_resolution, memory=memory, progress=progress, step=step)
    when = when_of(time, float(spectra.grid.time[-1]), spectra.problem.scales)
    require_room("velocity", (x, y, radius, angle), when, 2)
    grid = grid_of(x, y, radius, angle)
    asked = settled(spectra, asked, grid)
    values = _turned(grid, evaluate(spectra, asked, grid, np.atleast_1d(when), ("radial", "angular")))
    values *= spectra.problem.scales.velocity
    sign = OUTWARD if grid.polar else ALONG_AXES
    return labelled(
        spectra.problem.scales, grid, when, values, asked, name="velocity", long_name="particle velocity", units="m s-1", sign=sign
    )


def intensity(
    spectra: SolvedSpectra,
    x: npt.ArrayLike | None = None,
    y: npt.ArrayLike | None = None,
    *,
    radius: npt.ArrayLike | None = None,
    angle: npt.ArrayLike | None = None,
    time: npt.ArrayLike | None = None,
    filter: str | None = None,
    time_resolution: float | None = None,
    memory: float = 1e9,
    progress: Progress | None = None,
) -> xr.DataArray:
    """Return the instantaneous acoustic intensity p v of the total field, W/m^2, dims and components as of the velocity.

    Parameters and errors are those of :func:`coaxshell.response.fields.evaluate.pressure`.
    """
    step = spectra.grid.time_step
    asked = request(part="total", filter=filter, time_resolution=time_resolution, memory=memory, progress=progress, step=step)
    when = when_of(time, float(spectra.grid.time[-1]), spectra.problem.scales)
    require_room("intensity", (x, y, radius, angle), when, 3)
    grid = grid_of(x, y, radius, angle)
    asked = settled(spectra, asked, grid)
    pressure, *flow = evaluate(spectra, asked, grid, np.atleast_1d(when), ("pressure", "radial", "angular"))
    values = _turned(grid, flow)
    values *= pressure[:, None] * (spectra.problem.scales.pressure * spectra.problem.scales.velocity)
    sign = OUTWARD if grid.polar else ALONG_AXES
    return labelled(
        spectra.problem.scales, grid, when, values, asked, name="intensity", long_name="acoustic intensity", units="W m-2", sign=sign
    )


def _turned(grid: Grid, flow: list[FloatArray]) -> FloatArray:
    """Return polar components, or Cartesian ones on a Cartesian grid, stacked after the time."""
    radial, angular = flow
    if grid.polar:
        return np.stack([radial, angular], axis=1)
    cos, sin = np.cos(np.radians(grid.angle)), np.sin(np.radians(grid.angle))
    return np.stack([cos * radial - sin * angular, sin * radial + cos * angular], axis=1)
