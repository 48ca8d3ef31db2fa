"""What the time step costs: the band limit of the inverse transform, and the march of nonlinear interfaces.

Both are differences between two answers of the run at some of its orders, in norms over the surface and the whole time, so that they
are the same wherever the source stands.

- Band limit: what changes when the roll-off is widened from a fifth to two fifths of the band. Spectra that still matter there also
  go on above the band; those that fall off steeply do not, and the top fifth alone tells.
- March: the interface marched again at eight times the step, with the same kernels summed to longer steps. It converges at second order,
  so that the difference is 63 times the error where the step resolves the interface, and about once where it does not. Where the
  longer step is too long to tell, four times and twice the step are tried.

Actuators are cut at points around the circle, which fold the highest harmonics of what they give back into the orders kept. What twice as
many points make of the voltages of the run tells that error, which more orders, and with them more points, make smaller.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property, partial
from typing import Any

import numpy as np
import numpy.typing as npt

from coaxshell.errors import InputError
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.convolution import KernelTable, summed_weights
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.progress import Progress
from coaxshell.solver.interface.absorbers import AbsorberSet, InterfacePoints, PointsAlone
from coaxshell.solver.interface.saturation import CircleSums, voltage_limit
from coaxshell.solver.interface.seen import SeenStructure
from coaxshell.solver.kernels import voltage_law, voltage_weights
from coaxshell.solver.links.any_law import march_interface
from coaxshell.solver.orders_left_out import Interface, forces_against, relative
from coaxshell.solver.quadrature import unresolved_orders
from coaxshell.solver.sampled_orders import standing_for
from coaxshell.solver.structure_spectra import StructureSpectra

Array = npt.NDArray[Any]

WIDE_ROLL_OFF, NARROW_ROLL_OFF = 0.4, 0.1
_NARROW_SHARE = 4.0
"""Where what changes when the roll-off is narrowed to a tenth of the band, times this, is less than what widening it changes, it is
printed instead: 476 numbers over random systems are then up to 11 times too large, without it 107 times, and none less than half."""
SHARES = {8: (0.1, 3e-4), 4: (0.2, 0.06), 2: (1.0, np.inf)}
"""By how many times the step is longer, the printed share of what that changes, and the error up to which it tells: beyond, answers of the
longer step may have nothing to do with those of the run's, whatever its error, and a shorter one is marched. At second order, which most
interfaces show, that is 6 or 3 times the error; those that show less than first order still have their error printed."""
ROUNDING = float(np.finfo(np.float64).eps)
_MANY = 4
"""Kernels between points, times those between shells, up to which points march alone."""
_SAMPLE = 14
"""Orders whose histories are compared."""
_INSTANTS = 256
"""Instants whose voltages are cut together: their points stay in the processor's cache."""


def _some_orders(max_order: int) -> npt.NDArray[np.int64]:
    """Return all orders up to M, or some of them, the denser the lower."""
    if max_order < _SAMPLE:
        return np.arange(max_order + 1)
    return np.unique(np.append(0, np.geomspace(1, max_order, _SAMPLE).round())).astype(np.int64)


def _motion(normal: Array, tangential: Array, orders: npt.NDArray[np.int64]) -> tuple[Array, Array]:
    """Return displacement W and strain m V - W of some orders, each (shells, parities, orders, nodes)."""
    return normal, orders[:, None] * tangential - normal


def _standing(orders: npt.NDArray[np.int64]) -> FloatArray:
    """Return mean square on the circle of each order of a sample, times how many orders it stands for."""
    return np.where(orders == 0, 1.0, 0.5) * standing_for(orders.astype(np.float64))


def _of_orders(motion: tuple[Array, Array], orders: npt.NDArray[np.int64], history: Callable[[Array], FloatArray]) -> FloatArray:
    """Return the norms (shells, 2) of all orders of a motion, from the transforms of some."""
    histories = (history(x) for x in motion)
    squares = [np.einsum("ihmt,ihmt->im", x, x) for x in histories]
    return np.stack(squares, axis=1) @ _standing(orders)


