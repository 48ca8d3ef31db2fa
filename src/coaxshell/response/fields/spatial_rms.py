"""RMS of the pressure over a fluid's cross-section at one axial position of a three-dimensional run."""

from __future__ import annotations

from typing import TypedDict

import numpy as np
import numpy.typing as npt

from coaxshell.errors import InputError
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.late import xarray as xr
from coaxshell.numerics.progress import Progress
from coaxshell.response.fields.cross_cut import Circles, modal_histories, reached
from coaxshell.response.fields.cut_field import cut_cost, require_started
from coaxshell.response.fields.cuts import Cut
from coaxshell.response.fields.grids import MEANINGS, Grid
from coaxshell.response.fields.inversion import band
from coaxshell.response.fields.request import Domain, FieldRequest, axis, default_instants, domain_of, when_of
from coaxshell.response.fields.rms import labelled_rms, on_circles, points_around, with_incident
from coaxshell.response.fields.spatial_incident import SpatialIncident
from coaxshell.response.fields.spatial_pressure import spatial_request
from coaxshell.response.fields.spatial_waves import cut_waves, with_own_forces
from coaxshell.response.synthesis import mean_square
from coaxshell.solver.axial.solution import SpatialSolution
from coaxshell.solver.axial.solve import laplace_grid
from coaxshell.solver.rounds import rounds
from coaxshell.solver.scaling import Problem


class SpatialRmsOptions(TypedDict, total=False):
    """Keyword arguments of a mean over a cross-section."""

    z: float
    time: npt.ArrayLike | None
    part: str
    filter: str | None
    time_resolution: float | None
    memory: float
    progress: Progress | None


def spatial_pressure_rms(
    spatial: SpatialSolution,
    region: str | int,
    radius: float | None = None,
    *,
    z: float = 0.0,
    time: npt.ArrayLike | None = None,
    part: str = "total",
    filter: str | None = None,
    time_resolution: float | None = None,
    memory: float = 1e9,
    progress: Progress | None = None,
) -> xr.DataArray:
    """Return the RMS of the pressure over the cross-section of a region at one z, Pa, dims (time,).

    Parameters
    ----------
    spatial : SpatialSolution
    region, radius, time, part, filter, memory, progress
        As in two dimensions, see :func:`coaxshell.response.fields.rms.pressure_rms`.
    z : float
        Axial position, in a.
    time_resolution : float, optional
        As of :func:`coaxshell.response.fields.spatial_pressure.spatial_pressure`.

    Raises
    ------
    InputError
        If the region is unknown or another argument is not allowed.
    """
    asked = spatial_request(spatial, time_resolution, part=part, filter=filter, memory=memory, progress=progress)
    problem, run = spatial.problem, laplace_grid(spatial.settings)
    domain, position = domain_of(problem, region, radius), float(axis("z", z)[0])
    when = when_of(default_instants(run.time) if time is None else time, float(run.time[-1]), problem.scales)
    _require_nothing_sent_back(problem, domain, float(when.max()))
    square = _mean_square(spatial, asked, domain, position, np.atleast_1d(when))
    found = labelled_rms(problem, asked, domain, when, square, region)
    meaning = {"units": "a", "long_name": MEANINGS["z"]}
    return found.assign_coords(
        z=xr.Variable((), position, meaning), z_metres=xr.Variable((), position * problem.scales.length, meaning | {"units": "m"})
    )


def _require_nothing_sent_back(problem: Problem, domain: Domain, latest: float) -> None:
    """Refuse means of the exterior once the planes of the sea send the scattered wave back into it: single points know it, means do not."""
    if problem.planes is None or not domain.region.exterior:
        return
    until = rounds(problem, latest).start + 2.0 * problem.planes.nearest - domain.outer - problem.head
    if latest > until:
        found = f"{latest:.4g} is after t = {until:.4g}, when what the shells scatter is back within {domain.outer:g} a from the sea"
        raise InputError("time", found, "ask for earlier instants or a smaller radius, or average the pressure at points")


def _mean_square(spatial: SpatialSolution, asked: FieldRequest, domain: Domain, z: float, times: FloatArray) -> FloatArray:
    """Return the mean square of the dimensionless pressure over a cross-section, shape (times,)."""
    radii, weights = domain.rule(asked.resolution)
    positions, grid = np.array([z]), band(laplace_grid(spatial.settings), asked.resolution)
    cut = Cut("across", Grid(True, (radii, np.zeros(1)), radii, np.zeros(radii.size)), positions, None)
    require_started(spatial, cut)
    total: FloatArray = np.zeros(times.size)

    def tell(share: float) -> None:
        if asked.progress is not None:
            asked.progress(share, "mean square")

    waves, _ = cut_waves(spatial, grid, positions, float(times.max()), asked) if asked.part != "incident" else (None, None)
    modal: FloatArray | None = None
    if waves is not None and domain.region.fluid is not None:
        what = f"the mean square pressure of orders 0 to {waves.sampling.max_order} at {radii.size:,} radii and {times.size:,} instants"
        cut_cost(waves, cut, radii.size, times.size).require(what, "ask for some instants at a time")
        waves = with_own_forces(waves, spatial)
        modal = np.zeros((radii.size, waves.parities, waves.sampling.max_order + 1, times.size))
        for _, at in reached(waves, asked, radii, times):
            modal[at] = modal_histories(waves, [Circles(domain.region, radii[at])], times, ("pressure",), tell)[0]["pressure"]
        for weight, amplitudes in zip(weights, modal, strict=True):
            total += weight * mean_square(amplitudes)
    if domain.region.exterior and asked.part in ("total", "incident"):
        points = points_around(spatial.sampling.max_order + 1)
        x, y = on_circles(radii, points)
        incident = SpatialIncident(spatial.problem, x, y, np.full(x.size, z), float(times.max()))
        total += weights @ with_incident(incident, radii.size, times, modal, points)
    tell(1.0)
    return total
