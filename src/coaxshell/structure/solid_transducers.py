"""Sensors and actuators in walls of elastic solids, as loads on their shapes and readings of them.

A voltage u on a transducer loads a wall by d u; with x the displacements of its points, S readings of sensors,

    K x + M d2x/dt2 = (loads on the faces) + sum over transducers of d_j u_j,

and the voltages follow from the readings, u = L(s) y. With a_b what a load on face b does, D = d' a and Y = d per d (and so of readings),

    u = (1 - L Y)^-1 L y_b q_b,      H_ab -> H_ab + D_a u_b/r_b,

a change of the receptances whose rank is the number of transducers. det(1 - L Y) vanishes at the poles of the wall in vacuo.

"electrodes": a layer between electrodes has the potential Phi = psi u, psi from 1/2 on its inner face to -1/2 on its outer one, which makes
the enthalpy stationary within. It loads the wall by

    d'x = -int (psi' (e33 eps_r + e32 eps_theta + e31 eps_z) - psi e15 ((m/r) gamma_r_theta + k gamma_rz)) r dr,

and an open circuit reads y = -d'x/C, C = psi'G psi its capacitance per radian, and stiffens its layer by d d'/C. Of a layer that is driven
and read at once a bridge takes all that its own voltage does, the stretch of the thickness too, and the strain along the wall is left,
y = int psi' (e32~ eps_theta + e31~ eps_z) r dr/C~, C~ = C (1 + e33^2/(c33 mu33)). In a thin wall d is e32~ B(z_a) R. A charge-sensor, held
at no voltage by the amplifier that takes its charge, reads y = -d'x/C~ on a condenser of its own capacity, where its thickness is free.

What the law hears is what bends and stretches along the wall. A sensor in a solid wall feels the pressure across it too, up to the
resonances of the thickness, and an actuator moves the faces at once: an ideal law would answer pressure by pressure, without any bound,
and drive the thickness within nanoseconds. With A of the shapes along the wall alone, h = p A (loads, u) of all voltages u is heard,
over 1 - Y_0 where an open circuit charges itself through the thickness (Y_0 at rest). Open circuits feel all that moves.

"paper": a sensor is the potential in the middle of its layer, whose faces are grounded; an actuator pushes along the radius alone, as the
field's hoop stress does through u_r/r, with the paper's pressure per volt, spread evenly over the thickness of its layer.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.structure.elastic_basis import OrdersBasis, displacements, layer_strains
from coaxshell.structure.elastic_depth import STRESSES, Shown, place_in_layer, shown_by_shapes
from coaxshell.structure.elastic_mesh import LayerMesh
from coaxshell.structure.shape_sums import modal_sums
from coaxshell.structure.solid import AXIAL, HOOP, RADIAL, RADIAL_AXIAL, RADIAL_HOOP


def along_wall(wavenumber: float) -> int:
    """Return how many shapes of each order bend and stretch along the wall, the lowest; all others move through its thickness.

    Two, or three in a wave along the axis: as many as displacements take part. The others answer voltages without inertia, and the law
    does not hear them: resonances of the thickness, a thousand times faster than the shock, are no business of a control law, which would
    drive them without any bound.
    """
    return displacements(wavenumber)


@dataclass(frozen=True)
class Transducers:
    """Which layers of a wall sense and act.

    Attributes
    ----------
    electrodes : bool
        Whether layers lie between electrodes, or sense and act as in the paper.
    sensors, actuators : tuple of int
        Numbers of the layers, from the inside out; one each in the paper.
    push : float
        In the paper: inward force per radian and volt.
    limit : float
        Of the voltage, V.
    shorted : tuple of int
        Those of the sensors that are read by their charge, at no voltage.
    """

    electrodes: bool
    sensors: tuple[int, ...]
    actuators: tuple[int, ...]
    push: float = 0.0
    limit: float = float("inf")
    shorted: tuple[int, ...] = ()

    @property
    def driven(self) -> tuple[int, ...]:
        """Layers between electrodes, whose voltages load the wall: sensors too, of which open circuits charge themselves."""
        return tuple(sorted({*self.sensors, *self.actuators})) if self.electrodes else self.actuators

    @property
    def opened(self) -> FloatArray:
        """1 for each driven layer whose circuit is open, else 0."""
        held = {*self.actuators, *self.shorted}
        return np.array([float(self.electrodes and one not in held) for one in self.driven])

    @property
    def acting(self) -> FloatArray:
        """1 for each driven layer that the control law drives, else 0."""
        return np.array([float(one in self.actuators) for one in self.driven])

    @property
    def sensing(self) -> FloatArray:
        """The share of each reading in what the control law reads: the mean of all sensors."""
        if not self.electrodes:
            return np.ones(1)
        return np.array([float(one in self.sensors) / max(1, len(self.sensors)) for one in self.driven])

    @property
    def circuits(self) -> Circuits:
        """By what voltages and readings the loop is closed: one of each where no circuit is open, else those of every layer."""
        count = len(self.driven)
        if self.opened.any():
            return Circuits(np.eye(count), np.eye(count), self.opened, self.acting, self.sensing)
        return Circuits(self.acting[:, None], self.sensing[None], np.zeros(1), np.ones(1), np.ones(1))


class Circuits(NamedTuple):
    """Voltages that are given and readings that are taken, of which a loop is closed.

    Attributes
    ----------
    shares : ndarray, shape (driven, circuits)
        Voltage of each driven layer per voltage of a circuit.
    reading : ndarray, shape (circuits, driven)
        What each circuit reads of the readings of the layers.
    opened, acting, sensing : ndarray, shape (circuits,)
        As of :class:`Transducers`, of circuits instead of layers.
    """

    shares: FloatArray
    reading: FloatArray
    opened: FloatArray
    acting: FloatArray
    sensing: FloatArray

    @property
    def any_open(self) -> bool:
        """Whether any circuit is open."""
        return bool(self.opened.any())


class Driven(NamedTuple):
    """Transducers of some orders, per unit of each shape.

    Attributes
    ----------
    loads : ndarray, shape (orders, driven, shapes)
        d: the force on each shape per volt.
    readings : ndarray, shape (orders, driven, shapes)
        Volts per unit of each shape.
    capacitance : ndarray, shape (orders, driven)
        C per radian; 0 in the paper.
    """

    loads: FloatArray
    readings: FloatArray
    capacitance: FloatArray


def by_circuits(driven: Driven, circuits: Circuits) -> Driven:
    """Return the loads and readings of the circuits instead of the layers; capacitances stay those of the layers."""
    return Driven(circuits.shares.T @ driven.loads, circuits.reading @ driven.readings, driven.capacitance)


def driven_of(basis: OrdersBasis, transducers: Transducers) -> Driven:
    """Return the loads and readings of the transducers of a wall."""
    if not transducers.electrodes:
        push, read = pushed_evenly(basis, transducers.actuators[0], transducers.push), read_in_middle(basis, transducers.sensors[0])
        return Driven(push[:, None], read[:, None], np.zeros((basis.orders.size, 1)))
    found = [_between_electrodes(basis.mesh.layers[number], basis.orders, basis.wavenumber) for number in transducers.driven]
    loads, readings = [], []
    for number, layer in zip(transducers.driven, found, strict=True):
        shapes = basis.shapes[..., basis.mesh.layers[number].nodes]
        load = np.einsum("mcp,mncp->mn", layer.load, shapes)
        loads.append(load)
        read = np.einsum("mcp,mncp->mn", layer.along, shapes) if number in transducers.actuators else load
        opened = number not in transducers.actuators and number not in transducers.shorted
        readings.append(-read / (layer.capacitance if opened else layer.free)[:, None])
    return Driven(np.stack(loads, axis=1), np.stack(readings, axis=1), np.stack([one.capacitance for one in found], axis=1))


def pushed_evenly(basis: OrdersBasis, number: int, push: float) -> FloatArray:
    """Return the force of the paper's actuator, a layer, on each shape per volt, shape (orders, shapes)."""
    actuator = basis.mesh.layers[number]
    mean = actuator.weights / (actuator.radius * actuator.layer.thickness)
    return np.asarray(-push * (basis.shapes[:, :, 0, actuator.nodes] @ mean))


