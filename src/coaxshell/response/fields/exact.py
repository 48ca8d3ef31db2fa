"""The scattered field at points, order by order at their own radii: exact but for the number of orders and the band of frequencies."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from coaxshell.acoustics.laplace_grid import WORKERS, LaplaceGrid
from coaxshell.numerics.arrays import FloatArray
from coaxshell.response.fields.band import band
from coaxshell.response.fields.inversion import few_offsets
from coaxshell.response.fields.modal_field import Quantity, modal_field
from coaxshell.response.fields.regions import reach, split
from coaxshell.response.fields.request import Request, Tell, mode_filter
from coaxshell.response.synthesis import angle_basis
from coaxshell.solver.recompute import SolvedSpectra


@dataclass(frozen=True)
class Points:
    """Points grouped by radius: ``members[i]`` are the positions of those at ``radius[i]``, ``angle`` is in degrees."""

    radius: FloatArray
    angle: FloatArray
    members: list[np.ndarray]


def grouped(radius: FloatArray, angle: FloatArray) -> Points:
    """Return points grouped by their radius to 12 digits."""
    _, first, inverse = np.unique(np.round(radius, 12), return_index=True, return_inverse=True)
    order = np.argsort(inverse, kind="stable")
    edges = np.concatenate([[0], np.cumsum(np.bincount(inverse))])
    return Points(radius[first], angle, [order[a:b] for a, b in pairwise(edges)])


def add_exact(
    out: FloatArray, spectra: SolvedSpectra, request: Request, points: Points, times: FloatArray, quantity: Quantity, tell: Tell
) -> None:
    """Add the scattered field of a part at points to ``out``, shape (times, points)."""
    weight = mode_filter(request.filter, spectra.max_order)
    done = 0
    grid = band(spectra.grid, request.resolution)
    for region, at in split(spectra.problem, points.radius):
        field = modal_field(spectra, grid, region, request.part)
        if region.exterior:
            at = at[points.radius[at] <= reach(spectra.problem, times, request.resolution)]
        if field is not None:
            for block, span in _blocks(at, times, field.halves * weight.size, grid, request.memory):
                values = field.histories(points.radius[block], times[span], quantity)
                for i, modal in zip(block, values, strict=True):
                    here = points.members[i]
                    basis = angle_basis(points.angle[here], weight.size, modal.shape[0]) * weight
                    out[span, here] += (basis.reshape(here.size, -1) @ modal.reshape(-1, modal.shape[-1])).T
                tell((done + block.size) / points.radius.size)
        done += at.size


def _blocks(at: np.ndarray, times: FloatArray, rows: int, grid: LaplaceGrid, memory: float) -> Iterator[tuple[np.ndarray, slice]]:
    """Yield blocks of radii and of instants whose modal histories fill about a third of the memory, and their direct sums a sixth."""
    width = max(1, min(times.size, int(memory / 3 / (16 * rows * WORKERS))))
    if not few_offsets(grid, times):
        width = max(1, min(width, int(memory / 6 / (32 * grid.nodes.size))))
    count = max(1, int(memory / 3 / (16 * rows * width)))
    for first in range(0, times.size, width):
        for start in range(0, at.size, count):
            yield at[start : start + count], slice(first, min(first + width, times.size))
