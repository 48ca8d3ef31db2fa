"""Pieces of a wall of solid layers joined face to face (:mod:`coaxshell.structure.solid_pieces`), and what is read of the whole wall.

A joint shares its displacements, two or in waves along the axis three, and is a symmetric matrix of as many rows, inverted in closed form.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple, Protocol

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.modes import Modes
from coaxshell.structure.solid_pieces import Entry, Piece, PieceAnswer, PieceReading, Place, wavenumber_of


class Joined(NamedTuple):
    """Forces on the faces of each piece of a wall that join them, and how the wall's inner and outer face move."""

    forces: list[list[Entry]]
    inside: list[Entry]
    outside: list[Entry]


class PieceChain:
    """Pieces of one wall joined face to face: displacements are shared, the forces at a joint opposite.

    From the inside out each stack is seen from its outer face as a receptance Y (2 x 2, 3 x 3 with u_z) beside e, what a force on the
    wall's inner face moves it by. A piece with receptances G makes of them, at the joint f = (Y + G_ii)^-1 (G_io F - e),

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
        For each piece the forces on its faces under a unit force on the wall's inner and outer face: two lists of four or six.
    """

    def __init__(self, answers: Sequence[PieceAnswer]) -> None:
        self._faces = [answer.faces for answer in answers]
        first = self._faces[0]
        self._each = each = range(len(first) // 2)
        seen, moved = _block(first, 1, 1), [first[len(each) + i][0] for i in each]
        self._joints: list[tuple[_Joint, list[Entry]]] = []
        for faces in self._faces[1:]:
            inside, through, outside = _block(faces, 0, 0), _block(faces, 0, 1), _block(faces, 1, 1)
            joint = _joint([[seen[i][j] + inside[i][j] for j in each] for i in each])
            self._joints.append((joint, moved))
            columns = [joint.solve([row[j] for row in through]) for j in each]
            seen = [[_less(outside[i][j], [row[i] for row in through], columns[j]) for j in each] for i in each]
            moved = [_product(columns[j], moved) for j in each]
        both = [self._forces(1.0, 0.0), self._forces(0.0, 1.0)]
        self.forces = [[both[0][i], both[1][i]] for i in range(len(answers))]
        under_inner = both[0][0]
        self.inner = _under(first[0], under_inner)
        self.across, self.outer = moved[0], seen[0][0]

    def moved_apart(self, offsets: Sequence[Sequence[Entry]]) -> Joined:
        """Return what joins pieces whose faces would move without any force.

        With the displacements a of the faces, f = (Y + G_ii)^-1 (G_io F + a_i - e) and e -> a_o + G_oi (Y + G_ii)^-1 (e - a_i).

        Parameters
        ----------
        offsets : sequence of sequence
            Of each piece, a of its inner and of its outer face, as many as forces on it.
        """
        each, count = self._each, len(self._each)
        moved, held = list(offsets[0][count:]), []
        for faces, (joint, _), apart in zip(self._faces[1:], self._joints, offsets[1:], strict=True):
            through = _block(faces, 0, 1)
            force = joint.solve([apart[i] - moved[i] for i in each])
            moved = [apart[count + j] - _product([row[j] for row in through], force) for j in each]
            held.append(force)
        beyond: list[Entry] = [0.0] * count
        found: list[list[Entry]] = []
        for faces, (joint, _), force in zip(self._faces[:0:-1], self._joints[::-1], held[::-1], strict=True):
            more = joint.solve([_product(row, beyond) for row in _block(faces, 0, 1)])
            force = [a + b for a, b in zip(force, more, strict=True)]
            found.append([*(-x for x in force), *beyond])
            beyond = force
        found.append([*([0.0] * count), *beyond])
        inside = [offsets[0][i] + _product(self._faces[0][i][count:], beyond) for i in each]
        return Joined(found[::-1], inside, moved)

    def _forces(self, on_inner: float, on_outer: float) -> list[list[Entry]]:
        """Return the four forces on each piece under forces along r on the wall's faces."""
        aside = [0.0] * (len(self._each) - 1)
        beyond: list[Entry] = [on_outer, *aside]
        found: list[list[Entry]] = []
        for faces, (joint, moved) in zip(self._faces[:0:-1], self._joints[::-1], strict=True):
            through = _block(faces, 0, 1)
            held = joint.solve([_product(through[i], beyond) - on_inner * moved[i] for i in self._each])
            found.append([*(-force for force in held), *beyond])
            beyond = held
        found.append([on_inner, *aside, *beyond])
        return found[::-1]


def _under(answers: Sequence[Entry], forces: Sequence[Entry]) -> Entry:
    """Return the sum of answers times forces, of which many are the numbers 0 and 1."""
    total: Entry = 0.0
    for answer, force in zip(answers, forces, strict=True):
        if isinstance(force, float) and force in (0.0, 1.0):
            total = total + answer if force else total
        else:
            total = total + answer * force
    return total


def _product(a: Sequence[Entry], b: Sequence[Entry]) -> Entry:
    """Return the sum of products."""
    total = a[0] * b[0]
    for x, y in zip(a[1:], b[1:], strict=True):
        total = total + x * y
    return total


def _less(value: Entry, a: Sequence[Entry], b: Sequence[Entry]) -> Entry:
    """Return a value less the sum of products."""
    for x, y in zip(a, b, strict=True):
        value = value - x * y
    return value


def _block(faces: list[list[Entry]], row: int, column: int) -> list[list[Entry]]:
    """Return the displacements of the inner (0) or the outer face (1) per force on one of them."""
    count = len(faces) // 2
    return [line[column * count : (column + 1) * count] for line in faces[row * count : (row + 1) * count]]


class _Joint(Protocol):
    """Inverse of the symmetric matrix of a joint."""

    def solve(self, given: Sequence[Entry]) -> list[Entry]:
        """Return the inverse times some numbers."""


def _joint(matrix: list[list[Entry]]) -> _Joint:
    return _Symmetric.of(matrix) if len(matrix) == 2 else _SymmetricOfThree.of(matrix)


class _SymmetricOfThree(NamedTuple):
    """Inverse of a symmetric 3 x 3 matrix, by its cofactors: rows (a, b, c), (b, d, e), (c, e, f)."""

    a: Entry
    b: Entry
    c: Entry
    d: Entry
    e: Entry
    f: Entry

    @classmethod
    def of(cls, matrix: list[list[Entry]]) -> _SymmetricOfThree:
        """Return it for a matrix."""
        (a, b, c), (_, d, e), (_, _, f) = matrix
        aa, bb, cc = d * f - e * e, c * e - b * f, b * e - c * d
        scale = 1.0 / (a * aa + b * bb + c * cc)
        return cls(aa * scale, bb * scale, cc * scale, (a * f - c * c) * scale, (b * c - a * e) * scale, (a * d - b * b) * scale)

    def solve(self, given: Sequence[Entry]) -> list[Entry]:
        """Return the inverse times three numbers."""
        return [_product(row, given) for row in ((self.a, self.b, self.c), (self.b, self.d, self.e), (self.c, self.e, self.f))]


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
    beside : callable or None
        From the number of a piece to what else is read of it (:class:`PieceReading`), each row the sum over all pieces; None of a piece
        by potentials.
    rows : int
        How many rows that are.
    """

    pieces: tuple[Piece, ...]
    places: tuple[Place, ...] = ()
    beside: Callable[[int], Callable[[Modes], Sequence[FloatArray]] | None] | None = None
    rows: int = 0

    @cached_property
    def parts(self) -> list[tuple[PieceReading, list[int]]]:
        """Each piece's reading, and which of the wall's places lie in it."""
        found, last = [], len(self.pieces) - 1
        for number, piece in enumerate(self.pieces):
            own = range(piece.first, piece.first + len(piece.layers))
            members = [i for i, place in enumerate(self.places) if place.layer in own]
            places = tuple(self.places[i]._replace(layer=self.places[i].layer - piece.first) for i in members)
            beside = None if self.beside is None else self.beside(number)
            rows = [] if beside is None else range(len(self.places), len(self.places) + self.rows)
            found.append((PieceReading(piece, (number > 0, number < last), places, beside), [*members, *rows]))
        return found

    def prepare(self, modes: Modes) -> None:
        """Make what all blocks of nodes share, before all threads ask for it."""
        for reading, _ in self.parts:
            reading.prepare(modes)

    def at(self, modes: Modes, s: ComplexArray) -> tuple[PieceChain, ComplexArray]:
        """Return the joined pieces, and the places per outward force on the inner and the outer face, (places, 2, orders, nodes).

        What else is read comes after the places.
        """
        answers = [reading.at(modes, s) for reading, _ in self.parts]
        chain = PieceChain(answers)
        return chain, self.shown(modes, s, answers, chain.forces)

    def shown(
        self, modes: Modes, s: ComplexArray, answers: Sequence[PieceAnswer], forces: Sequence[Sequence[Sequence[Entry]]]
    ) -> ComplexArray:
        """Return what is shown under forces on the faces of all pieces, (places, loads, orders, nodes), forces by piece, load and face."""
        wavenumber = wavenumber_of(modes)
        found = np.zeros((len(self.places) + self.rows, len(forces[0]), modes.count, s.size), np.complex128)
        for (reading, members), answer, each in zip(self.parts, answers, forces, strict=True):
            if answer.fields is not None:
                found[members] = _of_waves(answer, each)
                continue
            active = reading.active(wavenumber)
            for row, place in zip(answer.shown, members, strict=True):
                for load, acting in enumerate(each):
                    one = _under([row[a] for a in active], [acting[a] for a in active])
                    if place < len(self.places):
                        found[place, load] = one
                    else:
                        found[place, load] += one
        return found


def _of_waves(answer: PieceAnswer, forces: Sequence[Sequence[Entry]]) -> ComplexArray:
    """Return what is shown in a piece by its potentials under the forces on its faces, (places, loads, orders, nodes)."""
    assert answer.fields is not None
    given = np.zeros((len(forces[0]), len(forces), *answer.shown.shape[2:]), np.complex128)
    for side, each in enumerate(forces):
        for number, force in enumerate(each):
            given[number, side] = force
    return np.asarray(np.einsum("pwmk,wsmk->psmk", answer.shown, answer.fields.waves(given)))
