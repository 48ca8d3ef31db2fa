"""Pieces of a wall of solid layers joined face to face (:mod:`coaxshell.structure.solid_pieces`), and what is read of the whole wall.

A joint shares its displacements, two or in waves along the axis three, and is a symmetric matrix of as many rows, inverted in closed form.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple, Protocol

import numpy as np

from coaxshell.numerics.arrays import ComplexArray
from coaxshell.numerics.modes import Modes
from coaxshell.structure.solid_pieces import Entry, Piece, PieceAnswer, PieceReading, Place, wavenumber_of


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
    """

    pieces: tuple[Piece, ...]
    places: tuple[Place, ...] = ()

    @cached_property
    def _parts(self) -> list[tuple[PieceReading, list[int]]]:
        """Each piece's reading, and which of the wall's places lie in it."""
        found, last = [], len(self.pieces) - 1
        for number, piece in enumerate(self.pieces):
            own = range(piece.first, piece.first + len(piece.layers))
            members = [i for i, place in enumerate(self.places) if place.layer in own]
            places = tuple(self.places[i]._replace(layer=self.places[i].layer - piece.first) for i in members)
            found.append((PieceReading(piece, (number > 0, number < last), places), members))
        return found

    def prepare(self, modes: Modes) -> None:
        """Make what all blocks of nodes share, before all threads ask for it."""
        for reading, _ in self._parts:
            reading.prepare(modes)

    def at(self, modes: Modes, s: ComplexArray) -> tuple[PieceChain, ComplexArray]:
        """Return the joined pieces, and the places per outward force on the inner and the outer face, (places, 2, orders, nodes)."""
        answers, wavenumber = [reading.at(modes, s) for reading, _ in self._parts], wavenumber_of(modes)
        chain = PieceChain(answers)
        shown = np.zeros((len(self.places), 2, modes.count, s.size), np.complex128)
        for (reading, members), answer, forces in zip(self._parts, answers, chain.forces, strict=True):
            if answer.fields is not None:
                shown[members] = _of_waves(answer, forces)
                continue
            active = reading.active(wavenumber)
            for row, place in zip(answer.shown, members, strict=True):
                for side in range(2):
                    shown[place, side] = _under([row[a] for a in active], [forces[side][a] for a in active])
        return chain, shown


def _of_waves(answer: PieceAnswer, forces: Sequence[Sequence[Entry]]) -> ComplexArray:
    """Return what is shown in a piece by its potentials under the forces on its faces, (places, 2, orders, nodes)."""
    assert answer.fields is not None
    given = np.zeros((len(forces[0]), 2, *answer.shown.shape[2:]), np.complex128)
    for side, each in enumerate(forces):
        for number, force in enumerate(each):
            given[number, side] = force
    return np.asarray(np.einsum("pwmk,wsmk->psmk", answer.shown, answer.fields.waves(given)))
