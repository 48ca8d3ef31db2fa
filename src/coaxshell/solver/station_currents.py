"""Charges and currents of thin walls' actuators at the stations of three-dimensional runs, and the warning of amplifiers asked for more.

The charge per area is that of the strains there and of the voltage, q = m + C u (theory manual, "Electrodes"); dq/dt by differences.
Walls of elastic solids keep no charges at stations.
"""

from __future__ import annotations

import numpy as np

from coaxshell.model.gains import law_of
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.circle import peak_on_circle
from coaxshell.numerics.differences import time_derivative
from coaxshell.solver.electrodes import segment_length, segment_mean
from coaxshell.solver.limited_currents import warning_beyond
from coaxshell.solver.solution import ModalSolution
from coaxshell.structure.electroded_wall import ElectrodedWall
from coaxshell.structure.segments import Segments
from coaxshell.structure.tied_wall import TiedWall


def strain_charge(solution: ModalSolution, shell: int, wall: ElectrodedWall) -> tuple[FloatArray, float]:
    """Return the charge of all actuators without that of their voltage, (parities, M + 1, T), and C, per volt; both dimensionless."""
    assert solution.along is not None
    if isinstance(wall, TiedWall) and wall.belts is not None:
        return wall.capacitance * solution.along.potentials[wall.shown_potentials - 3][shell], wall.capacitance  # of the belt over it
    held = wall.charges_of_fields(np.arange(float(solution.normal.shape[2])))
    moved = (gain.recovered({name: solution.field(name)[shell] for name in gain.fields}) for gain, _ in held)
    return np.asarray(sum(moved, np.zeros(1))), sum(capacitance for _, capacitance in held)


def warnings_at(*motions: ModalSolution) -> list[str]:
    """Return the warnings about amplifiers asked for more than their current at any of some stations of a run."""
    problem, warnings = motions[0].problem, []
    for i, wall in enumerate(problem.shells):
        law = law_of(problem.system, i)
        if law is None or law.current_limit is None or law.current_saturation:
            continue
        if isinstance(wall, ElectrodedWall) and wall.charges_of_fields(np.zeros(1)):
            length = segment_length(problem, i)
            asked = max(_largest(motion, i, wall, length) for motion in motions)
            warnings += warning_beyond(problem, i, asked, length)
    return warnings


def _largest(solution: ModalSolution, shell: int, wall: ElectrodedWall, length: float) -> float:
    """Return the largest current asked for at a station, A/m^2: of a segment over a step, or a mean over a length of the wall."""
    scales, along = solution.problem.scales, solution.along
    per_area, step = scales.pressure * scales.length, solution.settings.time_step * scales.time
    strained, capacitance = strain_charge(solution, shell, wall)
    cut = wall.electrode_segments
    if cut is not None and solution.segment_voltage is not None:
        assert along is not None
        charge = cut.means(strained) + capacitance * solution.segment_voltage[shell]
        return float(np.abs(np.diff(_driven(charge, cut, along.dead))).max(initial=0.0)) * per_area / step
    assert solution.control_voltage is not None
    share = segment_mean(np.arange(float(solution.normal.shape[2])), length / solution.problem.system.shells[shell].radius)
    charge = share[:, None] * (strained + capacitance * solution.control_voltage[shell])
    peak = peak_on_circle(time_derivative(charge, step))
    return 0.0 if peak is None else abs(peak.value) * per_area


def _driven(charge: FloatArray, cut: Segments, dead: tuple[int, ...]) -> FloatArray:
    """Return the charges of segments that have an amplifier."""
    return np.delete(charge, sorted({*cut.dead, *dead}), axis=0)
