"""Pieces of a wall of solid layers with losses: what the forces on the faces of one piece do to it.

Consecutive layers under one factor g(s) share an eigenbasis, as a wall without losses has, omega^2 -> g(s) omega^2: with K g the stiffness

    (g K + M s^2)^-1 = (1/g) sum over shapes of x x'/(omega^2 + s^2/g).

Potentials of ceramics lose nothing. With R their rows, K = K_C + R'R, and g K_C + R'R = g K + (1 - g) R'R: the shapes answer, beside the
forces on the faces, forces -(1 - g) y on y = R x, of which one for each ceramic counts. What does not have one factor, a rubber whose G
relaxes while its bulk modulus does not, is a piece by its potentials (:mod:`coaxshell.structure.solid_potentials`), and so is any soft
layer with losses that would need a high degree.

Forces and displacements at the faces stand in the order (u_r, u_theta) inside, (u_r, u_theta) outside; a force is r times the traction on
the piece.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import groupby
from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.modes import Modes, kept_with_modes
from coaxshell.structure.elastic_basis import OrdersBasis, PotentialOfLayer, elastic_basis, modal_sums
from coaxshell.structure.elastic_depth import STRESSES, Shown, field_stress, shown_by_shapes
from coaxshell.structure.elastic_mesh import degree
from coaxshell.structure.losses import Relaxation
from coaxshell.structure.solid import SolidLayer
from coaxshell.structure.solid_potentials import Potentials

FORCES = 4
MOST_DEGREE = 24
"""A layer with losses that needs a higher degree at the top of the band answers by its potentials."""


class Place(NamedTuple):
    """A quantity at a radius of a layer, by the layer's number in its piece."""

    what: Shown
    radius: float
    layer: int


class PieceAnswer(NamedTuple):
    """How a piece answers.

    Attributes
    ----------
    faces : list of list of ndarray (orders, nodes)
        Displacements per force, 4 x 4; 0 where a force was not asked for.
    shown : ndarray, shape (places, 4, orders, nodes)
        What was asked for per force.
    """

    faces: list[list[ComplexArray | float]]
    shown: ComplexArray


@dataclass(frozen=True, eq=False)
class Piece:
    """Consecutive layers of a wall.

    Attributes
    ----------
    first : int
        Number of its innermost layer in the wall.
    layers : tuple of SolidLayer
    frequency : float
        Up to which waves are resolved, radians per transit.
    """

    first: int
    layers: tuple[SolidLayer, ...]
    frequency: float

    @property
    def factor(self) -> Relaxation | None:
        """g(s) of all its layers; of a rubber on G alone."""
        return self.layers[0].factor

    @property
    def by_potentials(self) -> bool:
        """Whether it is one layer that answers by its potentials."""
        return by_potentials(self.layers[0], self.frequency)

    @kept_with_modes
    def basis(self, modes: Modes) -> tuple[OrdersBasis, ...]:
        """Return the shapes of some modes where its factor is 1."""
        return elastic_basis(self.layers, modes, self.frequency)


def by_potentials(layer: SolidLayer, frequency: float) -> bool:
    """Return whether a layer answers by its potentials in a wall with losses."""
    return layer.isotropic and (layer.shear_alone or degree(layer, 0.0, 0.0, frequency) > MOST_DEGREE)


def pieces(layers: Sequence[SolidLayer], frequency: float) -> tuple[Piece, ...]:
    """Return the pieces of a wall, from the inside out."""
    keys = [(number if by_potentials(layer, frequency) else -1, layer.factor) for number, layer in enumerate(layers)]
    found: list[Piece] = []
    for _, members in groupby(range(len(layers)), key=lambda number: keys[number]):
        numbers = list(members)
        found.append(Piece(numbers[0], tuple(layers[i] for i in numbers), frequency))
    return tuple(found)


def electric_rows(part: OrdersBasis) -> list[FloatArray]:
    """Return R x of the potentials of each layer per unit of each shape, shape (orders, rows, shapes); no rows of a layer without."""
    found = []
    for layer in part.mesh.layers:
        if layer.layer.coupling is None:
            found.append(np.zeros((part.orders.size, 0, part.squares.shape[1])))
        else:
            rows = PotentialOfLayer(layer, part.orders, part.wavenumber).rows
            found.append(np.einsum("micp,mncp->min", rows, part.shapes[..., layer.nodes]))
    return found


