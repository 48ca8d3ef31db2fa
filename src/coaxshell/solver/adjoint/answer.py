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
from coaxshell.solver.adjoint.backward import CubicBackwards, march_backwards
from coaxshell.solver.adjoint.faces import Rows, per_surface_load
from coaxshell.solver.adjoint.histories import marched_by_laws, marched_links
from coaxshell.solver.adjoint.laws import AnyBackwards, ElementSensitivity
from coaxshell.solver.adjoint.nodes import elements_at_nodes, solve_transposed
from coaxshell.solver.faced_forces import surface_motion
from coaxshell.solver.interface.absorbers import AbsorberSet, InterfacePoints
from coaxshell.solver.links.histories import middles_transform
from coaxshell.solver.solved_spectra import SolvedSpectra
from coaxshell.solver.spectral import node_blocks


class Reading(NamedTuple):
    """What a number changes by, Re sum(normal dW + tangential dV), both of the shape of W: (shells, parities, M + 1, nodes).

    Where walls have two faces it is in ``rows`` instead (:data:`coaxshell.solver.adjoint.faces.Rows`).
    """

    normal: ComplexArray
    tangential: ComplexArray
    rows: Rows = {}  # noqa: RUF012 - nobody changes it


class Around(NamedTuple):
    """What a number changes by with the places of N absorbers.

    Attributes
    ----------
    angle : ndarray, shape (N,)
        Per degree.
    shapes : ndarray, shape (2, N, M + 1)
        Per unit of h_m, by which each link feels and presses each order: the mean of a footprint.
    """

    angle: FloatArray
    shapes: FloatArray


