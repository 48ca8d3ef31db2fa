"""Energy of walls of solids with losses, and what turns into heat in them, piece by piece (:mod:`coaxshell.structure.solid_pieces`).

The forces on the faces of a piece give its motion at all nodes. Of layers under one factor these are amplitudes c of shapes, with energies
as without losses; of a rubber, displacements and strains at points through its thickness, whose squares are integrated by Gauss's rule,

    kinetic rho (u_r'^2 + u_theta'^2)/2,      K e^2/2 of the bulk,      G (eps_r^2 + eps_theta^2 - e^2/3 + gamma^2/2) of the shear,

e = eps_r + eps_theta; in waves along the axis with u_z'^2, eps_z and two more shears beside. An arm g_i of a factor holds g_i times the
energy of s tau/(1 + s tau) of the motion, and turns 2/tau of it per time into heat.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple, Self

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.blas_threads import one_blas_thread
from coaxshell.numerics.late import integrate
from coaxshell.numerics.threads import map_on_threads
from coaxshell.response.energy.motion import Motion
from coaxshell.response.energy.solid_transducers import of_circuits, open_fields, volts_of
from coaxshell.solver.spectral import map_node_blocks, node_blocks
from coaxshell.structure.elastic_basis import OrdersBasis, displacements
from coaxshell.structure.elastic_mesh import degree
from coaxshell.structure.losses import Relaxation
from coaxshell.structure.lossy_solid import LossySolidWall
from coaxshell.structure.shell_model import WallEnergy
from coaxshell.structure.solid_chain import WallReading
from coaxshell.structure.solid_driven import PieceLoads
from coaxshell.structure.solid_pieces import RIGID, Piece, lossless_rows, on_faces
from coaxshell.structure.solid_potentials import Potentials

MOST_POINTS = 20
"""Points of a rubber's integrals, at most: above the frequencies that they resolve its shear holds next to nothing."""
TOGETHER = 4
"""Points whose fields are found together: the waves at the faces are then found once for all of them."""


class _Tally(NamedTuple):
    """Stores at the kept instants, and the power that turns into heat at all of them."""

    kinetic: FloatArray
    strain: FloatArray
    electric: FloatArray
    power: FloatArray

    def plus(self, other: _Tally) -> _Tally:
        """Return the sum."""
        return _Tally(*(a + b for a, b in zip(self, other, strict=True)))

    @classmethod
    def none(cls, motion: Motion) -> Self:
        """Return nothing."""
        kept, all_instants = np.zeros(motion.grid.time[motion.kept].size), np.zeros(motion.grid.time.size)
        return cls(kept, kept, kept, all_instants)


def lossy_solid_energy(motion: Motion, shell: int) -> tuple[WallEnergy, FloatArray | None]:
    """Return the energies of a wall of solids in pieces and the heat in it, None without losses, at the kept instants."""
    wall = motion.problem.shells[shell]
    assert isinstance(wall, LossySolidWall)
    volts = volts_of(motion, shell)
    forces = _forces(motion, wall, shell)
    driven: list[_AtRest | None] = [None] * len(wall.pieces)
    if volts is not None:
        forces, driven = _with_voltages(motion, wall, forces, of_circuits(wall, volts))
    total = _Tally.none(motion)
    for piece, given, still in zip(wall.pieces, forces, driven, strict=True):
        total = total.plus(_of_potentials(motion, piece, given) if piece.by_potentials else _of_shapes(motion, piece, given, still))
    electric = total.electric if volts is None else total.electric + open_fields(motion, shell, volts)
    energy = WallEnergy(total.kinetic, total.strain, electric)
    if not wall.dissipates:
        return energy, None
    heat = integrate.cumulative_simpson(total.power, dx=motion.grid.time_step, initial=0.0)[motion.kept]
    return energy, np.asarray(heat)


