r"""What each natural mode carries of a motion: residues of the coupled system at its poles.

Near a pole s_n of order m the walls' answer to loads F is Z(s)^{-1} F = x (y^T F)/(y^T Z'(s_n) x (s - s_n)) + what stays finite, where
Z(s_n) x = 0 and y^T Z(s_n) = 0. The mode's share of a motion W(s), and of its conjugate, is

    x_i (y^T Z(s) W(s)) / (y^T Z'(s_n) x (s - s_n)) + the same of conj(s_n):

all loads that acted, those of absorbers among them, are Z W. In time it is what the loads so far have left ringing at e^{s_n t}, exactly;
the modes of an order leave over what the fluid outside remembers (its waves that creep around the shell) and what rings above the highest
frequency that is looked at.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from coaxshell.acoustics.basis import RadialBasis
from coaxshell.numerics.arrays import ComplexArray
from coaxshell.numerics.modes import Modes
from coaxshell.solver.coupling import ModalSystem
from coaxshell.solver.natural_modes import wet_modes
from coaxshell.solver.scaling import Problem

_STEP = 1e-5
"""Relative step of the derivative of Z."""
_REFINEMENTS = 3


class ModeResidue(NamedTuple):
    """A mode: its pole s (c_e/a), its shape x and left shape y by shells, y^T Z'(s) x, and V per W of each shell there."""

    pole: complex
    shape: ComplexArray
    left: ComplexArray
    slope: complex
    tangential: ComplexArray


def mode_residues(problem: Problem, order: int, highest: float, most_damped: float) -> list[ModeResidue]:
    """Return the natural modes of an order with their residues, ascending by frequency.

    Parameters
    ----------
    problem : Problem
        Of thin or rigid walls in two dimensions.
    order : int
    highest : float
        Radians per transit.
    most_damped : float
        Largest damping ratio.
    """
    modes = Modes(np.array([float(order)]))
    found = []
    for pole in wet_modes(problem, order, 0.0, highest, most_damped).poles:
        for _ in range(_REFINEMENTS):
            shape, left, slope = _vectors(problem, modes, pole)
            pole = pole - complex(left @ _matrix(problem, modes, pole) @ shape) / slope
        tangential = np.array([complex(np.asarray(wall.tangential).reshape(-1)[0]) for wall in _system(problem, modes, pole).shells])
        found.append(ModeResidue(complex(pole), shape, left, slope, tangential))
    return found


def loads_of(problem: Problem, order: int, nodes: ComplexArray, normal: ComplexArray) -> ComplexArray:
    """Return Z(s) W(s), the loads that made a motion of an order, shape (shells, nodes).

    Parameters
    ----------
    problem : Problem
    order : int
    nodes : ndarray of complex, shape (nodes,)
    normal : ndarray of complex, shape (shells, nodes)
    """
    modes = Modes(np.array([float(order)]))
    system = ModalSystem(problem, nodes, modes)
    loads = np.stack([np.asarray(system.diagonal[i])[0] * normal[i] for i in range(len(normal))])
    for i in range(len(normal) - 1):
        upper, lower = system.beside(i)
        loads[i] += np.broadcast_to(upper, (1, nodes.size))[0] * normal[i + 1]
        loads[i + 1] += np.broadcast_to(lower, (1, nodes.size))[0] * normal[i]
    return loads


def mode_spectrum(mode: ModeResidue, weight: complex, loads: ComplexArray, nodes: ComplexArray) -> ComplexArray:
    """Return the transform of what a mode and its conjugate carry of a quantity that is *weight* times the mode, at nodes."""
    return np.asarray(
        weight / mode.slope * (mode.left @ loads) / (nodes - mode.pole)
        + np.conj(weight / mode.slope) * (np.conj(mode.left) @ loads) / (nodes - np.conj(mode.pole))
    )


def _system(problem: Problem, modes: Modes, s: complex) -> ModalSystem:
    at = np.array([s])
    with np.errstate(all="ignore"):  # its factors, which nobody needs, may divide by zero at a pole
        return ModalSystem(problem, at, modes, RadialBasis(modes, at, left=True))


def _matrix(problem: Problem, modes: Modes, s: complex) -> ComplexArray:
    """Return Z at one s of the left half-plane, shape (shells, shells)."""
    system = _system(problem, modes, s)
    matrix = np.diag([complex(np.asarray(entry).reshape(-1)[0]) for entry in system.diagonal])
    for i in range(len(matrix) - 1):
        matrix[i, i + 1], matrix[i + 1, i] = (complex(np.asarray(one).reshape(-1)[0]) for one in system.beside(i))
    return matrix


def _vectors(problem: Problem, modes: Modes, s: complex) -> tuple[ComplexArray, ComplexArray, complex]:
    """Return x, y and y^T Z' x near a pole."""
    left, _, right = np.linalg.svd(_matrix(problem, modes, s))
    shape, other = right[-1].conj(), left[:, -1].conj()
    step = _STEP * abs(s)
    slope = (_matrix(problem, modes, s + step) - _matrix(problem, modes, s - step)) / (2.0 * step)
    return shape, other, complex(other @ slope @ shape)
