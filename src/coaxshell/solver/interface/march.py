"""The interface march: absorbers with any force law and saturating actuators, one small implicit solve a step.

Unknown are only the stretches D of the links and, where actuators saturate, the voltages asked for, together z. The shells and fluids
enter through their velocity kernels,

    dw/dt = (dw/dt)_linear + k * p,

summed by product integration; springs and masses are stepped by the trapezoidal rule. The step weights keep the positive real
part of the kernel and the trapezoidal rule keeps energy, so no step is unstable, however stiff or damped the absorbers. Where
actuators saturate the kernels are those without feedback, and the voltages given, clip(u), are forces like those of the links: a
law between 0 and 1 times that of the linear feedback, on a passive structure.

Time is worked through in blocks of a few steps. What came before a block, and what is linear in it, is summed for all its steps at
once; step by step remains z_n = z_known + sum_l Z_l n(z_{n-l}), n(z) what the nonlinear laws add to the linear ones. Where springs are
soft on the scale of a step, several steps are solved together instead.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from coaxshell.errors import InputError
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.convolution import HistorySum
from coaxshell.numerics.progress import Progress
from coaxshell.solver.interface.absorbers import AbsorberSet
from coaxshell.solver.interface.block_response import LinkConstants, block_response, block_toeplitz
from coaxshell.solver.interface.laws import CubicSprings, SpringsAndActuators
from coaxshell.solver.interface.newton import ConvergenceError, ImplicitStep
from coaxshell.solver.interface.relaxation import Relaxation
from coaxshell.solver.interface.saturation import LimitedVoltages, voltage_limit
from coaxshell.solver.prepared import StructureSpectra

_LONGEST_BLOCK = 32
_BLOCK_UNKNOWNS = 512
"""Unknowns of a block: above, its matrices leave the processor's cache."""


@dataclass(frozen=True)
class MarchResult:
    """Histories of one march, dimensionless.

    Attributes
    ----------
    force : ndarray, shape (2N, T)
        Line forces at the interface points, positive inward.
    mass_displacement : ndarray, shape (N, T)
        q.
    modal_pressure : ndarray, shape (shells, parities, M + 1, T)
        Of links and saturating actuators together, on every shell; the forces themselves where points march alone.
    actuation : ndarray, same shape, or None
        Of the actuators' share in it, where they saturate.
    saturated : bool
        Whether any actuator reached its limit.
    iterations : int
        Of all steps, each step's own.
    """

    force: FloatArray
    mass_displacement: FloatArray
    modal_pressure: FloatArray
    actuation: FloatArray | None
    saturated: bool
    iterations: int


def march(structure: StructureSpectra, absorbers: AbsorberSet, *, saturate: bool = False, progress: Progress | None = None) -> MarchResult:
    """March the interface over all times of the linear response.

    Parameters
    ----------
    structure : StructureSpectra
    absorbers : AbsorberSet
        May be empty.
    saturate : bool
        Whether actuators stop at their field limit. The motion that the forces are added to is then that without feedback.
    progress : callable, optional

    Raises
    ------
    InputError
        If a step does not converge.
    """
    return _March(structure, absorbers, saturate).run(progress)


