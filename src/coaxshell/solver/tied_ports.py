"""How pressures on the surfaces of walls are read by electrodes and how voltages move the surfaces, order by order, without feedback.

Where walls are thin both are shares of the compliance: with sigma what the sensors read per W and f the normal load per volt,
sigma_a C_aj and C_ib f_b. A pressure on one face of an elastic wall is heard otherwise than one on the other, and its actuators push
the faces apart too: there both come out of the cascade of walls and fluids (:mod:`coaxshell.solver.faced_voltages`).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import ComplexArray
from coaxshell.numerics.modes import Modes
from coaxshell.solver.faced_forces import surfaces_of
from coaxshell.solver.scaling import Problem
from coaxshell.solver.solid_spectra import FacedSystem
from coaxshell.solver.voltage_response import VoltageResponse, controlled, sensed_of


class TiedPorts(NamedTuple):
    """What loads and voltages do without feedback, at some orders and nodes.

    Attributes
    ----------
    response : VoltageResponse
        Volts read per volt.
    compliance : ndarray, shape (surfaces, surfaces, orders, nodes)
        C_ij, displacement of surface i per modal pressure on surface j.
    heard : ndarray, shape (controlled, surfaces, orders, nodes)
        Volts read on a wall per modal pressure on a surface.
    moved : ndarray, shape (surfaces, controlled, orders, nodes)
        Displacement of a surface per volt on a wall.
    """

    response: VoltageResponse
    compliance: ComplexArray
    heard: ComplexArray
    moved: ComplexArray

    @classmethod
    def of_thin(cls, problem: Problem, modes: Modes, s: ComplexArray, compliance: ComplexArray, ratio: ComplexArray) -> TiedPorts:
        """Return them from the compliance and V/W, (shells, orders, nodes), of thin walls; *problem* has its feedback."""
        response = VoltageResponse.of(problem, modes, s, compliance, list(ratio))
        sensed = [sensed_of(problem.shells[i], modes).columns.recovered(ratio[i]) for i in response.shells]
        heard = np.stack([one * compliance[i] for one, i in zip(sensed, response.shells, strict=True)])
        moved = np.stack([compliance[:, i] * load for load, i in zip(response.load, response.shells, strict=True)], axis=1)
        return cls(response, compliance, heard, moved)

    @classmethod
    def of_faces(cls, problem: Problem, passive: Problem, modes: Modes, s: ComplexArray) -> TiedPorts:
        """Return them of walls some of which have two faces; *passive* is *problem* without its feedback, its walls resolve the nodes."""
        shells, surfaces, each = controlled(problem), passive.surfaces, (modes.count, s.size)
        system, count = FacedSystem(passive, s, modes), len(surfaces)
        compliance, heard = np.empty((count, count, *each), np.complex128), np.empty((len(shells), count, *each), np.complex128)
        moved, read = np.empty((count, len(shells), *each), np.complex128), np.empty((len(shells), len(shells), *each), np.complex128)
        for j, surface in enumerate(surfaces):
            answers = system.under_force(surface, 1.0)
            compliance[:, j] = surfaces_of(passive, answers)
            heard[:, j] = [system.sensed(i, answers[i]) for i in shells]
        for b, driven in enumerate(shells):
            answers = system.under_voltage(driven, 1.0)
            moved[:, b] = surfaces_of(passive, answers)
            read[:, b] = [system.sensed(i, answers[i]) for i in shells]
        return cls(VoltageResponse.of_faces(shells, read), compliance, heard, moved)
