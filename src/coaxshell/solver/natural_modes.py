"""Natural modes: the poles of what walls do under loads on them, with the fluids ("wet") or each wall by itself ("dry").

A wall or a system of them rings at the zeros s of its characteristic function, frequency |Im s|/(2 pi) and damping ratio -Re s/|s|. Poles
of the motion itself are the same numbers, whatever theory a wall has, and are looked for: sound that leaves, losses in walls, and feedback
are what damps them. Standing waves of the fluids are among them as far as they move a wall. Absorbers are left out.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coaxshell.acoustics.basis import RadialBasis
from coaxshell.numerics.arrays import ComplexArray
from coaxshell.numerics.modes import Modes
from coaxshell.numerics.poles import poles_near_axis
from coaxshell.solver.cascade import CascadeSystem
from coaxshell.solver.scaling import Problem
from coaxshell.structure.shell_model import ShellModel

AT_REST = 1e-4
"""|s| below which a pole of order 1 that nothing along the axis holds is the free translation of the section."""
_ASIDE = 1e-7
"""Relative distance from a pole at which the motion is that of its mode alone."""


@dataclass(frozen=True, eq=False)
class NaturalModes:
    """Natural modes of one order and wavenumber.

    Attributes
    ----------
    poles : ndarray of complex, shape (modes,)
        s in units of c_e/a, ascending by frequency.
    shapes : ndarray of complex, shape (modes, shells)
        W of the outer faces; the largest is 1.
    """

    poles: ComplexArray
    shapes: ComplexArray


def wet_modes(problem: Problem, order: int, wavenumber: float, highest: float, most_damped: float) -> NaturalModes:
    """Return the natural modes of the walls in their fluids.

    Parameters
    ----------
    problem : Problem
    order : int
    wavenumber : float
        k, in 1/a.
    highest : float
        Radians per transit.
    most_damped : float
        Largest damping ratio.
    """
    modes = Modes(np.array([float(order)]), wavenumber)
    moving = [i for i, wall in enumerate(problem.shells) if wall.moves]
    weights = np.cos(1.0 + np.arange(len(problem.shells)))  # no mode is likely to have all of it vanish

    def motion(s: ComplexArray) -> ComplexArray:
        """Return W of all walls, shape (shells, nodes), under loads on all of them."""
        system = CascadeSystem(problem, s, modes, radial=RadialBasis(modes, s, left=True))
        answers = [system.solve(i, weights[i], side=1) for i in moving]
        return np.asarray(sum(np.stack([face.outer[0] for face in answer]) for answer in answers))

    poles = poles_near_axis(lambda s: np.asarray(weights @ motion(s)), highest, most_damped)
    poles = _vibrating(poles, order, wavenumber)
    shapes = np.stack([_normalised(motion(np.array([pole * (1.0 + _ASIDE)]))[:, 0]) for pole in poles]) if poles.size else None
    return NaturalModes(poles, np.zeros((0, len(problem.shells)), np.complex128) if shapes is None else shapes)


def dry_poles(wall: ShellModel, order: int, wavenumber: float, highest: float, most_damped: float) -> ComplexArray:
    """Return the poles of one wall without fluids; parameters as for :func:`wet_modes`."""
    if not wall.moves:
        return np.zeros(0, np.complex128)
    modes = Modes(np.array([float(order)]), wavenumber)

    def motion(s: ComplexArray) -> ComplexArray:
        return np.asarray(wall.receptance(modes, s).outer[0])

    return _vibrating(poles_near_axis(motion, highest, most_damped), order, wavenumber)


def _vibrating(poles: ComplexArray, order: int, wavenumber: float) -> ComplexArray:
    """Return the poles without those of free translation."""
    return poles[np.abs(poles) > AT_REST] if order == 1 and wavenumber == 0.0 else poles


def _normalised(shape: ComplexArray) -> ComplexArray:
    return np.asarray(shape / shape[np.argmax(np.abs(shape))])
