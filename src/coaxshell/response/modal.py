"""Modal amplitudes of a quantity on a shell: a linear combination of V and W of the same order, in SI.

Every quantity here has a cosine in parity 0 and a sine in parity 1, like w and dv/dtheta.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from coaxshell.errors import InputError
from coaxshell.numerics.arrays import FloatArray
from coaxshell.solver.scaling import Problem
from coaxshell.solver.solution import ModalSolution
from coaxshell.structure.section import Section
from coaxshell.structure.stress import WallPoint, design_stress_gain, stress_gain


class Gain(NamedTuple):
    """SI value of a quantity per unit dimensionless amplitude V and W of each order, each of shape (M + 1,)."""

    v: FloatArray
    w: FloatArray


def orders(solution: ModalSolution) -> FloatArray:
    """Return the circumferential orders 0..M as floats, shape (M + 1,)."""
    return np.arange(solution.normal.shape[2], dtype=np.float64)


def elastic_section(problem: Problem, shell: int) -> Section:
    """Return the section of a shell; InputError if it is rigid and has none."""
    section = problem.shells[shell].section
    if section is None:
        raise InputError(f"shells[{shell}]", "a rigid shell has no stress and no voltage", "choose an elastic one")
    return section


def displacement_gain(solution: ModalSolution) -> Gain:
    """Return the gain of the normal displacement, m: (0, a)."""
    m = orders(solution)
    return Gain(np.zeros_like(m), np.full_like(m, solution.problem.scales.length))


def stress_gain_of(solution: ModalSolution, shell: int, where: WallPoint | None = None) -> Gain:
    """Return the gain of the hoop stress, Pa: of the core at the mid-surface (Eq. 22), or at a point of the wall (Eqs. A.4, A.5)."""
    section = elastic_section(solution.problem, shell)
    m = orders(solution)
    gain = design_stress_gain(section, m) if where is None else stress_gain(section, m, where)
    a = solution.problem.scales.length
    return Gain(a * gain.v, a * gain.w)


def voltage_gain(solution: ModalSolution, shell: int, role: str = "sensor") -> Gain:
    """Return the gain of the open-circuit voltage of a layer, V (Eq. 20); InputError if the shell has no layer of that role."""
    section = elastic_section(solution.problem, shell)
    if section.layer(role) is None:
        raise InputError(f"shells[{shell}].layers", f"there is no {role}", f'give a piezoelectric layer the role "{role}"')
    return Gain(*solution.problem.sensor_gain(shell, orders(solution), role))


def amplitudes(solution: ModalSolution, shell: int, gain: Gain, window: slice = slice(None)) -> FloatArray:
    """Return the modal amplitudes of a quantity, gain.v V + gain.w W, in SI.

    Parameters
    ----------
    solution : ModalSolution
    shell : int
    gain : Gain
    window : slice
        Time indices.

    Returns
    -------
    ndarray, shape (parities, M + 1, T)
    """
    result: FloatArray = solution.normal[shell, :, :, window] * gain.w[:, None]
    if np.any(gain.v):
        result += solution.tangential[shell, :, :, window] * gain.v[:, None]
    return result
