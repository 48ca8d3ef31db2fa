"""Modal amplitudes of a quantity on a shell: a linear combination of V and W of the same order, in SI: a
:class:`~coaxshell.structure.shell_model.Gain` whose entries have the shape (M + 1,).

Every quantity here has a cosine in parity 0 and a sine in parity 1, like w and dv/dtheta.
"""

from __future__ import annotations

import numpy as np

from coaxshell.errors import InputError
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.modes import Modes
from coaxshell.response.synthesis import angle_basis, at_angles
from coaxshell.solver.scaling import Problem
from coaxshell.solver.solution import ModalSolution
from coaxshell.structure.shell_model import Gain, ShellModel


def orders(solution: ModalSolution) -> FloatArray:
    """Return the circumferential orders 0..M as floats, shape (M + 1,)."""
    return np.arange(solution.normal.shape[2], dtype=np.float64)


def elastic_wall(problem: Problem, shell: int) -> ShellModel:
    """Return the wall of a shell; InputError if it is rigid."""
    wall = problem.shells[shell]
    if not wall.moves:
        raise InputError(f"shells[{shell}]", "a rigid shell has no stress and no voltage", "choose an elastic one")
    return wall


def displacement_gain(solution: ModalSolution) -> Gain:
    """Return the gain of the normal displacement, m: (0, a)."""
    m = orders(solution)
    return Gain(np.zeros_like(m), np.full_like(m, solution.problem.scales.length))


def tangential_gain(solution: ModalSolution) -> Gain:
    """Return the gain of the tangential displacement, m: (a, 0)."""
    gain = displacement_gain(solution)
    return Gain(gain.w, gain.v)


def stress_gain_of(solution: ModalSolution, shell: int, depth: float | None = None) -> Gain:
    """Return the gain of the hoop stress, Pa: of the core at the mid-surface (Eq. 22), or at a depth (m; Eqs. A.4, A.5)."""
    scales = solution.problem.scales
    gain = elastic_wall(solution.problem, shell).stress_gain(Modes(orders(solution)), None if depth is None else depth / scales.length)
    return Gain(scales.pressure * gain.v, scales.pressure * gain.w)


def voltage_gain(solution: ModalSolution, shell: int, role: str = "sensor") -> Gain:
    """Return the gain of the open-circuit voltage of a layer, V (Eq. 20); InputError if the shell has no layer of that role."""
    wall = elastic_wall(solution.problem, shell)
    if not wall.has(role):
        raise InputError(f"shells[{shell}].layers", f"there is no {role}", f'give a piezoelectric layer the role "{role}"')
    return wall.sensor_gain(Modes(orders(solution)), role)


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


def combined(solution: ModalSolution, shell: int, gain: Gain, theta: FloatArray, component: str = "normal") -> FloatArray:
    """Return gain.v V + gain.w W at angles, shape (T, A); the gains go into the basis, so no modal array is built."""
    normal, tangential = solution.normal[shell], solution.tangential[shell]
    basis = angle_basis(np.atleast_1d(theta), normal.shape[1], normal.shape[0], component)
    return at_angles(normal, basis * gain.w) + at_angles(tangential, basis * gain.v)
