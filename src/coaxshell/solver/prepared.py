"""Prepare once, solve many: everything about shells, fluids, sources and feedback that does not depend on the absorbers."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from coaxshell.acoustics.operators import all_orders
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.convolution import KernelTable
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.progress import Progress
from coaxshell.solver.interface.absorbers import AbsorberSet, InterfacePoints, PointsAlone
from coaxshell.solver.kernels import sensor_rate_weights, velocity_weights, voltage_law, voltage_weights
from coaxshell.solver.quadrature import trapezoidal_weights, unresolved_orders
from coaxshell.solver.scaling import Problem
from coaxshell.solver.shared_parts import SharedParts
from coaxshell.solver.spectral import LinearSpectra, linear_spectra


@dataclass
class UnitResponse:
    """What structures that differ only in their sources, absorbers and field limits have in common; made when first needed.

    Attributes
    ----------
    compliance, ratio : ndarray or None
        C_ij and V/W.
    kernels, kernels_with_voltage : KernelTable or None
    sensor_rates : ndarray or None
        Step weights of the rates of the controlled shells' sensors.
    open_loop : UnitResponse or None
        What the structure without feedback shares.
    """

    compliance: ComplexArray | None = None
    ratio: ComplexArray | None = None
    kernels: KernelTable | None = None
    kernels_with_voltage: KernelTable | None = None
    sensor_rates: FloatArray | None = None
    open_loop: UnitResponse | None = None


class StructureSpectra:
    """Linear response and compliance of one structure under its sources, computed when first needed and kept.

    Parameters
    ----------
    problem : Problem
        Its absorbers are ignored here.
    grid : LaplaceGrid
    max_order : int
    progress : callable, optional
    shared : SharedParts, optional
        Where parts of other structures are found.
    forced : UnitResponse, optional
        What a structure that differs at most in its sources has made already.
    """

    def __init__(
        self,
        problem: Problem,
        grid: LaplaceGrid,
        max_order: int,
        progress: Progress | None = None,
        *,
        shared: SharedParts | None = None,
        forced: UnitResponse | None = None,
    ) -> None:
        self.problem, self.grid, self.max_order = problem, grid, max_order
        self.forced = forced or UnitResponse()
        self._progress, self.shared = progress, shared
        self._linear: LinearSpectra | None = None

    @property
    def linear(self) -> LinearSpectra:
        """Transforms of the response without absorbers."""
        if self._linear is None:
            self._linear = linear_spectra(self.problem, self.grid, self.max_order, self._progress, shared=self.shared)
        return self._linear

    def unit_pressures(self) -> tuple[ComplexArray, ComplexArray]:
        """Return compliance and V/W, made in one pass with the response to the sources where none of them is known."""
        forced = self.forced
        if forced.compliance is None or forced.ratio is None:
            made = linear_spectra(self.problem, self.grid, self.max_order, self._progress, compliance=True, shared=self.shared)
            self._linear = self._linear or made
            forced.compliance, forced.ratio = made.compliance, made.ratio
        assert forced.compliance is not None
        assert forced.ratio is not None
        return forced.compliance, forced.ratio

    @property
    def compliance(self) -> ComplexArray:
        """Compliance C_ij, W of shell i per modal pressure on shell j, shape (shells, shells, M + 1, nodes)."""
        return self.unit_pressures()[0]

    @property
    def tangential_ratio(self) -> ComplexArray:
        """V/W, shape (shells, M + 1, nodes)."""
        return self.unit_pressures()[1]

    @cached_property
    def linear_displacement(self) -> FloatArray:
        """W without absorbers, shape (shells, parities, M + 1, T)."""
        return self.grid.invert(self.linear.normal)

    @cached_property
    def linear_velocity(self) -> FloatArray:
        """dW/dt without absorbers, shape (shells, parities, M + 1, T)."""
        return self.grid.invert(self.linear.normal * self.grid.nodes)

    @property
    def kernels(self) -> KernelTable:
        """Step weights of the velocity kernels, ready for history sums."""
        if self.forced.kernels is None:
            self.forced.kernels = KernelTable(self.step_weights([])[0])
        return self.forced.kernels

    def points(self, absorbers: AbsorberSet) -> InterfacePoints | PointsAlone:
        """Return the points at which absorbers hold the shells, in the terms in which ``kernels`` and motion are given."""
        return InterfacePoints(self.problem, absorbers, self.max_order)

    def step_weights(self, sensors: list[int]) -> tuple[FloatArray, FloatArray]:
        """Return the step weights of modal pressures in the velocities and in the rates of the sensors' voltages of some shells.

        By product integration, and where the step does not resolve an order's membrane by the trapezoidal rule.
        """
        problem, grid = self.problem, self.grid
        velocity = velocity_weights(problem, grid, self.compliance)
        rate = sensor_rate_weights(problem, grid, self.compliance, self.tangential_ratio, sensors)
        late = unresolved_orders(problem, grid, self.max_order)
        if late.any():
            velocity[:, :, late], rate[:, :, late] = trapezoidal_weights(problem, grid, all_orders(self.max_order)[late], sensors)
        return velocity, rate

    @cached_property
    def controlled(self) -> list[int]:
        """Shells with feedback."""
        return [i for i, shell in enumerate(self.problem.shells) if shell.gains is not None]

    @cached_property
    def open_loop(self) -> StructureSpectra:
        """The structure without feedback, on which actuators act as forces like any other."""
        if self.forced.open_loop is None:
            self.forced.open_loop = UnitResponse()
        problem, shared = self.problem.open_loop, self.forced.open_loop
        return StructureSpectra(problem, self.grid, self.max_order, self._progress, shared=self.shared, forced=shared)

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
        if self.forced.kernels_with_voltage is None or self.forced.sensor_rates is None:
            velocity, rates = self.open_loop.step_weights(self.controlled)
            self.forced.sensor_rates = rates
            voltage = voltage_weights(self.problem, rates, self.controlled, self.grid.time_step)
            both = np.concatenate([velocity, voltage])
            self.forced.kernels_with_voltage = KernelTable(both)
            self.open_loop.forced.kernels = KernelTable(both[: velocity.shape[0]])
        return self.forced.kernels_with_voltage, self.forced.sensor_rates

    @cached_property
    def voltage_without_actuators(self) -> FloatArray:
        """Voltages asked for while neither absorbers nor actuators act, shape (controlled, parities, M + 1, T)."""
        bare = self.open_loop
        laws = [voltage_law(self.problem, i, self.grid.nodes, bare.tangential_ratio[i]) for i in self.controlled]
        return np.stack([self.grid.invert(law * bare.linear.normal[i]) for law, i in zip(laws, self.controlled, strict=True)])

    def forced_spectra(self, pressure: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
        """Return the transforms of W and V, sources and modal pressures on the shells together.

        Parameters
        ----------
        pressure : ndarray, shape (shells, parities, M + 1, nodes)
            Transforms of modal pressures, positive inward.
        """
        parities = max(pressure.shape[1], self.linear.normal.shape[1])
        shape = (*pressure.shape[:1], parities, *pressure.shape[2:])
        normal, tangential = np.zeros(shape, np.complex128), np.zeros(shape, np.complex128)
        sources, forced = slice(0, self.linear.normal.shape[1]), slice(0, pressure.shape[1])
        normal[:, sources], tangential[:, sources] = self.linear.normal, self.linear.tangential
        for i in range(shape[0]):
            moved = sum(self.compliance[i, j] * pressure[j] for j in range(shape[0]))
            normal[i, forced] += moved
            tangential[i, forced] += self.tangential_ratio[i] * moved
        return normal, tangential
