"""Particle velocity and acoustic intensity on the same grids as the pressure."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.late import xarray as xr
from coaxshell.numerics.progress import Progress
from coaxshell.response.fields.evaluate import evaluate, settled
from coaxshell.response.fields.grids import Grid, grid_of, labelled
from coaxshell.response.fields.request import request, require_room, when_of
from coaxshell.solver.recompute import SolvedSpectra

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
    the displacement of a shell). Parameters and errors are those of :func:`coaxshell.response.fields.pressure.pressure`.
    """
    step = spectra.grid.time_step
    asked = request(part=part, filter=filter, time_resolution=time_resolution, memory=memory, progress=progress, step=step)
    when = when_of(time, spectra)
    require_room("velocity", (x, y, radius, angle), when, 2)
    grid = grid_of(x, y, radius, angle)
    asked = settled(spectra, asked, grid)
    values = _turned(grid, evaluate(spectra, asked, grid, np.atleast_1d(when), ("radial", "angular")))
    values *= spectra.problem.scales.velocity
    sign = OUTWARD if grid.polar else ALONG_AXES
    return labelled(spectra, grid, when, values, asked, name="velocity", long_name="particle velocity", units="m s-1", sign=sign)


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

    Parameters and errors are those of :func:`coaxshell.response.fields.pressure.pressure`.
    """
    step = spectra.grid.time_step
    asked = request(part="total", filter=filter, time_resolution=time_resolution, memory=memory, progress=progress, step=step)
    when = when_of(time, spectra)
    require_room("intensity", (x, y, radius, angle), when, 3)
    grid = grid_of(x, y, radius, angle)
    asked = settled(spectra, asked, grid)
    pressure, *flow = evaluate(spectra, asked, grid, np.atleast_1d(when), ("pressure", "radial", "angular"))
    values = _turned(grid, flow)
    values *= pressure[:, None] * (spectra.problem.scales.pressure * spectra.problem.scales.velocity)
    sign = OUTWARD if grid.polar else ALONG_AXES
    return labelled(spectra, grid, when, values, asked, name="intensity", long_name="acoustic intensity", units="W m-2", sign=sign)


def _turned(grid: Grid, flow: list[FloatArray]) -> FloatArray:
    """Return polar components, or Cartesian ones on a Cartesian grid, stacked after the time."""
    radial, angular = flow
    if grid.polar:
        return np.stack([radial, angular], axis=1)
    cos, sin = np.cos(np.radians(grid.angle)), np.sin(np.radians(grid.angle))
    return np.stack([cos * radial - sin * angular, sin * radial + cos * angular], axis=1)
