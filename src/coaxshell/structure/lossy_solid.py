"""A wall of solid layers of which some have losses: pieces that each answer in closed form, joined face to face.

No node costs a matrix of the wall's points: layers under one factor answer by sums over the shapes they have without losses, rubbers by
their potentials (:mod:`coaxshell.structure.solid_pieces`), and joints are 2 x 2, or 3 x 3 in waves along the axis. A front meets a face
with the impedance rho c_L sqrt(g).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.modes import Modes
from coaxshell.structure.elastic_basis import OrdersBasis
from coaxshell.structure.elastic_depth import DISPLACEMENTS, STRESSES
from coaxshell.structure.elastic_mesh import degree
from coaxshell.structure.elastic_wall import Asked, ElasticWall
from coaxshell.structure.shell_model import FaceReceptance
from coaxshell.structure.solid import SolidLayer
from coaxshell.structure.solid_chain import PieceChain, WallReading
from coaxshell.structure.solid_pieces import MOST_DEGREE, Piece, Place, pieces

SOFT_DEGREE = 64
"""A wall without losses of which a layer needs a higher degree at the top of the band answers by pieces too."""


def is_soft(layer: SolidLayer, frequency: float) -> bool:
    """Return whether shear waves in an isotropic layer are so short that it had better answer by its potentials."""
    return layer.isotropic and degree(layer, 0.0, 0.0, frequency) > SOFT_DEGREE


def resolved(wall: ElasticWall, frequency: float) -> ElasticWall:
    """Return a wall that resolves waves up to a frequency, radians per transit: by pieces if a layer is too soft for shapes.

    A wall that senses or acts keeps its shapes, as pieces know no feedback.
    """
    plain = wall.gains is None and wall.transducers is None and not isinstance(wall, LossySolidWall)
    if plain and any(is_soft(layer, frequency) for layer in wall.layers):
        return LossySolidWall.of(wall.layers, wall.core).resolving(frequency)
    return wall.resolving(frequency)


@dataclass(frozen=True, kw_only=True)
class LossySolidWall(ElasticWall):
    """A wall of solid layers with losses, or with layers too soft for shapes."""

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """Consecutive layers that answer together, from the inside out."""
        return pieces(self.layers, self.frequency, self.meshed_as)

    @cached_property
    def stiffest(self) -> ElasticWall:
        """The wall without losses, every layer as stiff as it ever is within the run."""
        return ElasticWall.of(tuple(layer.stiffest for layer in self.layers), self.core)

    def degree_of(self, layer: SolidLayer, order: float, wavenumber: float = 0.0) -> int:
        """Return the degree for the waves of a layer that are worth a search: with losses they die within it as they become short."""
        return min(super().degree_of(layer, order, wavenumber), SOFT_DEGREE if layer.factor is None else MOST_DEGREE)

    def shape_count(self, order: float, wavenumber: float) -> int:
        """Return how many shapes there are in a wave along the axis: of the layers that have shapes."""
        counted = (layer for piece in self.pieces if not piece.by_potentials for layer in piece.layers)
        return 3 * (1 + sum(degree(layer, order, wavenumber, self.frequency) for layer in counted))

    def basis(self, modes: Modes) -> tuple[OrdersBasis, ...]:
        """Refuse: its pieces have shapes, some of them."""
        raise NotImplementedError("a wall with losses has no shapes of its own")

    def prepare(self, modes: Modes) -> None:
        """Make the shapes of its pieces."""
        self._port.prepare(modes)

    def receptance(self, modes: Modes, s: ComplexArray) -> FaceReceptance:
        """Return how its faces answer loads on them."""
        return _receptance(self._faces.at(modes, s)[0])

    def two_port(self, modes: Modes, s: ComplexArray) -> tuple[FaceReceptance, ComplexArray]:
        """Return how its faces answer, and what its reference shows, per load on either face: shape (3 + layers, 2, orders, nodes)."""
        chain, shown = self._port.at(modes, s)
        shown[3:] *= -1.0  # potentials, as without losses
        return _receptance(chain), self._per_load(shown)

    def station_port(self, modes: Modes, s: ComplexArray, *, reads: bool = True) -> tuple[FaceReceptance, ComplexArray]:
        """Return the same of what stations along the axis read, shape (9 + layers, 2, orders, nodes), or nothing of it."""
        chain, shown = (self._stations if reads else self._faces).at(modes, s)
        shown[len(DISPLACEMENTS) + len(STRESSES) :] *= -1.0
        return _receptance(chain), self._per_load(shown)

    def prepare_stations(self, modes: Modes) -> None:
        """Make the shapes of its pieces."""
        self._stations.prepare(modes)
        self._faces.prepare(modes)

    def transfer(self, modes: Modes, s: ComplexArray, asked: Sequence[Asked], *, fed_back: bool = True) -> ComplexArray:
        """Return quantities per inward load on the inner and on the outer face, shape (quantities, 2, orders, nodes)."""
        return self._per_load(self._reading(asked).at(modes, s)[1])

    @cached_property
    def _port(self) -> WallReading:
        return self._reading(self.asked_of_port)

    @cached_property
    def _stations(self) -> WallReading:
        return self._reading(self.asked_of_stations)

    @cached_property
    def _faces(self) -> WallReading:
        return WallReading(self.pieces)

    def _reading(self, asked: Sequence[Asked]) -> WallReading:
        places = (Place(one.what, self.radius + one.depth, self.layer_at(one.depth)) for one in asked)
        return WallReading(self.pieces, tuple(places))

    def _per_load(self, shown: ComplexArray) -> ComplexArray:
        """Return what outward forces show as what inward loads do: q at r is a force -r q."""
        for side, radius in enumerate(self.wetted):
            shown[:, side] *= -radius
        return shown

    def highest_frequency(self, modes: Modes) -> FloatArray:
        """Return that of the wall at its stiffest."""
        return self.stiffest.highest_frequency(modes)

    def fastest_wave(self, max_wavenumber: float) -> float:
        """Return that of the wall at its stiffest."""
        return self.stiffest.fastest_wave(max_wavenumber)

    @property
    def dissipates(self) -> bool:
        """Whether any layer has losses."""
        return any(layer.factor is not None for layer in self.layers)


def _receptance(chain: PieceChain) -> FaceReceptance:
    return FaceReceptance(*(np.asarray(x, dtype=np.complex128) for x in (chain.inner, chain.across, chain.outer)))


def shaped_layers(wall: ElasticWall) -> tuple[tuple[SolidLayer, ...], ...]:
    """Return the layers of a wall that have shapes, those together that share them."""
    if not isinstance(wall, LossySolidWall):
        return (wall.layers,)
    return tuple(piece.layers for piece in wall.pieces if not piece.by_potentials)