def kept_rows(part: OrdersBasis, rows: FloatArray) -> FloatArray:
    """Return the combination of a ceramic's rows that counts, shape (orders, rows, 1): the largest in slow motion, shapes by 1/omega^2.

    What is left of the field then loses as the layer does, where that resonates through its thickness: 2e-6 of the stresses of a shock on
    the paper's shells at a loss factor of 0.1.
    """
    turned, _, _ = np.linalg.svd(rows / np.maximum(part.squares, 1.0)[:, None], full_matrices=False)
    return np.asarray(turned[:, :, :1])


def lossless_rows(part: OrdersBasis) -> FloatArray:
    """Return what the kept combinations of all ceramics are per unit of each shape, shape (orders, ceramics, shapes)."""
    found = [np.einsum("mij,min->mjn", kept_rows(part, rows), rows) for rows in electric_rows(part) if rows.shape[1]]
    return np.concatenate([np.zeros((part.orders.size, 0, part.squares.shape[1])), *found], axis=1)


def on_faces(part: OrdersBasis) -> FloatArray:
    """Return u_r and u_theta of both faces per unit of each shape, shape (orders, 4, shapes)."""
    return np.stack([part.shapes[:, :, c, end] for end in (0, -1) for c in (0, 1)], axis=1)


@dataclass(frozen=True, eq=False)
class PieceReading:
    """What is read of a piece: the answers of its faces to some forces, and quantities at places within it.

    Attributes
    ----------
    piece : Piece
    active : tuple of int
        Forces that act.
    places : tuple of Place
    """

    piece: Piece
    active: tuple[int, ...]
    places: tuple[Place, ...] = ()

    def at(self, modes: Modes, s: ComplexArray) -> PieceAnswer:
        """Return the answer at some modes and nodes."""
        return self._by_potentials(modes, s) if self.piece.by_potentials else self._by_shapes(modes, s)

    def prepare(self, modes: Modes) -> None:
        """Make what all blocks of nodes share, before all threads ask for it."""
        if not self.piece.by_potentials:
            self._weights(modes)

    # By potentials

    def _by_potentials(self, modes: Modes, s: ComplexArray) -> PieceAnswer:
        (layer,) = self.piece.layers
        fields = Potentials(layer, modes, s)
        moved = [fields.rows(radius, ("normal", "tangential")) for radius in (layer.inner, layer.outer)]
        asked = [fields.rows(place.radius, (place.what,)) for place in self.places]
        found = fields.per_force(np.concatenate([*moved, *asked]))
        found[0:FORCES:2] *= -1.0  # u_r is outward
        return PieceAnswer([list(row) for row in found[:FORCES]], found[FORCES:])

    # By shapes

    @kept_with_modes
    def _weights(self, modes: Modes) -> list[_Weights]:
        return [_Weights.of(self, part) for part in self.piece.basis(modes)]

    def _by_shapes(self, modes: Modes, s: ComplexArray) -> PieceAnswer:
        factor = self.piece.factor
        g = None if factor is None else factor.at(s)
        found = [weights.answer(s, g) for weights in self._weights(modes)]
        whole = found[0] if len(found) == 1 else np.concatenate(found, axis=1)
        count, still = len(self.active), 0.0
        faces: list[list[ComplexArray | float]] = [[still] * FORCES for _ in range(FORCES)]
        pairs = [(i, j) for i in range(count) for j in range(i, count)]
        for row, (i, j) in zip(whole, pairs, strict=False):
            a, b = self.active[i], self.active[j]
            faces[a][b] = faces[b][a] = row
        shown = np.zeros((len(self.places), FORCES, *whole.shape[1:]), np.complex128)
        shown[:, self.active] = whole[len(pairs) :].reshape(len(self.places), count, *whole.shape[1:])
        return PieceAnswer(faces, shown)