class _March:
    """State and constants of one march. Block arrays run over (step, row)."""

    def __init__(self, structure: StructureSpectra, absorbers: AbsorberSet, saturate: bool) -> None:
        self.structure = structure.open_loop if saturate else structure
        self.count, self.controlled = absorbers.count, structure.controlled if saturate else []
        self.points = structure.points(absorbers)
        self.shells, self.parities, self.modes = self.points.shells, self.points.parities, self.points.modes
        self.table = structure.kernels_with_voltage if saturate else structure.kernels
        self.history = HistorySum(self.table, self.parities)
        self.limits = np.array([voltage_limit(structure.problem, i) for i in self.controlled])
        self.full_pressure = np.array([structure.problem.actuator_pressure(i) for i in self.controlled]) * self.limits
        unknowns = 2 * self.count + len(self.controlled) * self.parities * self.modes
        self.length = _LONGEST_BLOCK
        while self.length > 1 and self.length * unknowns > _BLOCK_UNKNOWNS:
            self.length //= 2
        self._links(absorbers)
        self._linear_motion(structure)

    def _links(self, absorbers: AbsorberSet) -> None:
        """Prepare the answers within a block and the implicit step."""
        kernels = self.table.kernels[: self.shells, ..., : self.length]
        of_forces = np.stack([self.points.immediate(kernels[..., lag]) for lag in range(kernels.shape[-1])])
        step = self.structure.grid.time_step
        self.links = LinkConstants.of(absorbers, np.diag(of_forces[0]), step)
        actuation = self._actuation(np.eye(len(self.controlled) * self.parities * self.modes))
        moved = np.stack([self.points.evaluate(_answer(kernels[..., lag], actuation)) for lag in range(kernels.shape[-1])])
        response = block_response(self.links, of_forces, moved)
        unknowns = np.concatenate([response.stretch, self._voltages(response.force, actuation)], axis=1)
        self.rows = block_toeplitz(unknowns)
        size = unknowns.shape[1]
        self.earlier = [self.rows[step * size : (step + 1) * size, : step * size] for step in range(unknowns.shape[0])]
        self.force_of_input = block_toeplitz(response.force)
        self.mass_velocity_of_input = block_toeplitz(response.mass_velocity)
        springs = CubicSprings(np.tile(absorbers.cubic, 2), np.tile(self.links.auxiliary_stiffness, 2))
        self.voltages = LimitedVoltages(len(self.controlled), self.parities, self.modes)
        law = SpringsAndActuators(springs, 2 * self.count, self.voltages) if self.controlled else springs
        self.law, self.newton = law, ImplicitStep(unknowns[0], law)
        self.relaxation = Relaxation(self.rows, size, springs)
        self.relaxing = self.relaxation.steps > 1 and not self.controlled
        half, length = self.links.half_step, kernels.shape[-1]
        self.integral = half * (2.0 * np.tri(length, k=-1) + np.eye(length))

    def _voltages(self, force: FloatArray, actuation: FloatArray) -> FloatArray:
        """Return the voltages asked for, in units of the limits, per unit input: shape (lags, amplitudes, inputs)."""
        lags, _, columns = force.shape
        found = np.zeros((lags, len(self.controlled) * self.parities * self.modes, columns))
        if not self.controlled:
            return found
        pressures = [self.points.project(f) for f in force]
        pressures[0][..., columns - actuation.shape[-1] :] += actuation
        for lag in range(lags):
            volts = sum(_answer(self.table.kernels[self.shells :, ..., k], pressures[lag - k]) for k in range(lag + 1))
            found[lag] = (volts / self.limits[:, None, None, None]).reshape(-1, columns)
        return found

    def _actuation(self, volts: FloatArray) -> FloatArray:
        """Return modal pressures (shells, parities, M + 1, ...) of voltages given (amplitudes, ...) in units of their limits."""
        pressure = np.zeros((self.shells, self.parities, self.modes, *volts.shape[1:]))
        parts = volts.reshape(len(self.controlled), self.parities, self.modes, *volts.shape[1:])
        for part, shell, scale in zip(parts, self.controlled, self.full_pressure, strict=True):
            pressure[shell] = scale * part
        return pressure

    def _linear_motion(self, structure: StructureSpectra) -> None:
        """Sample the motion, and where actuators saturate the voltages asked for, that the forces are added to: shape (T, rows)."""
        self.linear_displacement = self._by_step(self.points.evaluate(self.structure.linear_displacement))
        self.linear_velocity = self._by_step(self.points.evaluate(self.structure.linear_velocity))
        steps = structure.grid.time.size
        demanded_voltage = np.zeros((len(self.controlled), self.parities, self.modes, steps))
        if self.controlled:
            volts = structure.voltage_without_actuators
            demanded_voltage[:, : volts.shape[1]] = volts / self.limits[:, None, None, None]
        self.demanded_voltage = np.ascontiguousarray(demanded_voltage.reshape(-1, steps).T)

    def _by_step(self, histories: FloatArray) -> FloatArray:
        return np.ascontiguousarray(histories.T).reshape(histories.shape[-1], 2, self.count)

    def run(self, progress: Progress | None) -> MarchResult:
        """Return the histories of all steps; the first instant is at rest."""
        steps, n = self.structure.grid.time.size, self.count
        force, mass, volts = np.zeros((steps, 2, n)), np.zeros((steps, n)), np.zeros((steps, self.demanded_voltage.shape[1]))
        pressure = np.zeros((self.shells, self.parities, self.modes, steps))
        state = BlockState(*np.zeros((3, 2, n)), *np.zeros((2, n)))
        for start in range(1, steps, self.length):
            block = slice(start, min(start + self.length, steps))
            count = block.stop - start
            state, force[block], mass[block], volts[block] = self._block(block, state)
            pressure[..., block] = self._pressure(force[block].reshape(count, -1).T, volts[block].T)
            own = self.points.evaluate(self.history.push(pressure[..., block])[: self.shells]).T.reshape(count, 2, n)
            state = state.moved(own, self.integral[count - 1, :count])
            if progress is not None:
                progress(block.stop / steps, "interface march")
        actuation = self._actuation(volts.T) if self.controlled else None
        iterations = self.newton.iterations + self.relaxation.iterations
        return MarchResult(force.reshape(steps, -1).T, mass.T, pressure, actuation, self.voltages.saturated, iterations)

    def _pressure(self, force: FloatArray, volts: FloatArray) -> FloatArray:
        pressure = self.points.project(force)
        return pressure + self._actuation(volts) if self.controlled else pressure

    def _block(self, block: slice, state: BlockState) -> tuple[BlockState, FloatArray, FloatArray, FloatArray]:
        """Solve one block from the state before it.

        Returns the state at its end, but for what its own forces move, the forces, the masses' displacements and the voltages given.
        """
        n, half, count = self.count, self.links.half_step, block.stop - block.start
        integral = self.integral[:count, :count]
        history_forcing = self.history.forcing(count)
        excited = self.points.evaluate(history_forcing[: self.shells]).T
        free_w = integral @ excited
        excited, free_w = excited.reshape(count, 2, n), free_w.reshape(count, 2, n) + (state.displacement + half * state.velocity)
        free_u = state.mass_velocity - self.links.mobility * state.force.sum(axis=0)
        free_q = state.mass_displacement + half * state.mass_velocity + integral.sum(axis=1)[:, None] * free_u
        free_stretch = free_q[:, None] - self.linear_displacement[block] - free_w
        drive = self.links.damping * (free_u - self.linear_velocity[block] - excited) + self.links.stiffness * free_stretch
        added = self._march(block, history_forcing, free_stretch.reshape(count, -1), drive.reshape(count, -1))
        added[:, : 2 * n] += drive.reshape(count, -1)
        flat = added.ravel()
        force = (self.force_of_input[: 2 * n * count, : flat.size] @ flat).reshape(count, 2, n)
        u = (self.mass_velocity_of_input[: n * count, : flat.size] @ flat).reshape(count, n)
        mass = free_q + integral @ u
        return BlockState(force[-1], free_w[-1], excited[-1], mass[-1], free_u + u[-1]), force, mass, added[:, 2 * n :]

    def _march(self, block: slice, history_forcing: FloatArray, free_stretch: FloatArray, drive: FloatArray) -> FloatArray:
        """Return n(z) at the steps of a block, shape (steps, unknowns)."""
        count, n = block.stop - block.start, self.count
        demanded_voltage = self.demanded_voltage[block]
        if self.controlled:
            volts = history_forcing[self.shells :] / self.limits[:, None, None, None]
            demanded_voltage = demanded_voltage + volts.reshape(-1, count).T
        added = np.zeros((count, self.demanded_voltage.shape[1] + 2 * n))
        added[:, : 2 * n] = drive
        known = np.concatenate([free_stretch, demanded_voltage], axis=1)
        size = known.size
        known += (self.rows[:size, :size] @ added.ravel()).reshape(known.shape)
        done = self._relax_steps(known, added)
        flat = added.ravel()
        for step in range(done, count):
            earlier = self.earlier[step]
            z = self._solve(known[step] + earlier @ flat[: earlier.shape[1]] if step else known[step])
            added[step] = self.law.nonlinear_part(z)
        return added

    def _relax_steps(self, known: FloatArray, added: FloatArray) -> int:
        """Fill in n(z) of the first steps, several at once; return how many: once it does not pay, no more of this march."""
        flat, size, done = added.ravel(), known.shape[1], 0
        while self.relaxing and done < len(known):
            end = min(done + self.relaxation.steps, len(known))
            part, before = slice(done * size, end * size), slice(0, done * size)
            found = self.relaxation.solve(known[done:end] + (self.rows[part, before] @ flat[before]).reshape(-1, size))
            if found is None:
                self.newton.seed(self.relaxation.last)
                self.relaxing = False
            else:
                added[done:end], done = found, end
        return done

    def _solve(self, known: FloatArray) -> FloatArray:
        try:
            return self.newton.solve(known)
        except ConvergenceError:
            if self.links.auxiliary_stiffness.any():  # no step helps: the tangent is singular wherever both springs pass through rest
                remedy = "give them a linear stiffness, however small, such as 1 kN/m^2, or a mass"
                loose = "without mass, cubic springs alone leave them loose at rest, and their forces did not converge"
                raise InputError("absorbers", loose, remedy) from None
            guilty = [name for name, there in (("absorbers", self.count), ("saturating actuators", self.controlled)) if there]
            coarse = f"steps of {2.0 * self.links.half_step:g} (time_step/refinement) are too coarse for the {' and '.join(guilty)}"
            remedy = "use a quarter of time_step, or four times the refinement"
            raise InputError("time_step", f"{coarse}: their forces did not converge", remedy) from None


@dataclass(frozen=True)
class BlockState:
    """All that one block hands to the next: forces, forced displacement and velocity at the points (2, N), and the masses' (N,)."""

    force: FloatArray
    displacement: FloatArray
    velocity: FloatArray
    mass_displacement: FloatArray
    mass_velocity: FloatArray

    def moved(self, velocity: FloatArray, integral: FloatArray) -> BlockState:
        """Return the state with the velocities (steps, 2, N) that the block's own forces give to the points."""
        displacement = self.displacement + (integral @ velocity.reshape(integral.size, -1)).reshape(self.velocity.shape)
        return replace(self, displacement=displacement, velocity=self.velocity + velocity[-1])


def _answer(kernels: FloatArray, pressure: FloatArray) -> FloatArray:
    """Return what modal pressures (shells, parities, M + 1, ...) cause through one weight per mode, (outputs, shells, M + 1)."""
    return np.asarray(np.einsum("ijm,jhm...->ihm...", kernels, pressure))
