"""What walls of elastic solids show at their faces and within, as weights of their shapes and as sums over these."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.structure.elastic_basis import OrdersBasis
from coaxshell.structure.solid_transducers import Loop, LoopPart


class VoltPort(NamedTuple):
    """What voltages of the circuits do to what is shown.

    Attributes
    ----------
    loop : LoopPart
    rows : ndarray, shape (orders, quantities circuits, shapes)
        Weights of the shapes in the motion along the wall that volts make.
    resting : ndarray, shape (orders, quantities, circuits)
        What they make at once.
    """

    loop: LoopPart
    rows: FloatArray
    resting: FloatArray


class Port(NamedTuple):
    """What some orders show at their faces and within, per unit of each shape.

    Attributes
    ----------
    squares : ndarray, shape (orders, shapes)
        omega^2.
    faces : ndarray, shape (orders, 2, shapes)
        u_r of the faces.
    shown : ndarray, shape (orders, quantities, shapes)
    volts : VoltPort or None
        What voltages do, where a loop is closed.
    """

    squares: FloatArray
    faces: FloatArray
    shown: FloatArray
    volts: VoltPort | None = None


class UnderVoltage(NamedTuple):
    """What a volt that is given to all actuators of a wall does while nothing else loads it.

    Attributes
    ----------
    faces : ndarray, shape (2, orders, nodes)
        Inward displacements of the inner and the outer face.
    shown : ndarray, shape (quantities, orders, nodes)
        What was asked for.
    heard : ndarray, shape (orders, nodes)
        What the control law reads.
    """

    faces: ComplexArray
    shown: ComplexArray
    heard: ComplexArray


class DrivenPort(NamedTuple):
    """How the transducers of a wall answer while no law asks for a voltage.

    Attributes
    ----------
    sensed : ndarray, shape (2, orders, nodes)
        What the control law reads per inward load on either face.
    given : UnderVoltage
        What a volt on all actuators does.
    """

    sensed: ComplexArray
    given: UnderVoltage

    @classmethod
    def of(cls, loop: Loop, each: ComplexArray) -> DrivenPort:
        """Return it from a loop without feedback and what a volt of each circuit shows, (quantities, circuits, orders, nodes)."""
        given = loop.given[:, None]
        moved, shown = (under_volts(one, given)[:, 0] for one in (loop.moved, each))
        return cls(loop.sensed, UnderVoltage(moved, shown, loop.heard))


def per_volt(sums: ComplexArray, resting: Sequence[FloatArray]) -> ComplexArray:
    """Return quantities per volt of each circuit, (quantities, circuits, orders, nodes), by motion along the wall and at once.

    Parameters
    ----------
    sums : ndarray, shape (quantities circuits, orders, nodes)
        Over all shapes, of the motion along the wall.
    resting : sequence of ndarray, shape (orders, quantities, circuits)
        What answers at once, of each part of a basis.
    """
    at_once = np.concatenate(resting)
    return np.asarray(sums.reshape(*at_once.shape[1:], *sums.shape[1:]) + np.moveaxis(at_once, 0, -1)[..., None])


def under_volts(each: ComplexArray, volts: ComplexArray) -> ComplexArray:
    """Return what voltages do, (quantities, loads, orders, nodes).

    By what a volt of each circuit does, (quantities, circuits, orders, nodes), and their volts, (circuits, loads, orders, nodes).
    """
    found: ComplexArray = each[:, 0, None] * volts[0]
    for one, given in zip(np.moveaxis(each[:, 1:], 1, 0), volts[1:], strict=True):
        found += one[:, None] * given
    return found


def of_faces(part: OrdersBasis) -> FloatArray:
    """Return the weights of the shapes in H_ii, H_io and H_oo, shape (orders, 3, shapes)."""
    return products(part.faces)


def products(faces: FloatArray) -> FloatArray:
    """Return the same from u_r of the faces, shape (orders, 2, shapes)."""
    inner, outer = faces[:, 0], faces[:, 1]
    return np.stack([inner * inner, inner * outer, outer * outer], axis=1)