def read_in_middle(basis: OrdersBasis, number: int) -> FloatArray:
    """Return what the paper's sensor, a layer, reads per unit of each shape, V, shape (orders, shapes)."""
    sensor = basis.mesh.layers[number].layer
    return -shown_by_shapes(basis, number, 0.5 * (sensor.inner + sensor.outer), "potential")


class _Electroded(NamedTuple):
    """One layer: d on displacements at its points, (orders, displacements, points), C, (orders,), and psi at the points.

    ``along`` and ``free`` are d of the strains along the wall alone and C where the thickness is free.
    """

    load: FloatArray
    capacitance: FloatArray
    profile: FloatArray
    along: FloatArray
    free: FloatArray


def _between_electrodes(part: LayerMesh, orders: FloatArray, wavenumber: float) -> _Electroded:
    layer, local, weights, slope = part.layer, layer_strains(part, orders, wavenumber), part.weights, part.derivative
    assert layer.coupling is not None
    assert layer.permittivity is not None
    e, mu, per_radius = np.array(layer.coupling), layer.permittivity, orders[:, None] / part.radius
    electric = np.einsum("qi,q,qj->ij", slope, mu[0] * weights, slope) + np.zeros((orders.size, 1, 1))
    places, last = np.arange(part.radius.size), part.radius.size - 1
    electric[:, places, places] += mu[1] * weights * per_radius**2 + mu[2] * weights * wavenumber**2
    profile = np.zeros((orders.size, part.radius.size))
    profile[:, 0], profile[:, last] = 0.5, -0.5
    at_faces = 0.5 * (electric[:, 1:-1, 0] - electric[:, 1:-1, last])
    profile[:, 1:-1] = -np.linalg.solve(electric[:, 1:-1, 1:-1], at_faces[..., None])[..., 0]
    radial = np.einsum("j,mjqcp->mqcp", e[0, [RADIAL, HOOP, AXIAL]], local[:, [RADIAL, HOOP, AXIAL]])
    load = np.einsum("mq,mqcp->mcp", -weights * (profile @ slope.T), radial)
    load += np.einsum("mq,mqcp->mcp", weights * per_radius * profile * e[1, RADIAL_HOOP], local[:, RADIAL_HOOP])
    load += np.einsum("mq,mqcp->mcp", weights * wavenumber * profile * e[2, RADIAL_AXIAL], local[:, RADIAL_AXIAL])
    capacitance = np.einsum("mi,mij,mj->m", profile, electric, profile)
    c33 = layer.stiffness[RADIAL][RADIAL]
    reduced = {place: e[0, place] - e[0, RADIAL] * layer.stiffness[RADIAL][place] / c33 for place in (HOOP, AXIAL)}
    weighted = -weights * (profile @ slope.T)
    along = sum(coupling * np.einsum("mq,mqcp->mcp", weighted, local[:, place]) for place, coupling in reduced.items())
    return _Electroded(load, capacitance, profile, along, capacitance * (1.0 + e[0, RADIAL] ** 2 / (c33 * mu[0])))