def _forces(motion: Motion, wall: LossySolidWall, shell: int) -> ComplexArray:
    """Return the transforms of the forces on the faces of all pieces, shape (pieces, 4 or 6, parities, M + 1, nodes)."""
    solid, grid, modes = motion.solid, motion.grid, motion.modes
    assert solid is not None
    loads = solid.loads[:, shell]
    found = np.zeros((len(wall.pieces), 2 * displacements(motion.wavenumber), *loads.shape[1:]), np.complex128)
    reading = WallReading(wall.pieces)
    reading.prepare(modes)

    def work(block: slice) -> None:
        chain, _ = reading.at(modes, grid.nodes[block])
        for piece, both in enumerate(chain.forces):
            for side, radius in enumerate(wall.wetted):
                outward = -radius * loads[side, ..., block]
                for number, per_load in enumerate(both[side]):
                    found[piece, number, ..., block] += per_load * outward

    with one_blas_thread():
        map_node_blocks(node_blocks(grid, modes.max_order), work, None, "forces within walls")
    return found


class _AtRest(NamedTuple):
    """What pushes a piece that finds no inertia (:mod:`coaxshell.structure.solid_driven`).

    Attributes
    ----------
    loads : sequence of PieceLoads
        Of each part of its basis.
    faces : ndarray, shape (4 or 6, parities, M + 1, nodes)
        Forces on its faces.
    volts : ndarray, shape (circuits, parities, M + 1, nodes)
    pushed : ndarray, shape (2 or 3 + 1, parities, M + 1, nodes)
        Of the columns of B and of its spring.
    """

    loads: Sequence[PieceLoads]
    faces: ComplexArray
    volts: ComplexArray
    pushed: ComplexArray


def _with_voltages(
    motion: Motion, wall: LossySolidWall, forces: ComplexArray, volts: ComplexArray
) -> tuple[ComplexArray, list[_AtRest | None]]:
    """Return the forces on the faces of all pieces with those that voltages make, and what pushes pieces that find no inertia."""
    assert wall.driven_pieces is not None
    modes, along, found = motion.modes, displacements(motion.wavenumber), forces.copy()
    driven: list[_AtRest | None] = [None] * len(wall.pieces)
    every = wall.driven_pieces.loads(modes)
    for number in (number for numbers in wall.driven_pieces.stacks for number in numbers):
        pushed, loads = np.zeros((along + 1, *volts.shape[1:]), np.complex128), every[number]
        assert loads is not None
        driven[number] = _AtRest(loads, np.zeros_like(forces[number]), volts, pushed)

    def work(block: slice) -> None:
        answer, given = wall.answered(modes, motion.grid.nodes[block]), volts[..., block]
        for number, each in enumerate(answer.forces):
            for circuit, acting in enumerate(each):
                for a, force in enumerate(acting):
                    found[number, a, ..., block] += force * given[circuit]
        assert wall.driven_pieces is not None
        for numbers, stack in zip(wall.driven_pieces.stacks, answer.stacks, strict=True):
            for place, number in enumerate(numbers):
                still = driven[number]
                assert still is not None
                for circuit, pieces in enumerate(stack.forces):
                    for a, force in enumerate(pieces[place]):
                        still.faces[a, ..., block] += force * given[circuit]
                columns = stack.pushed[[*range(along), along + place]]
                still.pushed[..., block] = np.einsum("lcmk,chmk->lhmk", columns, given)

    with one_blas_thread():
        map_node_blocks(node_blocks(motion.grid, modes.max_order), work, None, "forces within walls")
    return found, driven


Share = ComplexArray | float
"""A share of the motion, a number or one for each node."""


