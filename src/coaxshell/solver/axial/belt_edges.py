"""How far stress within exact ceramics swings about the edges of electrodes that are cut along the axis, and the warning of it.

Under a voltage that ends at an edge the field alone makes e u/t, e = e_32 - e_33 c_23/c_33 of a free thickness. It is a sum of waves up to
k_max, which at a distance d from a jump is off by its part

    |Si(k d) - pi/2|/pi <= min(1/2, 1/(pi k_max d)):

a half at the edge itself, and as 1/k_max elsewhere. Weights against it (Lanczos) would smooth what thin walls have sharp. Thin walls take
the field of the belt over a station as it is.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from coaxshell.model.places import shell_phrase
from coaxshell.model.prefixes import engineering
from coaxshell.numerics.circle import peak_on_circle
from coaxshell.solver.scaling import Problem
from coaxshell.solver.settings import MAX_MODES
from coaxshell.solver.solution import ModalSolution
from coaxshell.structure.elastic_wall import ElasticWall
from coaxshell.structure.solid import HOOP, RADIAL

LIMIT = 0.05
"""Share of the field's own stress from which its swing is told."""


def part_off(distance: float, highest: float) -> float:
    """Return the part of a jump by which waves up to a highest wavenumber may be off at a distance from it."""
    return 0.5 if distance <= 0.0 else min(0.5, 1.0 / (math.pi * highest * distance))


def field_stress(wall: ElasticWall, volts: float) -> float:
    """Return the hoop stress, in rho_e c_e^2, that a voltage makes by its field in the ceramic where that is most."""
    assert wall.transducers is not None
    found = []
    for layer in (wall.layers[i] for i in wall.transducers.actuators):
        assert layer.coupling is not None
        e, c = layer.coupling[0], layer.stiffness
        found.append(abs(e[HOOP] - e[RADIAL] * c[RADIAL][HOOP] / c[RADIAL][RADIAL]) / layer.thickness)
    return volts * max(found, default=0.0)


def remarks(problem: Problem, highest: float, motions: Sequence[ModalSolution], stations: Sequence[float]) -> list[str]:
    """Return the warning of the exact wall whose ceramics' stress swings most at a station (m) of a run, if it does by much."""
    belts, scales, found = problem.belts, problem.scales, []
    for i, wall in enumerate(problem.shells):
        if belts is None or not isinstance(wall, ElasticWall) or wall.gains is None:
            continue
        volts = max(_largest_voltage(motion, i) for motion in motions)  # between electrodes there is none
        alone = field_stress(wall, volts) * scales.pressure
        for z in stations:
            place = z / scales.length
            distance = abs(abs(place - belts.pitch * np.rint(place / belts.pitch)) - 0.5 * belts.length)
            found.append((part_off(distance, highest) * alone, alone, z, distance * scales.length, i))
    swing, alone, z, distance, shell = max(found, default=(0.0, 0.0, 0.0, 0.0, 0))
    if swing <= LIMIT * alone:
        return []
    return [
        f"{shell_phrase(shell, len(problem.shells))}: stress within its ceramics is a sum of axial waves, which swings about the edges of "
        f"electrodes by up to {engineering(swing, 'Pa')} of the {engineering(alone, 'Pa')} that their field makes, at z = {z:g} m, "
        f"{engineering(distance, 'm')} from one; use axial_modes={min(2.0 * highest, MAX_MODES):g}, or stations farther off"
    ]


def _largest_voltage(motion: ModalSolution, shell: int) -> float:
    if motion.segment_voltage is not None:
        return float(np.abs(motion.segment_voltage[shell]).max(initial=0.0))
    assert motion.control_voltage is not None
    peak = peak_on_circle(motion.control_voltage[shell])
    return 0.0 if peak is None else abs(peak.value)
