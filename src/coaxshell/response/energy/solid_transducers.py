"""Voltages in walls of elastic solids: what actuators take from them, and what the fields of open circuits and of actuators hold."""

from __future__ import annotations

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.response.energy.motion import Motion
from coaxshell.response.energy.work import SurfaceWork
from coaxshell.solver.spectral import node_blocks
from coaxshell.structure.elastic_wall import ElasticWall
from coaxshell.structure.lossy_solid import LossySolidWall
from coaxshell.structure.solid_transducers import along_wall, inertia_left_out


def volts_of(motion: Motion, shell: int) -> ComplexArray | None:
    """Return the transforms of the voltages on the driven layers of a wall, (driven, parities, M + 1, nodes); None without any."""
    wall, solid = motion.problem.shells[shell], motion.solid
    assert isinstance(wall, ElasticWall)
    assert solid is not None
    if not wall.closes_a_loop:
        return None
    nodes, parts = motion.grid.nodes, []
    blocks = node_blocks(motion.grid, motion.modes.max_order) if isinstance(wall, LossySolidWall) else [slice(0, nodes.size)]
    for block in blocks:
        loop = wall.loop(motion.modes, nodes[block], fed_back=motion.voltage is None)
        assert loop is not None
        found = np.einsum("jbmk,bhmk->jhmk", loop.volts, solid.loads[:, shell, ..., block])
        of_circuits = found if motion.voltage is None else found + loop.given[:, None] * motion.voltage[shell][..., block]
        parts.append(np.tensordot(loop.shares, of_circuits, axes=1))
    return parts[0] if len(parts) == 1 else np.concatenate(parts, axis=-1)


def of_circuits(wall: ElasticWall, volts: ComplexArray) -> ComplexArray:
    """Return the voltages of the circuits of a wall from those of its driven layers, (circuits, ...)."""
    assert wall.transducers is not None
    return np.asarray(np.tensordot(np.linalg.pinv(wall.transducers.circuits.shares), volts, axes=1))


def driven_at(wall: ElasticWall, motion: Motion, order: int) -> FloatArray:
    """Return the force on each shape of an order per volt on each driven layer, shape (driven, shapes)."""
    for part, driven in zip(wall.basis(motion.modes), wall.driven(motion.modes), strict=True):
        if part.members.start <= order < part.members.stop:
            return np.asarray(driven.loads[order - part.members.start], dtype=np.float64)
    raise IndexError(order)


def strokes(motion: Motion, shell: int, volts: ComplexArray) -> ComplexArray:
    """Return d'x of every driven layer, what its voltage does work on, (driven, parities, M + 1, nodes)."""
    wall, solid, s = motion.problem.shells[shell], motion.solid, motion.grid.nodes
    assert isinstance(wall, ElasticWall)
    assert solid is not None
    if isinstance(wall, LossySolidWall):
        return _strokes_in_pieces(motion, wall, solid.loads[:, shell], of_circuits(wall, volts))
    found, along = np.empty_like(volts), along_wall(motion.wavenumber)
    for part, driven in zip(wall.basis(motion.modes), wall.driven(motion.modes), strict=True):
        for place in range(part.orders.size):
            order = part.members.start + place
            share = np.reciprocal(part.squares[place][:, None] + s * s)
            for parity in range(volts.shape[1]):
                loads = solid.loads[:, shell, parity, order] * np.array(wall.wetted)[:, None]
                pushed = inertia_left_out(part.squares[place], s, along) * (driven.loads[place].T @ volts[:, parity, order])
                forces = pushed - part.faces[place].T @ loads
                found[:, parity, order] = driven.loads[place] @ (forces * share)
    return found


def _strokes_in_pieces(motion: Motion, wall: LossySolidWall, loads: ComplexArray, volts: ComplexArray) -> ComplexArray:
    """Return the strokes of a wall in pieces under loads on its faces and voltages of its circuits."""
    parts, grid = [], motion.grid
    for block in node_blocks(grid, motion.modes.max_order):
        by_loads, by_volts = wall.strokes(motion.modes, grid.nodes[block])
        moved = np.einsum("jbmk,bhmk->jhmk", by_loads, loads[..., block])
        parts.append(moved + np.einsum("jcmk,chmk->jhmk", by_volts, volts[..., block]))
    return np.concatenate(parts, axis=-1)


def solid_actuator_work(motion: Motion, shell: int) -> FloatArray:
    """Return the work that the actuators of a wall have taken from it, minus the integral of u d'dx/dt over the circle, shape (T,)."""
    wall, volts, grid = motion.problem.shells[shell], volts_of(motion, shell), motion.grid
    assert isinstance(wall, ElasticWall)
    assert wall.transducers is not None
    assert volts is not None
    moved, total = strokes(motion, shell, volts), np.zeros(grid.time.size)
    for j in np.flatnonzero(wall.transducers.acting):
        total -= SurfaceWork(grid, motion.circle, moved[j] * grid.nodes)(volts[j])
    return total


def capacitances(wall: ElasticWall, motion: Motion) -> FloatArray:
    """Return C of each driven layer per radian, shape (driven, M + 1)."""
    return wall.capacitances(motion.modes)


def open_fields(motion: Motion, shell: int, volts: ComplexArray) -> FloatArray:
    """Return the energy in the fields of open circuits, C y^2/2, at the kept instants."""
    wall = motion.problem.shells[shell]
    assert isinstance(wall, ElasticWall)
    assert wall.transducers is not None
    total = np.zeros(motion.grid.time[motion.kept].size)
    for j in np.flatnonzero(wall.transducers.opened):
        history = motion.grid.invert(volts[j].copy())[..., motion.kept]
        total += 0.5 * np.einsum("m,hmt,hmt->t", capacitances(wall, motion)[j] * motion.circle, history, history)
    return total


def solid_electrical(motion: Motion, shell: int) -> tuple[FloatArray, FloatArray] | None:
    """Return the energy from the amplifiers of a wall since the start and that in its actuators' fields, (T,); None without electrodes.

    The charge of a driven layer is -d'x + C u per radian, in the sign in which u times its rate is the power of the amplifier. Voltages
    of belts charge C with waves that the run has left out too.
    """
    wall, grid = motion.problem.shells[shell], motion.grid
    assert isinstance(wall, ElasticWall)
    if wall.gains is None or wall.transducers is None or not wall.transducers.electrodes:
        return None
    volts = volts_of(motion, shell)
    assert volts is not None
    moved, held, supplied = strokes(motion, shell, volts), np.zeros(grid.time.size), np.zeros(grid.time.size)
    for j in np.flatnonzero(wall.transducers.acting):
        capacitance = capacitances(wall, motion)[j]
        charging = volts[j] if motion.charged is None else motion.charged[:, None] * volts[j]
        if motion.charged is None:
            supplied += SurfaceWork(grid, motion.circle, grid.nodes * (moved[j] + capacitance[:, None] * volts[j]))(volts[j])
        else:
            supplied += SurfaceWork(grid, motion.circle, grid.nodes * moved[j])(volts[j])
            supplied += SurfaceWork(grid, motion.circle, grid.nodes * (capacitance[:, None] * charging))(charging)
        history = grid.invert(charging.copy())
        held += 0.5 * np.einsum("m,hmt,hmt->t", capacitance * motion.circle, history, history)
    return supplied, held
