"""A wall of solid layers of which some have losses: pieces that each answer in closed form, joined face to face.

No node costs a matrix of the wall's points: layers under one factor answer by sums over the shapes they have without losses, rubbers by
their potentials (:mod:`coaxshell.structure.solid_pieces`), and joints are 2 x 2, or 3 x 3 in waves along the axis. A front meets a face
with the impedance rho c_L sqrt(g).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
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
from coaxshell.structure.solid_driven import DrivenAnswer, DrivenReading, WallDrive
from coaxshell.structure.solid_pieces import MOST_DEGREE, Piece, Place, pieces
from coaxshell.structure.solid_ports import DrivenPort, UnderVoltage, under_volts
from coaxshell.structure.solid_transducers import Loop, OpenCircuits, Unanswered, closed_loop, field_of_volts

BOTH = (0, 1)
"""What the law reads and the voltage that it gives."""
SOFT_DEGREE = 64
"""A wall without losses of which a layer needs a higher degree at the top of the band answers by pieces too."""


def is_soft(layer: SolidLayer, frequency: float) -> bool:
    """Return whether shear waves in an isotropic layer are so short that it had better answer by its potentials."""
    return layer.isotropic and degree(layer, 0.0, 0.0, frequency) > SOFT_DEGREE


def resolved(wall: ElasticWall, frequency: float) -> ElasticWall:
    """Return a wall that resolves waves up to a frequency, radians per transit: by pieces if a layer is too soft for shapes.

    A wall without losses that senses or acts keeps its shapes.
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
        """Consecutive layers that answer together, from the inside out; under control layers keep their shapes as long as they can."""
        return pieces(self.layers, self.frequency, self.meshed_as, MOST_DEGREE if self.transducers is None else SOFT_DEGREE)

    @cached_property
    def driven_pieces(self) -> WallDrive | None:
        """The transducers on its pieces; None where it is not under control."""
        return None if self.transducers is None else WallDrive(self.pieces, self.transducers, self.silent is not None)

    @property
    def driven_layers(self) -> tuple[range, ...]:
        """Numbers of the layers that voltages drive together: those of pieces with shapes that lie side by side."""
        if self.driven_pieces is None:
            return ()
        ends = ((self.pieces[each[0]], self.pieces[each[-1]]) for each in self.driven_pieces.stacks)
        return tuple(range(first.first, last.first + len(last.layers)) for first, last in ends)

    @cached_property
    def stiffest(self) -> ElasticWall:
        """The wall without losses, every layer as stiff as it ever is within the run."""
        found = ElasticWall.of(tuple(layer.stiffest for layer in self.layers), self.core)
        held = {name: getattr(self, name) for name in ("transducers", "gains", "segments", "belts", "tied_as")}
        return replace(found, **held, frequency=self.frequency)

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
        self._kept_reading(tuple(self.asked_of_port)).prepare(modes)
        if self.driven_pieces is not None:
            self._driven(self.asked_of_port).prepare(modes)

    def receptance(self, modes: Modes, s: ComplexArray) -> FaceReceptance:
        """Return how its faces answer loads on them."""
        if np.ndim(modes.wavenumber):
            return self.inclined_port(modes, s, [])[0]
        if not self.closes_a_loop:
            return _receptance(self._faces.at(modes, s)[0])
        found = self.answered(modes, s)
        return self._under_loop(found.receptance, self._closed_by(found, self._law(modes, s)))

    def fed_back_from(self, open_loop: FaceReceptance, modes: Modes, s: ComplexArray) -> FaceReceptance:
        """Return how its faces answer with its feedback; what they do without is no part of its sums."""
        return self.receptance(modes, s)

    def two_port(
        self, modes: Modes, s: ComplexArray, some: slice = slice(None), *, gives: bool = False
    ) -> tuple[FaceReceptance, ComplexArray]:
        """Return how its faces answer, and some of what its reference shows, per load on either face: (quantities, 2, orders, nodes)."""
        asked = self.asked_of_port[some]
        if self.driven_pieces is not None:
            return self._port_under_loop(asked, modes, s, tells=self._told(some, gives))[:2]
        chain, shown = self._kept_reading(tuple(asked)).at(modes, s)
        shown *= self.signs_of(asked)  # of potentials, as without losses
        return _receptance(chain), self._per_load(shown)

    def reading(self, modes: Modes, s: ComplexArray, some: slice = slice(None), *, gives: bool = False) -> ComplexArray:
        """Return what :meth:`two_port` shows; the pieces' ports give both."""
        return self.two_port(modes, s, some, gives=gives)[1]

    def station_port(self, modes: Modes, s: ComplexArray, *, reads: bool = True) -> tuple[FaceReceptance, ComplexArray]:
        """Return the same of what stations along the axis read, shape (9 + layers, 2, orders, nodes), or nothing of it."""
        if np.ndim(modes.wavenumber):
            return super().station_port(modes, s, reads=reads)
        if self.closes_a_loop:
            return self._of_stations(modes, s, reads)[:2]
        chain, shown = (self._stations if reads else self._faces).at(modes, s)
        shown[len(DISPLACEMENTS) + len(STRESSES) :] *= -1.0
        return _receptance(chain), self._per_load(shown)

    def driven_port(self, modes: Modes, s: ComplexArray, *, reads: bool = True) -> tuple[FaceReceptance, ComplexArray, DrivenPort]:
        """Return the same of a wall whose loop the solver closes, and how its transducers answer."""
        if np.ndim(modes.wavenumber):
            return super().driven_port(modes, s, reads=reads)
        receptance, shown, loop, each = self._of_stations(modes, s, reads, fed_back=False)
        return receptance, shown, DrivenPort.of(loop, each)

    def _of_stations(
        self, modes: Modes, s: ComplexArray, reads: bool, *, fed_back: bool = True
    ) -> tuple[FaceReceptance, ComplexArray, Loop, ComplexArray]:
        asked, tells = (self.asked_of_stations, BOTH) if reads else ([], ())
        return self._port_under_loop(asked, modes, s, tells=tells, fed_back=fed_back)

    def prepare_stations(self, modes: Modes) -> None:
        """Make the shapes of its pieces."""
        if np.ndim(modes.wavenumber):
            return
        self._stations.prepare(modes)
        self._faces.prepare(modes)
        if self.closes_a_loop:
            for asked in (self.asked_of_stations, []):
                self._driven(asked).prepare(modes)

    def transfer(self, modes: Modes, s: ComplexArray, asked: Sequence[Asked], *, fed_back: bool = True) -> ComplexArray:
        """Return quantities per inward load on the inner and on the outer face, shape (quantities, 2, orders, nodes)."""
        if np.ndim(modes.wavenumber):
            return self.inclined_port(modes, s, asked, fed_back=fed_back)[1]
        if not self.closes_a_loop:
            return self._per_load(self._reading(asked).at(modes, s)[1])
        found = self._driven(asked).at(modes, s)
        loop = self._closed_by(found, self._law(modes, s) if fed_back else 0.0)
        return self._per_load(found.shown) + under_volts(found.by_volts + self._fields(modes, asked), loop.volts)

    # Control

    def _port_under_loop(
        self, asked: Sequence[Asked], modes: Modes, s: ComplexArray, *, tells: Sequence[int] = BOTH, fed_back: bool = True
    ) -> tuple[FaceReceptance, ComplexArray, Loop, ComplexArray]:
        """Return how its faces answer and what it shows per load on them, last what the law reads and gives, as far as it *tells* that.

        And the loop, with what a volt of each circuit shows, (quantities, circuits, orders, nodes).
        """
        found, signs = self._driven(asked).at(modes, s), self.signs_of(asked)
        law = self._law(modes, s) if fed_back else 0.0
        loop = self._closed_by(found, law)
        by_volts = signs * (found.by_volts + self._fields(modes, asked))
        shown = signs * self._per_load(found.shown) + under_volts(by_volts, loop.volts)
        told = [loop.sensed, law * loop.sensed]
        return self._under_loop(found.receptance, loop), np.concatenate([shown, *(told[one][None] for one in tells)]), loop, by_volts

    def under_voltage(self, modes: Modes, s: ComplexArray, asked: Sequence[Asked]) -> UnderVoltage:
        """Return what a volt that is given to all its actuators does, open circuits beside them charging themselves, without feedback."""
        if np.ndim(modes.wavenumber):
            return self.inclined_under_voltage(modes, s, asked)
        found = self._driven(asked).at(modes, s)
        loop = self._closed_by(found, 0.0)
        shown = found.by_volts + self._fields(modes, asked)
        both = under_volts(np.concatenate([-found.moved, shown]), loop.given[:, None])[:, 0]
        return UnderVoltage(both[:2], both[2:], loop.heard)

    def along_resistance(self, modes: Modes, s: ComplexArray) -> FloatArray:
        """Return -inf: its pieces have shapes, some of them, and nothing is proven of it."""
        return np.full((modes.count, s.size), -np.inf)

    def answered(self, modes: Modes, s: ComplexArray) -> DrivenAnswer:
        """Return what its faces and its transducers answer while no voltage does."""
        return self._driven([]).at(modes, s)

    def _loop(self, modes: Modes, s: ComplexArray, law: ComplexArray | float) -> Loop:
        return self._closed_by(self.answered(modes, s), law)

    def _closed_by(self, found: DrivenAnswer, law: ComplexArray | float) -> Loop:
        assert self.transducers is not None
        circuits = None
        if found.charged is not None and found.at_once is not None and found.all_of_volts is not None:
            circuits = OpenCircuits(self._per_load(found.charged), found.all_of_volts, found.at_once)
        wall = Unanswered(-found.moved, self._per_load(found.heard), found.of_volts, circuits)
        return closed_loop(wall, self.transducers.circuits, law)

    def _fields(self, modes: Modes, asked: Sequence[Asked]) -> FloatArray:
        """Return what fields add to quantities per volt of each circuit, shape (quantities, circuits, orders, 1)."""
        assert self.transducers is not None
        every, found = self.transducers, np.zeros((len(asked), modes.count, len(self.transducers.driven)))
        for piece in (piece for piece in self.pieces if not piece.by_potentials):
            numbers = [one - piece.first for one in every.driven if 0 <= one - piece.first < len(piece.layers)]
            if not numbers:
                continue
            places = [every.driven.index(number + piece.first) for number in numbers]
            own = replace(every, sensors=(), actuators=tuple(numbers), shorted=())
            for row, one in enumerate(asked):
                if (layer := self.layer_at(one.depth) - piece.first) in numbers:
                    each = [field_of_volts(part, own, layer, self.radius + one.depth, one.what) for part in piece.basis(modes)]
                    found[row][:, places] = np.concatenate(each)
        return np.moveaxis(found @ every.circuits.shares, 2, 1)[..., None]

    def _driven(self, asked: Sequence[Asked]) -> DrivenReading:
        key = tuple(asked)
        if key not in self._readings:
            assert self.driven_pieces is not None
            self._readings[key] = DrivenReading(self.driven_pieces, self._places(asked))
        return self._readings[key]

    @cached_property
    def _readings(self) -> dict[tuple[Asked, ...], DrivenReading]:
        return {}

    def strokes(self, modes: Modes, s: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
        """Return d'x of every driven layer per inward load on either face and per volt of each circuit, (driven, ..., orders, nodes)."""
        found = self.answered(modes, s)
        return self._per_load(found.strokes), found.strokes_by_volts

    def capacitances(self, modes: Modes) -> FloatArray:
        """Return C of each driven layer per radian, shape (driven, orders)."""
        assert self.driven_pieces is not None
        loads = [one for one in self.driven_pieces.loads(modes) if one is not None]
        return np.asarray(sum(np.concatenate([part.capacitance for part in parts]) for parts in loads)).T

    def feedback_frequency(self, modes: Modes) -> float:
        """Return that of the wall at its stiffest."""
        return 0.0 if self.gains is None else self.stiffest.feedback_frequency(modes)

    # Readings

    def _kept_reading(self, asked: tuple[Asked, ...]) -> WallReading:
        if asked not in self._kept_readings:
            self._kept_readings[asked] = self._reading(asked)
        return self._kept_readings[asked]

    @cached_property
    def _kept_readings(self) -> dict[tuple[Asked, ...], WallReading]:
        return {}

    @cached_property
    def _stations(self) -> WallReading:
        return self._reading(self.asked_of_stations)

    @cached_property
    def _faces(self) -> WallReading:
        return WallReading(self.pieces)

    def _reading(self, asked: Sequence[Asked]) -> WallReading:
        return WallReading(self.pieces, self._places(asked))

    def _places(self, asked: Sequence[Asked]) -> tuple[Place, ...]:
        return tuple(Place(one.what, self.radius + one.depth, self.layer_at(one.depth)) for one in asked)

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