def _stores(motion: Motion, factor: Relaxation | None, whole: Callable[[Share], FloatArray]) -> tuple[FloatArray, FloatArray]:
    """Return the energy that springs under a factor hold, at the kept instants, and the power of its arms.

    Parameters
    ----------
    motion : Motion
    factor : Relaxation or None
    whole : callable
        From a share of the motion to what the springs would hold of it where the factor is 1, shape (T,).
    """
    if factor is None:
        return whole(1.0)[motion.kept], np.zeros(motion.grid.time.size)
    series, s = factor.series, motion.grid.nodes
    strain, power = np.zeros(motion.grid.time.size), np.zeros(motion.grid.time.size)
    if series.at_rest:
        strain += series.at_rest * whole(1.0)
    for strength, time in zip(series.strengths, series.times, strict=True):
        held = strength * whole(s * time / (1.0 + s * time))
        strain += held
        power += 2.0 / time * held
    return strain[motion.kept], power


def _of_shapes(motion: Motion, piece: Piece, forces: ComplexArray, still: _AtRest | None) -> _Tally:
    """Return what a piece holds by the amplitudes of its shapes."""

    def fields(part: OrdersBasis) -> FloatArray:
        return np.concatenate(part.electric_rows, axis=1) if piece.factor is None else lossless_rows(part)

    tasks = [
        (number, part, place, rows, parity)
        for number, part in enumerate(piece.basis(motion.modes))
        for place, rows in enumerate(fields(part))
        for parity in range(forces.shape[1])
    ]

    def of_order(task: tuple[int, OrdersBasis, int, FloatArray, int]) -> _Tally:
        number, part, place, rows, parity = task
        order, s, squares = part.members.start + place, motion.grid.nodes, part.squares[place]
        amplitude = _amplitudes(motion, piece, squares, s * s, rows, on_faces(part)[place].T @ forces[:, parity, order])
        if still is not None:
            loads = still.loads[number]
            pushing = on_faces(part)[place].T @ still.faces[:, parity, order] + loads.volts[place].T @ still.volts[:, parity, order]
            pushing -= np.concatenate([loads.along[place], loads.rigid[place]]).T @ still.pushed[:, parity, order]
            amplitude = amplitude + _amplitudes(motion, piece, np.where(squares == 0.0, RIGID, squares), np.zeros_like(s), rows, pushing)
        return _of_amplitudes(motion, piece, part.squares[place], rows, amplitude, 0.5 * motion.circle[order])

    total = _Tally.none(motion)
    with one_blas_thread():
        for one in map_on_threads(of_order, tasks):
            total = total.plus(one)
    return total


def _amplitudes(
    motion: Motion, piece: Piece, squares: FloatArray, inertia: ComplexArray, rows: FloatArray, forces: ComplexArray
) -> ComplexArray:
    """Return the amplitudes of the shapes of one order under forces on them, shape (shapes, nodes), potentials without losses."""
    s = motion.grid.nodes
    g = np.ones_like(s) if piece.factor is None else piece.factor.at(s)
    per_force = 1.0 / (g * squares[:, None] + inertia)
    amplitude = per_force * forces
    if piece.factor is None or not rows.size:
        return np.asarray(amplitude)
    lent = 1.0 - g
    matrix = np.einsum("in,nk,jn->kij", rows, per_force, rows) * lent[:, None, None] + np.eye(rows.shape[0])
    shown = np.linalg.solve(matrix, (rows @ amplitude).T[..., None])[..., 0].T
    return np.asarray(amplitude - per_force * (rows.T @ (lent * shown)))


def _of_amplitudes(motion: Motion, piece: Piece, squares: FloatArray, rows: FloatArray, amplitude: ComplexArray, weight: float) -> _Tally:
    grid = motion.grid

    def strained(share: Share) -> FloatArray:
        history = grid.invert(amplitude * share)
        return np.asarray(weight * (squares @ history**2 - np.sum((rows @ history) ** 2, axis=0)))

    strain, power = _stores(motion, piece.factor, strained)
    rate = grid.invert(amplitude * grid.nodes)[:, motion.kept]
    potential = rows @ grid.invert(amplitude)[:, motion.kept]
    return _Tally(weight * np.sum(rate**2, axis=0), strain, weight * np.sum(potential**2, axis=0), power)


