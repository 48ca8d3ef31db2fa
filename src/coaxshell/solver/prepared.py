"""Prepare once, solve many: everything about shells, fluids, sources and feedback that does not depend on the absorbers."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from coaxshell.acoustics.bessel_ratios import ComplexArray
from coaxshell.acoustics.laplace_grid import LaplaceGrid
from coaxshell.acoustics.operators import FloatArray
from coaxshell.solver.history import KernelTable
from coaxshell.solver.kernels import velocity_weights, voltage_law, voltage_weights
from coaxshell.solver.scaling import Problem
from coaxshell.solver.spectral import LinearSpectra, Progress, linear_spectra


class PreparedStructure:
    """Linear response and compliance of one structure under its sources, computed when first needed and kept.

    Parameters
    ----------
    problem : Problem
        Its absorbers are ignored here.
    grid : LaplaceGrid
    max_order : int
    """

    def __init__(self, problem: Problem, grid: LaplaceGrid, max_order: int, progress: Progress | None = None) -> None:
        self.problem, self.grid, self.max_order = problem, grid, max_order
        self._progress = progress

    @cached_property
    def _with_compliance(self) -> LinearSpectra:
        return linear_spectra(self.problem, self.grid, self.max_order, self._progress, compliance=True)

    @cached_property
    def _sources_alone(self) -> LinearSpectra:
        return linear_spectra(self.problem, self.grid, self.max_order, self._progress)

    @property
    def linear(self) -> LinearSpectra:
        """Transforms of the response without absorbers."""
        return self._with_compliance if "_with_compliance" in self.__dict__ else self._sources_alone

    @property
    def compliance(self) -> ComplexArray:
        """C_ij, shape (shells, shells, M + 1, nodes)."""
        compliance = self._with_compliance.compliance
        assert compliance is not None
        return compliance

    @property
    def tangential_ratio(self) -> ComplexArray:
        """V/W, shape (shells, M + 1, nodes)."""
        ratio = self._with_compliance.ratio
        assert ratio is not None
        return ratio

    @cached_property
    def linear_displacement(self) -> FloatArray:
        """W without absorbers, shape (shells, halves, M + 1, T)."""
        return self.grid.invert(self.linear.normal)

    @cached_property
    def linear_velocity(self) -> FloatArray:
        """dW/dt without absorbers, shape (shells, halves, M + 1, T)."""
        return self.grid.invert(self.linear.normal * self.grid.nodes)

    @cached_property
    def kernels(self) -> KernelTable:
        """Step weights of the velocity kernels, ready for history sums."""
        return KernelTable(velocity_weights(self.problem, self.grid, self.compliance))

    @cached_property
    def controlled(self) -> list[int]:
        """Shells with feedback."""
        return [i for i, shell in enumerate(self.problem.shells) if shell.gains is not None]

    @cached_property
    def kernels_with_voltage(self) -> KernelTable:
        """The same, with the voltages asked for on the controlled shells as further outputs."""
        voltage = voltage_weights(self.problem, self.grid, self.compliance, self.tangential_ratio, self.controlled)
        return KernelTable(np.concatenate([velocity_weights(self.problem, self.grid, self.compliance), voltage]))

    @cached_property
    def linear_voltage(self) -> FloatArray:
        """Voltages asked for without absorbers or saturation, shape (controlled, halves, M + 1, T)."""
        laws = [voltage_law(self.problem, i, self.grid.nodes, self.tangential_ratio[i]) for i in self.controlled]
        return np.stack([self.grid.invert(law * self.linear.normal[i]) for law, i in zip(laws, self.controlled, strict=True)])

    def forced_spectra(self, pressure: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
        """Return the transforms of W and V, sources and modal pressures on the shells together.

        Parameters
        ----------
        pressure : ndarray, shape (shells, halves, M + 1, nodes)
            Transforms of modal pressures, positive inward.
        """
        halves = max(pressure.shape[1], self.linear.normal.shape[1])
        shape = (*pressure.shape[:1], halves, *pressure.shape[2:])
        normal, tangential = np.zeros(shape, np.complex128), np.zeros(shape, np.complex128)
        sources, forced = slice(0, self.linear.normal.shape[1]), slice(0, pressure.shape[1])
        normal[:, sources], tangential[:, sources] = self.linear.normal, self.linear.tangential
        for i in range(shape[0]):
            moved = sum(self.compliance[i, j] * pressure[j] for j in range(shape[0]))
            normal[i, forced] += moved
            tangential[i, forced] += self.tangential_ratio[i] * moved
        return normal, tangential
