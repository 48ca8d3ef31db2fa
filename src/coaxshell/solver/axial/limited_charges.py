"""The charge of segments in one wave along the axis, which amplifiers bring whose current is limited (theory manual, "Limited currents").

Over the capacitance C of each wall (:func:`coaxshell.solver.limited_currents.capacities`) charges are volts: m/C of the strain under
sources, Q/C of that per volt on each wall, both in the patterns of the wave.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from coaxshell.numerics.arrays import ComplexArray
from coaxshell.solver.axial.tied_faces import TiedFaces
from coaxshell.solver.axial.tied_wave import TiedWave
from coaxshell.solver.cascade import FaceMotion
from coaxshell.solver.limited_currents import capacities
from coaxshell.solver.scaling import Problem
from coaxshell.solver.voltage_response import controlled
from coaxshell.structure.elastic_wall import ElasticWall
from coaxshell.structure.solid_charges import charging


class WaveCharges:
    """Charges over C of the actuators of all walls under control in one wave.

    Parameters
    ----------
    problem : Problem
    wave : TiedWave or TiedFaces
        Its loops.
    """

    def __init__(self, problem: Problem, wave: TiedWave | TiedFaces) -> None:
        self._wave, self._shells = wave, controlled(problem)
        self._capacities = dict(zip(self._shells, capacities(problem), strict=True))
        self._solids = {}
        if isinstance(wave, TiedFaces):
            walls = [(i, problem.shells[i]) for i in self._shells]
            known = wave.wave.modes, wave.wave.s
            self._solids = {i: charging(wall, *known) for i, wall in walls if isinstance(wall, ElasticWall)}

    @cached_property
    def per_volt(self) -> ComplexArray:
        """Q/C, (walls, walls, patterns, nodes)."""
        wave, found = self._wave, self._wave.charges_per_volt()
        if isinstance(wave, TiedFaces):
            for b, moved in enumerate(wave.per_volt):
                for a, shell in enumerate(self._shells):
                    if shell in self._solids:
                        found[a, b] = self._of_solid(shell, moved[shell], float(a == b))
        return wave.loops.patterns.responses(found)

    def strained(self, voltage: ComplexArray) -> ComplexArray:
        """Return Q u/C, (walls, patterns, nodes), of voltages in patterns."""
        return np.asarray(np.einsum("ijqk,jqk->iqk", self.per_volt, voltage))

    def of_normal(self, normal: ComplexArray) -> ComplexArray:
        """Return m/C, (walls, patterns, nodes), of thin walls whose W is known, (shells, parities, orders, nodes)."""
        assert isinstance(self._wave, TiedWave)
        return self._wave.loops.patterns.readings(self._wave.charges(normal))

    def of_faces(self, free: list[list[FaceMotion]]) -> ComplexArray:
        """Return m/C, (walls, patterns, nodes), of what the faces of all walls do, for each parity around."""
        wave = self._wave
        assert isinstance(wave, TiedFaces)
        found = wave.charges(free)
        for a, shell in enumerate(self._shells):
            if shell in self._solids:
                found[a] = np.stack([self._of_solid(shell, faces[shell], 0.0) for faces in free])
        return wave.loops.patterns.readings(found)

    def _of_solid(self, shell: int, moving: FaceMotion, volts: float) -> ComplexArray:
        """Return what an exact wall's charge is over C, less its own voltage."""
        held, capacity = self._solids[shell], self._capacities[shell]
        whole = held.per_load[0] * moving.load_inner + held.per_load[1] * moving.load_outer + held.per_volt * volts
        return np.asarray(whole / capacity - volts)
