"""A field at the points of a grid: the scattered part by the cheaper of two ways, the incident one as it is."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np

from coaxshell.acoustics.laplace_grid import WORKERS
from coaxshell.numerics.arrays import FloatArray
from coaxshell.response.fields.band import band
from coaxshell.response.fields.exact import Points, add_exact, grouped
from coaxshell.response.fields.gridded import add_gridded, raster_radii
from coaxshell.response.fields.grids import Grid
from coaxshell.response.fields.modal_field import Quantity
from coaxshell.response.fields.request import Request
from coaxshell.response.fields.sources import Incident
from coaxshell.solver.recompute import SolvedSpectra


def settled(spectra: SolvedSpectra, asked: Request, grid: Grid) -> Request:
    """Return the request with its time resolution decided: unless given, the run's step where that costs no more than a raster."""
    if asked.resolution_given:
        return asked
    fine = replace(asked, resolution=spectra.grid.time_step, resolution_given=True)
    if grid.polar:
        return fine
    radii = points_of(grid).radius
    cost = radii.size * asked.resolution / fine.resolution
    return fine if cost <= raster_radii(spectra, asked, radii) else replace(asked, resolution_given=True)


def points_of(grid: Grid) -> Points:
    """Return the points of a grid by radius."""
    return Points(grid.radii, grid.angle, grid.members) if grid.polar else grouped(grid.radius, grid.angle)


def _exact(spectra: SolvedSpectra, asked: Request, grid: Grid, points: Points) -> bool:
    """Return whether to evaluate radius by radius: always in polar coordinates, otherwise if there are fewer radii than on a raster."""
    return grid.polar or points.radius.size <= raster_radii(spectra, asked, points.radius)


def evaluate(spectra: SolvedSpectra, asked: Request, grid: Grid, times: FloatArray, quantities: tuple[Quantity, ...]) -> list[FloatArray]:
    """Return dimensionless quantities at all points and times, each of shape (times, points)."""
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
    if asked.part in ("total", "incident"):
        add_incident(results, spectra, asked, grid, times, quantities)
    if asked.progress is not None:
        asked.progress(1.0, "field")
    return results


def add_incident(
    results: list[FloatArray], spectra: SolvedSpectra, asked: Request, grid: Grid, times: FloatArray, quantities: tuple[Quantity, ...]
) -> None:
    """Add the incident waves, exact in space, and in time too unless fronts are to match the scattered part's, outside the shells."""
    outside = np.flatnonzero(grid.radius >= 1.0)
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
    with ThreadPoolExecutor(WORKERS) as pool:
        list(pool.map(add, range(1, times.size)))
