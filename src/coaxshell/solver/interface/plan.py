"""What a march is made from: constants of the interface, and the motion without it. Nothing here changes while it marches."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.convolution import HistorySum, KernelTable
from coaxshell.solver.interface.absorbers import AbsorberSet, InterfacePoints, PointsAlone
from coaxshell.solver.interface.block_response import LinkConstants, block_response, block_toeplitz
from coaxshell.solver.interface.laws import CubicSprings, InterfaceLaw, SpringsAndActuators
from coaxshell.solver.interface.newton import ImplicitStep
from coaxshell.solver.interface.relaxation import Relaxation
from coaxshell.solver.interface.saturation import LimitedVoltages, voltage_limit
from coaxshell.solver.structure_spectra import StructureSpectra

_LONGEST_BLOCK = 32
_BLOCK_UNKNOWNS = 512
"""Unknowns of a block: above, its matrices leave the processor's cache."""


@dataclass(frozen=True)
class Actuators:
    """Limited actuators: their voltages are unknowns in units of their limits.

    Attributes
    ----------
    shells : int
        Of the structure.
    controlled : list of int
        Shells with an actuator that may saturate; empty if none does.
    parities, modes : int
    limits : ndarray, shape (controlled,)
        Volt.
    full_pressure : ndarray, shape (controlled,)
        Pressure at the limit.
    """

    shells: int
    controlled: list[int]
    parities: int
    modes: int
    limits: FloatArray
    full_pressure: FloatArray

    @property
    def amplitudes(self) -> int:
        """Modal voltages of all controlled shells."""
        return len(self.controlled) * self.parities * self.modes

    def pressure(self, volts: FloatArray) -> FloatArray:
        """Return modal pressures (shells, parities, M + 1, ...) of voltages given (amplitudes, ...)."""
        pressure = np.zeros((self.shells, self.parities, self.modes, *volts.shape[1:]))
        parts = volts.reshape(len(self.controlled), self.parities, self.modes, *volts.shape[1:])
        for part, shell, scale in zip(parts, self.controlled, self.full_pressure, strict=True):
            pressure[shell] = scale * part
        return pressure

    def of_limits(self, volts: FloatArray) -> FloatArray:
        """Return modal voltages (controlled, parities, M + 1, T) in units of the limits."""
        return volts / self.limits[:, None, None, None]


@dataclass(frozen=True)
class MotionWithout:
    """The motion that the forces of a march are added to, at every step.

    Attributes
    ----------
    displacement, velocity : ndarray, shape (T, 2, N)
        Of the points without absorbers.
    demanded_voltage : ndarray, shape (T, amplitudes)
        Asked for without absorbers or actuators, in units of the limits.
    """

    displacement: FloatArray
    velocity: FloatArray
    demanded_voltage: FloatArray

    def __getitem__(self, block: slice) -> MotionWithout:
        return MotionWithout(self.displacement[block], self.velocity[block], self.demanded_voltage[block])

    @property
    def steps(self) -> int:
        """Number of steps, T of the whole run."""
        return int(self.displacement.shape[0])


@dataclass(frozen=True)
class MarchPlan:
    """Constants of one march. Unknown at a step are the stretches of the links, then the voltages asked for: z.

    Attributes
    ----------
    points : InterfacePoints or PointsAlone
    actuators : Actuators
    links : LinkConstants
    kernels : HistorySum
        Velocities, then voltages, of the modal pressures so far.
    length : int
        Steps of a block.
    rows : ndarray, shape (length * unknowns, length * unknowns)
        z at the steps of a block per input there: b of the links, then the voltages given.
    earlier : list of ndarray
        For every step of a block its part of ``rows``, from the inputs of the steps before it.
    force_of_input, mass_velocity_of_input : ndarray
        The links' forces and the masses' velocities at the steps of a block, per the same inputs.
    integral : ndarray, shape (length, length)
        The trapezoidal rule from velocities to displacements.
    law : InterfaceLaw
    voltages : LimitedVoltages
        Its part for the actuators.
    newton : ImplicitStep
    relaxation : Relaxation
    """

    points: InterfacePoints | PointsAlone
    actuators: Actuators
    links: LinkConstants
    kernels: HistorySum
    length: int
    rows: FloatArray
    earlier: list[FloatArray]
    force_of_input: FloatArray
    mass_velocity_of_input: FloatArray
    integral: FloatArray
    law: InterfaceLaw[Any]
    voltages: LimitedVoltages
    newton: ImplicitStep
    relaxation: Relaxation

    @property
    def count(self) -> int:
        """Number N of the absorbers."""
        return self.links.count

    @property
    def unknowns(self) -> int:
        """Number of unknowns of a step: 2 N stretches and the amplitudes of the voltages."""
        return 2 * self.count + self.actuators.amplitudes

    @property
    def time_step(self) -> float:
        """Step of the march, transits."""
        return 2.0 * self.links.half_step