def field_of_volts(basis: OrdersBasis, transducers: Transducers, number: int, radius: float, what: Shown) -> FloatArray:
    """Return what a volt on each driven layer adds by its field to a quantity at a radius of a layer, shape (orders, driven)."""
    found = np.zeros((basis.orders.size, len(transducers.driven)))
    if not transducers.electrodes or number not in transducers.driven or what not in STRESSES:
        return found
    part, at = place_in_layer(basis, number, radius)
    profile = _between_electrodes(part, basis.orders, basis.wavenumber).profile
    e = np.array(part.layer.coupling)[:, STRESSES[what]]
    along = e[1] * basis.orders / radius + e[2] * basis.wavenumber
    found[:, transducers.driven.index(number)] = e[0] * (profile @ (at @ part.derivative)) - along * (profile @ at)
    return found


class Loop(NamedTuple):
    """What transducers do to a wall, feedback and open circuits included.

    Attributes
    ----------
    moved : ndarray, shape (2, circuits, orders, nodes)
        Inward displacement of each face per volt.
    volts : ndarray, shape (circuits, 2, orders, nodes)
        Voltages per inward load on either face.
    sensed : ndarray, shape (2, orders, nodes)
        What the control law reads per inward load on either face.
    given : ndarray, shape (circuits, orders, nodes)
        Voltages per volt that is given to all actuators beside what the law asks for.
    heard : ndarray, shape (orders, nodes)
        What the control law reads of that volt.
    characteristic : ndarray, shape (orders, nodes)
        det(1 - L Y).
    shares : ndarray, shape (driven, circuits)
        Of :class:`Circuits`: voltages of the layers are their product with those of the circuits.
    """

    moved: ComplexArray
    volts: ComplexArray
    sensed: ComplexArray
    given: ComplexArray
    heard: ComplexArray
    characteristic: ComplexArray
    shares: FloatArray


