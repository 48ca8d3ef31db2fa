"""Modal histories of the field at radii of one region: the radial transfer of its walls, then the inverse transform to given instants."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import Literal

import numpy as np
import numpy.typing as npt

from coaxshell.acoustics.laplace_grid import WORKERS, LaplaceGrid
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.response.fields.inversion import Inversion
from coaxshell.response.fields.regions import Region
from coaxshell.response.fields.slopes import wall_slopes
from coaxshell.response.fields.transfer import CENTRE, Transfer
from coaxshell.solver.recompute import SolvedSpectra

Quantity = Literal["pressure", "slope", "radial", "angular"]
"""Pressure, its radial slope, and the particle velocity outward and towards increasing angle; all dimensionless."""

_BLOCK = 16 * 1024
"""Radius-node pairs of one block: a quarter of a megabyte, of which a dozen share a cache."""


class ModalField:
    """The scattered field of one region as circumferential orders.

    Parameters
    ----------
    region : Region
        Must hold a fluid.
    transfer : Transfer
    grid : LaplaceGrid
        The band of nodes of the transfer.
    """

    def __init__(self, region: Region, transfer: Transfer, grid: LaplaceGrid) -> None:
        assert region.fluid is not None
        self.region, self.grid, self._transfer = region, grid, transfer
        self._density = region.fluid.density
        self.halves = transfer.halves

    def spectra(self, radii: FloatArray, quantity: Quantity, weight: FloatArray) -> Iterator[tuple[int, ComplexArray]]:
        """Yield (m, weighted transforms of a quantity at radii, (halves, radii, nodes)) for m = 0..M."""
        momentum = self._density * self.grid.nodes
        match quantity:
            case "pressure":
                yield from self._transfer.pressure(radii, weight)
            case "slope":
                yield from self._transfer.slope(radii, weight)
            case "radial":
                yield from self._transfer.slope(radii, -weight / momentum)
            case "angular":
                turning = 1.0 / np.maximum(radii, CENTRE)[:, None]
                for m, pressure in self._transfer.pressure(radii, weight / momentum):
                    pressure *= m * turning
                    sine = -pressure[1] if self.halves == 2 else np.zeros_like(pressure[0])
                    yield m, np.stack([sine, pressure[0]])  # coefficients of cos(m theta) and sin(m theta)

    def histories(
        self, radii: FloatArray, times: FloatArray, quantity: Quantity = "pressure", dtype: npt.DTypeLike = np.float64
    ) -> npt.NDArray[np.floating]:
        """Return a quantity at radii and times, shape (radii, halves, M + 1, times)."""
        inversion = Inversion(self.grid, times)
        halves = 2 if quantity == "angular" else self.halves
        result = np.empty((radii.size, halves, self._transfer.max_order + 1, times.size), dtype)
        width = max(1, min(-(-radii.size // WORKERS), _BLOCK // self.grid.nodes.size))

        def work(start: int) -> None:
            span = slice(start, start + width)
            for m, spectra in self.spectra(radii[span], quantity, inversion.weight):
                result[span, :, m] = inversion(spectra).swapaxes(0, 1)

        with ThreadPoolExecutor(WORKERS) as pool:
            list(pool.map(work, range(0, radii.size, width)))
        return result


def modal_field(spectra: SolvedSpectra, grid: LaplaceGrid, region: Region, part: str) -> ModalField | None:
    """Return the field of a region; None where the part vanishes."""
    slopes = wall_slopes(spectra, grid, region, part)
    if slopes is None:
        return None
    return ModalField(region, Transfer(region, slopes, grid.nodes, spectra.max_order), grid)
