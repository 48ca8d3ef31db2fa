"""The scattered field at many points: once per radius of a polar raster, once around it by FFT, then to the points by interpolation."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import numpy as np

from coaxshell.acoustics.laplace_grid import WORKERS
from coaxshell.numerics.arrays import FloatArray
from coaxshell.response.fields.band import band
from coaxshell.response.fields.modal_field import Quantity, modal_field
from coaxshell.response.fields.raster import TAPS_RADIUS, TAPS_THETA, Raster, Single, around, compensation, operator, raster_of
from coaxshell.response.fields.regions import reach, split
from coaxshell.response.fields.request import Request, Tell, mode_filter
from coaxshell.solver.recompute import SolvedSpectra

STEPS_PER_RESOLUTION = 0.8
"""Radial raster spacing per shortest half wave: the window leaves little at the band's end (measured, see the theory manual)."""

_POINTS = 16 * 1024
_BYTES_PER_POINT = 8 * TAPS_RADIUS * TAPS_THETA


def add_gridded(
    out: FloatArray,
    spectra: SolvedSpectra,
    asked: Request,
    place: tuple[FloatArray, FloatArray],
    times: FloatArray,
    quantity: Quantity,
    tell: Tell,
) -> None:
    """Add the scattered field of a part to ``out``, (times, points), at points (radius, angle in degrees)."""
    radius, angle = place
    grid = band(spectra.grid, asked.resolution)
    done = 0
    for region, at in split(spectra.problem, radius):
        field = modal_field(spectra, grid, region, asked.part)
        if region.exterior:
            at = at[radius[at] <= reach(spectra.problem, times, asked.resolution)]
        if field is not None and at.size:
            spacing = STEPS_PER_RESOLUTION * grid.time_step * region.spacing
            raster = raster_of(region, radius[at], spacing, spectra.max_order)
            weight = mode_filter(asked.filter, spectra.max_order) * compensation(spectra.max_order, raster.angles)
            # Stores of modal histories, then of the field around the raster, each within a quarter of the memory.
            per_instant = 4 * raster.count * (2 * field.halves * weight.size)
            width = max(1, min(times.size, int(asked.memory / 4 / per_instant)))
            for start in range(0, times.size, width):
                span = slice(start, min(start + width, times.size))
                modal = field.histories(raster.radii, times[span], quantity, np.float32)
                modal *= weight.astype(np.float32)[:, None]
                _to_points(out[span], modal, raster, (radius[at], angle[at]), at, asked.memory, odd=quantity in ("radial", "angular"))
                tell((done + at.size * span.stop / times.size) / radius.size)
        done += at.size


def _to_points(
    out: FloatArray, modal: Single, raster: Raster, place: tuple[FloatArray, FloatArray], at: np.ndarray, memory: float, *, odd: bool
) -> None:
    """Add modal histories (radii, halves, M + 1, times), summed around the raster and interpolated, to ``out[:, at]``."""
    radius, angle = place
    times = modal.shape[-1]
    blocks = [slice(i, min(i + _POINTS, at.size)) for i in range(0, at.size, _POINTS)]
    keep = at.size * _BYTES_PER_POINT <= memory / 4
    operators = [operator(raster, radius[b], angle[b], odd=odd) if keep else None for b in blocks]
    width = max(1, min(times, 16, int(memory / 4 / (10 * raster.count * raster.angles))))
    for start in range(0, times, width):
        span = slice(start, min(start + width, times))
        field = around(modal[..., span], raster.angles).reshape(raster.count * raster.angles, -1)

        def work(i: int, span: slice = span, field: Single = field) -> None:
            matrix = operators[i]
            if matrix is None:
                matrix = operator(raster, radius[blocks[i]], angle[blocks[i]], odd=odd)
            out[span, at[blocks[i]]] += (matrix @ field).T

        with ThreadPoolExecutor(WORKERS) as pool:
            list(pool.map(work, range(len(blocks))))


def raster_radii(spectra: SolvedSpectra, asked: Request, radius: FloatArray) -> int:
    """Return about how many radii the rasters of all regions have for points at these radii."""
    total = 0
    for region, at in split(spectra.problem, radius):
        spacing = STEPS_PER_RESOLUTION * asked.resolution * region.spacing
        total += int(np.ptp(radius[at]) / spacing) + TAPS_RADIUS
    return total