def at_rest(basis: OrdersBasis, shown: FloatArray, driven: Driven) -> FloatArray:
    """Return what voltages do through the thickness, where they find no inertia, shape (orders, quantities, driven).

    ``shown`` are quantities per unit of each shape, (orders, quantities, shapes).
    """
    high = slice(along_wall(basis.wavenumber), None)
    return np.asarray(np.einsum("mqn,mjn,mn->mqj", shown[..., high], driven.loads[..., high], 1.0 / basis.squares[:, high]))


class LoopPart(NamedTuple):
    """What closes a loop, of some orders.

    Attributes
    ----------
    rows : ndarray, shape (orders, rows, 2 or 3)
        Weights of the shapes that bend and stretch along the wall in D (2 J rows), in what is heard per load (2 J) and per volt (J J).
    moved : ndarray, shape (orders, 2, circuits)
        Inward displacements of the faces that volts make at once.
    charged : ndarray, shape (orders, 2 J, shapes), or None
        Weights of all shapes in the readings per load; None where no circuit is open.
    at_once : ndarray, shape (orders, circuits, circuits), or None
        What volts add at once to these.
    """

    rows: FloatArray
    moved: FloatArray
    charged: FloatArray | None
    at_once: FloatArray | None


def loop_part(
    basis: OrdersBasis, driven: Driven, wetted: tuple[float, float], *, opened: bool, at_once: FloatArray | None = None
) -> LoopPart:
    """Return it from the shapes of some orders and their transducers.

    Parameters
    ----------
    basis : OrdersBasis
    driven : Driven
        Of the circuits.
    wetted : (float, float)
    opened : bool
        Whether any circuit is open.
    at_once : ndarray, optional
        Readings per volt at once, where they are not those of *basis*.
    """
    size, along = basis.orders.size, slice(along_wall(basis.wavenumber))
    pressed = -basis.faces * np.array(wetted)[:, None]
    moved = -basis.faces[:, :, None, along] * driven.loads[:, None, :, along]
    read = driven.readings[:, :, None] * pressed[:, None]
    answer = driven.readings[:, :, None, along] * driven.loads[:, None, :, along]
    rows = np.concatenate([one.reshape(size, -1, one.shape[-1]) for one in (moved, read[..., along], answer)], axis=1)
    resting = at_rest(basis, -basis.faces, driven)
    if not opened:
        return LoopPart(rows, resting, None, None)
    own = at_rest(basis, driven.readings, driven) if at_once is None else at_once
    return LoopPart(rows, resting, read.reshape(size, -1, read.shape[-1]), own)


class OpenCircuits(NamedTuple):
    """What circuits read of all that moves, as far as they are open.

    Attributes
    ----------
    charged : ndarray, shape (circuits, 2, orders, nodes)
        Readings per inward load on either face.
    by_volts : ndarray, shape (circuits, circuits, orders, nodes)
        Readings per volt.
    at_once : ndarray, shape (circuits, circuits, orders, nodes or 1)
        What of these volts make through the thickness, at rest.
    """

    charged: ComplexArray
    by_volts: ComplexArray
    at_once: ComplexArray | FloatArray


