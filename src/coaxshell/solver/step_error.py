"""What the time step costs: the band limit of the inverse transform, and the march of nonlinear interfaces.

Both are differences between two answers of the run at some of its orders, in norms over the surface and the whole time, so that they
are the same wherever the source stands.

- Band limit: what changes when the roll-off is widened from a fifth to two fifths of the band. Spectra that still matter there also
  go on above the band.
- March: the interface marched again at four times the step, with the same kernels summed to longer steps. It converges at second order,
  so that the difference is fifteen times the error where the step resolves the interface, and about once where it does not. Where the
  longer step fails altogether, twice the step is tried.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from coaxshell.errors import InputError
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.convolution import KernelTable
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.absorbers import InterfacePoints
from coaxshell.solver.kernels import voltage_weights
from coaxshell.solver.march import march
from coaxshell.solver.orders_left_out import Interface, relative
from coaxshell.solver.prepared import StructureSpectra, UnitResponse
from coaxshell.solver.sampled_orders import standing_for

Array = npt.NDArray[Any]

WIDE_ROLL_OFF = 0.4
SHARES = {4: 0.2, 2: 1.0}
"""By how many times the step is longer, the printed share of what that changes: three times the error where the step resolves the
interface, a fifth of it or more where it does not."""
TOO_MUCH = 0.3
"""Error beyond which the longer step may be to blame."""
ROUNDING = float(np.finfo(np.float64).eps)
_SAMPLE = 14
"""Orders whose histories are compared."""


def _some_orders(max_order: int) -> npt.NDArray[np.int64]:
    """Return all orders up to M, or some of them, the denser the lower."""
    if max_order < _SAMPLE:
        return np.arange(max_order + 1)
    return np.unique(np.append(0, np.geomspace(1, max_order, _SAMPLE).round())).astype(np.int64)


def _of_orders(normal: Array, tangential: Array, orders: npt.NDArray[np.int64], history: Callable[[Array], FloatArray]) -> FloatArray:
    """Return the norms (shells, 2) of all orders of a motion, from transforms (shells, parities, orders, nodes) of some."""
    share = np.where(orders == 0, 1.0, 0.5) * standing_for(orders.astype(np.float64))
    squares = [np.sum(history(x) ** 2, axis=(1, 3)) for x in (normal, orders[:, None] * tangential - normal)]
    return np.stack(squares, axis=1) @ share


def band_limit(grid: LaplaceGrid, normal: ComplexArray, tangential: ComplexArray, whole: FloatArray) -> FloatArray:
    """Return the relative error of displacement and stress by the inverse transform, shape (shells, 2), from all transforms of a run.

    The band limit, what comes back from later in the period, and rounding. ``whole`` are the norms of the run, (shells, 2, M + 1),
    summed over the instants of the grid.
    """
    orders = _some_orders(normal.shape[2] - 1)
    parts = normal[:, :, orders], tangential[:, :, orders], orders
    wider = grid.taper() - grid.taper(WIDE_ROLL_OFF)
    total = whole.sum(axis=-1)
    change = relative(_of_orders(*parts, lambda x: grid.invert(x, wider)), total)
    later = relative(_of_orders(*parts, grid.beyond), total)
    return change + grid.wrap_around * (1.0 + later) + rounding(grid, total)


def rounding(grid: LaplaceGrid, whole: FloatArray) -> FloatArray:
    """Return the relative error by rounding: of the shell that moves most, amplified by e^{sigma t} up to the end, on every shell."""
    amplified: FloatArray = relative(np.broadcast_to(whole.max(axis=0), whole.shape), whole) * (ROUNDING / np.sqrt(grid.wrap_around))
    return amplified


class CoarserStructure(StructureSpectra):
    """A structure seen at every few steps of another: kernels for forces that are linear over the longer steps.

    Parameters
    ----------
    fine : StructureSpectra
    every : int
        Steps of the fine one in one of this.
    saturate : bool
        Whether voltages are needed.
    """

    def __init__(self, fine: StructureSpectra, every: int, saturate: bool) -> None:
        grid = LaplaceGrid(fine.grid.time_step * every, fine.grid.steps // every)
        self._fine, self._every, self._kept = fine, every, slice(0, grid.time.size * every, every)
        velocity = _summed((fine.open_loop if saturate else fine).kernels.kernels, every, grid.time.size)
        forced = UnitResponse(kernels=KernelTable(velocity))
        if saturate:
            rates = _summed(fine.sensor_rates, every, grid.time.size)
            voltage = voltage_weights(fine.problem, rates, fine.controlled, grid.time_step)
            forced = UnitResponse(kernels_with_voltage=KernelTable(np.concatenate([velocity, voltage])))
        super().__init__(fine.problem, grid, fine.max_order, forced=forced)

    @cached_property
    def open_loop(self) -> StructureSpectra:
        """The same without feedback."""
        return CoarserStructure(self._fine.open_loop, self._every, False)

    @cached_property
    def linear_displacement(self) -> FloatArray:
        """W without absorbers at the kept instants."""
        return self._fine.linear_displacement[..., self._kept]

    @cached_property
    def linear_velocity(self) -> FloatArray:
        """dW/dt without absorbers there."""
        return self._fine.linear_velocity[..., self._kept]

    @cached_property
    def voltage_without_actuators(self) -> FloatArray:
        """Voltages asked for while neither absorbers nor actuators act, there."""
        return self._fine.voltage_without_actuators[..., self._kept]


def _summed(weights: FloatArray, every: int, steps: int) -> FloatArray:
    """Return step weights for steps *every* times longer: a hat as wide is the sum of narrower ones."""
    padded = np.zeros((*weights.shape[:-1], steps * every + 2 * every))
    length = min(weights.shape[-1], steps * every + every)
    padded[..., every : every + length] = weights[..., :length]
    total = np.zeros((*weights.shape[:-1], steps))
    for shift in range(1 - every, every):
        start = every + shift
        total += (1.0 - abs(shift) / every) * padded[..., start : start + steps * every : every]
    return total


def march_error(structure: StructureSpectra, interface: Interface, whole: FloatArray) -> FloatArray:
    """Return the printed error of displacement and stress by the march's steps, shape (shells, 2), relative.

    A share of what changes when the interface is marched at four times the step, or at twice the step where that fails; 1 if both do.

    Parameters
    ----------
    structure : StructureSpectra
        Which the forces moved.
    interface : Interface
        What it did in the run.
    whole : ndarray, shape (shells, 2)
        Mean squares of the run's motion, summed over the instants of its grid.
    """
    least = np.where(whole > 0, 1.0, 0.0)
    for every, share in SHARES.items():
        least = np.minimum(least, share * _difference(structure, interface, whole, every))
        if np.all(least < TOO_MUCH):
            break
    return least


def _difference(structure: StructureSpectra, interface: Interface, whole: FloatArray, every: int) -> FloatArray:
    """Return what changes when the interface is marched at steps *every* times longer, infinity if that fails."""
    grid, links, saturating = structure.grid, interface.links, interface.saturating
    coarser = CoarserStructure(saturating or structure, every, saturating is not None)
    unknown = np.full(whole.shape, np.inf)
    try:
        with np.errstate(all="ignore"):
            coarse = march(coarser, links, saturate=saturating is not None)
    except (InputError, np.linalg.LinAlgError, FloatingPointError):
        return unknown
    if not np.abs(coarse.modal_pressure).max(initial=0.0) < 1e100:
        return unknown
    orders = _some_orders(structure.max_order)
    points = InterfacePoints(structure.problem, links, structure.max_order)
    pressure = points.project(grid.transform_linear(_between(coarser, grid, coarse.force) - interface.force))[:, :, orders]
    if interface.actuation is not None and coarse.actuation is not None:
        given = _between(coarser, grid, coarse.actuation[:, :, orders])
        pressure += grid.transform_linear(given - interface.actuation[:, :, orders])
    normal = np.einsum("ijmk,jhmk->ihmk", structure.compliance[:, :, orders], pressure)
    tangential = structure.tangential_ratio[:, None, orders] * normal
    return relative(_of_orders(normal, tangential, orders, grid.invert), whole)


def _between(coarser: StructureSpectra, grid: LaplaceGrid, histories: FloatArray) -> FloatArray:
    """Return histories of the coarser grid at the instants of the fine one, by straight lines; the last value goes on."""
    position = np.minimum(grid.time / coarser.grid.time_step, coarser.grid.steps)
    left = np.minimum(position.astype(int), coarser.grid.steps - 1)
    part = position - left
    return np.asarray(histories[..., left] * (1.0 - part) + histories[..., left + 1] * part)
