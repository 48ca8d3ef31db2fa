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
from coaxshell.structure.solid import AXIAL, HOOP, RADIAL, RADIAL_AXIAL, RADIAL_HOOP


def along_wall(wavenumber: float) -> int:
    """Return how many shapes of each order bend and stretch along the wall, the lowest; all others move through its thickness.

    Two, or three in a wave along the axis: as many as displacements take part. The others answer voltages without inertia, and what
    sensors that are driven read of them is what loads on the faces make: resonances of the thickness, a thousand times faster than the
    shock, are no business of a control law, which would drive them without any bound.
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
    def listening(self) -> FloatArray:
        """1 for each driven layer that only reads, and so reads motions through the thickness too, else 0."""
        return np.array([float(self.electrodes and one not in self.actuators) for one in self.driven])

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
        """By what voltages and readings the loop is closed: one of each where all that reads is driven too, else those of every layer."""
        count = len(self.driven)
        if self.listening.any():
            return Circuits(np.eye(count), np.eye(count), self.opened, self.acting, self.sensing, self.listening)
        return Circuits(self.acting[:, None], self.sensing[None], np.zeros(1), np.ones(1), np.ones(1), np.zeros(1))


class Circuits(NamedTuple):
    """Voltages that are given and readings that are taken, of which a loop is closed.

    Attributes
    ----------
    shares : ndarray, shape (driven, circuits)
        Voltage of each driven layer per voltage of a circuit.
    reading : ndarray, shape (circuits, driven)
        What each circuit reads of the readings of the layers.
    opened, acting, sensing, listening : ndarray, shape (circuits,)
        As of :class:`Transducers`, of circuits instead of layers.
    """

    shares: FloatArray
    reading: FloatArray
    opened: FloatArray
    acting: FloatArray
    sensing: FloatArray
    listening: FloatArray


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


def loop_rows(basis: OrdersBasis, driven: Driven, wetted: tuple[float, float]) -> FloatArray:
    """Return the weights of all shapes in D (2 J rows), in readings per load (2 J) and per volt (J J), shape (orders, rows, shapes)."""
    size, shapes = basis.orders.size, basis.squares.shape[1]
    moved = -basis.faces[:, :, None] * driven.loads[:, None]
    pressed = -basis.faces * np.array(wetted)[:, None]
    read = driven.readings[:, :, None] * pressed[:, None]
    answer = driven.readings[:, :, None] * driven.loads[:, None]
    along = along_wall(basis.wavenumber)
    moved[..., along:] = answer[..., along:] = 0.0
    return np.concatenate([one.reshape(size, -1, shapes) for one in (moved, read, answer)], axis=1)


def at_rest(basis: OrdersBasis, shown: FloatArray, driven: Driven) -> FloatArray:
    """Return what voltages do through the thickness, where they find no inertia, shape (orders, quantities, driven).

    ``shown`` are quantities per unit of each shape, (orders, quantities, shapes).
    """
    high = slice(along_wall(basis.wavenumber), None)
    return np.asarray(np.einsum("mqn,mjn,mn->mqj", shown[..., high], driven.loads[..., high], 1.0 / basis.squares[:, high]))


class LoopPart(NamedTuple):
    """What closes a loop, of some orders: weights of all shapes (:func:`loop_rows`), and what volts do at once.

    ``moved`` are inward displacements of the faces, (orders, 2, driven), ``read`` readings, (orders, driven, driven), per volt.
    """

    rows: FloatArray
    moved: FloatArray
    read: FloatArray


def loop_part(basis: OrdersBasis, driven: Driven, wetted: tuple[float, float]) -> LoopPart:
    """Return it from the shapes of some orders and their transducers."""
    return LoopPart(loop_rows(basis, driven, wetted), at_rest(basis, -basis.faces, driven), at_rest(basis, driven.readings, driven))


def loop_sizes(bases: Sequence[OrdersBasis], driven: Sequence[Driven], highest: float) -> FloatArray:
    """Return the sum of |d||p| over all shapes below a frequency, shape (orders,), from all parts of a basis."""
    products = (np.einsum("mjn,min->mn", np.abs(one.loads), np.abs(one.readings)) for one in driven)
    return np.concatenate([(each * (basis.squares < highest**2)).sum(axis=1) for basis, each in zip(bases, products, strict=True)])


def inertia_left_out(squares: FloatArray, s: ComplexArray, along: int) -> ComplexArray:
    """Return by how much more a voltage pushes each shape that answers it without inertia, 1 + s^2/omega^2, shape (shapes, nodes).

    ``along`` is how many shapes bend and stretch along the wall (:func:`along_wall`).
    """
    factor = np.ones((squares.size, s.size), np.complex128)
    factor[along:] += s * s / squares[along:, None]
    return factor


def closed_loop(sums: ComplexArray, resting: tuple[FloatArray, FloatArray], circuits: Circuits, law: ComplexArray | float) -> Loop:
    """Return the loop from the sums over all shapes of :func:`loop_rows` and the control law H(s), 0 without feedback.

    Parameters
    ----------
    sums : ndarray, shape (rows, orders, nodes)
    resting : tuple of ndarray
        Of :func:`at_rest`, inward displacements of the faces, (orders, 2, circuits), and readings, (orders, circuits, circuits).
    circuits : Circuits
    law : ndarray or float
        Broadcast to (orders, nodes).
    """
    count, shape = circuits.opened.size, sums.shape[1:]
    moved = sums[: 2 * count].reshape(2, count, *shape) + np.moveaxis(resting[0], 0, -1)[..., None]
    read = sums[2 * count : 4 * count].reshape(count, 2, *shape)
    at_once = np.moveaxis(resting[1] * circuits.listening[:, None], 0, -1)[..., None]
    return loop_closed(moved, read, sums[4 * count :].reshape(count, count, *shape) + at_once, circuits, law)


def loop_closed(moved: ComplexArray, read: ComplexArray, answer: ComplexArray, circuits: Circuits, law: ComplexArray | float) -> Loop:
    """Return the loop from what the wall does while no voltage answers.

    Parameters
    ----------
    moved : ndarray, shape (2, circuits, orders, nodes)
        Inward displacement of each face per volt.
    read : ndarray, shape (circuits, 2, orders, nodes)
        Readings per inward load on either face.
    answer : ndarray, shape (circuits, circuits, orders, nodes)
        Readings per volt.
    circuits : Circuits
    law : ndarray or float
        H(s), broadcast to (orders, nodes).
    """
    shares, _, opened, acting, sensing, _ = circuits
    count, shape = opened.size, answer.shape[2:]
    gains = np.broadcast_to(law, shape)
    if count == 1:
        own = opened[0] + acting[0] * sensing[0] * gains
        characteristic = 1.0 - own * answer[0, 0]
        asked, given = read[0] / characteristic, acting[0] / characteristic
        heard = sensing[0] * answer[0, 0] * given
        return Loop(moved, (own * asked)[None], sensing[0] * asked, given[None], heard, characteristic, shares)
    laws = np.diag(opened)[..., None, None] + np.multiply.outer(np.outer(acting, sensing), gains)
    matrix = np.eye(count)[..., None, None] - np.einsum("ijmk,jlmk->ilmk", laws, answer)
    given = np.broadcast_to(acting[:, None, None, None], (count, 1, *shape))
    asked = np.concatenate([np.einsum("ijmk,jbmk->ibmk", laws, read), given], axis=1)
    square = np.moveaxis(matrix, (0, 1), (-2, -1))
    volts = np.moveaxis(np.linalg.solve(square, np.moveaxis(asked, (0, 1), (-2, -1))), (-2, -1), (0, 1))
    heard = np.einsum("i,ibmk->bmk", sensing, np.einsum("ijmk,jbmk->ibmk", answer, volts))
    sensed = np.einsum("j,jbmk->bmk", sensing, read) + heard[:2]
    return Loop(moved, volts[:, :2], sensed, volts[:, 2], heard[2], np.linalg.det(square), shares)