class Unanswered(NamedTuple):
    """What a wall does while no voltage answers.

    Attributes
    ----------
    moved : ndarray, shape (2, circuits, orders, nodes)
        Inward displacement of each face per volt.
    heard : ndarray, shape (circuits, 2, orders, nodes)
        Readings of what moves along the wall, per inward load on either face.
    of_volts : ndarray, shape (circuits, circuits, orders, nodes)
        The same per volt.
    open : OpenCircuits or None
    """

    moved: ComplexArray
    heard: ComplexArray
    of_volts: ComplexArray
    open: OpenCircuits | None


def unanswered(parts: Sequence[LoopPart], squares: Sequence[FloatArray], s: ComplexArray) -> Unanswered:
    """Return it from what closes the loop and omega^2 of all shapes, of each part of a basis, at nodes."""
    sums = _joined([modal_sums(part.rows, square[:, : part.rows.shape[-1]], s) for part, square in zip(parts, squares, strict=True)])
    resting = np.concatenate([part.moved for part in parts])
    count, shape = resting.shape[2], sums.shape[1:]
    moved = sums[: 2 * count].reshape(2, count, *shape) + np.moveaxis(resting, 0, -1)[..., None]
    heard = sums[2 * count : 4 * count].reshape(count, 2, *shape)
    of_volts, circuits = sums[4 * count :].reshape(count, count, *shape), None
    each = [(part.charged, part.at_once) for part in parts if part.charged is not None and part.at_once is not None]
    if each:
        charged = _joined([modal_sums(rows, square, s) for (rows, _), square in zip(each, squares, strict=True)])
        at_once = np.moveaxis(np.concatenate([one for _, one in each]), 0, -1)[..., None]
        circuits = OpenCircuits(charged.reshape(count, 2, *shape), of_volts + at_once, at_once)
    return Unanswered(moved, heard, of_volts, circuits)


def _joined(parts: Sequence[ComplexArray]) -> ComplexArray:
    """Return the sums of all orders, (rows, orders, nodes), from those of the parts of a basis."""
    return parts[0] if len(parts) == 1 else np.concatenate(parts, axis=1)


def loop_sizes(bases: Sequence[OrdersBasis], driven: Sequence[Driven], highest: float) -> FloatArray:
    """Return the sum of |d||p| over all shapes below a frequency, shape (orders,), from all parts of a basis."""
    products = (np.einsum("mjn,min->mn", np.abs(one.loads), np.abs(one.readings)) for one in driven)
    return np.concatenate([(each * (basis.squares < highest**2)).sum(axis=1) for basis, each in zip(bases, products, strict=True)])


def resistance_along(basis: OrdersBasis, driven: Driven, law: ComplexArray, s: ComplexArray) -> FloatArray:
    """Return the least eigenvalue of the Hermitian part of (omega^2 + s^2 - H d p')/s on the shapes along a wall, shape (orders, nodes).

    -inf where other shapes answer too.

    Parameters
    ----------
    basis : OrdersBasis
    driven : Driven
        Of the one circuit.
    law : ndarray, shape (orders, nodes)
        H(s).
    s : ndarray, shape (nodes,)
    """
    along = along_wall(basis.wavenumber)
    fed_back = driven.loads[:, 0, :along, None] * driven.readings[:, 0, None, :along]
    matrix, places = -(law / s)[..., None, None] * fed_back[:, None], np.arange(along)
    matrix[..., places, places] += (basis.squares[:, None, :along] + (s * s)[:, None]) / s[:, None]
    least = _least_eigenvalue(0.5 * (matrix + np.conj(np.swapaxes(matrix, -1, -2))))
    least[np.any(basis.shapes[:, along:], axis=(1, 2, 3))] = -np.inf
    return np.asarray(least)