def _of_potentials(motion: Motion, piece: Piece, forces: ComplexArray) -> _Tally:
    """Return what an isotropic layer holds by its fields at Gauss's points."""
    (layer,) = piece.layers
    count = degree(layer.stiffest, motion.modes.max_order, motion.wavenumber, piece.frequency)
    count = count if layer.factor is None else min(MOST_POINTS, count)
    points, weights = np.polynomial.legendre.leggauss(count)
    half, total = layer.thickness / 2.0, _Tally.none(motion)
    radii = layer.inner + half * (1.0 + points)
    waves = _waves(motion, piece, forces)
    for start in range(0, count, TOGETHER):
        some = slice(start, start + TOGETHER)
        for field, weight in zip(_fields(motion, piece, waves, radii[some]), (half * weights * radii)[some], strict=True):
            total = total.plus(_of_field(motion, piece, field, float(weight)))
    return total


def _waves(motion: Motion, piece: Piece, forces: ComplexArray) -> ComplexArray:
    """Return the waves of an isotropic layer under the forces on its faces, of their shape."""
    found = np.empty_like(forces)

    def work(block: slice) -> None:
        found[..., block] = Potentials(piece.layers[0], motion.modes, motion.grid.nodes[block]).waves(forces[..., block])

    map_node_blocks(node_blocks(motion.grid, motion.modes.max_order), work, None, "waves")
    return found


def _fields(motion: Motion, piece: Piece, waves: ComplexArray, radii: FloatArray) -> ComplexArray:
    """Return displacements and strains (:meth:`Potentials.motion`) at some radii, shape (radii, 5 or 9, parities, orders, nodes)."""
    found = np.empty((radii.size, 9 if motion.wavenumber else 5, *waves.shape[1:]), np.complex128)

    def work(block: slice) -> None:
        potentials = Potentials(piece.layers[0], motion.modes, motion.grid.nodes[block])
        for field, radius in zip(found, radii, strict=True):
            field[..., block] = np.einsum("qwmk,whmk->qhmk", potentials.motion(float(radius)), waves[..., block])

    map_node_blocks(node_blocks(motion.grid, motion.modes.max_order), work, None, "waves")
    return found


def _of_field(motion: Motion, piece: Piece, field: ComplexArray, weight: float) -> _Tally:
    """Return what an isotropic layer holds at a radius whose share of the integral over r dr is given."""
    grid, layer, circle = motion.grid, piece.layers[0], motion.circle
    moved = field[[0, 1, 5]] if motion.wavenumber else field[:2]
    strained = field[[2, 3, 4, 6, 7, 8]] if motion.wavenumber else field[2:]

    def squares(histories: FloatArray) -> FloatArray:
        """Return the sum of squares over the circle, shape (T,)."""
        return np.asarray(weight * np.einsum("m,hmt,hmt->t", circle, histories, histories))

    def of_bulk(share: Share) -> FloatArray:
        return 0.5 * layer.bulk * squares(grid.invert(field[2] * share))

    def of_shear(share: Share) -> FloatArray:
        spread, hoop, angle, *along = (grid.invert(x * share) for x in strained)
        if not along:
            return layer.shear * (squares(spread - hoop) + squares(hoop) - squares(spread) / 3.0 + 0.5 * squares(angle))
        axial, *angles = along
        stretched = squares(spread - hoop - axial) + squares(hoop) + squares(axial) - squares(spread) / 3.0
        return layer.shear * (stretched + 0.5 * (squares(angle) + squares(angles[0]) + squares(angles[1])))

    bulk, bulk_power = _stores(motion, None if layer.shear_alone else layer.factor, of_bulk)
    shear, shear_power = _stores(motion, layer.factor, of_shear)
    rates = np.sum([squares(grid.invert(x * grid.nodes)) for x in moved], axis=0)
    kinetic = 0.5 * layer.density * rates[motion.kept]
    return _Tally(kinetic, bulk + shear, np.zeros_like(bulk), bulk_power + shear_power)