@dataclass(frozen=True, eq=False)
class _Weights:
    """Weights of the shapes of some orders in all sums of a reading: of pairs of forces, then of parts of the places per force.

    Forces are those on the faces and, last, those on the rows of potentials.

    Attributes
    ----------
    active, electric, places : int
        Numbers of forces on faces and on rows, and of places.
    parts : tuple of (int, bool)
        Place of each part, and whether g weighs it not: a displacement or the field of a ceramic; stresses of strains are g times that.
    squares : ndarray, shape (orders, shapes)
    weights : ndarray, shape (orders, rows, shapes)
    """

    active: int
    electric: int
    places: int
    parts: tuple[tuple[int, bool], ...]
    squares: FloatArray
    weights: FloatArray

    @classmethod
    def of(cls, reading: PieceReading, part: OrdersBasis) -> _Weights:
        """Return those of a reading on the shapes of some orders."""
        rows = lossless_rows(part)[:, : None if reading.piece.factor is not None else 0]
        forces = np.concatenate([on_faces(part)[:, reading.active], rows], axis=1)
        count = forces.shape[1]
        found, parts = [forces[:, i] * forces[:, j] for i in range(count) for j in range(i, count)], []
        for number, place in enumerate(reading.places):
            for shown, unweighted in _parts_of(place, part, reading.piece.factor is not None):
                parts.append((number, unweighted))
                found += [shown * forces[:, i] for i in range(count)]
        return cls(len(reading.active), rows.shape[1], len(reading.places), tuple(parts), part.squares, np.stack(found, axis=1))

    def answer(self, s: ComplexArray, g: ComplexArray | None) -> ComplexArray:
        """Return displacements of the faces for pairs of forces on them and what is shown per force, shape (rows, orders, nodes)."""
        sums = modal_sums(self.weights, self.squares, s if g is None else s / np.sqrt(g))
        count = self.active + self.electric
        pairs, parts = np.split(sums, [count * (count + 1) // 2])
        parts = parts.reshape(-1, count, *sums.shape[1:])
        if g is not None:
            inverse = 1.0 / g
            pairs *= inverse
            for part, (_, unweighted) in zip(parts, self.parts, strict=True):
                if unweighted:
                    part *= inverse
        shown = parts
        if len(self.parts) > self.places:
            shown = np.zeros((self.places, *parts.shape[1:]), np.complex128)
            for part, (place, _) in zip(parts, self.parts, strict=True):
                shown[place] += part
        elif g is None:
            return sums
        return _without_rows(pairs, shown, self.active, self.electric, np.zeros_like(s) if g is None else 1.0 - g)


def _parts_of(place: Place, part: OrdersBasis, lossy: bool) -> list[tuple[FloatArray, bool]]:
    """Return a quantity per unit of each shape in parts, with whether g weighs each of them not."""
    whole = shown_by_shapes(part, place.layer, place.radius, place.what)
    if not lossy or place.what not in STRESSES:
        return [(whole, True)]
    if part.mesh.layers[place.layer].layer.coupling is None:
        return [(whole, False)]
    rows = electric_rows(part)[place.layer]
    kept = kept_rows(part, rows)
    field = np.einsum("mi,mij,mkj,mkn->mn", field_stress(part, place.layer, place.radius, place.what), kept, kept, rows)
    return [(whole - field, False), (field, True)]


def _without_rows(pairs: ComplexArray, shown: ComplexArray, active: int, electric: int, lent: ComplexArray) -> ComplexArray:
    """Return the sums of forces on the faces where -lent y acts on the rows: y = (1 + lent G_RR)^-1 G_Rf f, row by row, in place.

    A wall of which some rows lose and others do not is passive too, so that no divisor vanishes.
    """
    count = active + electric
    place = {pair: row for row, pair in enumerate((i, j) for i in range(count) for j in range(i, count))}
    for k in reversed(range(active, count)):
        scale = lent / (1.0 + lent * pairs[place[k, k]])
        taken = [scale * pairs[place[i, k]] for i in range(k)]
        for i in range(k):
            for j in range(i, k):
                pairs[place[i, j]] -= taken[i] * pairs[place[j, k]]
            shown[:, i] -= taken[i] * shown[:, k]
    kept = [place[i, j] for i in range(active) for j in range(i, active)]
    return np.concatenate([pairs[kept], shown[:, :active].reshape(-1, *pairs.shape[1:])])


class PieceChain:
    """Pieces of one wall joined face to face: displacements are shared, the forces at a joint opposite.

    From the inside out each stack is seen from its outer face as a receptance Y (2 x 2) beside e, what a force on the wall's inner face
    moves it by. A piece with receptances G makes of them, at the joint f = (Y + G_ii)^-1 (G_io F - e),

        Y -> G_oo - G_oi (Y + G_ii)^-1 G_io,      e -> G_oi (Y + G_ii)^-1 e.

    Parameters
    ----------
    answers : sequence of PieceAnswer
        From the inside out.

    Attributes
    ----------
    inner, across, outer : ndarray, shape (orders, nodes)
        u_r of the wall's faces per force on them.
    forces : list
        For each piece its four forces under a unit force on the wall's inner and outer face: two lists of four.
    """

    def __init__(self, answers: Sequence[PieceAnswer]) -> None:
        self._faces = [answer.faces for answer in answers]
        first = self._faces[0]
        seen, moved = _block(first, 2, 2), [first[2][0], first[3][0]]
        self._joints: list[tuple[_Symmetric, list[Entry]]] = []
        for faces in self._faces[1:]:
            inside = _block(faces, 0, 0)
            joint = _Symmetric.of([[seen[i][j] + inside[i][j] for j in range(2)] for i in range(2)])
            self._joints.append((joint, moved))
            through = _block(faces, 0, 2)
            columns = [joint.solve([through[0][j], through[1][j]]) for j in range(2)]
            outside = _block(faces, 2, 2)
            seen = [[outside[i][j] - through[0][i] * columns[j][0] - through[1][i] * columns[j][1] for j in range(2)] for i in range(2)]
            moved = [columns[j][0] * moved[0] + columns[j][1] * moved[1] for j in range(2)]
        both = [self._forces(1.0, 0.0), self._forces(0.0, 1.0)]
        self.forces = [[both[0][i], both[1][i]] for i in range(len(answers))]
        under_inner = both[0][0]
        self.inner = _under(first[0], under_inner)
        self.across, self.outer = moved[0], seen[0][0]

    def _forces(self, on_inner: float, on_outer: float) -> list[list[Entry]]:
        """Return the four forces on each piece under forces along r on the wall's faces."""
        beyond: list[Entry] = [on_outer, 0.0]
        found: list[list[Entry]] = []
        for faces, (joint, moved) in zip(self._faces[:0:-1], self._joints[::-1], strict=True):
            through = _block(faces, 0, 2)
            given = [through[i][0] * beyond[0] + through[i][1] * beyond[1] - on_inner * moved[i] for i in range(2)]
            held = joint.solve(given)
            found.append([-held[0], -held[1], *beyond])
            beyond = held
        found.append([on_inner, 0.0, *beyond])
        return found[::-1]


Entry = ComplexArray | float


def _under(answers: Sequence[Entry], forces: Sequence[Entry]) -> Entry:
    """Return the sum of answers times forces, of which many are the numbers 0 and 1."""
    total: Entry = 0.0
    for answer, force in zip(answers, forces, strict=True):
        if isinstance(force, float) and force in (0.0, 1.0):
            total = total + answer if force else total
        else:
            total = total + answer * force
    return total


def _block(faces: list[list[Entry]], row: int, column: int) -> list[list[Entry]]:
    return [[faces[row + i][column + j] for j in range(2)] for i in range(2)]


class _Symmetric(NamedTuple):
    """Inverse of a symmetric 2 x 2 matrix."""

    a: Entry
    b: Entry
    c: Entry

    @classmethod
    def of(cls, matrix: list[list[Entry]]) -> _Symmetric:
        a, b, c = matrix[0][0], matrix[0][1], matrix[1][1]
        scale = 1.0 / (a * c - b * b)
        return cls(c * scale, -b * scale, a * scale)

    def solve(self, given: Sequence[Entry]) -> list[Entry]:
        """Return the inverse times two numbers."""
        return [self.a * given[0] + self.b * given[1], self.b * given[0] + self.c * given[1]]


@dataclass(frozen=True, eq=False)
class WallReading:
    """What is read of a wall of pieces: its faces, and quantities at places within it.

    Attributes
    ----------
    pieces : tuple of Piece
    places : tuple of Place
        With the layers' numbers in the wall.
    """

    pieces: tuple[Piece, ...]
    places: tuple[Place, ...] = ()

    @cached_property
    def _parts(self) -> list[tuple[PieceReading, list[int]]]:
        """Each piece's reading, and which of the wall's places lie in it."""
        found, last = [], len(self.pieces) - 1
        for number, piece in enumerate(self.pieces):
            inside = (0,) if number == 0 else (0, 1)
            outside = (2,) if number == last else (2, 3)
            own = range(piece.first, piece.first + len(piece.layers))
            members = [i for i, place in enumerate(self.places) if place.layer in own]
            places = tuple(self.places[i]._replace(layer=self.places[i].layer - piece.first) for i in members)
            found.append((PieceReading(piece, inside + outside, places), members))
        return found

    def prepare(self, modes: Modes) -> None:
        """Make what all blocks of nodes share, before all threads ask for it."""
        for reading, _ in self._parts:
            reading.prepare(modes)

    def at(self, modes: Modes, s: ComplexArray) -> tuple[PieceChain, ComplexArray]:
        """Return the joined pieces, and the places per outward force on the inner and the outer face, (places, 2, orders, nodes)."""
        answers = [reading.at(modes, s) for reading, _ in self._parts]
        chain = PieceChain(answers)
        shown = np.zeros((len(self.places), 2, modes.count, s.size), np.complex128)
        for (reading, members), answer, forces in zip(self._parts, answers, chain.forces, strict=True):
            for row, place in zip(answer.shown, members, strict=True):
                for side in range(2):
                    shown[place, side] = _under([row[a] for a in reading.active], [forces[side][a] for a in reading.active])
        return chain, shown
