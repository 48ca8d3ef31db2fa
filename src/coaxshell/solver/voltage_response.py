"""What voltages on electrodes move, and what the sensors read of it, while no feedback acts.

With V eliminated a voltage of order m on wall j is a normal load f_j = P_w + P_v r_j per volt, r = V/W, and moves V by P_v/A_vv besides:

    W_i = C_ij f_j u_j,      V_i = r_i W_i + (P_v/A_vv) u_i,      phi_i = (S_w + S_v r_i) W_i + (S_v P_v/A_vv) u_i.

At an axial wavenumber U is eliminated with V: f has P_u U/W too, and in the place of P_v/A_vv stands what a voltage moves of both.

Where walls have two faces voltages are no loads on a surface: :mod:`coaxshell.solver.faced_voltages`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.modes import Modes
from coaxshell.solver.coupling import ModalSystem
from coaxshell.solver.faced_voltages import moved_by_voltages, read_of_solids, readings_of_grid, readings_per_volt
from coaxshell.solver.scaling import Problem
from coaxshell.solver.structure_spectra import Moved, StructureSpectra
from coaxshell.structure.control_law import ControlLaw
from coaxshell.structure.electroded_wall import ElectrodedWall, slid_of
from coaxshell.structure.shell_model import Gain, ShellModel

Values = TypeVar("Values", ComplexArray, FloatArray)


def sensed_of(wall: ShellModel, modes: Modes) -> Gain:
    """Return what the sensors of a wall read per unit (V, W), volts."""
    return wall.sensor_gain(modes)


@dataclass(frozen=True)
class VoltageResponse:
    """Answers of the walls under control to voltages at some orders and nodes.

    Attributes
    ----------
    shells : tuple of int
        Those under control.
    load : ndarray, shape (controlled, orders, nodes)
        f: normal load per volt; nothing where walls have two faces.
    slid : ndarray, same shape
        P_v/A_vv: V per volt where W is held.
    read : ndarray, shape (controlled, controlled, orders, nodes)
        Volts read on one wall per volt on another.
    slid_axially : ndarray or None
        U per volt where W is held, of the shape of ``slid``; None where nothing moves along the axis.
    """

    shells: tuple[int, ...]
    load: ComplexArray
    slid: ComplexArray
    read: ComplexArray
    slid_axially: ComplexArray | None = None

    @classmethod
    def of(
        cls,
        problem: Problem,
        modes: Modes,
        s: ComplexArray,
        compliance: ComplexArray,
        ratio: Sequence[ComplexArray],
        reading: Callable[[ShellModel, Modes], Gain] = sensed_of,
        axial: Sequence[ComplexArray | None] | None = None,
    ) -> VoltageResponse:
        """Return it from the compliance C_ij (shells, shells, orders, nodes), V/W and U/W of each wall, without feedback.

        What is read is that of the sensors, or another *reading* of each wall.
        """
        shells = controlled(problem)
        walls, shape = [problem.shells[i] for i in shells], (modes.count, s.size)
        per_w = [(ratio[i], None if axial is None else axial[i]) for i in shells]
        slides = [slid_of(wall, modes, s) for wall in walls]
        slid = np.stack([np.broadcast_to(v, shape) for v, _ in slides])
        drives = [wall.drive(modes).columns.recovered(*each) for wall, each in zip(walls, per_w, strict=True)]
        load = np.stack([np.broadcast_to(one, shape) for one in drives])
        gains = [reading(wall, modes).columns for wall in walls]
        sensed = np.stack([gain.recovered(*each) for gain, each in zip(gains, per_w, strict=True)])
        read = np.empty((len(shells), len(shells), *load.shape[1:]), np.complex128)
        for a, i in enumerate(shells):
            for b, j in enumerate(shells):
                np.multiply(sensed[a] * load[b], compliance[i, j], out=read[a, b])
            read[a, a] += gains[a].v * slid[a]
        if modes.two_dimensional:
            return cls(shells, load, slid, read)
        axially = np.stack([np.zeros(shape, np.complex128) if u is None else np.broadcast_to(u, shape) for _, u in slides])
        for a, gain in enumerate(gains):
            if gain.u is not None:
                read[a, a] += gain.u * axially[a]
        return cls(shells, load, slid, read, axially)

    @classmethod
    def of_faces(cls, shells: tuple[int, ...], read: ComplexArray) -> VoltageResponse:
        """Return it from what is read, where walls have two faces."""
        nothing = np.zeros((0, *read.shape[2:]), np.complex128)
        return cls(shells, nothing, nothing, read)

    @classmethod
    def at(
        cls,
        passive: Problem,
        controls: Problem,
        modes: Modes,
        s: ComplexArray,
        reading: Callable[[ShellModel, Modes], Gain] = sensed_of,
    ) -> VoltageResponse:
        """Return it at any nodes; ``passive`` is the problem ``controls`` without its feedback."""
        if passive.two_faced:
            shells = controlled(controls)
            return cls.of_faces(shells, readings_per_volt(passive, shells, modes, s))
        system = ModalSystem(passive, s, modes)
        return cls.of_system(system, controls, system.compliance(), reading)

    @classmethod
    def of_system(
        cls,
        system: ModalSystem,
        controls: Problem,
        compliance: ComplexArray,
        reading: Callable[[ShellModel, Modes], Gain] = sensed_of,
    ) -> VoltageResponse:
        """Return it from walls and fluids without feedback, at their modes and nodes."""
        tangential, axial = [wall.tangential for wall in system.shells], [wall.axial for wall in system.shells]
        return cls.of(controls, system.modes, system.s, compliance, tangential, reading, axial)


def controlled(problem: Problem) -> tuple[int, ...]:
    """Return the walls with feedback, by number."""
    return tuple(i for i, wall in enumerate(problem.shells) if wall.gains is not None)


def electroded(problem: Problem, shell: int) -> ElectrodedWall:
    """Return a wall under control by electrodes."""
    wall = problem.shells[shell]
    assert isinstance(wall, ElectrodedWall)
    return wall


def gains_of_wall(problem: Problem, shell: int) -> ControlLaw:
    """Return the law of a wall under control."""
    law = problem.shells[shell].gains
    assert law is not None
    return law


def of_all(problem: Problem, response: VoltageResponse, values: Values) -> Values:
    """Return values of the walls under control, (controlled, ...), as those of all shells, 0 of the others."""
    every = np.zeros((len(problem.shells), *values.shape[1:]), values.dtype)
    every[list(response.shells)] = values
    return every


def response_of(structure: StructureSpectra, reading: Callable[[ShellModel, Modes], Gain] = sensed_of) -> VoltageResponse:
    """Return the answers to voltages at the orders and nodes of a run."""
    bare, shells = structure.open_loop, controlled(structure.problem)
    if structure.problem.two_faced:
        return VoltageResponse.of_faces(shells, readings_of_grid(bare.problem, shells, bare.modes, bare.grid))
    known = structure.problem, structure.modes, structure.grid.nodes, bare.compliance, list(bare.tangential_ratio)
    return VoltageResponse.of(*known, reading)


def read_without(structure: StructureSpectra, reading: Callable[[ShellModel, Modes], Gain] = sensed_of) -> ComplexArray:
    """Return what the sensors read of the motion without voltages, V, (controlled, parities, M + 1, nodes)."""
    bare = structure.open_loop
    return read_of(structure, Moved(bare.normal, bare.tangential, bare.solid), reading)


def read_of(structure: StructureSpectra, moved: Moved, reading: Callable[[ShellModel, Modes], Gain] = sensed_of) -> ComplexArray:
    """Return what the sensors read of a motion, V, (controlled, parities, M + 1, nodes)."""
    if moved.solid is not None:
        return read_of_solids(structure.open_loop.problem, controlled(structure.problem), moved.solid, structure.modes)
    gains = [(i, reading(structure.problem.shells[i], structure.modes).columns) for i in controlled(structure.problem)]
    return np.stack([gain.v * moved.tangential[i] + gain.w * moved.normal[i] for i, gain in gains])


def driven(structure: StructureSpectra, response: VoltageResponse, voltage: ComplexArray, beside: ComplexArray | None = None) -> Moved:
    """Return the motion under the sources, voltages in orders, V, and modal pressures *beside*, shape (shells, parities, M + 1, nodes)."""
    bare = structure.open_loop
    if bare.solid is not None:
        whole = bare.solid.plus(moved_by_voltages(bare.problem, bare.grid, bare.modes, voltage))
        return Moved(whole.normal, whole.tangential, whole)
    pressure = np.zeros_like(voltage)
    for load, i in zip(response.load, response.shells, strict=True):
        pressure[i] = load * voltage[i]
    if beside is not None:
        pressure[:, : beside.shape[1]] += beside
    moved = bare.forced_spectra(pressure)
    for slid, i in zip(response.slid, response.shells, strict=True):
        moved.tangential[i, : voltage.shape[1]] += slid * voltage[i]
    return moved
