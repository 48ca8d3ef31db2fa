"""How a number read from a run changes with its absorbers and with what its spectra are made from.

The number is known by what it changes with W and V at every node (:class:`Reading`); one solution backwards
(:mod:`coaxshell.solver.adjoint.backward`, :mod:`coaxshell.solver.adjoint.nodes`) gives all that follows.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from coaxshell.acoustics.basis import Modes
from coaxshell.errors import InputError
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.solver.adjoint.backward import march_backwards
from coaxshell.solver.adjoint.histories import marched_links
from coaxshell.solver.adjoint.nodes import solve_transposed
from coaxshell.solver.interface.absorbers import AbsorberSet, InterfacePoints
from coaxshell.solver.solved_spectra import SolvedSpectra


class Reading(NamedTuple):
    """What a number changes by, Re sum(normal dW + tangential dV), both of the shape of W: (shells, parities, M + 1, nodes)."""

    normal: ComplexArray
    tangential: ComplexArray


@dataclass(frozen=True)
class LinkSensitivity:
    """What a number changes by per unit of each property of the N absorbers carried, dimensionless; per degree of their angles."""

    mass: FloatArray
    damping: FloatArray
    linear: FloatArray
    cubic: FloatArray
    angle: FloatArray

    @classmethod
    def none(cls) -> LinkSensitivity:
        """Return that of no absorbers."""
        return cls(*np.zeros((5, 0)))


@dataclass(frozen=True)
class Felt:
    """What links feel of the walls in a run that was marched, backwards, and what their forces do.

    Attributes
    ----------
    displacement, velocity : ndarray, shape (shells, parities, M + 1, T)
        What the number changes by, through the links, per unit of the walls' displacement and velocity without forces.
    forced : ndarray, same shape
        The same per unit of the velocity that forces give.
    pressure : ndarray, same shape
        Modal pressures of the links.
    """

    displacement: FloatArray
    velocity: FloatArray
    forced: FloatArray
    pressure: FloatArray


@dataclass(frozen=True)
class Backwards:
    """The answer backwards of a run.

    Attributes
    ----------
    reading : Reading
        Of the motion; of links that were solved at each node what they feel is in it already.
    links : LinkSensitivity
    felt : Felt or None
        Of links that were marched.
    tighter : ndarray, shape (shells,)
        What the number changes by if the forces of the links on a shell grow by a factor 1 + x, per x.
    """

    reading: Reading
    links: LinkSensitivity
    felt: Felt | None
    tighter: FloatArray


def backwards(solved: SolvedSpectra, reading: Reading) -> Backwards:
    """Return the answer backwards of a run in two dimensions whose actuators follow a linear law.

    Raises
    ------
    InputError
        If actuators saturated.
    """
    if solved.actuation is not None:
        raise InputError(
            "control.saturation", "is reached in this run, and has no gradient", "use saturation=False, or a higher field limit"
        )
    absorbers = solved.absorbers
    if not absorbers.count:
        return Backwards(reading, LinkSensitivity.none(), None, np.zeros(len(solved.problem.shells)))
    structure = solved.structure
    points = InterfacePoints(solved.problem, absorbers, solved.modes)
    h = points.parities
    on_wall = reading.normal[:, :h] + structure.tangential_ratio[:, None] * reading.tangential[:, :h]
    per_pressure = np.einsum("ijmk,ihmk->jhmk", structure.compliance, on_wall)
    return (_exact if solved.exact is not None else _marched)(solved, points, per_pressure, reading)


def _marched(solved: SolvedSpectra, points: InterfacePoints, per_pressure: ComplexArray, reading: Reading) -> Backwards:
    """Return the answer of absorbers that were marched."""
    structure, absorbers, grid = solved.structure, solved.absorbers, solved.grid
    first = np.array([int(np.flatnonzero(absorbers.member == i)[0]) for i in range(absorbers.count)])
    force = solved.force[first].swapaxes(0, 1).reshape(2 * absorbers.count, -1)
    forward = marched_links(structure, absorbers, points, force, solved.displacement[first])
    pressure = grid.transform_linear_transposed(per_pressure)
    linear, cubic, damping = (np.tile(x, 2)[:, None] for x in (absorbers.linear, absorbers.cubic, absorbers.damping))
    tangent = linear + 3.0 * cubic * forward.stretch**2
    load = points.project_transposed(pressure)
    back = march_backwards(structure.kernels_transposed, absorbers, points, tangent, load, grid.time_step)
    pressure -= back.velocity
    walls = [
        (-back.force, forward.forced_velocity),
        (-damping * back.law, structure.linear_velocity),
        (-tangent * back.law, structure.linear_displacement),
    ]
    links = LinkSensitivity(
        mass=np.einsum("nt,nt->n", back.mass, forward.mass_acceleration),
        damping=_of_both(back.law, forward.stretch_rate),
        linear=_of_both(back.law, forward.stretch),
        cubic=_of_both(back.law, forward.stretch**3),
        angle=_around(points, absorbers, (force, pressure), walls, [shell.radius for shell in solved.problem.shells]),
    )
    displacement, velocity, forced = (points.evaluate_transposed(walls[k][0]) for k in (2, 1, 0))
    tighter = np.einsum("ihmt,ihmt->i", pressure, forward.modal_force)
    return Backwards(reading, links, Felt(displacement, velocity, forced, forward.modal_force), tighter)


def _exact(solved: SolvedSpectra, points: InterfacePoints, per_pressure: ComplexArray, reading: Reading) -> Backwards:
    """Return the answer of absorbers that were solved at each node."""
    structure, absorbers, s = solved.structure, solved.absorbers, solved.grid.nodes
    assert solved.exact is not None
    force, displacement = solved.exact
    back = solve_transposed(structure, absorbers, points, points.project_transposed(per_pressure))
    stretch = np.tile(displacement, (2, 1)) - points.evaluate(solved.normal)
    felt = points.evaluate_transposed(back.force)
    pressure = per_pressure - np.einsum("ijmk,ihmk->jhmk", structure.compliance, felt)
    links = LinkSensitivity(
        mass=-np.einsum("nk,nk->n", back.mass, s**2 * displacement).real,
        damping=_of_both(back.law, s * stretch),
        linear=_of_both(back.law, stretch),
        cubic=np.full(absorbers.count, np.nan),
        angle=_around(
            points, absorbers, (force, pressure), [(-back.force, solved.normal)], [shell.radius for shell in solved.problem.shells]
        ),
    )
    normal = reading.normal.copy()
    normal[:, : points.parities] -= felt
    tighter = np.einsum("ihmk,ihmk->i", pressure, points.project(force)).real
    return Backwards(Reading(normal, reading.tangential), links, None, tighter)


def _of_both(law: FloatArray | ComplexArray, part: FloatArray | ComplexArray) -> FloatArray:
    """Return the real part of the sum over time, or nodes, of a product over both links of each absorber, shape (N,)."""
    return np.asarray(np.einsum("pt,pt->p", law, part).real.reshape(2, -1).sum(axis=0), dtype=np.float64)


def _around(
    points: InterfacePoints,
    absorbers: AbsorberSet,
    force: tuple[FloatArray | ComplexArray, FloatArray | ComplexArray],
    walls: Sequence[tuple[FloatArray | ComplexArray, FloatArray | ComplexArray]],
    radii: list[float],
) -> FloatArray:
    """Return what a number changes by per degree of each absorber's angle.

    Parameters
    ----------
    points : InterfacePoints
    absorbers : AbsorberSet
    force : tuple
        Forces at the points, and what a unit of each modal pressure changes.
    walls : list of tuple
        What a unit of motion at the points changes, and that motion by modes.
    radii : list of float
        Of the shells, in a.
    """
    modes, (load, pressures) = Modes.up_to(points.modes - 1), force
    beta_pi = np.pi * np.where(modes.orders == 0, 2.0, 1.0)
    multiplicity = np.tile(absorbers.multiplicity, 2)
    angles = np.radians(np.tile(absorbers.angle, 2))[:, None] * modes.orders
    slope = np.radians(modes.orders) * np.stack([-np.sin(angles), np.cos(angles)][: points.parities])
    total = np.zeros(points.count)
    for i in np.unique(points.surface):
        here = np.flatnonzero(points.surface == i)
        share = (multiplicity[here, None] / beta_pi) / radii[i]
        for h in range(points.parities):
            placed = share * _product(load[here], pressures[i, h])
            for weight, motion in walls:
                if h < motion.shape[1]:
                    placed = placed + _product(weight[here], motion[i, h])
            total[here] += (placed * slope[h, here]).sum(axis=1)
    return np.asarray(total.reshape(2, -1).sum(axis=0))


def _product(points: FloatArray | ComplexArray, modal: FloatArray | ComplexArray) -> FloatArray:
    """Return the real part of the sum over time, or nodes, of values at points (P, T) times modal ones (M + 1, T): shape (P, M + 1)."""
    return np.asarray((points @ modal.T).real)
