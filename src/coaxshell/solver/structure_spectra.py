"""All spectra of one structure under its sources, at some modes and at the nodes of a Laplace grid: what does not depend on absorbers."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from coaxshell.acoustics.basis import Modes
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.convolution import KernelTable
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.progress import Progress
from coaxshell.solver.coupling import ModalSystem
from coaxshell.solver.excitation import SurfaceLoads
from coaxshell.solver.faced_answers import UnderSources, UnitFaces, answers_of_faces, read_within, under_pressures
from coaxshell.solver.faced_forces import march_weights, moved_by_forces, surface_motion
from coaxshell.solver.interface.absorbers import AbsorberSet, InterfacePoints, PointsAlone
from coaxshell.solver.kernels import sensor_rate_weights, velocity_weights, voltage_law, voltage_weights
from coaxshell.solver.quadrature import trapezoidal_weights, unresolved_orders
from coaxshell.solver.sampled_orders import SampledOrders, orders_above
from coaxshell.solver.scaling import Problem
from coaxshell.solver.shared_parts import SharedParts, shared_parts
from coaxshell.solver.solid_spectra import SolidSpectra, band, solid_spectra
from coaxshell.solver.spectral import map_node_blocks, node_blocks


@dataclass
class _UnitAnswers:
    """Answers to unit loads, which structures share that differ only in their sources, absorbers and field limits; None until made.

    Attributes
    ----------
    compliance, ratio : ndarray or None
        C_ij and V/W.
    faces : UnitFaces or None
        What loads act on all faces, where walls have two; its compliance is ``compliance``.
    kernels, kernels_transposed, kernels_with_voltage : KernelTable or None
    marched : bool
        Whether absorbers have marched whose kernels were added up over the orders before they were inverted.
    classes : dict
        Kernels added up by classes of orders, of lattices met so far (:mod:`coaxshell.solver.interface.seen`).
    sensor_rates : ndarray or None
        Step weights of the rates of the controlled shells' sensors.
    open_loop : _UnitAnswers or None
        Those of the structure without feedback.
    """

    compliance: ComplexArray | None = None
    ratio: ComplexArray | None = None
    faces: UnitFaces | None = None
    kernels: KernelTable | None = None
    kernels_transposed: KernelTable | None = None
    kernels_with_voltage: KernelTable | None = None
    marched: bool = False
    classes: dict[Hashable, KernelTable] = field(default_factory=dict)
    sensor_rates: FloatArray | None = None
    open_loop: _UnitAnswers | None = None


class Moved(NamedTuple):
    """Transforms of W and V, each (shells, parities, orders, nodes), and where walls have two faces of all else that they do."""

    normal: ComplexArray
    tangential: ComplexArray
    solid: SolidSpectra | None = None


class StructureSpectra:
    """Spectra of one structure under its sources and under unit loads; each is made when first needed and kept.

    Parameters
    ----------
    problem : Problem
        Its absorbers are ignored here.
    grid : LaplaceGrid
    modes : Modes
    progress : callable, optional
    shared : SharedParts, optional
        Where parts of other structures are found, and left for others.
    units : optional
        Another structure's ``units``; it differs at most in its sources, absorbers and field limits.
    notes : tuple of str
        What was found when its modes were chosen, for the warnings of its answers.
    returned : ndarray, shape (parities, M + 1, nodes), optional
        Load of what the planes of the sea send back of its scattered wave.

    Attributes
    ----------
    units
        Answers to unit loads as far as they have been made.
    """

    def __init__(
        self,
        problem: Problem,
        grid: LaplaceGrid,
        modes: Modes,
        progress: Progress | None = None,
        *,
        shared: SharedParts | None = None,
        units: _UnitAnswers | None = None,
        notes: tuple[str, ...] = (),
        returned: ComplexArray | None = None,
    ) -> None:
        self.problem, self.grid, self.modes, self.shared = problem.resolving(band(grid)), grid, modes, shared
        self.units, self.notes, self.returned = units or _UnitAnswers(), notes, returned
        self._progress = progress
        self._under_sources: tuple[ComplexArray, ComplexArray] | None = None
        self._faces: UnderSources | None = None
        self._solid: SolidSpectra | None = None

    def same_structure(self, problem: Problem) -> bool:
        """Return whether a problem differs at most in its sources, absorbers and field limits."""
        own = self.problem
        return all(getattr(own, name) == getattr(problem, name) for name in ("shells", "fluids", "scales", "point_force_shares"))

    def same_but_absorbers(self, problem: Problem) -> bool:
        """Return whether a problem differs at most in its absorbers."""
        same = problem.system.replace(absorbers=()) == self.problem.system.replace(absorbers=())
        return same and problem.sources == self.problem.sources and self.same_structure(problem)

    def receiving(self, returned: ComplexArray) -> StructureSpectra:
        """Return the structure under its sources and what the planes of the sea send back, given by its load."""
        own = self.problem, self.grid, self.modes, self._progress
        return StructureSpectra(*own, shared=self.share(), units=self.units, notes=self.notes, returned=returned)

    def share(self) -> SharedParts:
        """Return where parts are left for other structures, from now on at the latest."""
        if self.shared is None:
            self.shared = shared_parts()
        return self.shared

    def solve(self, *, units: bool) -> None:
        """Solve for the sources, and for unit pressures on each shell if asked for, in one pass; what is known is left as it is.

        Parameters
        ----------
        units : bool
            Whether absorbers or actuators will need the answers to unit pressures too.
        """
        problem, grid, modes = self.problem, self.grid, self.modes
        if problem.two_faced:
            self._solve_faces(units=units)
            return
        count, each = len(problem.shells), (modes.count, grid.nodes.size)
        loads = SurfaceLoads(problem, grid, modes, self.shared, self.returned) if self._under_sources is None else None
        units = units and self.units.compliance is None
        if loads is not None:
            normal, tangential = (np.empty((count, loads.parities, *each), np.complex128) for _ in range(2))
        if units:
            compliance, ratio = np.empty((count, count, *each), np.complex128), np.empty((count, *each), np.complex128)

        def work(block: slice) -> None:
            modal = ModalSystem(problem, grid.nodes[block], modes, shared=self.shared)
            for parity, load in enumerate([] if loads is None else loads(modal.radial, block)):
                moved = modal.solve_outside(load)
                for shell, (w, v) in enumerate(zip(moved, modal.tangential(moved), strict=True)):
                    normal[shell, parity, :, block], tangential[shell, parity, :, block] = w, v
            if units:
                for j in range(count):
                    for i, w in enumerate(modal.solve(j, 1.0)):
                        compliance[i, j, :, block] = w
                for i, operator in enumerate(modal.shells):
                    ratio[i, :, block] = operator.tangential

        if loads is not None or units:
            map_node_blocks(node_blocks(grid, modes.max_order), work, self._progress, "frequencies")
        if loads is not None:
            self._under_sources = normal, tangential
        if units:
            self.units.compliance, self.units.ratio = compliance, ratio

    def _solve_faces(self, *, units: bool) -> None:
        """Do the same where walls have two faces, which are read within only where no forces are to come."""
        problem, grid, modes, unknown = self.problem, self.grid, self.modes, self._solid is None and self._faces is None
        loads = SurfaceLoads(problem, grid, modes, self.shared, self.returned) if unknown else None
        if units and self.units.faces is None:
            under, unit = answers_of_faces(problem, grid, modes, loads, self._progress)
            self._faces, self.units.faces, self.units.compliance = under or self._faces, unit, unit.compliance
        elif loads is not None:
            self._solid = solid_spectra(problem, grid, modes, loads, self._progress)

    @property
    def faces(self) -> UnderSources:
        """What the sources do to walls some of which have two faces: loads on all faces, displacements of the surfaces."""
        self.solve(units=False)
        if self._faces is None:
            solid = self.solid
            assert solid is not None
            self._faces = UnderSources(solid.loads, surface_motion(self.problem, solid.normal, solid.faces))
        return self._faces

    def _sources(self) -> tuple[ComplexArray, ComplexArray]:
        if self.problem.two_faced:
            solid = self.solid
            assert solid is not None
            return solid.normal, solid.tangential
        self.solve(units=False)
        assert self._under_sources is not None
        return self._under_sources

    @property
    def solid(self) -> SolidSpectra | None:
        """What walls of two faces do under the sources; None where there is none."""
        if self.problem.two_faced:
            self.solve(units=False)
            if self._solid is None:
                self._solid = read_within(self.problem, self.grid, self.modes, self.faces, self._progress)
        return self._solid

    @property
    def normal(self) -> ComplexArray:
        """W under the sources alone, shape (shells, parities, M + 1, nodes)."""
        return self._sources()[0]

    @property
    def tangential(self) -> ComplexArray:
        """V under the sources alone, same shape."""
        return self._sources()[1]

    @property
    def surface_motion(self) -> ComplexArray:
        """Displacements under the sources alone of the surfaces on which links act, shape (surfaces, parities, M + 1, nodes)."""
        return self.faces.surfaces if self.problem.two_faced else self.normal

    @property
    def compliance(self) -> ComplexArray:
        """Compliance C_ij, displacement of surface i per modal pressure on surface j, shape (surfaces, surfaces, M + 1, nodes)."""
        self.solve(units=True)
        assert self.units.compliance is not None
        return self.units.compliance

    @property
    def unit_bytes(self) -> int:
        """Bytes of the answers to unit pressures."""
        self.solve(units=True)
        if self.units.faces is not None:
            return self.units.faces.nbytes
        return sum(0 if x is None else x.nbytes for x in (self.units.compliance, self.units.ratio))

    @property
    def tangential_ratio(self) -> ComplexArray:
        """V/W under any normal load, shape (shells, M + 1, nodes), where no wall has two faces."""
        self.solve(units=True)
        assert self.units.ratio is not None
        return self.units.ratio

    @cached_property
    def linear_displacement(self) -> FloatArray:
        """Displacements of the surfaces under the sources alone, shape (surfaces, parities, M + 1, T)."""
        return self.grid.invert(self.surface_motion)

    @cached_property
    def linear_velocity(self) -> FloatArray:
        """Velocities of the surfaces under the sources alone, shape (surfaces, parities, M + 1, T)."""
        return self.grid.invert(self.surface_motion * self.grid.nodes)

    @cached_property
    def orders_above(self) -> SampledOrders:
        """A sample of the orders above M."""
        return SampledOrders.of(self.problem, self.grid, orders_above(self.problem, self.modes.max_order + 1), self.shared)

    @property
    def kernels(self) -> KernelTable:
        """Step weights of the velocity kernels, ready for history sums."""
        if self.units.kernels is None:
            self.units.kernels = KernelTable(self.step_weights([])[0])
        return self.units.kernels

    @property
    def kernels_transposed(self) -> KernelTable:
        """Step weights of the velocity kernels with outputs and inputs exchanged: what marches backwards."""
        if self.units.kernels_transposed is None:
            self.units.kernels_transposed = KernelTable(self.kernels.kernels.swapaxes(0, 1))
        return self.units.kernels_transposed

    def points(self, absorbers: AbsorberSet) -> InterfacePoints | PointsAlone:
        """Return the points at which absorbers hold the shells, in the terms in which ``kernels`` and motion are given."""
        return InterfacePoints(self.problem, absorbers, self.modes)

    def motion_at(self, points: InterfacePoints | PointsAlone) -> tuple[FloatArray, FloatArray]:
        """Return displacements and velocities of the points under the sources alone, (points, T) each."""
        return points.evaluate(self.linear_displacement), points.evaluate(self.linear_velocity)

    def step_weights(self, sensors: list[int]) -> tuple[FloatArray, FloatArray]:
        """Return the step weights of modal pressures in the velocities and in the rates of the sensors' voltages of some shells.

        By product integration, and where the step does not resolve an order's membrane, or a wall has two faces, by the trapezoidal rule.
        """
        problem, grid = self.problem, self.grid
        if problem.two_faced:
            return march_weights(problem, grid, self.modes, self._progress), np.empty((0, 0, 0, 0))
        velocity = velocity_weights(problem, grid, self.compliance)
        rate = sensor_rate_weights(problem, grid, self.compliance, self.tangential_ratio, sensors)
        late = unresolved_orders(problem, grid, self.modes)
        if late.any():
            velocity[:, :, late], rate[:, :, late] = trapezoidal_weights(problem, grid, Modes(self.modes.orders[late]), sensors)
        return velocity, rate

    @cached_property
    def controlled(self) -> list[int]:
        """Shells with feedback."""
        return [i for i, shell in enumerate(self.problem.shells) if shell.gains is not None]

    @cached_property
    def open_loop(self) -> StructureSpectra:
        """The structure without feedback, on which actuators act as forces like any other."""
        if self.units.open_loop is None:
            self.units.open_loop = _UnitAnswers()
        passive, units = self.problem.open_loop, self.units.open_loop
        return StructureSpectra(passive, self.grid, self.modes, self._progress, shared=self.shared, units=units, returned=self.returned)

    @property
    def kernels_with_voltage(self) -> KernelTable:
        """Step weights of the velocities without feedback, with the voltages asked for on the controlled shells as further outputs."""
        return self._controlled_kernels()[0]

    @property
    def sensor_rates(self) -> FloatArray:
        """Step weights of modal pressures in the rates of the controlled shells' sensors, without feedback."""
        return self._controlled_kernels()[1]

    def _controlled_kernels(self) -> tuple[KernelTable, FloatArray]:
        """Return the kernels with voltages and the sensors' rates, made together."""
        if self.units.kernels_with_voltage is None or self.units.sensor_rates is None:
            velocity, rates = self.open_loop.step_weights(self.controlled)
            self.units.sensor_rates = rates
            voltage = voltage_weights(self.problem, rates, self.controlled, self.grid.time_step)
            both = np.concatenate([velocity, voltage])
            self.units.kernels_with_voltage = KernelTable(both)
            self.open_loop.units.kernels = KernelTable(both[: velocity.shape[0]])
        return self.units.kernels_with_voltage, self.units.sensor_rates

    @cached_property
    def voltage_without_actuators(self) -> FloatArray:
        """Voltages asked for while neither absorbers nor actuators act, shape (controlled, parities, M + 1, T)."""
        bare = self.open_loop
        laws = [voltage_law(self.problem, i, self.grid.nodes, bare.tangential_ratio[i]) for i in self.controlled]
        return np.stack([self.grid.invert(law * bare.normal[i]) for law, i in zip(laws, self.controlled, strict=True)])

    def moved_by(self, pressure: ComplexArray, nodes: slice = slice(None), orders: npt.NDArray[np.int64] | slice = slice(None)) -> Moved:
        """Return what modal pressures alone move, in some of the orders at some of the nodes.

        Parameters
        ----------
        pressure : ndarray, shape (surfaces, parities, orders, nodes)
            Transforms at these nodes, positive inward.
        nodes, orders
            Which of the grid's nodes and of the orders 0 to M.
        """
        if self.problem.two_faced:
            modes = Modes(self.modes.orders[orders], sparse=self.modes.orders[orders].size < self.modes.count)
            solid = moved_by_forces(self.problem, self.grid, modes, pressure, nodes)
            return Moved(solid.normal, solid.tangential, solid)
        normal = np.einsum("ijmk,jhmk->ihmk", self.compliance[:, :, orders, nodes], pressure)
        return Moved(normal, self.tangential_ratio[:, None, orders, nodes] * normal)

    def forced_spectra(self, pressure: ComplexArray) -> Moved:
        """Return the transforms of what sources and modal pressures on the surfaces move together.

        Parameters
        ----------
        pressure : ndarray, shape (surfaces, parities, M + 1, nodes)
            Transforms of modal pressures, positive inward.
        """
        if self.problem.two_faced:
            self.solve(units=True)
            assert self.units.faces is not None
            moved = under_pressures(self.faces, self.units.faces, pressure)
            whole = read_within(self.problem, self.grid, self.modes, moved, self._progress)
            return Moved(whole.normal, whole.tangential, whole)
        parities = max(pressure.shape[1], self.normal.shape[1])
        shape = (*pressure.shape[:1], parities, *pressure.shape[2:])
        normal, tangential = np.zeros(shape, np.complex128), np.zeros(shape, np.complex128)
        sources, forced = slice(0, self.normal.shape[1]), slice(0, pressure.shape[1])
        normal[:, sources], tangential[:, sources] = self.normal, self.tangential
        for i in range(shape[0]):
            moved = self.compliance[i, 0] * pressure[0]
            moved += 0.0  # no zero has a sign, as of any sum
            for j in range(1, shape[0]):
                moved += self.compliance[i, j] * pressure[j]
            normal[i, forced] += moved
            tangential[i, forced] += np.multiply(self.tangential_ratio[i], moved, out=moved)
        return Moved(normal, tangential)