def _least_eigenvalue(matrix: ComplexArray) -> FloatArray:
    """Return the least eigenvalue of Hermitian matrices (..., n, n): of two rows by hand, which costs a tenth."""
    if matrix.shape[-1] != 2:
        return np.asarray(np.linalg.eigvalsh(matrix)[..., 0])
    one, other = matrix[..., 0, 0].real, matrix[..., 1, 1].real
    return np.asarray(0.5 * (one + other) - np.hypot(0.5 * (one - other), np.abs(matrix[..., 0, 1])))


def inertia_left_out(squares: FloatArray, s: ComplexArray, along: int) -> ComplexArray:
    """Return by how much more a voltage pushes each shape that answers it without inertia, 1 + s^2/omega^2, shape (shapes, nodes).

    ``along`` is how many shapes bend and stretch along the wall (:func:`along_wall`).
    """
    factor = np.ones((squares.size, s.size), np.complex128)
    factor[along:] += s * s / squares[along:, None]
    return factor


def closed_loop(wall: Unanswered, circuits: Circuits, law: ComplexArray | float) -> Loop:
    """Return the loop from what the wall does while no voltage answers: with O the open circuits, a what acts and h what is heard,

        u = O (y + Y u) + a H h,      h = s' (1 - O Y_0 O)^-1 (y_l + Y_l u),

    s the share of each reading in what the law reads, Y and y of all that moves, Y_l and y_l of what moves along the wall, Y_0 at rest.

    Parameters
    ----------
    wall : Unanswered
    circuits : Circuits
    law : ndarray or float
        H(s), broadcast to (orders, nodes).
    """
    shares, _, opened, acting, sensing = circuits
    count, shape = opened.size, wall.of_volts.shape[2:]
    gains = np.broadcast_to(law, shape)
    if count == 1 and wall.open is None:
        characteristic = 1.0 - acting[0] * sensing[0] * gains * wall.of_volts[0, 0]
        asked, given = sensing[0] * wall.heard[0] / characteristic, acting[0] / characteristic
        heard = sensing[0] * wall.of_volts[0, 0] * given
        return Loop(wall.moved, (acting[0] * gains * asked)[None], asked, given[None], heard, characteristic, shares)
    share = _heard_shares(wall.open, opened, sensing)
    of_loads, of_volts = (np.einsum("jmk,jbmk->bmk", share, each) for each in (wall.heard, wall.of_volts))
    driving = np.multiply.outer(acting, gains)
    matrix, asked = -driving[:, None] * of_volts, driving[:, None] * of_loads
    matrix += np.eye(count)[..., None, None]
    if wall.open is not None:
        is_open = opened[:, None, None, None]
        matrix, asked = matrix - is_open * wall.open.by_volts, asked + is_open * wall.open.charged
    given = np.broadcast_to(acting[:, None, None, None], (count, 1, *shape))
    square = np.moveaxis(matrix, (0, 1), (-2, -1))
    right = np.moveaxis(np.concatenate([asked, given], axis=1), (0, 1), (-2, -1))
    volts = np.moveaxis(np.linalg.solve(square, right), (-2, -1), (0, 1))
    heard = np.einsum("jmk,jbmk->bmk", of_volts, volts)
    return Loop(wall.moved, volts[:, :2], of_loads + heard[:2], volts[:, 2], heard[2], np.linalg.det(square), shares)


def _heard_shares(circuits: OpenCircuits | None, opened: FloatArray, sensing: FloatArray) -> ComplexArray | FloatArray:
    """Return s'(1 - O Y_0 O)^-1, by which the law reads each circuit's motion along the wall, (circuits, orders or 1, nodes or 1)."""
    if circuits is None:
        return sensing[:, None, None]
    at_once = circuits.at_once * np.outer(opened, opened)[..., None, None]
    matrix = np.eye(opened.size) - np.moveaxis(at_once, (0, 1), (-1, -2))  # transposed
    found = np.linalg.solve(matrix, np.broadcast_to(sensing[:, None], (*matrix.shape[:2], opened.size, 1)))
    return np.asarray(np.moveaxis(found[..., 0], -1, 0))
