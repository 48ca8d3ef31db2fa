"""Feedback that ties walls or orders to each other where walls have two faces, in one wave along the axis.

As of thin walls (:mod:`coaxshell.solver.axial.tied_wave`) each wavenumber is a system of loops by itself. What walls without feedback do
under loads is heard by the loads on their faces; a volt on the actuators of one moves the faces of all, and is heard there,

    phi_i = sigma_i . q_i + C_ij u_j,      u = (1 - H K C)^-1 H K sigma . q,      faces = faces_0 + E_j u_j,

q the loads on both faces of wall i without voltages, E and C the faces and the readings per volt of each order, and the loops those of
patterns (:mod:`coaxshell.solver.electrode_loops`). Thin walls stand beside walls of elastic solids.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import ComplexArray
from coaxshell.solver.axial.faced import FacedWave
from coaxshell.solver.cascade import FaceMotion
from coaxshell.solver.electrode_loops import ElectrodeLoops
from coaxshell.solver.electrode_patterns import patterns_of
from coaxshell.solver.voltage_response import VoltageResponse, controlled, of_all
from coaxshell.structure.tied_wall import TiedWall


class Closed(NamedTuple):
    """Motion with feedback: of the faces of all walls, for each parity around, and voltages, (shells, parities, orders, nodes)."""

    faces: list[list[FaceMotion]]
    voltage: ComplexArray

    def read(self, wave: FacedWave, layers: int) -> ComplexArray:
        """Return what all walls are read for, (9 + layers, shells, parities, orders, nodes), see :meth:`FacedWave.read`."""
        given = [self.voltage[:, parity] if self.voltage.size else None for parity in range(len(self.faces))]
        return np.stack([wave.read(faces, layers, volts) for faces, volts in zip(self.faces, given, strict=True)], axis=2)


class OpenFaces:
    """What voltages do in one wave, and what is read of its motion, without feedback.

    Parameters
    ----------
    wave : FacedWave
        All walls and fluids without feedback; all orders from 0 to the highest where electrodes are cut.

    Attributes
    ----------
    wave : FacedWave
    response : VoltageResponse
    per_volt : list of lists of FaceMotion
        What the faces of all walls do under a volt on each wall under control.
    """

    def __init__(self, wave: FacedWave) -> None:
        self.wave, shells = wave, controlled(wave.problem)
        self.per_volt = [wave.under_voltage(shell) for shell in shells]
        read = np.empty((len(shells), len(shells), wave.modes.count, wave.s.size), np.complex128)
        for b, moved in enumerate(self.per_volt):
            for a, shell in enumerate(shells):
                read[a, b] = wave.sensed(shell, moved[shell], float(a == b))
        self.response = VoltageResponse.of_faces(shells, read)

    def readings(self, free: list[list[FaceMotion]]) -> ComplexArray:
        """Return what the sensors of walls under control read of faces that do *free*, (walls, parities, orders, nodes)."""
        wave = self.wave
        return np.stack([np.stack([wave.sensed(shell, faces[shell]) for faces in free]) for shell in self.response.shells])

    def charges(self, free: list[list[FaceMotion]]) -> ComplexArray:
        """Return what the charge of strain is over the capacitance of each thin wall under control, V, likewise; 0 of elastic walls."""
        shape = (len(self.response.shells), len(free), self.wave.modes.count, self.wave.s.size)
        found = np.zeros(shape, np.complex128)
        for a, shell in enumerate(self.response.shells):
            wall = self.wave.problem.shells[shell]
            if isinstance(wall, TiedWall):
                gain = wall.charge_voltage(self.wave.modes)
                found[a] = np.stack([self.wave.sensed(shell, faces[shell], 0.0, gain) for faces in free])
        return found

    def charges_per_volt(self) -> ComplexArray:
        """Return what the charge of each thin wall under control is over its capacitance, V, per volt on each; 0 of elastic walls."""
        found = np.zeros_like(self.response.read)
        for b, moved in enumerate(self.per_volt):
            for a, shell in enumerate(self.response.shells):
                wall = self.wave.problem.shells[shell]
                if isinstance(wall, TiedWall):
                    found[a, b] = self.wave.sensed(shell, moved[shell], float(a == b), wall.charge_voltage(self.wave.modes))
        return found

    def moved(self, voltage: ComplexArray, free: list[list[FaceMotion]] | None = None) -> Closed:
        """Return the motion under voltages, (walls, parities, orders, nodes), besides what faces do without them."""
        alone: list[list[FaceMotion]] = [self._nothing] * voltage.shape[1] if free is None else [*free]
        alone += [self._nothing] * (voltage.shape[1] - len(alone))
        faces = [self._together(each, voltage[:, parity]) for parity, each in enumerate(alone)]
        return Closed(faces, of_all(self.wave.problem, self.response, voltage))

    @property
    def _nothing(self) -> list[FaceMotion]:
        zero = np.zeros((self.wave.modes.count, self.wave.s.size), np.complex128)
        return [FaceMotion(zero, zero, zero, zero)] * len(self.wave.problem.shells)

    def _together(self, alone: list[FaceMotion], volts: ComplexArray) -> list[FaceMotion]:
        """Return motion without voltages and by voltages, (controlled, orders, nodes), together."""
        found = []
        for shell, moving in enumerate(alone):
            by_volts = [per[shell] for per in self.per_volt]
            parts = zip(moving, *by_volts, strict=True)
            found.append(FaceMotion(*(own + sum(u * one for u, one in zip(volts, per, strict=True)) for own, *per in parts)))
        return found


class TiedFaces(OpenFaces):
    """The loops of one wave.

    Parameters
    ----------
    wave : FacedWave
    parities : int
        How many the motion has around the circle.

    Attributes
    ----------
    loops : ElectrodeLoops
    """

    def __init__(self, wave: FacedWave, parities: int) -> None:
        super().__init__(wave)
        patterns = patterns_of(wave.problem, self.response.shells, wave.modes.orders, parities)
        self.loops = ElectrodeLoops.of(wave.problem, self.response, patterns, wave.s)

    def closed(self, free: list[list[FaceMotion]]) -> Closed:
        """Return the motion with feedback of faces that do *free* without it, for each parity around."""
        patterns = self.loops.patterns
        return self.moved(patterns.in_orders(self.loops.voltages(patterns.readings(self.readings(free))))[:, : len(free)], free)
