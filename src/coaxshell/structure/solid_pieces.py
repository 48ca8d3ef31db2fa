"""Pieces of a wall of solid layers with losses: what the forces on the faces of one piece do to it.

Consecutive layers under one factor g(s) share an eigenbasis, as a wall without losses has, omega^2 -> g(s) omega^2: with K g the stiffness

    (g K + M s^2)^-1 = (1/g) sum over shapes of x x'/(omega^2 + s^2/g).

Potentials of ceramics lose nothing. With R their rows, K = K_C + R'R, and g K_C + R'R = g K + (1 - g) R'R: the shapes answer, beside the
forces on the faces, forces -(1 - g) y on y = R x, of which one for each ceramic counts. What does not have one factor, a rubber whose G
relaxes while its bulk modulus does not, is a piece by its potentials (:mod:`coaxshell.structure.solid_potentials`), and so is any soft
layer with losses that would need a high degree.

Forces and displacements at the faces stand in the order (u_r, u_theta) inside, (u_r, u_theta) outside, with u_z beside them in waves along
the axis; a force is r times the traction on the piece.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.modes import Modes, kept_with_modes
from coaxshell.structure.elastic_basis import OrdersBasis, displacements, elastic_basis, some_of
from coaxshell.structure.elastic_depth import STRESSES, Shown, field_stress, shown_by_shapes
from coaxshell.structure.elastic_mesh import degree
from coaxshell.structure.losses import Relaxation
from coaxshell.structure.shape_sums import modal_sums
from coaxshell.structure.solid import SolidLayer
from coaxshell.structure.solid_potentials import Potentials

MOST_DEGREE = 24
"""A layer of a wall in pieces that needs a higher degree at the top of the band answers by its potentials."""


RIGID = 1.0
"""omega^2 of the spring that a piece without inertia moves on as it is."""
MANY_PLACES = 8
"""Quantities of a piece above which its waves are found before them."""


class Place(NamedTuple):
    """A quantity at a radius of a layer, by the layer's number in its piece."""

    what: Shown
    radius: float
    layer: int


Entry = ComplexArray | float
"""A number for each order and node, or one for all."""


