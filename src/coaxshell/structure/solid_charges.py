"""The charge that actuators in walls of elastic solids hold, by loads on the faces and by a voltage that is given to them.

The electrodes of layer j hold d_j'x + C_j u_j per radian, in the sign in which u times its rate is the power of the amplifier
(:mod:`coaxshell.structure.solid_transducers`): shapes that bend and stretch along the wall answer a voltage with their inertia, all others
at rest. All actuators of a wall hang on one amplifier, so that their charges add up; open circuits beside them charge themselves.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import ComplexArray
from coaxshell.numerics.modes import Modes
from coaxshell.structure.elastic_wall import ElasticWall
from coaxshell.structure.lossy_solid import LossySolidWall
from coaxshell.structure.shape_sums import modal_sums
from coaxshell.structure.solid import RADIAL
from coaxshell.structure.solid_transducers import along_wall, at_rest, by_circuits


class Charging(NamedTuple):
    """Charge per area of all actuators of a wall together while no law asks for a voltage.

    Attributes
    ----------
    per_load : ndarray, shape (2, orders, nodes)
        Per inward load on the inner and on the outer face.
    per_volt : ndarray, shape (orders, nodes)
        Per volt that is given to all of them, while nothing loads the faces.
    """

    per_load: ComplexArray
    per_volt: ComplexArray


def charging(wall: ElasticWall, modes: Modes, s: ComplexArray) -> Charging:
    """Return the charge of the actuators of a wall, sum of (d'x + C u)/R."""
    assert wall.transducers is not None
    every, loop = wall.transducers, wall.loop(modes, s, fed_back=False)
    by_loads, by_volts = _strokes(wall, modes, s)
    held = every.acting[:, None] * wall.capacitances(modes)
    by_volts = by_volts + np.einsum("jm,jc->cm", held, every.circuits.shares)[..., None]
    if loop is None:  # nothing beside the actuators is open
        return Charging(by_loads / wall.radius, np.einsum("cmk,c->mk", by_volts, every.circuits.acting) / wall.radius)
    per_load = by_loads + np.einsum("cmk,cbmk->bmk", by_volts, loop.volts)
    per_volt = np.einsum("cmk,cmk->mk", by_volts, np.broadcast_to(loop.given, by_volts.shape))
    return Charging(per_load / wall.radius, per_volt / wall.radius)


def _strokes(wall: ElasticWall, modes: Modes, s: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
    """Return the sum of d'x over all actuators per inward load, (2, orders, nodes), and per volt of each circuit, (circuits, ...)."""
    assert wall.transducers is not None
    acting, circuits = wall.transducers.acting, wall.transducers.circuits
    if isinstance(wall, LossySolidWall):
        each = wall.strokes(modes, s)
        return np.tensordot(acting, each[0], axes=1), np.tensordot(acting, each[1], axes=1)
    sums, resting = [], []
    for part, driven in zip(wall.basis(modes), wall.driven(modes), strict=True):
        stroke = np.einsum("j,mjn->mn", acting, driven.loads)[:, None]
        of_circuits = by_circuits(driven, circuits)
        along = np.arange(part.squares.shape[1]) < along_wall(part.wavenumber)
        pressed = -part.faces * np.array(wall.wetted)[:, None]
        sums.append(modal_sums(np.concatenate([stroke * pressed, stroke * of_circuits.loads * along], axis=1), part.squares, s))
        resting.append(at_rest(part, stroke, of_circuits)[:, 0])
    whole = np.concatenate(sums, axis=1)
    return whole[:2], whole[2:] + np.concatenate(resting).T[..., None]


def free_capacity(wall: ElasticWall) -> float:
    """Return the charge per area and volt of all actuators of order 0 whose thickness is free, 0 without any.

    Of each layer mu33 (1 + e33^2/(c33 mu33))/(R ln(r_o/r_i)).
    """
    assert wall.transducers is not None
    total = 0.0
    for layer in (wall.layers[number] for number in wall.transducers.actuators):
        assert layer.coupling is not None
        assert layer.permittivity is not None
        stiffened = layer.coupling[0][RADIAL] ** 2 / layer.stiffness[RADIAL][RADIAL]
        total += (layer.permittivity[0] + stiffened) / (wall.radius * float(np.log(layer.outer / layer.inner)))
    return total
