"""What walls of elastic solids show at their faces and within, as weights of their shapes and as sums over these."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.structure.elastic_basis import OrdersBasis
from coaxshell.structure.elastic_depth import Shown
from coaxshell.structure.shape_sums import modal_sums
from coaxshell.structure.solid_transducers import (
    Driven,
    Loop,
    LoopPart,
    Transducers,
    along_wall,
    at_rest,
    by_circuits,
    driven_of,
    field_of_volts,
    loop_part,
)


class ByVolts(NamedTuple):
    """What a volt on each circuit does to what is shown.

    Attributes
    ----------
    along : ndarray, shape (orders, quantities, circuits, shapes along the wall)
        Weights of the shapes in the motion along the wall.
    at_once : ndarray, shape (orders, quantities, circuits)
        What is made without inertia, through the thickness and by the field.
    """

    along: FloatArray
    at_once: FloatArray


class VoltPort(NamedTuple):
    """What closes a loop, and what volts of its circuits do to what is shown."""

    loop: LoopPart
    shown: ByVolts


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


def by_volts(
    basis: OrdersBasis, transducers: Transducers, driven: Driven, shown: FloatArray, places: Sequence[tuple[Shown, int, float]]
) -> ByVolts:
    """Return what volts of each circuit add to quantities.

    Parameters
    ----------
    basis : OrdersBasis
    transducers : Transducers
    driven : Driven
        Of the circuits.
    shown : ndarray, shape (orders, quantities, shapes)
        The quantities per unit of each shape.
    places : sequence of (str, int, float)
        What each of them is, in which layer and at which radius.
    """
    moving = slice(along_wall(basis.wavenumber))
    fields = [field_of_volts(basis, transducers, layer, radius, what) for what, layer, radius in places]
    at_once = np.stack(fields, axis=1) @ transducers.circuits.shares + at_rest(basis, shown, driven)
    return ByVolts(shown[:, :, None, moving] * driven.loads[:, None, :, moving], at_once)


def volt_port(
    basis: OrdersBasis,
    transducers: Transducers,
    wetted: tuple[float, float],
    shown: FloatArray,
    places: Sequence[tuple[Shown, int, float]],
) -> VoltPort:
    """Return what voltages do to what stations read, ``shown`` and ``places`` as of :func:`by_volts`."""
    driven = by_circuits(driven_of(basis, transducers), transducers.circuits)
    loop = loop_part(basis, driven, wetted, opened=transducers.circuits.any_open)
    return VoltPort(loop, by_volts(basis, transducers, driven, shown, places))


def per_volt(volts: Sequence[ByVolts], squares: Sequence[FloatArray], s: ComplexArray, some: slice = slice(None)) -> ComplexArray:
    """Return quantities per volt of each circuit, (quantities, circuits, orders, nodes), by motion along the wall and at once.

    Parameters
    ----------
    volts : sequence of ByVolts
        Of each part of a basis.
    squares : sequence of ndarray, shape (orders, shapes)
        omega^2 of all shapes.
    s : ndarray, shape (nodes,)
    some : slice, optional
        Of the quantities.
    """
    parts, at_once = [], np.concatenate([one.at_once[:, some] for one in volts])
    for one, square in zip(volts, squares, strict=True):
        rows = one.along[:, some]
        parts.append(modal_sums(rows.reshape(len(rows), -1, rows.shape[-1]), square[:, : rows.shape[-1]], s))
    sums = parts[0] if len(parts) == 1 else np.concatenate(parts, axis=1)
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