@dataclass(frozen=True)
class LinkSensitivity:
    """What a number changes by per unit of each property of the N absorbers carried, dimensionless.

    Attributes
    ----------
    mass, damping, linear, cubic : ndarray, shape (N,)
    around : Around
    elements : ElementSensitivity or None
        Of the laws of their links, where there are such; the common damper and springs are the first two of each link.
    """

    mass: FloatArray
    damping: FloatArray
    linear: FloatArray
    cubic: FloatArray
    around: Around
    elements: ElementSensitivity | None = None

    @classmethod
    def none(cls) -> LinkSensitivity:
        """Return that of no absorbers."""
        mass, damping, linear, cubic, angle = np.zeros((5, 0))
        return cls(mass, damping, linear, cubic, Around(angle, np.zeros((2, 0, 1))))


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
        Of the motion; of links that were solved at each node what they feel is in it already, but where walls have two faces.
    links : LinkSensitivity
    felt : Felt or None
        Of links that were marched.
    tighter : ndarray, shape (surfaces,)
        What the number changes by if the forces of the links on a surface grow by a factor 1 + x, per x.
    moved : ndarray, shape (surfaces, parities, M + 1, nodes), or None
        What links that were solved at each node feel of the surfaces, where walls have two faces.
    pressure : ndarray, same shape, or None
        Transforms of the modal pressures of the links, there.
    returned : ndarray, shape (parities, M + 1, nodes), or None
        What the number changes by per unit of what the planes of the sea send back.
    """

    reading: Reading
    links: LinkSensitivity
    felt: Felt | None
    tighter: FloatArray
    moved: ComplexArray | None = None
    pressure: ComplexArray | None = None
    returned: ComplexArray | None = None


def backwards(solved: SolvedSpectra, reading: Reading) -> Backwards:
    """Return the answer backwards of a run in two dimensions whose actuators follow a linear law.

    Raises
    ------
    InputError
        If actuators saturated.
    """
    if solved.actuation is not None or solved.asked is not None:
        raise InputError(
            "control.saturation", "is reached in this run, and has no gradient", "use saturation=False, or a higher field limit"
        )
    absorbers = solved.absorbers
    if not absorbers.count:
        return Backwards(reading, LinkSensitivity.none(), None, np.zeros(len(solved.problem.surfaces)))
    structure = solved.structure
    points = InterfacePoints(solved.problem, absorbers, solved.modes)
    h = points.parities
    if solved.solid is not None:
        blocks = node_blocks(solved.grid, solved.modes.max_order)
        per_pressure = per_surface_load(structure.problem, blocks, solved.grid.nodes, solved.modes, reading.rows)[:, :h]
    else:
        on_wall = reading.normal[:, :h] + structure.tangential_ratio[:, None] * reading.tangential[:, :h]
        per_pressure = np.einsum("ijmk,ihmk->jhmk", structure.compliance, on_wall)
    if solved.exact is not None:
        return _exact(solved, points, per_pressure, reading)
    return (_marched if solved.laws is None else _marched_by_laws)(solved, points, per_pressure, reading)


def _marched(solved: SolvedSpectra, points: InterfacePoints, per_pressure: ComplexArray, reading: Reading) -> Backwards:
    """Return the answer of absorbers that were marched."""
    structure, absorbers, grid = solved.structure, solved.absorbers, solved.grid
    first = _first(absorbers)
    force = solved.force[first].swapaxes(0, 1).reshape(2 * absorbers.count, -1)
    forward = marched_links(structure, absorbers, points, force, solved.displacement[first])
    pressure = grid.transform_linear_transposed(per_pressure)
    linear, cubic, damping = (np.tile(x, 2)[:, None] for x in (absorbers.linear, absorbers.cubic, absorbers.damping))
    tangent = linear + 3.0 * cubic * forward.stretch**2
    load, laws = points.project_transposed(pressure), CubicBackwards(damping[:, 0], tangent, 0.5 * grid.time_step)
    back = march_backwards(structure.kernels_transposed, absorbers, points, laws, load, grid.time_step)
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
        around=_around(solved, points, (force, pressure), walls),
    )
    displacement, velocity, forced = (points.evaluate_transposed(walls[k][0]) for k in (2, 1, 0))
    tighter = np.einsum("ihmt,ihmt->i", pressure, forward.modal_force)
    felt = Felt(displacement, velocity, forced, forward.modal_force)
    given = None if solved.solid is None else solved.grid.transform_linear(forward.modal_force)
    return Backwards(reading, links, felt, tighter, pressure=given)


def _marched_by_laws(solved: SolvedSpectra, points: InterfacePoints, per_pressure: ComplexArray, reading: Reading) -> Backwards:
    """Return the answer of absorbers whose links have laws, marched in the means over the steps; f is that of their middles."""
    structure, absorbers, grid, done = solved.structure, solved.absorbers, solved.grid, solved.laws
    assert done is not None
    forward = marched_by_laws(structure, absorbers, points, done.force, solved.displacement[_first(absorbers)])
    pressure = grid.transform_linear_transposed(per_pressure * np.exp(0.5 * grid.time_step * grid.nodes))
    laws = AnyBackwards(absorbers, done.stretch, grid.time_step)
    back = march_backwards(structure.kernels_transposed, absorbers, points, laws, points.project_transposed(pressure), grid.time_step)
    pressure -= back.velocity
    of_stretch = laws.stretch_slope.T
    of_stretch[:, 0] = 0.0  # links begin at rest, whatever the inverse transform leaves of w_0
    walls = [(-back.force, forward.forced_velocity), (-of_stretch, structure.linear_displacement)]
    own = np.array([[bars[0][0], bars[0][1], bars[1][2]] if bars else np.zeros(3) for bars in laws.sensitivity.elements])
    stiffness, damping, cubic = own.reshape(2, absorbers.count, 3).sum(axis=0).T
    links = LinkSensitivity(
        mass=np.einsum("nt,nt->n", back.mass, forward.mass_acceleration),
        damping=damping,
        linear=stiffness,
        cubic=cubic,
        around=_around(solved, points, (done.force, pressure), walls),
        elements=laws.sensitivity,
    )
    displacement, forced = points.evaluate_transposed(-of_stretch), points.evaluate_transposed(-back.force)
    tighter = np.einsum("ihmt,ihmt->i", pressure, forward.modal_force)
    felt = Felt(displacement, np.zeros_like(displacement), forced, forward.modal_force)
    given = None if solved.solid is None else middles_transform(grid, forward.modal_force)
    return Backwards(reading, links, felt, tighter, pressure=given)


def _first(absorbers: AbsorberSet) -> list[int]:
    """Return the number in the description of the first absorber that each one carried stands for."""
    return [int(np.flatnonzero(absorbers.member == i)[0]) for i in range(absorbers.count)]


def _exact(solved: SolvedSpectra, points: InterfacePoints, per_pressure: ComplexArray, reading: Reading) -> Backwards:
    """Return the answer of absorbers that were solved at each node."""
    structure, absorbers, s = solved.structure, solved.absorbers, solved.grid.nodes
    assert solved.exact is not None
    force, displacement = solved.exact
    back = solve_transposed(structure, absorbers, points, points.project_transposed(per_pressure))
    moving = solved.normal if solved.solid is None else surface_motion(solved.problem, solved.normal, solved.solid.faces)
    stretch = np.tile(displacement, (2, 1)) - points.evaluate(moving)
    felt = points.evaluate_transposed(back.force)
    pressure = per_pressure - np.einsum("ijmk,ihmk->jhmk", structure.compliance, felt)
    there = np.ones(2 * absorbers.count) if absorbers.elements is None else absorbers.elements.present.astype(np.float64)
    links = LinkSensitivity(
        mass=-np.einsum("nk,nk->n", back.mass, s**2 * displacement).real,
        damping=_of_both(back.law * there[:, None], s * stretch),
        linear=_of_both(back.law * there[:, None], stretch),
        cubic=np.full(absorbers.count, np.nan),
        around=_around(solved, points, (force, pressure), [(-back.force, moving)]),
        elements=None if absorbers.elements is None else elements_at_nodes(absorbers, s, back.law * stretch),
    )
    given = points.project(force)
    tighter = np.einsum("ihmk,ihmk->i", pressure, given).real
    if solved.solid is not None:
        return Backwards(reading, links, None, tighter, moved=-felt, pressure=given)
    normal = reading.normal.copy()
    normal[:, : points.parities] -= felt
    return Backwards(Reading(normal, reading.tangential), links, None, tighter)


def _of_both(law: FloatArray | ComplexArray, part: FloatArray | ComplexArray) -> FloatArray:
    """Return the real part of the sum over time, or nodes, of a product over both links of each absorber, shape (N,)."""
    return np.asarray(np.einsum("pt,pt->p", law, part).real.reshape(2, -1).sum(axis=0), dtype=np.float64)


def _around(
    solved: SolvedSpectra,
    points: InterfacePoints,
    force: tuple[FloatArray | ComplexArray, FloatArray | ComplexArray],
    walls: Sequence[tuple[FloatArray | ComplexArray, FloatArray | ComplexArray]],
) -> Around:
    """Return what a number changes by with the angle of each absorber and the arcs of its links.

    Parameters
    ----------
    solved : SolvedSpectra
    points : InterfacePoints
    force : tuple
        Forces at the points, and what a unit of each modal pressure changes.
    walls : list of tuple
        What a unit of motion at the points changes, and that motion by modes.
    """
    absorbers, modes, (load, pressures) = solved.absorbers, Modes.up_to(points.modes - 1), force
    radii = [surface.radius for surface in solved.problem.surfaces]
    beta_pi = np.pi * np.where(modes.orders == 0, 2.0, 1.0)
    multiplicity, held = np.tile(absorbers.multiplicity, 2), absorbers.held.ravel()
    angles = np.radians(np.tile(absorbers.angle, 2))[:, None] * modes.orders
    means = absorbers.means(solved.problem, modes).reshape(points.count, -1) * held[:, None]
    turned = np.radians(modes.orders) * np.stack([-np.sin(angles), np.cos(angles)][: points.parities]) * means
    shaped = np.stack([np.cos(angles), np.sin(angles)][: points.parities]) * held[:, None]
    total, shapes = np.zeros(points.count), np.zeros((points.count, modes.count))
    for i in np.unique(points.surface):
        here = np.flatnonzero(points.surface == i)
        share = (multiplicity[here, None] / beta_pi) / radii[i]
        for h in range(points.parities):
            placed = share * _product(load[here], pressures[i, h])
            for weight, motion in walls:
                if h < motion.shape[1]:
                    placed = placed + _product(weight[here], motion[i, h])
            total[here] += (placed * turned[h, here]).sum(axis=1)
            shapes[here] += placed * shaped[h, here]
    return Around(np.asarray(total.reshape(2, -1).sum(axis=0)), shapes.reshape(2, absorbers.count, -1))


def _product(points: FloatArray | ComplexArray, modal: FloatArray | ComplexArray) -> FloatArray:
    """Return the real part of the sum over time, or nodes, of values at points (P, T) times modal ones (M + 1, T): shape (P, M + 1)."""
    return np.asarray((points @ modal.T).real)