def band_limit(grid: LaplaceGrid, normal: ComplexArray, tangential: ComplexArray, whole: FloatArray) -> FloatArray:
    """Return the relative error of displacement and stress by the inverse transform, shape (shells, 2), from all transforms of a run.

    The band limit, what comes back from later in the period, and rounding. ``whole`` are the norms of the run, (shells, 2, M + 1),
    summed over the instants of the grid.
    """
    orders = _some_orders(normal.shape[2] - 1)
    motion = _motion(normal[:, :, orders], tangential[:, :, orders], orders)
    total = whole.sum(axis=-1)
    wider, narrower = (grid.taper() - grid.taper(other) for other in (WIDE_ROLL_OFF, NARROW_ROLL_OFF))
    change, later = (relative(_of_orders(motion, orders, x), total) for x in (partial(grid.invert, window=wider), grid.beyond))
    if _falls_steeply(motion, orders, wider, narrower):
        top = relative(_of_orders(motion, orders, partial(grid.invert, window=narrower)), total)
        change = np.minimum(change, _NARROW_SHARE * top)
    return change + grid.wrap_around * (1.0 + later) + rounding(grid, total)


def _falls_steeply(motion: tuple[Array, Array], orders: npt.NDArray[np.int64], wider: FloatArray, narrower: FloatArray) -> bool:
    """Return whether any spectrum has so little under the narrower window that it is to be looked at in time."""
    first = int(np.flatnonzero(wider)[0])
    windows = np.stack([wider, narrower], axis=1)[first:] ** 2
    squares = [np.einsum("ihmw,m->iw", (x.real**2 + x.imag**2) @ windows, _standing(orders)) for x in (y[..., first:] for y in motion)]
    return any(bool(np.any(_NARROW_SHARE**2 * x[:, 1] < x[:, 0])) for x in squares)


def rounding(grid: LaplaceGrid, whole: FloatArray) -> FloatArray:
    """Return the relative error by rounding: of the shell that moves most, amplified by e^{sigma t} up to the end, on every shell."""
    amplified: FloatArray = relative(np.broadcast_to(whole.max(axis=0), whole.shape), whole) * (ROUNDING / np.sqrt(grid.wrap_around))
    return amplified


