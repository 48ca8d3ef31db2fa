"""Feedback that ties walls or orders to each other, in one wave along the axis (theory manual, "Segments").

Electrodes vary freely along the axis, so that each wavenumber is a system of loops by itself: those of
:mod:`coaxshell.solver.electrode_loops`, of the orders that the wave has. The motion without feedback gives the readings, these the
voltages, and the voltages move the walls besides,

    W_i = W0_i + C_ij f_j u_j,      (V, U)_i = (r_v, r_u)_i W_i + B_i^-1 P_i u_i,

B the stiffness of U and V on each other, P their load per volt (:mod:`coaxshell.structure.axial_feedback`).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import ComplexArray
from coaxshell.numerics.modes import Modes
from coaxshell.solver.coupling import ModalSystem
from coaxshell.solver.electrode_loops import ElectrodeLoops
from coaxshell.solver.electrode_patterns import patterns_of, uneven
from coaxshell.solver.excitation import source_parities
from coaxshell.solver.scaling import Problem
from coaxshell.solver.voltage_response import VoltageResponse, controlled, of_all, sensed_of
from coaxshell.structure.shell_model import Gain, ShellModel
from coaxshell.structure.tied_wall import TiedWall


class Driven(NamedTuple):
    """Motion of all walls with their feedback and the voltages of their actuators, each (shells, parities, orders, nodes)."""

    normal: ComplexArray
    tangential: ComplexArray
    axial: ComplexArray
    voltage: ComplexArray


def motion_parities(problem: Problem) -> int:
    """Return how many parities around the circle walls move in under their sources: both where dead segments tie them."""
    return 2 if uneven(problem, controlled(problem)) else source_parities(problem)


class OpenWave:
    """Walls and fluids in one wave, and what voltages do in it, without feedback.

    Parameters
    ----------
    problem : Problem
    s : ndarray, shape (nodes,)
    modes : Modes

    Attributes
    ----------
    bare : ModalSystem
    response : VoltageResponse
    """

    def __init__(self, problem: Problem, s: ComplexArray, modes: Modes) -> None:
        self._problem, self.bare = problem, ModalSystem(problem.open_loop, s, modes)
        self._compliance = self.bare.compliance()
        self.response = VoltageResponse.of_system(self.bare, problem, self._compliance)

    def readings(self, normal: ComplexArray) -> ComplexArray:
        """Return what the sensors of walls under control read, (walls, parities, orders, nodes), of the W of all shells."""
        return self._read(normal, sensed_of)

    def charges(self, normal: ComplexArray) -> ComplexArray:
        """Return what the charge of strain is over the capacitance of each wall under control, V, likewise."""
        return self._read(normal, charge_of)

    def _read(self, normal: ComplexArray, reading: Callable[[ShellModel, Modes], Gain]) -> ComplexArray:
        ratios = [(wall.tangential, wall.axial) for wall in self.bare.shells]
        gains = [reading(self._problem.shells[i], self.bare.modes).columns.recovered(*ratios[i]) for i in self.response.shells]
        return np.stack([gain * normal[i] for gain, i in zip(gains, self.response.shells, strict=True)])

    def charges_per_volt(self) -> ComplexArray:
        """Return what the charge of each wall under control is over its capacitance, V, per volt on each, (walls, walls, orders, nodes)."""
        return VoltageResponse.of_system(self.bare, self._problem, self._compliance, charge_of).read

    def moved(self, voltage: ComplexArray, normal: ComplexArray | None = None) -> Driven:
        """Return what walls do under voltages, (walls, parities, orders, nodes), besides what W of all shells is without them."""
        response, shape = self.response, (len(self.bare.shells), *voltage.shape[1:])
        moved = np.zeros(shape, np.complex128) if normal is None else normal.copy()
        for load, volts, j in zip(response.load, voltage, response.shells, strict=True):
            moved += self._compliance[:, j, None] * (load * volts)
        tangential = np.stack([wall.tangential * w for wall, w in zip(self.bare.shells, moved, strict=True)])
        axial = np.stack(self.bare.axial(list(moved)))
        for place, i in enumerate(response.shells):
            tangential[i] += response.slid[place] * voltage[place]
            if response.slid_axially is not None:
                axial[i] += response.slid_axially[place] * voltage[place]
        return Driven(moved, tangential, axial, of_all(self._problem, response, voltage))


def charge_of(wall: ShellModel, modes: Modes) -> Gain:
    """Return the charge that strain brings to the actuators of a wall over their capacitance, per unit (V, W, U), V."""
    assert isinstance(wall, TiedWall)
    return wall.charge_voltage(modes)


class TiedWave(OpenWave):
    """The loops of one wave.

    Parameters
    ----------
    problem : Problem
    s : ndarray, shape (nodes,)
    modes : Modes
        All orders from 0 to the highest where electrodes are cut.
    parities : int, optional
        How many the motion has around the circle; as many as under the sources unless given.

    Attributes
    ----------
    loops : ElectrodeLoops
    """

    def __init__(self, problem: Problem, s: ComplexArray, modes: Modes, parities: int = 1) -> None:
        super().__init__(problem, s, modes)
        patterns = patterns_of(problem, self.response.shells, modes.orders, max(parities, motion_parities(problem)))
        self.loops = ElectrodeLoops.of(problem, self.response, patterns, s)

    def driven(self, normal: ComplexArray) -> Driven:
        """Return what walls do with feedback that do W, (shells, parities, orders, nodes), without it."""
        loops = self.loops
        voltage = loops.patterns.in_orders(loops.voltages(loops.patterns.readings(self.readings(normal))))
        return self.moved(voltage[:, : normal.shape[1]], normal)