def march_plan(structure: StructureSpectra, absorbers: AbsorberSet, *, saturate: bool = False) -> MarchPlan:
    """Return the constants of a march of some absorbers, and of the structure's actuators if they *saturate*."""
    points = structure.points(absorbers)
    table = structure.kernels_with_voltage if saturate else structure.kernels
    actuators = actuators_of(structure, points, structure.controlled if saturate else [])
    length = _block_length(2 * absorbers.count + actuators.amplitudes)
    kernels = table.kernels[: points.surfaces, ..., :length]
    length = kernels.shape[-1]
    of_forces = np.stack([points.immediate(kernels[..., lag]) for lag in range(length)])
    links = LinkConstants.of(absorbers, np.diag(of_forces[0]), structure.grid.time_step)
    actuation = actuators.pressure(np.eye(actuators.amplitudes))
    moved = np.zeros((length, points.count, actuators.amplitudes))
    for lag in range(length if actuators.controlled else 0):
        moved[lag] = points.evaluate(answer_of(kernels[..., lag], actuation))
    response = block_response(links, of_forces, moved)
    unknowns = np.concatenate([response.stretch, _voltages(points, actuators, table, response.force, actuation)], axis=1)
    rows, size = block_toeplitz(unknowns), unknowns.shape[1]
    springs = CubicSprings(np.tile(absorbers.cubic, 2), np.tile(links.auxiliary_stiffness, 2))
    voltages = LimitedVoltages(len(actuators.controlled), points.parities, points.modes)
    law: InterfaceLaw[Any] = SpringsAndActuators(springs, 2 * absorbers.count, voltages) if actuators.controlled else springs
    return MarchPlan(
        points=points,
        actuators=actuators,
        links=links,
        kernels=HistorySum(table, points.parities),
        length=length,
        rows=rows,
        earlier=[rows[step * size : (step + 1) * size, : step * size] for step in range(length)],
        force_of_input=block_toeplitz(response.force),
        mass_velocity_of_input=block_toeplitz(response.mass_velocity),
        integral=links.half_step * (2.0 * np.tri(length, k=-1) + np.eye(length)),
        law=law,
        voltages=voltages,
        newton=ImplicitStep(unknowns[0], law),
        relaxation=Relaxation(rows, size, springs),
    )


def motion_without(
    structure: StructureSpectra, absorbers: AbsorberSet, points: InterfacePoints | PointsAlone, actuators: Actuators
) -> MotionWithout:
    """Return the motion of a structure that the forces of a march are added to: without feedback if actuators saturate."""
    moved = structure.open_loop if actuators.controlled else structure
    steps = structure.grid.time.size
    displacement, velocity = (np.ascontiguousarray(x.T).reshape(steps, 2, absorbers.count) for x in moved.motion_at(points))
    demanded = demanded_voltage(structure, actuators)
    return MotionWithout(displacement, velocity, np.ascontiguousarray(demanded.reshape(-1, steps).T))


def demanded_voltage(structure: StructureSpectra, actuators: Actuators) -> FloatArray:
    """Return what is asked for without absorbers or actuators, in units of the limits, shape (controlled, parities, M + 1, T)."""
    demanded = np.zeros((len(actuators.controlled), actuators.parities, actuators.modes, structure.grid.time.size))
    if actuators.controlled:
        volts = structure.voltage_without_actuators
        demanded[:, : volts.shape[1]] = actuators.of_limits(volts)
    return demanded


def _block_length(unknowns: int) -> int:
    length = _LONGEST_BLOCK
    while length > 1 and length * unknowns > _BLOCK_UNKNOWNS:
        length //= 2
    return length


def actuators_of(structure: StructureSpectra, points: InterfacePoints | PointsAlone, controlled: list[int]) -> Actuators:
    """Return the limited actuators of the controlled shells of a structure."""
    limits = np.array([voltage_limit(structure.problem, i) for i in controlled])
    full = np.array([structure.problem.shells[i].actuator_pressure for i in controlled]) * limits
    return Actuators(points.surfaces, controlled, points.parities, points.modes, limits, full)


def _voltages(
    points: InterfacePoints | PointsAlone, actuators: Actuators, table: KernelTable, force: FloatArray, actuation: FloatArray
) -> FloatArray:
    """Return the voltages asked for, in units of the limits, per unit input: shape (lags, amplitudes, inputs)."""
    lags, _, columns = force.shape
    found = np.zeros((lags, actuators.amplitudes, columns))
    if not actuators.controlled:
        return found
    pressures = [points.project(f) for f in force]
    pressures[0][..., columns - actuation.shape[-1] :] += actuation
    for lag in range(lags):
        volts = sum(answer_of(table.kernels[points.surfaces :, ..., k], pressures[lag - k]) for k in range(lag + 1))
        found[lag] = actuators.of_limits(np.asarray(volts)).reshape(-1, columns)
    return found


def answer_of(kernels: FloatArray, pressure: FloatArray) -> FloatArray:
    """Return what modal pressures (shells, parities, M + 1, ...) cause through one weight per mode, (outputs, shells, M + 1)."""
    return np.asarray(np.einsum("ijm,jhm...->ihm...", kernels, pressure))
