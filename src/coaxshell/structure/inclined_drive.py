"""What voltages do to walls of solids in waves that run along the axis with a front, and what their circuits read.

As across the axis (:mod:`coaxshell.structure.solid_driven`) a voltage finds the inertia of motions along the wall alone. With Y of a stack,
the layers side by side that are driven together (:mod:`coaxshell.structure.inclined_shapes`), B B' = M Y W^-1 Y'M, and K_g its stiffness,

    (K_g + s^2 B B') x = d u:      [K_g    M Y     ] [x     ]   [d u]
                                   [Y'M   -W/s^2   ] [lambda] = [0  ],

lambda = s^2 W^-1 Y'M x; what the law hears is p'Y W^-1 Y'M x, of a volt p'Y lambda/s^2. K_g may be as near to singular as it likes: long
waves are no case of their own. A stack that is the whole wall moves so. Beside rubbers it is made to by the forces

    f = d u + s^2 (M - B B') x,

under which the wall answers with all its inertia.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import ComplexArray
from coaxshell.numerics.blas_threads import one_blas_thread
from coaxshell.numerics.lobatto import interpolation
from coaxshell.numerics.modes import Modes
from coaxshell.structure.elastic_basis import layer_strains
from coaxshell.structure.elastic_depth import STRESSES
from coaxshell.structure.elastic_mesh import LayerMesh, wall_mesh
from coaxshell.structure.inclined_shapes import LowestShapes, lowest_shapes
from coaxshell.structure.solid import AXIAL, HOOP, RADIAL, RADIAL_AXIAL, RADIAL_HOOP, SolidLayer
from coaxshell.structure.solid_inclined import (
    SAMPLES,
    Assembled,
    InclinedMesh,
    InclinedPlace,
    at_powers,
    inclined_meshes,
    meshed_equations,
    powers_of,
    wall_faces,
)
from coaxshell.structure.solid_transducers import Transducers

_DISPLACEMENTS = 3


class InclinedAnswer(NamedTuple):
    """What a wall does per outward force on its inner and its outer face, and per volt of each circuit while no voltage answers.

    Attributes
    ----------
    faces : ndarray, shape (2, 2, orders, nodes)
        Inward displacements of the faces per force.
    shown, heard, strokes : ndarray, shape (places, 2, orders, nodes), (circuits, 2, ...) and (driven, 2, ...)
        Per force; of the circuits what moves along the wall.
    charged : ndarray, shape (circuits, 2, orders, nodes)
        All that they read.
    moved : ndarray, shape (2, circuits, orders, nodes)
        Inward displacements of the faces per volt.
    by_volts, of_volts, all_of_volts, strokes_by_volts : ndarray
        The rest per volt, (..., circuits, orders, nodes); places with the field that a volt makes in its layer.
    at_once : ndarray, shape (circuits, circuits, orders, nodes)
        What circuits read per volt of what moves through the thickness of stacks, without inertia.
    """

    faces: ComplexArray
    shown: ComplexArray
    heard: ComplexArray
    strokes: ComplexArray
    charged: ComplexArray
    moved: ComplexArray
    by_volts: ComplexArray
    of_volts: ComplexArray
    all_of_volts: ComplexArray
    strokes_by_volts: ComplexArray
    at_once: ComplexArray


class _Electrodes:
    """A layer between electrodes by powers of m and k: Q and G of its potential at all its points, and the strains along the wall.

    Attributes
    ----------
    part : LayerMesh
    """

    def __init__(self, part: LayerMesh) -> None:
        self.part = part
        layer, slope, weights, size = part.layer, part.derivative, part.weights, part.radius.size
        assert layer.coupling is not None
        assert layer.permittivity is not None
        e, mu, c33 = np.array(layer.coupling), layer.permittivity, layer.stiffness[RADIAL][RADIAL]
        charge, electric, along = {}, {}, {}
        for m, k in SAMPLES:
            local = layer_strains(part, np.array([m]), k, _DISPLACEMENTS)[0]
            radial = np.einsum("j,jqcp->qcp", e[0, [RADIAL, HOOP, AXIAL]], local[[RADIAL, HOOP, AXIAL]])
            around = (m / part.radius)[:, None, None] * e[1, RADIAL_HOOP] * local[RADIAL_HOOP] + k * e[2, RADIAL_AXIAL] * local[
                RADIAL_AXIAL
            ]
            charge[m, k] = (slope * weights[:, None]).T @ radial.reshape(size, -1) - (weights[:, None, None] * around).reshape(size, -1)
            square = mu[1] * (m / part.radius) ** 2 + mu[2] * k**2
            electric[m, k] = (slope * (mu[0] * weights)[:, None]).T @ slope + np.diag(weights * square)
            each = ((e[0, one] - e[0, RADIAL] * layer.stiffness[RADIAL][one] / c33) * local[one] for one in (HOOP, AXIAL))
            along[m, k] = -(weights[:, None, None] * sum(each)).reshape(size, -1)
        self._charge, self._electric, self._along = powers_of(charge), powers_of(electric), powers_of(along)
        self._free = 1.0 + e[0, RADIAL] ** 2 / (c33 * mu[0])

    def at(self, order: float, k: ComplexArray) -> _Electroded:
        """Return it at an order and some wavenumbers."""
        electric, last = at_powers(self._electric, order, k), self.part.radius.size - 1
        profile = np.zeros((k.size, last + 1), np.complex128)
        profile[:, 0], profile[:, last] = 0.5, -0.5
        at_faces = 0.5 * (electric[:, 1:-1, 0] - electric[:, 1:-1, last])
        profile[:, 1:-1] = -np.linalg.solve(electric[:, 1:-1, 1:-1], at_faces[..., None])[..., 0]
        powers = np.stack([np.ones_like(k), order + 0.0 * k, order**2 + 0.0 * k, k, k * k, order * k])
        load = -np.einsum("jn,jnb->nb", powers, profile @ self._charge)
        along = np.einsum("jn,jnb->nb", powers, (profile @ self.part.derivative.T) @ self._along)
        capacitance = np.einsum("ni,nij,nj->n", profile, electric, profile)
        return _Electroded(load, along, profile, capacitance, self._free * capacitance)

    def field(self, order: float, k: ComplexArray, profile: ComplexArray, place: InclinedPlace) -> ComplexArray:
        """Return what the field of a volt adds to a stress at a radius of the layer, shape (nodes,)."""
        part = self.part
        inside = 2.0 * (place.radius - part.layer.inner) / part.layer.thickness - 1.0
        at = interpolation(part.degree, min(max(inside, -1.0), 1.0))
        e = np.array(part.layer.coupling)[:, STRESSES[place.what]]
        along = e[1] * order / place.radius + e[2] * k
        return np.asarray(e[0] * (profile @ (at @ part.derivative)) - along * (profile @ at))


class _Electroded(NamedTuple):
    """d and the strains along the wall that are read, (nodes, 3 (p + 1)), psi, C, and C of a free thickness."""

    load: ComplexArray
    along: ComplexArray
    profile: ComplexArray
    capacitance: ComplexArray
    free: ComplexArray


_electrodes = lru_cache(maxsize=64)(_Electrodes)


class _Volts(NamedTuple):
    """Loads and readings of circuits and layers at an order and nodes, on displacements over the root of the mass.

    Attributes
    ----------
    loads, readings : ndarray, shape (nodes, circuits, N)
    strokes : ndarray, shape (nodes, driven, N)
        d of every driven layer.
    profiles : dict
        psi of the layers between electrodes, by number.
    """

    loads: ComplexArray
    readings: ComplexArray
    strokes: ComplexArray
    profiles: dict[int, ComplexArray]


def _volts(equations: InclinedMesh, transducers: Transducers, order: float, k: ComplexArray, first: int) -> _Volts:
    """Return them of the layers of a stack, of which the wall's number *first* is the first; 0 of the wall's other layers."""
    every, root, layers = transducers, equations.root, equations.mesh.layers
    loads, readings = (np.zeros((k.size, len(every.driven), equations.inertia.size), np.complex128) for _ in range(2))
    profiles = {}
    here = {number: layers[number - first] for number in {*every.driven, *every.sensors} if 0 <= number - first < len(layers)}
    for number, part in here.items():
        columns = equations.columns(part)
        if every.electrodes:
            found, place = _electrodes(part).at(order, k), every.driven.index(number)
            opened = number not in every.actuators and number not in every.shorted
            read, condenser = (found.along if number in every.actuators else found.load), (found.capacitance if opened else found.free)
            loads[:, place, columns] = found.load / root[columns]
            readings[:, place, columns] = -read / (condenser[:, None] * root[columns])
            profiles[number] = found.profile
            continue
        if number in every.actuators:
            places = columns[: part.radius.size]
            loads[:, 0, places] = -every.push * part.weights / (part.radius * part.layer.thickness * root[places])
        if number == every.sensors[0]:
            readings[:, 0, columns] = -equations.of_potential(part, interpolation(part.degree, 0.0), order, k)
    circuits = every.circuits
    return _Volts(circuits.shares.T @ loads, circuits.reading @ readings, loads, profiles)


class _Stack:
    """Layers of a wall that are driven together, by themselves: with no other layers on their faces.

    Parameters
    ----------
    wall : InclinedMesh
        The equations of the whole wall.
    numbers : range
        Of the layers.
    """

    def __init__(self, wall: InclinedMesh, numbers: range) -> None:
        self.numbers, whole = numbers, len(numbers) == len(wall.mesh.layers)
        parts = [wall.mesh.layers[number] for number in numbers]
        self.equations = wall if whole else meshed_equations(wall_mesh([one.layer for one in parts], [one.degree for one in parts]))
        own = self.equations.mesh
        self.places = np.arange(wall.inertia.size)
        self._ratio = np.ones(wall.inertia.size)
        if not whole:
            points, start = own.radius.size, parts[0].nodes.start
            displaced = [which * wall.mesh.radius.size + start + point for which in range(_DISPLACEMENTS) for point in range(points)]
            self.places = np.array(displaced)
            self._ratio = wall.root[self.places] / self.equations.root

    def in_wall(self, forces: ComplexArray, size: int) -> ComplexArray:
        """Return forces on its displacements as forces on those of the wall, (nodes, N, loads)."""
        found = np.zeros((len(forces), size, forces.shape[-1]), np.complex128)
        found[:, self.places] = forces[:, : self.places.size] / self._ratio[:, None]
        return found

    def rows_in_wall(self, rows: ComplexArray, size: int) -> ComplexArray:
        """Return rows per unit of its displacements, (nodes, rows, N), as rows per unit of those of the wall."""
        found = np.zeros((*rows.shape[:2], size), np.complex128)
        found[..., self.places] = rows[..., : self.places.size] / self._ratio
        return found


class _Driven(NamedTuple):
    """What a stack adds at an order and nodes: x under volts or forces that make it, and rows of the wall."""

    moved: ComplexArray
    forces: ComplexArray | None
    hearing: ComplexArray
    readings: ComplexArray
    strokes: ComplexArray
    of_volts: ComplexArray
    at_once: ComplexArray
    profiles: dict[int, ComplexArray]


class InclinedDrive:
    """The transducers of a wall on one mesh.

    Parameters
    ----------
    equations : InclinedMesh
    transducers : Transducers
    stacks : tuple of range
        The layers that are driven together.
    orders : tuple of float
        That share the mesh.
    """

    def __init__(self, equations: InclinedMesh, transducers: Transducers, stacks: tuple[range, ...], orders: tuple[float, ...]) -> None:
        self._equations, self._transducers, self._orders = equations, transducers, orders
        self._stacks = [_Stack(equations, numbers) for numbers in stacks]
        self._shapes: list[LowestShapes] = [lowest_shapes(stack.equations.mesh, orders) for stack in self._stacks]

    def put(self, found: InclinedAnswer, member: int, at: int, k: ComplexArray, s: ComplexArray, places: Sequence[InclinedPlace]) -> None:
        """Put down what the wall answers in one order, by its number in the mesh and in the answer, at all nodes."""
        equations, order = self._equations, self._orders[member]
        every = [*wall_faces([part.layer for part in equations.mesh.layers]), *places]
        rows, layers = np.stack([equations.rows(place) for place in every]), [place.layer for place in every]
        for start in range(0, s.size, step := equations.nodes_together):
            some = slice(start, start + step)
            assembled = equations.assembled(order, k[some], s[some])
            each = [self._stack(number, member, k[some], s[some], assembled) for number in range(len(self._stacks))]
            moving = assembled.moving()
            forces = [one.forces for one in each if one.forces is not None]
            loads = np.broadcast_to(equations.forces_on_faces.astype(np.complex128), (k[some].size, equations.inertia.size, 2))
            answer, _ = moving.solve(np.concatenate([loads, np.sum(forces, axis=0)], axis=-1) if forces else loads)
            under, volts = answer[..., :2], answer[..., 2:] if forces else each[0].moved
            shown, by_volts = (equations.shown(order, k[some], s[some], x, rows, layers) for x in (under, volts))
            for one in each:
                self._add_fields(by_volts, one.profiles, order, k[some], every)
            found.faces[:, :, at, some], found.shown[:, :, at, some] = shown[:2], shown[2:]
            found.moved[:, :, at, some], found.by_volts[:, :, at, some] = by_volts[:2], by_volts[2:]
            read = [
                ([one.hearing for one in each], found.heard, found.of_volts),
                ([one.readings for one in each], found.charged, found.all_of_volts),
                ([one.strokes for one in each], found.strokes, found.strokes_by_volts),
            ]
            for parts, per_force, per_volt in read:
                row = np.sum(parts, axis=0)
                per_force[:, :, at, some], per_volt[:, :, at, some] = (np.moveaxis(row @ x, 0, -1) for x in (under, volts))
            found.at_once[:, :, at, some] = np.moveaxis(np.sum([one.at_once for one in each], axis=0), 0, -1)
            if not forces:
                found.of_volts[:, :, at, some] = np.moveaxis(each[0].of_volts, 0, -1)

    def _stack(self, number: int, member: int, k: ComplexArray, s: ComplexArray, assembled: Assembled) -> _Driven:
        """Return what a stack does at some nodes, and what is read of it as rows of the wall."""
        stack, order, size = self._stacks[number], self._orders[member], self._equations.inertia.size
        own = stack.equations
        whole, count = own is self._equations, own.inertia.size
        volts = _volts(own, self._transducers, order, k, stack.numbers.start)
        lowest = np.zeros((k.size, count, 3), np.complex128)
        lowest[:, : own.root.size] = self._shapes[number].at(member, k)
        turned, square = np.swapaxes(lowest, 1, 2), (s * s)[:, None, None]
        mass = turned @ lowest
        still = assembled if whole else own.assembled(order, k, s)
        loads = np.swapaxes(volts.loads, 1, 2)
        moved, pushed = still.solve(loads, lowest, -mass / square)
        along = volts.readings @ lowest
        of_volts, hearing = along @ pushed / square, along @ np.linalg.solve(mass, turned)
        at_once = volts.readings @ moved - of_volts
        if whole:
            return _Driven(moved, None, hearing, volts.readings, volts.strokes, of_volts, at_once, volts.profiles)
        inertia = own.inertia[:, None] * moved - lowest @ (pushed / square)
        forces = stack.in_wall(loads + square * inertia, size)
        heard, read, stroked = (stack.rows_in_wall(each, size) for each in (hearing, volts.readings, volts.strokes))
        return _Driven(moved, forces, heard, read, stroked, of_volts, at_once, volts.profiles)

    def _add_fields(
        self, by_volts: ComplexArray, profiles: dict[int, ComplexArray], order: float, k: ComplexArray, every: Sequence[InclinedPlace]
    ) -> None:
        """Add what the field of each circuit's volt does to stresses within the layers that it drives, in place."""
        driven, shares = self._transducers.driven, self._transducers.circuits.shares
        for row, place in enumerate(every):
            if place.what in STRESSES and place.layer in profiles:
                field = _electrodes(self._equations.mesh.layers[place.layer]).field(order, k, profiles[place.layer], place)
                by_volts[row] += np.multiply.outer(shares[driven.index(place.layer)], field)