class CoarserStructure(StructureSpectra):
    """A structure seen at every few steps of another: kernels for forces that are linear over the longer steps.

    Without saturation, and unless they are very many, the points of the absorbers march alone: their motion is all that is needed.

    Parameters
    ----------
    fine : StructureSpectra
    every : int
        Steps of the fine one in one of this.
    saturate : bool
        Whether voltages are needed: then all modes march.
    absorbers : AbsorberSet
    """

    def __init__(self, fine: StructureSpectra, every: int, saturate: bool, absorbers: AbsorberSet) -> None:
        grid = LaplaceGrid(fine.grid.time_step * every, fine.grid.steps // every)
        super().__init__(fine.problem, grid, fine.modes)
        self._fine, self._every, self._kept = fine, every, slice(0, grid.time.size * every, every)
        points = InterfacePoints(fine.problem, absorbers, fine.modes)
        many = points.count**2 > _MANY * len(fine.problem.surfaces) ** 2 * points.modes
        self._points, self._absorbers = None if saturate or many else points, absorbers

    @cached_property
    def kernels(self) -> KernelTable:
        """Step weights of the velocities."""
        velocity = summed_weights(self._fine.kernels.kernels, self._every, self.grid.time.size)
        return KernelTable(velocity if self._points is None else self._points.between(velocity)[:, :, None])

    @cached_property
    def kernels_with_voltage(self) -> KernelTable:
        """Step weights of the velocities without feedback, with the voltages asked for as further outputs."""
        fine, steps = self._fine, self.grid.time.size
        velocity = summed_weights(fine.open_loop.kernels.kernels, self._every, steps)
        rates = summed_weights(fine.sensor_rates, self._every, steps)
        return KernelTable(np.concatenate([velocity, voltage_weights(fine.problem, rates, fine.controlled, self.grid.time_step)]))

    def points(self, absorbers: AbsorberSet) -> InterfacePoints | PointsAlone:
        """Return the points, alone where they march so."""
        return super().points(absorbers) if self._points is None else PointsAlone(absorbers)

    @cached_property
    def open_loop(self) -> StructureSpectra:
        """The coarser structure without feedback, all modes of it."""
        return CoarserStructure(self._fine.open_loop, self._every, True, self._absorbers)

    def _seen(self, histories: FloatArray) -> FloatArray:
        """Return histories of the modes, or of the points alone, at the kept instants."""
        kept = histories[..., self._kept]
        return kept if self._points is None else np.asarray(self._points.evaluate(kept)[:, None, None])

    @cached_property
    def linear_displacement(self) -> FloatArray:
        """W without absorbers at the kept instants."""
        return self._seen(self._fine.linear_displacement)

    @cached_property
    def linear_velocity(self) -> FloatArray:
        """dW/dt without absorbers at the kept instants."""
        return self._seen(self._fine.linear_velocity)

    @cached_property
    def voltage_without_actuators(self) -> FloatArray:
        """Voltages asked for while neither absorbers nor actuators act, at the kept instants."""
        return self._fine.voltage_without_actuators[..., self._kept]


class CoarserSeen(StructureSpectra):
    """What absorbers see of a structure (:mod:`coaxshell.solver.interface.seen`), at every few steps.

    Parameters
    ----------
    fine : SeenStructure
    every : int
        Steps of the fine one in one of this.
    """

    def __init__(self, fine: SeenStructure, every: int) -> None:
        grid = LaplaceGrid(fine.grid.time_step * every, fine.grid.steps // every)
        super().__init__(fine.problem, grid, fine.modes)
        self._fine, self._every = fine, every

    @cached_property
    def kernels(self) -> KernelTable:
        """Step weights of the velocities."""
        return KernelTable(summed_weights(self._fine.kernels.kernels, self._every, self.grid.time.size))

    def points(self, absorbers: AbsorberSet) -> InterfacePoints | PointsAlone:
        """Return the points as the fine structure has them."""
        return self._fine.points(absorbers)

    def motion_at(self, points: InterfacePoints | PointsAlone) -> tuple[FloatArray, FloatArray]:
        """Return the motion of the points at the kept instants."""
        displacement, velocity = (x[:, :: self._every][:, : self.grid.time.size] for x in self._fine.motion_at(points))
        return displacement, velocity


def march_error(structure: StructureSpectra, interface: Interface, whole: FloatArray, progress: Progress | None = None) -> FloatArray:
    """Return the printed error of displacement and stress by the march's steps, shape (shells, 2), relative.

    A share of what changes when the interface is marched at eight times the step, or at four times or twice where that says too little;
    1 if all fail.

    Parameters
    ----------
    structure : StructureSpectra
        Which the forces moved.
    interface : Interface
        What it did in the run.
    whole : ndarray, shape (shells, 2)
        Mean squares of the run's motion, summed over the instants of its grid.
    progress : callable, optional
    """
    found = unknown = np.where(whole > 0, 1.0, 0.0)
    for every, (share, telling) in SHARES.items():
        found = np.minimum(share * _difference(structure, interface, whole, every, progress), unknown)
        if np.all(found < telling):
            break
    return found


def folded_error(structure: StructureSpectra, interface: Interface, whole: FloatArray) -> FloatArray:
    """Return the relative error by the points at which voltages are cut, shape (shells, 2).

    What twice as many points change in the voltages given, at what the run asks for, moves the structure without feedback: within 2.7 of
    the error of the stress, with or without absorbers. Of the displacement, which feedback holds in the low orders, that is several times
    too much; it is taken to be no more than that of the stress, 0.4 to 1.4 times which it was. ``whole`` as in :func:`march_error`.
    """
    assert interface.saturating is not None
    assert interface.asked is not None
    grid, problem, asked = structure.grid, interface.saturating.problem, interface.asked
    orders = _some_orders(structure.modes.max_order)
    folded = np.zeros((*asked.shape[:2], orders.size, asked.shape[-1]))
    for i in interface.saturating.controlled:
        full = problem.shells[i].actuator_pressure * voltage_limit(problem, i)
        folded[i] = full * _folded(asked[i] / full, orders)
    position = np.arange(grid.time.size) * (folded.shape[-1] - 1) / grid.steps
    left = np.minimum(position.astype(int), folded.shape[-1] - 2)
    part = position - left
    changed = structure.moved_by(grid.transform_linear(folded[..., left] * (1.0 - part) + folded[..., left + 1] * part), orders=orders)
    found = relative(_of_orders(_motion(changed.normal, changed.tangential, orders), orders, grid.invert), whole)
    return np.stack([found.min(axis=1), found[:, 1]], axis=1)


def _folded(volts: FloatArray, orders: npt.NDArray[np.int64]) -> FloatArray:
    """Return by how much twice as many points change the voltages given in some orders, (parities, orders, T), of (parities, M + 1, T)."""
    parities, modes, _ = volts.shape
    coarse, fine = CircleSums(modes, parities), CircleSums(modes, parities, 2)
    found = np.zeros((parities, orders.size, volts.shape[-1]))
    cut = np.flatnonzero(np.abs(volts).sum(axis=(0, 1)) > 1.0)
    for start in range(0, cut.size, _INSTANTS):
        some = cut[start : start + _INSTANTS]
        rows = volts[..., some].transpose(2, 0, 1)
        more, run = (one.amplitudes(np.clip(one.at_points(rows), -1.0, 1.0)) for one in (fine, coarse))
        found[..., some] = (more - run)[..., orders].transpose(1, 2, 0)
    return found


def membrane_error(structure: StructureSpectra, interface: Interface, whole: FloatArray) -> FloatArray:
    """Return the relative error by the march's weights for membranes that the step does not resolve, shape (shells, 2).

    The trapezoidal rule moves their frequencies (:mod:`coaxshell.solver.quadrature`), at all longer steps alike. What those weights make
    of the pressures of the run moves the ends of the links and the sensors, and so changes the forces. ``whole`` as in
    :func:`march_error`; actuators are taken as free, which changes most.
    """
    grid, problem, links = structure.grid, structure.problem, interface.links
    late = np.flatnonzero(unresolved_orders(problem, grid, structure.modes) | problem.two_faced)
    if not late.size:
        return np.zeros_like(whole)
    points, compliance = InterfacePoints(problem, links, structure.modes), structure.compliance
    histories = points.project(interface.force, late)
    if interface.actuation is not None:
        histories = histories + interface.actuation[:, :, late]
    pressure = grid.transform(histories)
    marched = grid.transform(structure.kernels.kernels[:, :, late]) / (grid.time_step * grid.nodes)
    moved = np.zeros((len(problem.surfaces), pressure.shape[1], structure.modes.count, grid.nodes.size), np.complex128)
    moved[:, :, late] = np.einsum("ijmk,jhmk->ihmk", marched - compliance[:, :, late] * grid.hat, pressure)
    orders = _some_orders(structure.modes.max_order)
    given = np.zeros((*moved.shape[:2], orders.size, grid.nodes.size), np.complex128)
    if links.count:
        ends = points.evaluate(moved).reshape(2, links.count, -1)
        forces = forces_against(structure, interface.linear_links(), ends, which=slice(None))
        given += points.project(forces.reshape(2 * links.count, -1), orders)
    for i in [] if interface.saturating is None else interface.saturating.controlled:
        assert interface.saturating is not None
        law = voltage_law(interface.saturating.problem, i, grid.nodes, structure.tangential_ratio[i])
        given[i] += problem.shells[i].actuator_pressure * (law * moved[i])[:, orders]
    changed = structure.moved_by(given, orders=orders)
    motion = _motion(changed.normal, changed.tangential, orders)
    return relative(_of_orders(motion, orders, grid.invert), whole)


def _difference(structure: StructureSpectra, interface: Interface, whole: FloatArray, every: int, progress: Progress | None) -> FloatArray:
    """Return what changes when the interface is marched at steps *every* times longer, infinity if that fails."""
    grid, links, saturating = structure.grid, interface.links, interface.saturating
    coarser: StructureSpectra
    if saturating is None and isinstance(interface.seen, SeenStructure):
        coarser = CoarserSeen(interface.seen, every)
    else:
        coarser = CoarserStructure(saturating or structure, every, saturating is not None, links)
    unknown = np.full(whole.shape, np.inf)
    try:
        with np.errstate(all="ignore"):
            told = None if progress is None else lambda share, _: progress(share, "error estimates")
            coarse = march_interface(coarser, links, saturate=saturating is not None, progress=told)
    except (InputError, np.linalg.LinAlgError, FloatingPointError):
        return unknown
    if not np.abs(coarse.modal_pressure).max(initial=0.0) < 1e100:
        return unknown
    orders = _some_orders(structure.modes.max_order)
    points = InterfacePoints(structure.problem, links, structure.modes)
    pressure = points.project(grid.transform_linear(_between(coarser, grid, coarse.force) - interface.force), orders)
    if interface.actuation is not None and coarse.actuation is not None:
        given = _between(coarser, grid, coarse.actuation[:, :, orders])
        pressure += grid.transform_linear(given - interface.actuation[:, :, orders])
    changed = structure.moved_by(pressure, orders=orders)
    motion = _motion(changed.normal, changed.tangential, orders)
    return relative(_of_orders(motion, orders, grid.invert), whole)


def _between(coarser: StructureSpectra, grid: LaplaceGrid, histories: FloatArray) -> FloatArray:
    """Return histories of the coarser grid at the instants of the fine one, by straight lines; the last value goes on."""
    position = np.minimum(grid.time / coarser.grid.time_step, coarser.grid.steps)
    left = np.minimum(position.astype(int), coarser.grid.steps - 1)
    part = position - left
    return np.asarray(histories[..., left] * (1.0 - part) + histories[..., left + 1] * part)
