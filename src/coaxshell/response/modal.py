"""Modal amplitudes of a quantity on a shell: a linear combination of V and W of the same order, in SI: a
:class:`~coaxshell.structure.shell_model.Gain` whose entries have the shape (M + 1,).

At a station of a three-dimensional run it may be one of all fields there, a :class:`~coaxshell.structure.shell_model.FieldGain`.

Every quantity here has a cosine in parity 0 and a sine in parity 1, like w and dv/dtheta.
"""

from __future__ import annotations

import numpy as np

from coaxshell.errors import InputError
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.modes import Modes
from coaxshell.response.relaxing import Relaxing, relaxed
from coaxshell.response.synthesis import angle_basis, at_angles
from coaxshell.solver.scaling import Problem
from coaxshell.solver.solution import ModalSolution
from coaxshell.structure.losses import Relaxation
from coaxshell.structure.shell_model import FieldGain, Gain, ShellModel


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


def axial_gain(solution: ModalSolution) -> FieldGain:
    """Return the gain of the axial displacement, m: a u."""
    return FieldGain(u=np.full_like(orders(solution), solution.problem.scales.length))


def stress_gain_of(solution: ModalSolution, shell: int, depth: float | None = None, component: str = "hoop") -> Gain | FieldGain | Relaxing:
    """Return the gain of a stress, Pa: of the core at the mid-surface (Eq. 22), or at a depth (m; Eqs. A.4, A.5).

    Of an elastic wall at its design depth alone: the middle of the wall, or of its core, in two dimensions the hoop stress; the rest is
    read from the transforms (:mod:`coaxshell.response.through`) or, at stations, by solving once more.
    At a station of a three-dimensional run the hoop stress feels the axial strain, and "axial" and "shear" are others. In a wall whose
    layers have losses it is a sum of parts, each under a factor g(s).
    """
    scales, wall = solution.problem.scales, elastic_wall(solution.problem, shell)
    depth, modes = None if depth is None else depth / scales.length, Modes(orders(solution))
    if not wall.faces_move_alike:
        assert depth is None  # the rest is read in another way
        return FieldGain(**{component: np.full_like(modes.orders, scales.pressure)})  # type: ignore[arg-type]
    parts: list[tuple[Relaxation | None, Gain | FieldGain]]
    if solution.along is None:
        plane = wall.stress_parts(modes, depth, component)
        parts = [(factor, Gain(scales.pressure * gain.v, scales.pressure * gain.w)) for factor, gain in plane]
    else:
        parts = [(factor, gain.times(scales.pressure)) for factor, gain in wall.field_parts(modes.orders, depth, component)]
    return parts[0][1] if len(parts) == 1 and parts[0][0] is None else Relaxing(tuple(parts))


def voltage_gain(solution: ModalSolution, shell: int, role: str = "sensor") -> Gain | FieldGain:
    """Return the gain of the open-circuit voltage of a layer, V (Eq. 20); InputError if the shell has no layer of that role."""
    wall = elastic_wall(solution.problem, shell)
    if not wall.has(role):
        raise InputError(f"shells[{shell}].layers", f"there is no {role}", f'give a piezoelectric layer the role "{role}"')
    if solution.along is not None or not wall.faces_move_alike:
        return FieldGain(potential=np.ones(solution.normal.shape[2]), layer=wall.layer_number(role))
    return wall.sensor_gain(Modes(orders(solution)), role)


def scaled(gain: Gain | FieldGain, share: FloatArray) -> Gain | FieldGain:
    """Return a gain times a factor for each order."""
    if isinstance(gain, Gain):
        return Gain(gain.v * share, gain.w * share)
    return gain.times(share)


def _parts(solution: ModalSolution, shell: int, gain: Gain | FieldGain) -> list[tuple[FloatArray, FloatArray]]:
    """Return the fields (parities, M + 1, T) that a quantity is made of, each with its factor."""
    if isinstance(gain, Gain):
        return [(solution.normal[shell], gain.w)] + ([(solution.tangential[shell], gain.v)] if np.any(gain.v) else [])
    parts = [(solution.field(name)[shell], factor) for name, factor in gain.fields.items()]
    if gain.layer is not None:
        parts.append((solution.potential(gain.layer)[shell], np.broadcast_to(gain.potential, solution.normal.shape[2:3])))
    return parts


def amplitudes(solution: ModalSolution, shell: int, gain: Gain | FieldGain | Relaxing, window: slice = slice(None)) -> FloatArray:
    """Return the modal amplitudes of a quantity, gain.v V + gain.w W, or that of all fields, in SI.

    Parameters
    ----------
    solution : ModalSolution
    shell : int
    gain : Gain, FieldGain or Relaxing
    window : slice
        Time indices.

    Returns
    -------
    ndarray, shape (parities, M + 1, T)
    """
    if isinstance(gain, Relaxing):
        relaxing = [relaxed(solution, factor, amplitudes(solution, shell, part)) for factor, part in gain.parts]
        return np.asarray(sum(each[..., window] for each in relaxing), dtype=np.float64)
    (first, factor), *others = _parts(solution, shell, gain)
    result: FloatArray = first[:, :, window] * factor[:, None]
    for values, factor in others:
        result += values[:, :, window] * factor[:, None]
    return result


def combined(
    solution: ModalSolution,
    shell: int,
    gain: Gain | FieldGain | Relaxing,
    theta: FloatArray,
    component: str = "normal",
    window: slice = slice(None),
) -> FloatArray:
    """Return a quantity at angles, shape (T, A); the gains go into the basis, so no modal array is built."""
    if isinstance(gain, Relaxing):
        relaxing = [relaxed(solution, factor, combined(solution, shell, part, theta, component).T) for factor, part in gain.parts]
        return np.asarray(sum(each[:, window].T for each in relaxing), dtype=np.float64)
    parities, modes = solution.normal.shape[1:3]
    basis = angle_basis(np.atleast_1d(theta), modes, parities, component)
    if isinstance(gain, Gain):
        normal, tangential = solution.normal[shell, :, :, window], solution.tangential[shell, :, :, window]
        return at_angles(normal, basis * gain.w) + at_angles(tangential, basis * gain.v)
    parts = (at_angles(values[:, :, window], basis * factor) for values, factor in _parts(solution, shell, gain))
    return np.asarray(sum(parts), dtype=np.float64)
