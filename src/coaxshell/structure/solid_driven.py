"""What voltages do to walls of solids in pieces, of which some have losses (:mod:`coaxshell.structure.solid_pieces`).

As without losses (:mod:`coaxshell.structure.solid_transducers`) a voltage finds the inertia of motions along the wall alone. Pieces with
shapes that lie side by side are a *stack*; with X the lowest shapes of the whole of it where every factor is 1, two or in waves along the
axis three, B = M X, and K_g the stiffness of its pieces under their factors, joined face to face,

    (K_g + s^2 B B') x = d u:      x = K_g^-1 (d u - s^2 B y),      y = (1 + s^2 B'K_g^-1 B)^-1 B'K_g^-1 d u.

Of order 1 in the plane a piece moves as it is without any force: it stands on a spring, which columns beside B, with the
spring's stiffness for -s^2, take away again. (Nothing turns a piece of order 0, whose spring may stay.)

Of a stack without losses that is the sum over its shapes, those of X with omega^2 + s^2 and all others with omega^2. Its free faces move by
what its neighbours, rubbers by their potentials, and the fluids have to follow: displacements apart, that joints close with all inertia.
What the control law hears is what moves along the wall, p'X y, and of loads on the faces p'X B'x; open circuits read all of x.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.lobatto import interpolation, lobatto
from coaxshell.numerics.modes import Modes, kept_with_modes
from coaxshell.structure.elastic_basis import OrdersBasis, displacements, elastic_basis
from coaxshell.structure.shell_model import FaceReceptance
from coaxshell.structure.solid_chain import PieceChain, WallReading
from coaxshell.structure.solid_pieces import RIGID, Entry, Piece, PieceAnswer, Place, Weights, on_faces, wavenumber_of
from coaxshell.structure.solid_transducers import Transducers, along_wall, driven_of, pushed_evenly, read_in_middle


class PieceLoads(NamedTuple):
    """Transducers of some orders of a piece, per unit of each of its shapes.

    Attributes
    ----------
    volts, readings : ndarray, shape (orders, circuits, shapes)
        d and p of the circuits that close the loop; 0 of layers of other pieces.
    strokes : ndarray, shape (orders, driven, shapes)
        d of every driven layer.
    capacitance : ndarray, shape (orders, driven)
    along : ndarray, shape (orders, 2 or 3, shapes)
        B.
    heard : ndarray, shape (orders, circuits, shapes)
        (p'X) B, p'X of the whole stack.
    rigid : ndarray, shape (orders, 1, shapes)
        1 of the shape of order 1 that moves the piece as it is.
    """

    volts: FloatArray
    readings: FloatArray
    strokes: FloatArray
    capacitance: FloatArray
    along: FloatArray
    heard: FloatArray
    rigid: FloatArray


class StackAnswer(NamedTuple):
    """What a stack whose faces are free does per volt of each circuit.

    Attributes
    ----------
    inside, outside : list of list
        For each circuit the displacements of its faces.
    shown : ndarray, shape (places + rows, circuits, orders, nodes)
        Places, what is heard, readings where any circuit is open, and strokes.
    forces : list
        For each circuit and piece the forces on its faces.
    pushed : ndarray, shape (2 or 3 + pieces, circuits, orders, nodes)
        s^2 y, and less what the spring under each piece gives: columns beside the voltages take so much away.
    """

    inside: list[list[ComplexArray]]
    outside: list[list[ComplexArray]]
    shown: ComplexArray
    forces: list[list[list[ComplexArray]]]
    pushed: ComplexArray

    def put(self, orders: slice, other: StackAnswer) -> None:
        """Put down another answer at some orders, in place."""
        pairs = [(self.inside, other.inside), (self.outside, other.outside)]
        pairs += [(mine, others) for mine, others in zip(self.forces, other.forces, strict=True)]
        for mine, others in pairs:
            for a, b in zip(mine, others, strict=True):
                for place, row in enumerate(b):
                    a[place] = np.broadcast_to(a[place], self.shown.shape[2:]).copy()
                    a[place][orders] = row
        self.shown[:, :, orders] = other.shown
        self.pushed[:, :, orders] = other.pushed


class DrivenAnswer(NamedTuple):
    """What a wall does per outward force on its inner and its outer face, and per volt of each circuit while no voltage answers.

    Attributes
    ----------
    chain : PieceChain
    shown, heard, strokes : ndarray, shape (places, 2, orders, nodes), (circuits, 2, ...) and (driven, 2, ...)
        Per force; of the circuits what moves along the wall.
    charged : ndarray, shape (circuits, 2, orders, nodes), or None
        All that they read; None where none is open.
    moved : ndarray, shape (2, circuits, orders, nodes)
        u_r of the faces per volt.
    by_volts, of_volts, strokes_by_volts : ndarray
        The rest per volt, (..., circuits, orders, nodes).
    all_of_volts, at_once : ndarray or None
        All that circuits read per volt, and what of that moves through the thickness of stacks, without inertia.
    forces : list
        For each piece and circuit the forces on its faces that close what stacks leave apart.
    stacks : list of StackAnswer
    """

    chain: PieceChain
    shown: ComplexArray
    heard: ComplexArray
    strokes: ComplexArray
    charged: ComplexArray | None
    moved: ComplexArray
    by_volts: ComplexArray
    of_volts: ComplexArray
    strokes_by_volts: ComplexArray
    all_of_volts: ComplexArray | None
    at_once: ComplexArray | None
    forces: list[list[list[Entry]]]
    stacks: list[StackAnswer]

    @property
    def receptance(self) -> FaceReceptance:
        """How the faces answer loads on them while no voltage does."""
        return FaceReceptance(*(np.asarray(x, dtype=np.complex128) for x in (self.chain.inner, self.chain.across, self.chain.outer)))


@dataclass(frozen=True, eq=False)
class WallDrive:
    """The transducers of a wall in pieces.

    Attributes
    ----------
    pieces : tuple of Piece
        Of the whole wall.
    transducers : Transducers
    along_alone : bool
        Whether voltages move the wall along itself alone, by X y.
    """

    pieces: tuple[Piece, ...]
    transducers: Transducers
    along_alone: bool = False

    @cached_property
    def stacks(self) -> tuple[range, ...]:
        """Numbers of the pieces of each stack that is driven, from the inside out."""
        found, start = [], 0
        for number in range(len(self.pieces) + 1):
            if number == len(self.pieces) or self.pieces[number].by_potentials:
                if start < number:
                    found.append(range(start, number))
                start = number + 1
        return tuple(each for each in found if self._is_driven(each))

    def _is_driven(self, numbers: range) -> bool:
        first, last = self.pieces[numbers[0]], self.pieces[numbers[-1]]
        return any(first.first <= layer < last.first + len(last.layers) for layer in self.transducers.driven)

    @property
    def whole(self) -> bool:
        """Whether the wall is one stack, which leaves nothing apart."""
        return self.stacks == (range(len(self.pieces)),)

    @kept_with_modes
    def loads(self, modes: Modes) -> tuple[tuple[PieceLoads, ...] | None, ...]:
        """Return the loads on each part of the basis of each piece, None of pieces by potentials."""
        lowest = dict[int, list[FloatArray]]()
        for numbers in self.stacks:
            lowest |= self._lowest(numbers, modes)
        found: list[tuple[PieceLoads, ...] | None] = []
        for number, piece in enumerate(self.pieces):
            if piece.by_potentials:
                found.append(None)
                continue
            parts = piece.basis(modes)
            resting = (np.zeros((part.orders.size, along_wall(part.wavenumber), part.squares.shape[1])) for part in parts)
            along = lowest.get(number) or resting
            found.append(tuple(self._loads_of(piece, part, one) for part, one in zip(parts, along, strict=True)))
        for numbers in self.stacks:
            hearing = _readings_along([found[number] or () for number in numbers])
            for number in numbers:
                each = zip(self.pieces[number].basis(modes), found[number] or (), strict=True)
                found[number] = tuple(one._replace(heard=hearing[part.members] @ one.along) for part, one in each)
        return tuple(found)

    def _loads_of(self, piece: Piece, part: OrdersBasis, along: FloatArray) -> PieceLoads:
        """Return the loads on a part of the basis of a piece."""
        every, circuits, shapes = self.transducers, self.transducers.circuits, part.squares.shape[1]
        loads, readings = (np.zeros((part.orders.size, len(every.driven), shapes)) for _ in range(2))
        capacitance = np.zeros((part.orders.size, len(every.driven)))
        here = {number + piece.first: number for number in range(len(piece.layers))}
        own = [place for place, number in enumerate(every.driven) if number in here]
        if not every.electrodes:
            if own:
                loads[:, 0] = pushed_evenly(part, here[every.actuators[0]], every.push)
            if every.sensors[0] in here:
                readings[:, 0] = read_in_middle(part, here[every.sensors[0]])
        elif own:
            roles = (tuple(here[i] for i in role if i in here) for role in (every.sensors, every.actuators, every.shorted))
            sensors, actuators, shorted = roles
            found = driven_of(part, replace(every, sensors=sensors, actuators=actuators, shorted=shorted))
            loads[:, own], readings[:, own], capacitance[:, own] = found
        rigid = np.zeros((part.orders.size, 1, shapes))
        rigid[:, 0, 0] = (part.orders == 1.0) & (part.wavenumber == 0.0)
        read = circuits.reading @ readings
        return PieceLoads(circuits.shares.T @ loads, read, loads, capacitance, along, np.zeros_like(read), rigid)

    def _lowest(self, numbers: range, modes: Modes) -> dict[int, list[FloatArray]]:
        """Return B of the pieces of a stack, by number, for each part of their bases."""
        stack = [self.pieces[number] for number in numbers]
        meshed = [piece.meshed_as for piece in stack]
        held = None if meshed[0] is None else tuple(layer for one in meshed for layer in one or ())
        bases = elastic_basis(tuple(layer for piece in stack for layer in piece.layers), modes, stack[0].frequency, held)
        return {
            number: [_weights_of_lowest(bases, part, piece.first - stack[0].first) for part in piece.basis(modes)]
            for number, piece in zip(numbers, stack, strict=True)
        }

    def beside(self, number: int) -> partial[list[FloatArray]] | None:
        """Return what is read of a piece beside places, from modes; None of a piece by potentials."""
        return None if self.pieces[number].by_potentials else partial(self._rows, number)

    def _rows(self, number: int, modes: Modes) -> list[FloatArray]:
        return [np.concatenate(self.read_of(one), axis=1) for one in self.loads(modes)[number] or ()]

    def read_of(self, one: PieceLoads) -> list[FloatArray]:
        """Return the rows of what is read of a part: what is heard, readings where any circuit is open, and strokes."""
        return [one.heard, *([one.readings] if self.transducers.circuits.any_open else []), one.strokes]

    @property
    def rows(self) -> int:
        """How many rows that are."""
        circuits = self.transducers.circuits
        return circuits.opened.size * (2 if circuits.any_open else 1) + len(self.transducers.driven)


def _readings_along(loads: Sequence[Sequence[PieceLoads]]) -> FloatArray:
    """Return p'X of a stack from the loads of its pieces, shape (orders, circuits, 2 or 3)."""
    each = [np.concatenate([one.readings @ np.swapaxes(one.along, 1, 2) for one in parts]) for parts in loads]
    return np.asarray(np.sum(each, axis=0), dtype=np.float64)


def _weights_of_lowest(bases: Sequence[OrdersBasis], part: OrdersBasis, first: int) -> FloatArray:
    """Return X_p'M X, (orders, 2 or 3, shapes): the lowest shapes of a stack in those of a piece, which begins with its layer *first*."""
    count = along_wall(part.wavenumber)
    found = np.zeros((part.orders.size, count, part.squares.shape[1]))
    for basis in bases:
        start, stop = max(part.members.start, basis.members.start), min(part.members.stop, basis.members.stop)
        if start >= stop:
            continue
        own, other = (slice(start - one.members.start, stop - one.members.start) for one in (part, basis))
        shapes = np.zeros((stop - start, count, part.shapes.shape[2], part.mesh.radius.size))
        for place, mesh in enumerate(part.mesh.layers):
            known = basis.mesh.layers[first + place]
            at = np.stack([interpolation(known.degree, x) for x in lobatto(mesh.degree).points])
            shapes[..., mesh.nodes] = basis.shapes[other, :count][..., known.nodes] @ at.T
        found[own] = np.einsum("mncp,p,mlcp->mln", part.shapes[own], part.mesh.mass, shapes)
    return found


@dataclass(frozen=True, eq=False)
class DrivenReading:
    """What is read of a driven wall in pieces, under forces on its faces and under voltages.

    Attributes
    ----------
    drive : WallDrive
    places : tuple of Place
        With the layers' numbers in the wall.
    """

    drive: WallDrive
    places: tuple[Place, ...] = ()

    @cached_property
    def _under_forces(self) -> WallReading:
        return WallReading(self.drive.pieces, self.places, self.drive.beside, self.drive.rows)

    def prepare(self, modes: Modes) -> None:
        """Make what all blocks of nodes share, before all threads ask for it."""
        self._under_forces.prepare(modes)
        self._at_rest(modes)

    @kept_with_modes
    def _at_rest(self, modes: Modes) -> dict[int, list[Weights]]:
        """Return the weights without inertia of the pieces of all stacks, by number: of forces on both faces, voltages and B."""
        found = {}
        for number in (number for numbers in self.drive.stacks for number in numbers):
            piece, loads = self.drive.pieces[number], self.drive.loads(modes)[number]
            assert loads is not None
            places = self._under_forces.parts[number][0].places
            found[number] = [
                Weights.of(
                    part,
                    np.concatenate([on_faces(part), one.volts, one.along, one.rigid], axis=1),
                    places,
                    np.concatenate([*self.drive.read_of(one), one.along, one.rigid], axis=1),
                    lossy=piece.factor is not None,
                )
                for part, one in zip(piece.basis(modes), loads, strict=True)
            ]
        return found

    def at(self, modes: Modes, s: ComplexArray) -> DrivenAnswer:
        """Return what the wall does at some modes and nodes."""
        reading, circuits, count = self._under_forces, self.drive.transducers.circuits.opened.size, len(self.places)
        answers = [one.at(modes, s) for one, _ in reading.parts]
        chain = PieceChain(answers)
        under_forces = reading.shown(modes, s, answers, chain.forces)
        stacks = [self._stack(numbers, modes, s) for numbers in self.drive.stacks]
        by_volts, size = np.sum([one.shown for one in stacks], axis=0), 2 * displacements(wavenumber_of(modes))
        forces: list[list[list[Entry]]] = [[] for _ in self.drive.pieces]
        moved = np.empty((2, circuits, modes.count, s.size), np.complex128)
        for circuit in range(circuits):
            apart: list[list[Entry]] = [[0.0] * size for _ in self.drive.pieces]
            for numbers, stack in zip(self.drive.stacks, stacks, strict=True):
                apart[numbers[0]][: size // 2] = stack.inside[circuit]
                apart[numbers[-1]][size // 2 :] = stack.outside[circuit]
            joined = chain.moved_apart(apart)
            moved[0, circuit], moved[1, circuit] = joined.inside[0], joined.outside[0]
            for found, one in zip(forces, joined.forces, strict=True):
                found.append(one)
        stops = np.cumsum([count, circuits] + [circuits] * self.drive.transducers.circuits.any_open)
        at_once = None
        if len(stops) == 3:
            at_once = by_volts[stops[1] : stops[2]] - by_volts[stops[0] : stops[1]]
        if not self.drive.whole:
            by_volts = by_volts + reading.shown(modes, s, answers, forces)
        (shown, heard, *charged, strokes), (given, of_volts, *all_of_volts, driven) = (np.split(x, stops) for x in (under_forces, by_volts))
        opened = (charged[0], all_of_volts[0]) if charged else (None, None)
        return DrivenAnswer(chain, shown, heard, strokes, opened[0], moved, given, of_volts, driven, opened[1], at_once, forces, stacks)

    def _stack(self, numbers: range, modes: Modes, s: ComplexArray) -> StackAnswer:
        """Return what a stack does per volt of each circuit."""
        size = 2 * displacements(wavenumber_of(modes))
        each = [_PieceAtRest.of(self._at_rest(modes)[i], self.drive.pieces[i], size, modes, s) for i in numbers]
        along = _readings_along([self.drive.loads(modes)[number] or () for number in numbers])
        found = self._freed(numbers, each, s, along)
        found = found._replace(pushed=np.concatenate([found.pushed, np.zeros((len(each), *found.pushed.shape[1:]))]))
        if size == 4 and np.any(first := modes.orders == 1.0):
            place = int(np.flatnonzero(first)[0])
            some = slice(place, place + 1)
            found.put(some, self._freed(numbers, [one.of_orders(some) for one in each], s, along[some], [one.factor for one in each]))
        if self.drive.along_alone:
            y = found.pushed[: along.shape[2]] / (s * s)
            for number, ends, rows in ((numbers[0], found.inside, slice(size // 2)), (numbers[-1], found.outside, slice(size // 2, size))):
                shapes = np.einsum("mfl,lcmk->cfmk", self._lowest_at_faces(number, modes)[:, rows], y)
                ends[:] = [list(each) for each in shapes]
        return found

    def _lowest_at_faces(self, number: int, modes: Modes) -> FloatArray:
        """Return the displacements of the lowest shapes of a stack at the faces of a piece, shape (orders, 4 or 6, 2 or 3)."""
        pairs = zip(self.drive.pieces[number].basis(modes), self.drive.loads(modes)[number] or (), strict=True)
        return np.concatenate([on_faces(part) @ np.swapaxes(one.along, 1, 2) for part, one in pairs])

    def _freed(
        self, numbers: range, each: Sequence[_PieceAtRest], s: ComplexArray, along: FloatArray, springs: Sequence[ComplexArray] = ()
    ) -> StackAnswer:
        """Return what a stack does whose pieces answer so, (K_g + s^2 B B')^-1 d, springs under pieces taken away.

        Parameters
        ----------
        numbers : range
        each : sequence of _PieceAtRest
        s : ndarray, shape (nodes,)
        along : ndarray, shape (orders, circuits, 2 or 3)
            p'X.
        springs : sequence of ndarray (nodes,)
            Factor of the spring under each piece.
        """
        size, circuits = len(each[0].faces), self.drive.transducers.circuits
        count, inert = circuits.opened.size, along.shape[2]
        half, last = size // 2, count + inert
        chain = PieceChain([PieceAnswer([row[:size] for row in one.faces], one.shown) for one in each])
        pushes = [[[row[size + load] for row in one.faces] for one in each] for load in range(last)]
        for held, _ in zip(each, springs, strict=False):
            pushes.append([[row[size + last] if one is held else 0.0 for row in one.faces] for one in each])
        columns = [chain.moved_apart(one) for one in pushes]
        rows = np.zeros((len(self.places) + self.drive.rows, len(columns), *each[0].shown.shape[2:]), np.complex128)
        taken = np.zeros((inert + len(springs), *rows.shape[1:]), np.complex128)
        for piece, (number, one) in enumerate(zip(numbers, each, strict=True)):
            members = self._under_forces.parts[number][1]
            for load, column in enumerate(columns):
                own = sum((one.shown[:, a] * force for a, force in enumerate(column.forces[piece])), np.zeros((), np.complex128))
                if load < last or load == last + piece:
                    own = own + one.shown[:, size + min(load, last)]
                for row, place in zip(own, members, strict=False):
                    rows[place, load] += row
                taken[:inert, load] += own[len(members) : len(members) + inert]
                if springs:
                    taken[inert + piece, load] += own[-1]
        strengths = np.stack([s * s] * inert + [-RIGID * g for g in springs])[:, None]
        square = np.eye(len(taken))[..., None, None] + strengths[:, None] * taken[:, count:]
        moving = (np.moveaxis(x, (0, 1), (2, 3)) for x in (square, strengths[:, None] * taken[:, :count]))
        solved: ComplexArray = np.linalg.solve(*moving).astype(np.complex128)
        pushed = np.moveaxis(solved, (2, 3), (0, 1))  # what inertia takes and springs gave

        def less(at_once: Sequence[Entry], circuit: int) -> ComplexArray:
            """Return what a volt does of what it does at once, by the columns."""
            return np.asarray(at_once[circuit] - sum(pushed[row, circuit] * at_once[count + row] for row in range(len(pushed))))

        ends = [[one.inside for one in columns], [one.outside for one in columns]]
        inside, outside = ([[less([one[i] for one in end], c) for i in range(half)] for c in range(count)] for end in ends)
        joined = [
            [[less([one.forces[piece][a] for one in columns], c) for a in range(size)] for piece in range(len(each))] for c in range(count)
        ]
        by_volts = rows[:, :count] - np.einsum("lcmk,rlmk->rcmk", pushed, rows[:, count:])
        readings = slice(len(self.places), len(self.places) + count)
        heard = np.einsum("mil,lcmk->icmk", along, pushed[:inert] / (s * s))
        by_volts[readings] = heard  # without a difference of large numbers
        return StackAnswer(inside, outside, by_volts, joined, pushed)


class _PieceAtRest(NamedTuple):
    """How a piece answers without inertia, per force on its faces, per volt and per column beside.

    Attributes
    ----------
    faces : list of list of ndarray (orders, nodes)
        Displacements of its faces.
    shown : ndarray, shape (rows, columns, orders, nodes)
    factor : ndarray, shape (nodes,)
        g.
    """

    faces: list[list[Entry]]
    shown: ComplexArray
    factor: ComplexArray

    def of_orders(self, some: slice) -> _PieceAtRest:
        """Return it at some orders."""
        faces = [[x if isinstance(x, float) else x[some] for x in row] for row in self.faces]
        return _PieceAtRest(faces, self.shown[:, :, some], self.factor)

    @classmethod
    def of(cls, weights: Sequence[Weights], piece: Piece, faces: int, modes: Modes, s: ComplexArray) -> _PieceAtRest:
        """Return it from the weights of each part of the piece's basis."""
        g = None if piece.factor is None else piece.factor.at(s)
        found = np.concatenate([one.at_rest(s, g) for one in weights], axis=1)
        count = weights[0].active
        answers: list[list[Entry]] = [[0.0] * count for _ in range(faces)]
        pairs = [(i, j) for i in range(count) for j in range(i, count)]
        for row, (i, j) in zip(found, pairs, strict=False):
            if i < faces:
                answers[i][j] = row
                if j < faces:
                    answers[j][i] = row
        return cls(answers, found[len(pairs) :].reshape(-1, count, *found.shape[1:]), np.ones_like(s) if g is None else g)