_drives = lru_cache(maxsize=24)(InclinedDrive)


def inclined_under_volts(
    layers: Sequence[SolidLayer],
    modes: Modes,
    s: ComplexArray,
    frequency: float,
    places: Sequence[InclinedPlace],
    transducers: Transducers,
    stacks: tuple[range, ...],
) -> InclinedAnswer:
    """Return what a wall with transducers answers.

    Parameters
    ----------
    layers, modes, s, frequency, places
        As of :func:`coaxshell.structure.solid_inclined.inclined_port`.
    transducers : Transducers
    stacks : tuple of range
        The layers that are driven together.
    """
    k = np.broadcast_to(np.asarray(modes.wavenumber, np.complex128), s.shape)
    circuits, driven, shape = transducers.circuits.opened.size, len(transducers.driven), (modes.count, s.size)
    sizes = [(2, 2), (len(places), 2), (circuits, 2), (driven, 2), (circuits, 2), (2, circuits), (len(places), circuits)]
    sizes += [(circuits, circuits), (circuits, circuits), (driven, circuits), (circuits, circuits)]
    found = InclinedAnswer(*(np.empty((*each, *shape), np.complex128) for each in sizes))
    with one_blas_thread():  # many small matrices
        for members, equations in inclined_meshes(layers, modes, s, frequency):
            orders = tuple(float(m) for m in modes.orders[members])
            drive = _drives(equations, transducers, stacks, orders)
            for member in range(len(orders)):
                drive.put(found, member, members.start + member, k, s, places)
    return found