class PieceAnswer(NamedTuple):
    """How a piece answers.

    Attributes
    ----------
    faces : list of list of ndarray (orders, nodes)
        Displacements per force, 4 x 4 or, with u_z, 6 x 6; 0 where a force was not asked for.
    shown : ndarray, shape (places, 4 or 6, orders, nodes)
        What was asked for per force, or per unit of each wave of the fields.
    fields : Potentials or None
        Of a piece by its potentials of which so much is asked for that the waves under the forces on it are found first.
    """

    faces: list[list[Entry]]
    shown: ComplexArray
    fields: Potentials | None = None


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
    meshed_as : tuple of SolidLayer or None
        Layers beside its own that decide on its mesh.
    most_degree : int
        Above which a layer answers by its potentials.
    """

    first: int
    layers: tuple[SolidLayer, ...]
    frequency: float
    meshed_as: tuple[SolidLayer, ...] | None = None
    most_degree: int = MOST_DEGREE

    @property
    def factor(self) -> Relaxation | None:
        """g(s) of all its layers; of a rubber on G alone."""
        return self.layers[0].factor

    @property
    def by_potentials(self) -> bool:
        """Whether it is one layer that answers by its potentials."""
        return by_potentials((self.meshed_as or self.layers)[0], self.frequency, self.most_degree)

    @kept_with_modes
    def basis(self, modes: Modes) -> tuple[OrdersBasis, ...]:
        """Return the shapes of some modes where its factor is 1."""
        if modes.whole is not None:
            return some_of(self.basis(modes.whole), modes.orders)
        return elastic_basis(self.layers, modes, self.frequency, self.meshed_as)


def by_potentials(layer: SolidLayer, frequency: float, most_degree: int = MOST_DEGREE) -> bool:
    """Return whether a layer answers by its potentials in a wall in pieces."""
    return layer.isotropic and (layer.shear_alone or degree(layer, 0.0, 0.0, frequency) > most_degree)


def pieces(
    layers: Sequence[SolidLayer], frequency: float, meshed_as: Sequence[SolidLayer] | None = None, most_degree: int = MOST_DEGREE
) -> tuple[Piece, ...]:
    """Return the pieces of a wall, from the inside out; divided and meshed as those of other layers nearby, if given."""
    divided = meshed_as or layers
    keys = [(number if by_potentials(layer, frequency, most_degree) else -1, layer.factor) for number, layer in enumerate(divided)]
    found: list[Piece] = []
    for _, members in groupby(range(len(layers)), key=lambda number: keys[number]):
        numbers = list(members)
        held = None if meshed_as is None else tuple(meshed_as[i] for i in numbers)
        found.append(Piece(numbers[0], tuple(layers[i] for i in numbers), frequency, held, most_degree))
    return tuple(found)


def wavenumber_of(modes: Modes) -> float:
    """Return the one wavenumber of some modes."""
    assert isinstance(modes.wavenumber, (int, float))
    return float(modes.wavenumber)


def kept_rows(part: OrdersBasis, rows: FloatArray) -> FloatArray:
    """Return the combination of a ceramic's rows that counts, shape (orders, rows, 1): the largest in slow motion, shapes by 1/omega^2.

    What is left of the field then loses as the layer does, where that resonates through its thickness: 2e-6 of the stresses of a shock on
    the paper's shells at a loss factor of 0.1.
    """
    turned, _, _ = np.linalg.svd(rows / np.maximum(part.squares, 1.0)[:, None], full_matrices=False)
    return np.asarray(turned[:, :, :1])


def lossless_rows(part: OrdersBasis) -> FloatArray:
    """Return what the kept combinations of all ceramics are per unit of each shape, shape (orders, ceramics, shapes)."""
    found = [np.einsum("mij,min->mjn", kept_rows(part, rows), rows) for rows in part.electric_rows if rows.shape[1]]
    return np.concatenate([np.zeros((part.orders.size, 0, part.squares.shape[1])), *found], axis=1)


def on_faces(part: OrdersBasis) -> FloatArray:
    """Return u_r, u_theta and, if there is one, u_z of both faces per unit of each shape, shape (orders, 4 or 6, shapes)."""
    return np.stack([part.shapes[:, :, c, end] for end in (0, -1) for c in range(part.shapes.shape[2])], axis=1)


@dataclass(frozen=True, eq=False)
class PieceReading:
    """What is read of a piece: the answers of its faces to some forces, and quantities at places within it.

    Attributes
    ----------
    piece : Piece
    joined : tuple of bool
        Whether other pieces are bonded to its inner and its outer face: all forces then act there, else that along r alone.
    places : tuple of Place
    beside : callable or None
        From modes to what else is read, weights of the shapes in displacements, (orders, rows, shapes) of each part of the basis.
    """

    piece: Piece
    joined: tuple[bool, bool]
    places: tuple[Place, ...] = ()
    beside: Callable[[Modes], Sequence[FloatArray]] | None = None

    def active(self, wavenumber: float) -> tuple[int, ...]:
        """Return the numbers of the forces that act."""
        count = displacements(wavenumber)
        return tuple(side * count + i for side, all_act in enumerate(self.joined) for i in range(count if all_act else 1))

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
        names: tuple[Shown, ...] = ("normal", "tangential", "along_axis")
        count = displacements(fields.wavenumber)
        moved = [fields.rows(radius, names[:count]) for radius in (layer.inner, layer.outer)]
        asked = [fields.rows(place.radius, (place.what,)) for place in self.places]
        many = len(asked) > MANY_PLACES
        found = fields.per_force(np.concatenate(moved if many else [*moved, *asked]))
        found[0 : 2 * count : count] *= -1.0  # u_r is outward
        faces: list[list[Entry]] = [list(row) for row in found[: 2 * count]]
        return PieceAnswer(faces, np.concatenate(asked), fields) if many else PieceAnswer(faces, found[2 * count :])

    # By shapes

    @kept_with_modes
    def _weights(self, modes: Modes) -> list[Weights]:
        parts = self.piece.basis(modes)
        beside = [None] * len(parts) if self.beside is None else self.beside(modes)
        return [
            Weights.of(part, on_faces(part)[:, self.active(part.wavenumber)], self.places, rows, lossy=self.piece.factor is not None)
            for part, rows in zip(parts, beside, strict=True)
        ]

    def _by_shapes(self, modes: Modes, s: ComplexArray) -> PieceAnswer:
        factor = self.piece.factor
        g = None if factor is None else factor.at(s)
        found = [weights.answer(s, g) for weights in self._weights(modes)]
        whole = found[0] if len(found) == 1 else np.concatenate(found, axis=1)
        wavenumber = wavenumber_of(modes)
        active, forces, still = self.active(wavenumber), 2 * displacements(wavenumber), 0.0
        count = len(active)
        faces: list[list[Entry]] = [[still] * forces for _ in range(forces)]
        pairs = [(i, j) for i in range(count) for j in range(i, count)]
        for row, (i, j) in zip(whole, pairs, strict=False):
            a, b = active[i], active[j]
            faces[a][b] = faces[b][a] = row
        read = whole[len(pairs) :].reshape(-1, count, *whole.shape[1:])
        shown = np.zeros((len(read), forces, *whole.shape[1:]), np.complex128)
        shown[:, active] = read
        return PieceAnswer(faces, shown)


@dataclass(frozen=True, eq=False)
class Weights:
    """What the weights of the shapes of some orders in all sums of a reading are made of: pairs of forces, then parts of places per force.

    Forces are those on the faces and beside, and last those on the rows of potentials. The products are made anew for each block of
    nodes: kept, they would be five times as much for every wave.

    Attributes
    ----------
    active, electric, places : int
        Numbers of forces on faces and beside, of those on rows, and of places with what is read beside them.
    parts : tuple of (int, bool)
        Place of each part, and whether g weighs it not: a displacement or the field of a ceramic; stresses of strains are g times that.
    squares : ndarray, shape (orders, shapes)
    forces : ndarray, shape (orders, forces, shapes)
    shown : ndarray, shape (orders, parts, shapes)
    """

    active: int
    electric: int
    places: int
    parts: tuple[tuple[int, bool], ...]
    squares: FloatArray
    forces: FloatArray
    shown: FloatArray

    @classmethod
    def of(
        cls, part: OrdersBasis, forces: FloatArray, places: Sequence[Place], beside: FloatArray | None = None, *, lossy: bool
    ) -> Weights:
        """Return those on the shapes of some orders.

        Parameters
        ----------
        part : OrdersBasis
        forces : ndarray, shape (orders, forces, shapes)
            Those on the faces and beside.
        places : sequence of Place
        beside : ndarray, shape (orders, rows, shapes), optional
            What else is read, of displacements.
        lossy : bool
            Whether the piece has losses.
        """
        rows = lossless_rows(part)[:, : None if lossy else 0]
        shown, parts = [np.zeros((part.orders.size, 0, part.squares.shape[1]))], []
        fields = _Fields(part)
        for number, place in enumerate(places):
            for one, unweighted in _parts_of(place, part, fields if lossy else None):
                parts.append((number, unweighted))
                shown.append(one[:, None])
        count = len(places)
        if beside is not None:
            parts += [(count + row, True) for row in range(beside.shape[1])]
            shown.append(beside)
            count += beside.shape[1]
        every = np.concatenate([forces, rows], axis=1)
        return cls(forces.shape[1], rows.shape[1], count, tuple(parts), part.squares, every, np.concatenate(shown, axis=1))

    @property
    def weights(self) -> FloatArray:
        """Return those of all sums, shape (orders, rows, shapes)."""
        orders, count, shapes = self.forces.shape
        pairs = np.triu_indices(count)
        places = (self.shown[:, :, None] * self.forces[:, None]).reshape(orders, -1, shapes)
        return np.concatenate([self.forces[:, pairs[0]] * self.forces[:, pairs[1]], places], axis=1)

    def answer(self, s: ComplexArray, g: ComplexArray | None) -> ComplexArray:
        """Return displacements of the faces for pairs of forces on them and what is shown per force, shape (rows, orders, nodes)."""
        return self._lossy(modal_sums(self.weights, self.squares, s if g is None else s / np.sqrt(g)), g)

    def at_rest(self, s: ComplexArray, g: ComplexArray | None) -> ComplexArray:
        """Return the same where nothing has inertia, each rigid motion on a spring of :data:`RIGID`."""
        sums = np.einsum("mrn,mn->rm", self.weights, 1.0 / np.where(self.squares == 0.0, RIGID, self.squares))
        return self._lossy(np.repeat(sums[..., None].astype(np.complex128), s.size, axis=-1), g)

    def _lossy(self, sums: ComplexArray, g: ComplexArray | None) -> ComplexArray:
        """Return the sums over all shapes under the factor g, in place."""
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
        return _without_rows(pairs, shown, self.active, self.electric, np.zeros(1, np.complex128) if g is None else 1.0 - g)


class _Fields:
    """The kept part of the rows of ceramics per unit of each shape, found once a layer."""

    def __init__(self, part: OrdersBasis) -> None:
        self._part, self._known = part, dict[int, tuple[FloatArray, FloatArray]]()

    def stress(self, place: Place) -> FloatArray:
        """Return what the field of a ceramic adds to a stress in it, shape (orders, shapes)."""
        if place.layer not in self._known:
            rows = self._part.electric_rows[place.layer]
            kept = kept_rows(self._part, rows)
            self._known[place.layer] = kept, np.swapaxes(kept, 1, 2) @ rows
        kept, shown = self._known[place.layer]
        per_row = field_stress(self._part, place.layer, place.radius, place.what)
        return np.asarray(((per_row[:, None] @ kept) @ shown)[:, 0])


def _parts_of(place: Place, part: OrdersBasis, fields: _Fields | None) -> list[tuple[FloatArray, bool]]:
    """Return a quantity per unit of each shape in parts, with whether g weighs each of them not; one part without losses."""
    whole = shown_by_shapes(part, place.layer, place.radius, place.what)
    if fields is None or place.what not in STRESSES:
        return [(whole, True)]
    if part.mesh.layers[place.layer].layer.coupling is None:
        return [(whole, False)]
    field = fields.stress(place)
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
