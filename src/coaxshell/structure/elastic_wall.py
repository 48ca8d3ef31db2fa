"""A wall whose layers are three-dimensional elastic solids, wetted at its true faces.

Its two faces move differently, so that it answers by receptances (:class:`coaxshell.structure.shell_model.FaceReceptance`), and everything
within it by the loads on both: with u_r = phi_a at face a of a shape of its eigenbasis and an inward load q_a at the radius r_a there,

    x = -sum over shapes of (shape) sum_a phi_a r_a q_a/(omega^2 + s^2),      H_ab = sum phi_a phi_b/(omega^2 + s^2).

All of it is a matrix product for each order (:func:`coaxshell.structure.shape_sums.modal_sums`). Its middle is the reference surface.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple, Self

import numpy as np

from coaxshell.model.layers import serves
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.modes import Modes, kept_with_modes
from coaxshell.structure.belts import Belts
from coaxshell.structure.elastic_basis import OrdersBasis, elastic_basis, some_of
from coaxshell.structure.elastic_depth import DISPLACEMENTS, STRESSES, Shown, all_by_shapes, several_by_shapes, shown_by_shapes
from coaxshell.structure.inclined_drive import InclinedAnswer, inclined_under_volts
from coaxshell.structure.layered_wall import LayeredWall
from coaxshell.structure.segments import Segments
from coaxshell.structure.shape_sums import modal_sums
from coaxshell.structure.shell_model import FaceReceptance
from coaxshell.structure.solid import SolidLayer
from coaxshell.structure.solid_inclined import InclinedPlace, inclined_port
from coaxshell.structure.solid_ports import (
    ByVolts,
    DrivenPort,
    Port,
    UnderVoltage,
    by_volts,
    of_faces,
    per_volt,
    products,
    under_volts,
    volt_port,
)
from coaxshell.structure.solid_transducers import (
    Driven,
    Loop,
    LoopPart,
    OpenCircuits,
    Transducers,
    Unanswered,
    at_rest,
    by_circuits,
    closed_loop,
    driven_of,
    loop_part,
    loop_sizes,
    resistance_along,
    unanswered,
)
from coaxshell.structure.tied_wall import TiedWall


class Asked(NamedTuple):
    """A quantity at a depth z, outward from the middle of the wall in a; see :data:`coaxshell.structure.elastic_depth.Shown`."""

    what: Shown
    depth: float


@dataclass(frozen=True, kw_only=True)
class ElasticWall(LayeredWall):
    """A wall of solid layers, as it answers and as it is fed back.

    Attributes
    ----------
    transducers : Transducers or None
        What senses and acts, where the wall is under control.
    depth_read : float or None
        Depth at which stations read it; None for the motion of its middle and the stresses at its design depth.
    keeps_shapes : bool
        Whether stations keep its shapes as long as the modes are in use, which are three times what they read of them.
    silent : ndarray, shape (2, orders), or None
        Orders, and the frequency of each above which shapes do not answer, where only slower ones are looked at.
    meshed_as : tuple of SolidLayer or None
        Layers beside its own that decide on its mesh.
    segments : Segments or None
        Of its electrodes. Where they are cut its feedback, which ties orders to each other, is closed by the solver, not by the wall.
    belts : Belts or None
        Those into which its electrodes are cut along the axis; the solver closes such loops too.
    tied_as : TiedWall or None
        The thin wall of its layers where its actuators answer other walls too; the solver closes such a loop.
    """

    transducers: Transducers | None = None
    segments: Segments | None = None
    belts: Belts | None = None
    tied_as: TiedWall | None = None
    depth_read: float | None = field(default=None, compare=False)
    keeps_shapes: bool = field(default=False, compare=False)
    silent: FloatArray | None = field(default=None, compare=False)
    meshed_as: tuple[SolidLayer, ...] | None = field(default=None, compare=False)

    def along_alone(self, highest: FloatArray) -> Self:
        """Return the wall whose shapes above a frequency of each order do not answer: it bends and stretches along itself alone."""
        return replace(self, silent=highest)

    @kept_with_modes
    def basis(self, modes: Modes) -> tuple[OrdersBasis, ...]:
        """Return the shapes of some modes, made once as long as these are in use; nobody may change them."""
        found = self._shapes(modes) if modes.whole is None else some_of(self.basis(modes.whole), modes.orders)
        if self.silent is None:
            return found
        slow = (part.squares < np.interp(part.orders, *self.silent)[:, None] ** 2 for part in found)
        return tuple(replace(part, shapes=part.shapes * answering[..., None, None]) for part, answering in zip(found, slow, strict=True))

    def _shapes(self, modes: Modes) -> tuple[OrdersBasis, ...]:
        return elastic_basis(self.layers, modes, self.frequency, self.meshed_as)

    def prepare(self, modes: Modes) -> None:
        """Make what all blocks of nodes share, before all threads ask for it."""
        self.basis(modes)

    def receptance(self, modes: Modes, s: ComplexArray) -> FaceReceptance:
        """Return how its faces answer loads on them."""
        if np.ndim(modes.wavenumber):
            return self.inclined_port(modes, s, [])[0]
        found = self._summed(modes, s, [of_faces(part) for part in self.basis(modes)])
        loop = self.loop(modes, s)
        return FaceReceptance(*found) if loop is None else self._under_loop(FaceReceptance(*found), loop)

    def fed_back_from(self, open_loop: FaceReceptance, modes: Modes, s: ComplexArray) -> FaceReceptance:
        """Return how its faces answer with its feedback from how they do without."""
        if self.transducers is None or self.transducers.circuits.any_open or np.ndim(modes.wavenumber):
            return self.receptance(modes, s)  # open circuits charge themselves without feedback too
        return self._under_loop(open_loop, self._loop(modes, s, self._law(modes, s)))

    def two_port(
        self, modes: Modes, s: ComplexArray, some: slice = slice(None), *, gives: bool = False
    ) -> tuple[FaceReceptance, ComplexArray]:
        """Return how its faces answer, and what its reference shows, per load on either face: shape (3 + layers, 2, orders, nodes).

        W and V of the middle, hoop stress at the design depth and potentials in the middle of the piezoelectric layers, whose faces are
        grounded, in the sign of the sensor equation. Under control two more: what the law reads, and the voltage that it gives. Or ``some``
        of it, if asked for, and last that voltage if the wall *gives* it besides.
        """
        first, stop, _ = some.indices(len(self.asked_of_port))
        found = self._summed(modes, s, [weights[:, [0, 1, 2, *range(3 + 2 * first, 3 + 2 * stop)]] for weights in self._of_port(modes)])
        receptance, shown = FaceReceptance(*found[:3]), found[3:].reshape(-1, 2, *found.shape[1:])
        if self.transducers is None:
            return receptance, shown
        law, asked = self._law(modes, s), slice(first, stop)
        loop = self._loop(modes, s, law)
        added = under_volts(self._shown_per_volt(modes, s, self._volts_of_port(modes), asked), loop.volts)
        shown += self.signs_of(self.asked_of_port[asked]) * added
        told = [loop.sensed, law * loop.sensed]
        return self._under_loop(receptance, loop), np.concatenate([shown, *(told[one][None] for one in self._told(some, gives))])

    def reading(self, modes: Modes, s: ComplexArray, some: slice = slice(None), *, gives: bool = False) -> ComplexArray:
        """Return what :meth:`two_port` shows, without how the faces answer where that is not needed for it."""
        if self.transducers is not None:
            return self.two_port(modes, s, some, gives=gives)[1]
        first, stop, _ = some.indices(len(self.asked_of_port))
        found = self._summed(modes, s, [weights[:, 3 + 2 * first : 3 + 2 * stop] for weights in self._of_port(modes)])
        return found.reshape(-1, 2, *found.shape[1:])

    def _told(self, some: slice, gives: bool) -> list[int]:
        """Return which of what the law reads and gives is among what :meth:`two_port` shows, where it comes last."""
        count = len(self.asked_of_port)
        return [*(one - count for one in range(count + 2)[some] if one >= count), *([1] if gives else [])]

    def transfer(self, modes: Modes, s: ComplexArray, asked: Sequence[Asked], *, fed_back: bool = True) -> ComplexArray:
        """Return quantities per inward load on the inner and on the outer face, shape (quantities, 2, orders, nodes).

        Without being ``fed_back`` its actuators are given no voltage.
        """
        if np.ndim(modes.wavenumber):
            return self.inclined_port(modes, s, asked, fed_back=fed_back)[1]
        found = self._summed(modes, s, self._weights(modes, asked))
        shown, loop = found.reshape(-1, 2, *found.shape[1:]), self.loop(modes, s, fed_back=fed_back)
        if loop is None:
            return shown
        return shown + under_volts(self._shown_per_volt(modes, s, self._volts_of(modes, asked)), loop.volts)

    def inclined_port(
        self, modes: Modes, s: ComplexArray, asked: Sequence[Asked], *, fed_back: bool = True, tells: bool = False
    ) -> tuple[FaceReceptance, ComplexArray, DrivenPort | None]:
        """Return how its faces answer and what it shows per inward load on them in a wave that runs along the axis.

        Last what the law reads and gives if it *tells* that; and how its transducers answer where nothing is *fed_back*.
        """
        places = [InclinedPlace(one.what, self.radius + one.depth, self.layer_at(one.depth)) for one in asked]
        pressed = -np.array(self.wetted)[:, None, None]
        if self.transducers is None or not self.closes_a_loop:
            free, found = inclined_port(self.layers, modes, s, self.frequency, places)
            return FaceReceptance(*free), -pressed * found, None
        law = self._law(modes, s) if fed_back else 0.0
        each, loop = self._inclined_loop(modes, s, places, law)
        shown = pressed * each.shown + under_volts(each.by_volts, loop.volts)
        if tells:
            shown = np.concatenate([shown, loop.sensed[None], law * loop.sensed[None]])
        faces = -each.faces
        receptance = self._under_loop(FaceReceptance(faces[0, 0], faces[0, 1], faces[1, 1]), loop)
        return receptance, shown, None if fed_back else DrivenPort.of(loop, each.by_volts)

    def _inclined_loop(
        self, modes: Modes, s: ComplexArray, places: Sequence[InclinedPlace], law: ComplexArray | float
    ) -> tuple[InclinedAnswer, Loop]:
        assert self.transducers is not None
        each = inclined_under_volts(self.layers, modes, s, self.frequency, places, self.transducers, self.driven_layers)
        pressed, circuits = -np.array(self.wetted)[:, None, None], None
        if self.transducers.circuits.any_open:
            circuits = OpenCircuits(pressed * each.charged, each.all_of_volts, each.at_once)
        wall = Unanswered(each.moved, pressed * each.heard, each.of_volts, circuits)
        return each, closed_loop(wall, self.transducers.circuits, law)

    def inclined_under_voltage(self, modes: Modes, s: ComplexArray, asked: Sequence[Asked]) -> UnderVoltage:
        """Return what a volt on all its actuators does in a wave that runs along the axis."""
        driven = self.inclined_port(modes, s, asked, fed_back=False)[2]
        assert driven is not None
        return driven.given

    @property
    def driven_layers(self) -> tuple[range, ...]:
        """Numbers of the layers that voltages drive together, without what lies beside them: all."""
        return (range(len(self.layers)),)

    def under_voltage(self, modes: Modes, s: ComplexArray, asked: Sequence[Asked]) -> UnderVoltage:
        """Return what a volt that is given to all its actuators does, open circuits beside them charging themselves, without feedback."""
        if np.ndim(modes.wavenumber):
            return self.inclined_under_voltage(modes, s, asked)
        loop = self._loop(modes, s, 0.0)
        volts = self._volts_of_port(modes) if list(asked) == self.asked_of_port else self._volts_of(modes, asked)
        each, given = np.concatenate([loop.moved, self._shown_per_volt(modes, s, volts)]), loop.given[:, None]
        found = under_volts(each, given)[:, 0]
        return UnderVoltage(found[:2], found[2:], loop.heard)

    @property
    def electrode_segments(self) -> Segments | None:
        """Segments of its electrodes."""
        return self.segments

    @property
    def shares(self) -> dict[int, float] | None:
        """What its actuators answer, by the number of the wall that reads; None for their own wall alone."""
        return None if self.tied_as is None else self.tied_as.shares

    def loop(self, modes: Modes, s: ComplexArray, *, fed_back: bool = True) -> Loop | None:
        """Return what its transducers do to it; None without any, or where none acts and none is open."""
        if not self.closes_a_loop:
            return None
        law = self._law(modes, s) if fed_back else 0.0
        return self._inclined_loop(modes, s, [], law)[1] if np.ndim(modes.wavenumber) else self._loop(modes, s, law)

    def _loop(self, modes: Modes, s: ComplexArray, law: ComplexArray | float) -> Loop:
        assert self.transducers is not None
        return self._loop_of(self._loop_parts(modes), [part.squares for part in self.basis(modes)], s, law)

    @kept_with_modes
    def _loop_parts(self, modes: Modes) -> tuple[LoopPart, ...]:
        """Return what closes its loop, of each part of the basis."""
        assert self.transducers is not None
        opened, bases = self.transducers.circuits.any_open, self.basis(modes)
        each = zip(bases, self._circuits(modes), self._at_once(modes) if opened else [None] * len(bases), strict=True)
        return tuple(loop_part(part, driven, self.wetted, opened=opened, at_once=at_once) for part, driven, at_once in each)

    @kept_with_modes
    def _at_once(self, modes: Modes) -> tuple[FloatArray, ...]:
        """Return what volts add at once to the readings of its circuits: through the thickness, in which nothing else may move."""
        whole = replace(self, silent=None)
        return tuple(at_rest(part, one.readings, one) for part, one in zip(whole.basis(modes), whole._circuits(modes), strict=True))

    def along_resistance(self, modes: Modes, s: ComplexArray) -> FloatArray:
        """Return :func:`resistance_along` of what volts move and the law hears, (orders, nodes); -inf where open circuits answer too."""
        assert self.transducers is not None
        if self.transducers.circuits.any_open:
            return np.full((modes.count, s.size), -np.inf)
        law = np.broadcast_to(self._law(modes, s), (modes.count, s.size))
        pairs = zip(self.basis(modes), self._circuits(modes), strict=True)
        return np.concatenate([resistance_along(part, driven, law[part.members], s) for part, driven in pairs])

    @property
    def closes_a_loop(self) -> bool:
        """Whether any layer acts, or is an open circuit."""
        return self.transducers is not None and (self.gains is not None or bool(self.transducers.opened.any()))

    def _loop_of(self, parts: Sequence[LoopPart], squares: Sequence[FloatArray], s: ComplexArray, law: ComplexArray | float) -> Loop:
        assert self.transducers is not None
        return closed_loop(unanswered(parts, squares, s), self.transducers.circuits, law)

    @kept_with_modes
    def driven(self, modes: Modes) -> tuple[Driven, ...]:
        """Return loads and readings of its transducers, for each part of the basis."""
        assert self.transducers is not None
        return tuple(driven_of(part, self.transducers) for part in self.basis(modes))

    def capacitances(self, modes: Modes) -> FloatArray:
        """Return C of each driven layer per radian, shape (driven, orders)."""
        return np.concatenate([one.capacitance for one in self.driven(modes)]).T

    @kept_with_modes
    def _circuits(self, modes: Modes) -> tuple[Driven, ...]:
        """Return the same of the circuits that close the loop."""
        assert self.transducers is not None
        return tuple(by_circuits(one, self.transducers.circuits) for one in self.driven(modes))

    @property
    def closed_by_solver(self) -> bool:
        """Whether its feedback ties orders or walls to each other, so that the solver closes the loop."""
        return self.gains is not None and bool(self.segments or self.belts or self.tied_as)

    def _law(self, modes: Modes, s: ComplexArray) -> ComplexArray | float:
        return 0.0 if self.gains is None or self.closed_by_solver else self.gains.at(s, modes)

    def _under_loop(self, open_loop: FaceReceptance, loop: Loop) -> FaceReceptance:
        """Return receptances with what the transducers add to them."""
        inner, outer = self.wetted
        added = under_volts(loop.moved, loop.volts) / np.array([inner, outer])[:, None, None]
        h_ii, h_io, h_oo = open_loop.inner, open_loop.across, open_loop.outer
        return FaceReceptance(h_ii + added[0, 0], h_io + added[0, 1], h_oo + added[1, 1], loop.characteristic, h_io + added[1, 0])

    def _shown_per_volt(self, modes: Modes, s: ComplexArray, volts: Sequence[ByVolts], some: slice = slice(None)) -> ComplexArray:
        """Return quantities per volt of each circuit: by the motion that it makes, in its layers by their field."""
        return per_volt(volts, [part.squares for part in self.basis(modes)], s, some)

    @kept_with_modes
    def _volts_of_port(self, modes: Modes) -> tuple[ByVolts, ...]:
        """Return what volts of each circuit add to what :meth:`two_port` shows, of each part of the basis."""
        return self._volts_of(modes, self.asked_of_port)

    def _volts_of(self, modes: Modes, asked: Sequence[Asked]) -> tuple[ByVolts, ...]:
        assert self.transducers is not None
        places, found = self._read_at(asked), []
        for part, driven in zip(self.basis(modes), self._circuits(modes), strict=True):
            found.append(by_volts(part, self.transducers, driven, self._shown(part, asked), places))
        return tuple(found)

    @property
    def shows_control(self) -> bool:
        """Whether it is under control."""
        return self.transducers is not None

    @property
    def shown_potentials(self) -> int:
        """How many potentials it shows: of its piezoelectric layers, and under control what the law reads and the voltage given."""
        return len(self.piezoelectric) + (2 if self.transducers is not None else 0)

    def voltage_limit(self, field: float | None = None) -> float:
        """Return the least of field limit times thickness of all actuators."""
        if self.transducers is None or field is None:
            return float("inf") if self.transducers is None else self.transducers.limit
        return min((field * self.layers[one].thickness for one in self.transducers.actuators), default=float("inf"))

    def feedback_frequency(self, modes: Modes) -> float:
        """Return a frequency above which feedback is less than half of its inertia, as far as orders bend and stretch along the wall."""
        if self.gains is None or self.transducers is None:
            return 0.0
        top = float(self.highest_frequency(modes).max())
        if self.tied_as is not None:
            fades = self.tied_as.feedback_frequency(modes)
        else:
            sizes = loop_sizes(self.basis(modes), self.driven(modes), 1.5 * top)
            sizes = sizes if self.segments is None else self.segments.of_patterns(sizes, modes.orders)
            fades = self.gains.fades(sizes * np.abs(self.gains.weight(modes.orders)))
        return max(fades, 1.2 * top) if fades > 0.0 else 0.0

    def station_port(self, modes: Modes, s: ComplexArray, *, reads: bool = True) -> tuple[FaceReceptance, ComplexArray]:
        """Return the same of what stations along the axis read, shape (9 + layers, 2, orders, nodes), or nothing of it.

        W, V and U of the middle, the six stresses at the design depth (:data:`coaxshell.structure.elastic_depth.STRESSES`) and the
        potentials; at :attr:`depth_read` all but the potentials, if there is one. Under control what the law reads and gives come last.
        """
        receptance, per_load, _ = self._at_stations(modes, s, reads, fed_back=not self.closed_by_solver)
        return receptance, per_load

    def driven_port(self, modes: Modes, s: ComplexArray, *, reads: bool = True) -> tuple[FaceReceptance, ComplexArray, DrivenPort]:
        """Return the same of a wall whose loop the solver closes, and how its transducers answer, signs as of what stations read."""
        receptance, per_load, driven = self._at_stations(modes, s, reads, fed_back=False)
        assert driven is not None
        return receptance, per_load, driven

    def _at_stations(
        self, modes: Modes, s: ComplexArray, reads: bool, *, fed_back: bool
    ) -> tuple[FaceReceptance, ComplexArray, DrivenPort | None]:
        """Return what :meth:`station_port` does, and where it is not fed back how its transducers answer."""
        if np.ndim(modes.wavenumber):
            return self._inclined_stations(modes, s, reads, fed_back=fed_back)
        parts, ports = [], self.ports(modes)
        for port in ports:
            pressed, weights = -port.faces * np.array(self.wetted)[:, None], products(port.faces)
            if reads:
                shown = (port.shown[:, :, None] * pressed[:, None]).reshape(len(weights), -1, weights.shape[-1])
                weights = np.concatenate([weights, shown], axis=1)
            parts.append(modal_sums(weights, port.squares, s))
        found = parts[0] if len(parts) == 1 else np.concatenate(parts, axis=1)
        per_load = found[3:].reshape(-1, 2, *found.shape[1:])
        volts = [port.volts for port in ports if port.volts is not None]
        if not volts:
            return FaceReceptance(*found[:3]), per_load, None
        law = self._law(modes, s) if fed_back else 0.0
        loop = self._loop_of([one.loop for one in volts], [port.squares for port in ports], s, law)
        each = np.zeros((0, len(loop.volts), *found.shape[1:]), np.complex128)
        if reads:
            each = per_volt([one.shown for one in volts], [port.squares for port in ports], s)
            per_load = np.concatenate([per_load + under_volts(each, loop.volts), loop.sensed[None], law * loop.sensed[None]])
        driven = None if fed_back else DrivenPort.of(loop, each)
        return self._under_loop(FaceReceptance(*found[:3]), loop), per_load, driven

    def _inclined_stations(
        self, modes: Modes, s: ComplexArray, reads: bool, *, fed_back: bool
    ) -> tuple[FaceReceptance, ComplexArray, DrivenPort | None]:
        asked = self.asked_of_stations if reads else []
        receptance, per_load, driven = self.inclined_port(modes, s, asked, fed_back=fed_back, tells=reads)
        signs = self.signs_of(asked)
        per_load[: len(asked)] *= signs
        if driven is not None:
            driven.given.shown[:] *= signs[:, 0]
        return receptance, per_load, driven

    @kept_with_modes
    def ports(self, modes: Modes) -> tuple[Port, ...]:
        """Return what stations need of the shapes of some modes, made once as long as these are in use; nobody may change it."""
        middles = [0.5 * (self.layers[i].inner + self.layers[i].outer) for i in self.piezoelectric]
        stressed = self.design_depth if self.depth_read is None else self.depth_read
        moved, count, found = 0.0 if self.depth_read is None else stressed, len(DISPLACEMENTS), []
        for part in self.basis(modes) if self.keeps_shapes else self._shapes(modes):
            rows = all_by_shapes(part, self.layer_at(stressed), self.radius + stressed)
            if moved != stressed:
                rows[:, :count] = all_by_shapes(part, self.layer_at(moved), self.radius + moved)[:, :count]
            volts = [-shown_by_shapes(part, i, r, "potential")[:, None] for i, r in zip(self.piezoelectric, middles, strict=True)]
            shown = np.concatenate([rows, *volts], axis=1)
            given = None
            if self.transducers is not None and self.closes_a_loop:
                given = volt_port(part, self.transducers, self.wetted, shown, self._read_at(self.asked_of_stations))
            found.append(Port(part.squares, part.faces, shown, given))
        return tuple(found)

    def prepare_stations(self, modes: Modes) -> None:
        """Make what all blocks of nodes share in three dimensions, before all threads ask for it."""
        if np.ndim(modes.wavenumber) == 0:  # inclined waves have no shapes
            self.ports(modes)

    @property
    def asked_of_port(self) -> list[Asked]:
        """What :meth:`two_port` shows."""
        motion = [Asked("normal", 0.0), Asked("tangential", 0.0), Asked("hoop", self.design_depth)]
        return [*motion, *self._asked_potentials]

    @property
    def asked_of_stations(self) -> list[Asked]:
        """What :meth:`station_port` shows."""
        moved = [Asked(name, self.depth_read or 0.0) for name in DISPLACEMENTS]  # type: ignore[arg-type]
        stressed = self.design_depth if self.depth_read is None else self.depth_read
        return [*moved, *(Asked(name, stressed) for name in STRESSES), *self._asked_potentials]  # type: ignore[arg-type]

    @property
    def _asked_potentials(self) -> list[Asked]:
        return [Asked("potential", 0.5 * (self.layers[i].inner + self.layers[i].outer) - self.radius) for i in self.piezoelectric]

    def signs_of(self, asked: Sequence[Asked]) -> FloatArray:
        """Return -1 for the potentials that ports show, in the sign of the sensor equation, else 1, shape (quantities, 1, 1, 1)."""
        return np.array([-1.0 if one in self._asked_potentials else 1.0 for one in asked]).reshape(-1, 1, 1, 1)

    @kept_with_modes
    def _of_port(self, modes: Modes) -> list[FloatArray]:
        """Return the weights of all shapes in what :meth:`two_port` gives, (orders, rows, shapes) of each part of the basis."""
        found = self._weights(modes, self.asked_of_port)
        for each in found:
            each[:, 6:] *= -1.0  # Phi = -cos(pi z'/t) phi: a half cosine has no sign of its own
        return [np.concatenate([of_faces(part), each], axis=1) for part, each in zip(self.basis(modes), found, strict=True)]

    def _weights(self, modes: Modes, asked: Sequence[Asked]) -> list[FloatArray]:
        """Return the weights of all shapes in quantities per load on either face, (orders, 2 quantities, shapes) of each part."""
        found = []
        for part in self.basis(modes):
            shown = self._shown(part, asked)
            pressed = -part.faces * np.array(self.wetted)[:, None]
            found.append((shown[:, :, None] * pressed[:, None]).reshape(part.orders.size, 2 * len(asked), -1))
        return found

    def _shown(self, part: OrdersBasis, asked: Sequence[Asked]) -> FloatArray:
        """Return quantities per unit of each shape, (orders, quantities, shapes)."""
        return several_by_shapes(part, self._read_at(asked))

    def _read_at(self, asked: Sequence[Asked]) -> list[tuple[Shown, int, float]]:
        return [(one.what, self.layer_at(one.depth), self.radius + one.depth) for one in asked]

    def _summed(self, modes: Modes, s: ComplexArray, weights: list[FloatArray]) -> ComplexArray:
        """Return the sums over all shapes, (rows, orders, nodes), from their weights in each part of the basis."""
        parts = [modal_sums(each, part.squares, s) for part, each in zip(self.basis(modes), weights, strict=True)]
        return parts[0] if len(parts) == 1 else np.concatenate(parts, axis=1)

    def has(self, role: str) -> bool:
        """Return whether it has a piezoelectric layer of a role."""
        return self.layer_number(role) is not None

    def layer_number(self, role: str) -> int | None:
        """Return the number of the layer of a role among the potentials shown; under control what the law reads stands for a sensor."""
        if role == "sensor" and self.transducers is not None:
            return len(self.piezoelectric)
        return next((number for number, i in enumerate(self.piezoelectric) if serves(self.layers[i].role, role)), None)
