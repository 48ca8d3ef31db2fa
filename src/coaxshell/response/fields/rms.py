"""RMS of the pressure over a fluid region: orders by Parseval, radii by Gauss quadrature."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import scipy.fft

from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.cost import Cost
from coaxshell.numerics.late import xarray as xr
from coaxshell.numerics.progress import Progress
from coaxshell.response.fields.grids import instants_of
from coaxshell.response.fields.incident import Incident
from coaxshell.response.fields.inversion import band
from coaxshell.response.fields.modal_field import modal_field
from coaxshell.response.fields.request import Domain, FieldRequest, default_instants, domain_of, mode_filter, request, when_of
from coaxshell.response.fields.spatial_incident import SpatialIncident
from coaxshell.response.synthesis import mean_square
from coaxshell.solver.scaling import Problem
from coaxshell.solver.solved_spectra import SolvedSpectra

_HELD = 3.0
"""Arrays of all orders, circles of a block and instants that stand side by side."""


def pressure_rms(
    spectra: SolvedSpectra,
    region: str | int,
    radius: float | None = None,
    *,
    time: npt.ArrayLike | None = None,
    part: str = "total",
    filter: str | None = None,
    time_resolution: float | None = None,
    memory: float = 1e9,
    progress: Progress | None = None,
) -> xr.DataArray:
    """Return the RMS of the pressure over the area of a region, Pa, dims (time,).

    Parameters
    ----------
    spectra : SolvedSpectra
    region : str or int
        "interior" (within the innermost shell), "gap" (between two shells), "exterior" (from the outermost shell to *radius*), or the
        number of a fluid from the inside.
    radius : float, optional
        Outer radius of the exterior annulus in units of a, 3 by default.
    time : float or array_like, optional
        Instants in transits; by default equal steps of the run, 500 to 1000 of them.
    part, filter, time_resolution, memory, progress
        As in :func:`coaxshell.response.fields.evaluate.pressure`.

    Raises
    ------
    InputError
        If the region is unknown or another argument is not allowed.
    """
    step = spectra.grid.time_step
    asked = request(part=part, filter=filter, time_resolution=time_resolution, memory=memory, progress=progress, step=step)
    domain = domain_of(spectra.problem, region, radius)
    when = when_of(default_instants(spectra.grid.time) if time is None else time, float(spectra.grid.time[-1]), spectra.problem.scales)
    square = _mean_square(spectra, asked, domain, np.atleast_1d(when))
    return labelled_rms(spectra.problem, asked, domain, when, square, region)


def labelled_rms(
    problem: Problem, asked: FieldRequest, domain: Domain, when: FloatArray, square: FloatArray, region: str | int
) -> xr.DataArray:
    """Return the root of mean squares (dimensionless), Pa, with what they are of."""
    part, filter = asked.part, asked.filter
    values = np.sqrt(np.maximum(square, 0.0)) * problem.scales.pressure
    attributes = {
        "units": "Pa",
        "long_name": f"RMS of the {'' if part == 'total' else part + ' '}pressure, {region}",
        "region": str(region),
        "inner_radius": domain.region.inner,
        "outer_radius": domain.outer,
        "part": part,
        "filter": filter or "none",
        "time_resolution": asked.resolution,
    }
    dims = ("time",) if when.ndim else ()
    return xr.DataArray(
        values.reshape(when.shape), dims=dims, coords=instants_of(problem.scales, when), name="pressure_rms", attrs=attributes
    )


def _mean_square(spectra: SolvedSpectra, asked: FieldRequest, domain: Domain, times: FloatArray) -> FloatArray:
    """Return the mean square of the dimensionless pressure over a domain, shape (times,)."""
    radii, weights = domain.rule(asked.resolution)
    field = modal_field(spectra, band(spectra.grid, asked.resolution), domain.region, asked.part, sent_back=True)
    weight = mode_filter(asked.filter, spectra.modes.max_order)[:, None]
    points = points_around(weight.size) if domain.region.exterior else 0
    block = max(1, int(asked.memory / 4 / (8 * times.size * (4 * weight.size + 3 * points))))
    _require_room(spectra, times.size, min(block, radii.size))
    total = np.zeros(times.size)
    for start in range(0, radii.size, block):
        here, share = radii[start : start + block], weights[start : start + block]
        modal = None
        if field is not None:
            modal = field.histories(here, times) * weight
            for r, amplitudes in zip(share, modal, strict=True):
                total += r * mean_square(amplitudes)
        if domain.region.exterior and asked.part in ("total", "incident"):
            x, y = on_circles(here, points)
            total += share @ with_incident(Incident(spectra.problem, x, y, float(times.max())), here.size, times, modal, points)
        if asked.progress is not None:
            asked.progress(min(1.0, (start + block) / radii.size), "mean square")
    return total


def _require_room(spectra: SolvedSpectra, instants: int, circles: int) -> None:
    """Raise InputError if the orders on so many circles at all instants, and the walls' own transforms, do not fit into memory."""
    orders = spectra.normal.shape[1] * spectra.normal.shape[2]
    cost = Cost(_HELD * 8.0 * circles * instants * orders + 2.0 * spectra.normal.nbytes)
    if not cost.fits:
        cost.require(
            f"the mean square pressure of orders 0 to {spectra.modes.max_order} at {instants:,} instants", "ask for some instants at a time"
        )


def points_around(orders: int) -> int:
    """Return at how many points of a circle the incident waves are taken, so that their product with so many orders is exact."""
    return int(scipy.fft.next_fast_len(max(720, 4 * orders), real=True))


def on_circles(radii: FloatArray, points: int) -> tuple[FloatArray, FloatArray]:
    """Return x and y of so many points on each circle."""
    theta = 2.0 * np.pi * np.arange(points) / points
    return np.outer(radii, np.cos(theta)).ravel(), np.outer(radii, np.sin(theta)).ravel()


def with_incident(
    incident: Incident | SpatialIncident, circles: int, times: FloatArray, modal: FloatArray | None, points: int
) -> FloatArray:
    """Return what the incident waves add to the mean squares on circles, (circles, times): their own, and twice the product with the field.

    The product needs only the orders of the field, from an FFT of the incident waves around each circle.
    """
    added = np.empty((circles, times.size))
    for i, instant in enumerate(times):
        waves = incident.pressure(float(instant)).reshape(circles, points)
        added[:, i] = np.einsum("rp,rp->r", waves, waves) / points
        if modal is not None:
            spectrum = scipy.fft.rfft(waves, axis=1)[:, : modal.shape[2]] * (2.0 / points)
            added[:, i] += np.einsum("rm,rm->r", modal[:, 0, :, i], spectrum.real)
            if modal.shape[1] == 2:
                added[:, i] -= np.einsum("rm,rm->r", modal[:, 1, :, i], spectrum.imag)
    return added
