"""The interface march: absorbers with any force law and saturating actuators, one small implicit solve a step.

Unknown are only the forces f at the points where absorbers touch shells, the velocities of their masses, and what saturated
actuators lack. The shells and fluids enter through their velocity kernels,

    dw/dt = (dw/dt)_linear + k * p,

summed by product integration; springs and masses are stepped by the trapezoidal rule. The step weights keep the positive real
part of the kernel and the trapezoidal rule keeps energy, so no step is unstable, however stiff or damped the absorbers.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coaxshell.acoustics.operators import FloatArray
from coaxshell.solver.absorbers import AbsorberSet, InterfacePoints
from coaxshell.solver.history import HistorySum
from coaxshell.solver.newton import InterfaceNewton, StepState
from coaxshell.solver.prepared import PreparedStructure
from coaxshell.solver.saturation import SaturatedShell
from coaxshell.solver.spectral import Progress

_REPORT_EVERY = 100
_COUPLING_TOLERANCE = 1e-10
_MAX_COUPLING = 30


@dataclass(frozen=True)
class MarchResult:
    """Histories of one march, dimensionless.

    Attributes
    ----------
    force : ndarray, shape (2N, T)
        Line forces at the interface points, positive inward.
    mass_displacement : ndarray, shape (N, T)
        q.
    modal_pressure : ndarray, shape (shells, halves, M + 1, T)
        Of forces and corrections together, on every shell.
    correction : ndarray, same shape, or None
        Of what saturated actuators lack.
    iterations : int
        Newton iterations in all.
    """

    force: FloatArray
    mass_displacement: FloatArray
    modal_pressure: FloatArray
    correction: FloatArray | None
    iterations: int


def march(structure: PreparedStructure, absorbers: AbsorberSet, *, saturate: bool = False, progress: Progress | None = None) -> MarchResult:
    """March the interface over all times of the linear response.

    Parameters
    ----------
    structure : PreparedStructure
    absorbers : AbsorberSet
        May be empty.
    saturate : bool
        Whether actuators stop at their field limit.
    progress : callable, optional
    """
    return _March(structure, absorbers, saturate).run(progress)


class _March:
    """State and constants of one march."""

    def __init__(self, structure: PreparedStructure, absorbers: AbsorberSet, saturate: bool) -> None:
        self.steps, self.count = structure.grid.time.size, absorbers.count
        self.shells = len(structure.problem.shells)
        self.points = InterfacePoints(structure.problem, absorbers, structure.max_order)
        table = structure.kernels_with_voltage if saturate else structure.kernels
        self.history = HistorySum(table, absorbers.halves)
        self.immediate = table.present
        self.actuators: list[SaturatedShell] = []
        if saturate:
            self.asked = np.zeros((len(structure.controlled), absorbers.halves, *structure.linear_voltage.shape[2:]))
            self.asked[:, : structure.linear_voltage.shape[1]] = structure.linear_voltage
            self.actuators = [
                SaturatedShell(structure.problem, i, table.present[self.shells + row, i], absorbers.halves)
                for row, i in enumerate(structure.controlled)
            ]
        self.state = StepState.at_rest(self.count)
        if self.count:
            self.newton = InterfaceNewton(absorbers, self.points.immediate(table.present), structure.grid.time_step)
            self.displacement = self._by_step(self.points.evaluate(structure.linear_displacement))
            self.velocity = self._by_step(self.points.evaluate(structure.linear_velocity))

    def _by_step(self, histories: FloatArray) -> FloatArray:
        return np.ascontiguousarray(histories.T).reshape(self.steps, 2, self.count)

    def run(self, progress: Progress | None) -> MarchResult:
        """Return the histories of all steps."""
        force, mass = np.zeros((2, self.count, self.steps)), np.zeros((self.count, self.steps))
        correction = np.zeros_like(self.history.inputs) if self.actuators else None
        iterations = 0
        for n in range(self.steps):
            if n > 0:
                lacking, used = self._step(n)
                iterations += used
                pressure = self._forces()
                if correction is not None and lacking is not None:
                    correction[..., n] = lacking
                    pressure = pressure + lacking
                self.history.push(pressure)
            else:
                self.history.push(np.zeros(self.history.inputs.shape[:-1]))
            force[..., n], mass[:, n] = self.state.force, self.state.mass_displacement
            if progress is not None and (n + 1) % _REPORT_EVERY == 0:
                progress((n + 1) / self.steps, "interface march")
        return MarchResult(force.reshape(2 * self.count, self.steps), mass, self.history.inputs, correction, iterations)

    def _forces(self) -> FloatArray:
        return self.points.project(self.state.force.ravel())

    def _step(self, n: int) -> tuple[FloatArray | None, int]:
        """Advance to step n; return the corrections' modal pressure and the Newton iterations used."""
        promised = self.history.present()
        if not self.actuators:
            return None, self._absorbers(n, promised[: self.shells], self.state)
        lacking = np.zeros(self.history.inputs.shape[:-1])
        iterations, before = 0, self.state
        for _ in range(_MAX_COUPLING):
            if self.count:
                self.state = before.copy()
                velocity = promised[: self.shells] + np.einsum("ijm,jhm->ihm", self.immediate[: self.shells], lacking)
                iterations += self._absorbers(n, velocity, self.state)
            update = self._corrections(n, promised, self._forces())
            change = float(np.abs(update - lacking).max())
            lacking = update
            if not self.count or change <= _COUPLING_TOLERANCE * max(float(np.abs(lacking).max()), 1e-30):
                break
        return lacking, iterations

    def _absorbers(self, n: int, velocity: FloatArray, state: StepState) -> int:
        excited = self.points.evaluate(velocity).reshape(2, self.count)
        return self.newton.step(state, excited, self.displacement[n], self.velocity[n])

    def _corrections(self, n: int, promised: FloatArray, forces: FloatArray) -> FloatArray:
        """Return the modal pressures of the corrections, given the absorbers' forces of this step."""
        lacking = np.zeros_like(forces)
        for row, actuator in enumerate(self.actuators):
            output = self.shells + row
            asked = self.asked[row, ..., n] + promised[output] + np.einsum("jm,jhm->hm", self.immediate[output], forces)
            lacking[actuator.index] = actuator.correction(asked)
        return lacking
