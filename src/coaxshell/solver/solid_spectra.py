"""Transforms of what walls with two faces do under the sources, by the cascade of all walls and fluids (:mod:`coaxshell.solver.cascade`).

A wall is read at its reference surface (W, V, and the hoop stress at its design depth) and at its faces (what the fluids feel); the loads
on the faces give everything within it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from coaxshell.acoustics.basis import Modes
from coaxshell.numerics.arrays import ComplexArray
from coaxshell.numerics.blas_threads import one_blas_thread
from coaxshell.numerics.laplace_grid import ROLL_OFF, LaplaceGrid
from coaxshell.numerics.progress import Progress
from coaxshell.solver.cascade import CascadeSystem, FaceMotion
from coaxshell.solver.excitation import SurfaceLoads
from coaxshell.solver.scaling import Problem, Surface
from coaxshell.solver.spectral import map_node_blocks, node_blocks
from coaxshell.structure.elastic_wall import ElasticWall
from coaxshell.structure.electroded_wall import slid_of
from coaxshell.structure.shell_model import FaceReceptance, ShellModel, WallOperator
from coaxshell.structure.solid_ports import UnderVoltage


def band(grid: LaplaceGrid) -> float:
    """Return the frequency up to which walls resolve waves in runs on a grid: where its roll-off begins, radians per transit."""
    return (1.0 - ROLL_OFF) * grid.nyquist


class WallAnswer(NamedTuple):
    """What one wall does, each (orders, nodes): W, V, hoop stress and potentials of its reference, 0 of thin walls, and its faces.

    Thin walls tell U besides, where there is an axial wavenumber; walls of which W and V alone are read the voltage that their law gives.
    """

    normal: ComplexArray
    tangential: ComplexArray
    hoop: ComplexArray | float
    potentials: list[ComplexArray]
    faces: FaceMotion
    axial: ComplexArray | float = 0.0
    given: ComplexArray | None = None


class FacedSystem:
    """All walls and fluids at some orders and a block of Laplace nodes, each wall read at its reference surface.

    Parameters
    ----------
    problem : Problem
    s : ndarray, shape (nodes,)
    modes : Modes
    some : slice, optional
        What of each wall is read: all, or :data:`MOTION` alone.
    """

    def __init__(self, problem: Problem, s: ComplexArray, modes: Modes, some: slice = slice(None)) -> None:
        self._problem, self._s, self._modes, self._some = problem, s, modes, some
        ports = [port(wall, modes, s, some) for wall in problem.shells]
        self.cascade = CascadeSystem(problem, s, modes, walls=[receptance for receptance, _ in ports])
        self.radial = self.cascade.radial
        self._reading: list[ComplexArray | WallOperator] = [reading for _, reading in ports]
        self._volts: dict[int, UnderVoltage] = {}

    def under_sources(self, load: ComplexArray) -> list[WallAnswer]:
        """Return what all walls do under a pressure on the surface that the exterior fluid wets."""
        return [read(reading, faces, self._some) for reading, faces in zip(self._reading, self.cascade.solve_outside(load), strict=True)]

    def under_force(self, surface: Surface, load: ComplexArray | float) -> list[WallAnswer]:
        """Return what all walls do under an inward pressure on one surface of a wall."""
        return self.under_forces([(surface, load)])

    def under_forces(self, loads: Sequence[tuple[Surface, ComplexArray | float]]) -> list[WallAnswer]:
        """Return what all walls do under inward pressures on several surfaces, read once."""
        return self._together([self.cascade.solve(surface.shell, load, surface.side) for surface, load in loads])

    def ratio(self, shell: int) -> ComplexArray:
        """Return V/W of a wall whose faces move alike."""
        return self._thin(shell).tangential

    def _thin(self, shell: int) -> WallOperator:
        found = self._reading[shell]
        assert isinstance(found, WallOperator)
        return found

    def under_voltage(self, shell: int, volts: ComplexArray | float) -> list[WallAnswer]:
        """Return what all walls do under a voltage that is given to the actuators of one, no law asking for any."""
        return self.under_voltages([(shell, volts)])

    def under_voltages(self, voltages: Sequence[tuple[int, ComplexArray | float]]) -> list[WallAnswer]:
        """Return the same under voltages given to the actuators of several walls, read once."""
        found = self._together([self._freed(shell, volts) for shell, volts in voltages])
        for shell, volts in voltages:
            found[shell] = self._driven(shell, volts, found[shell])
        return found

    def _freed(self, shell: int, volts: ComplexArray | float) -> list[FaceMotion]:
        """Return the motion of all faces under a voltage on one wall."""
        wall = self._problem.shells[shell]
        if isinstance(wall, ElasticWall):
            given = self._given(shell, wall)
            return self.cascade.solve_free(shell, given.faces[0] * volts, given.faces[1] * volts)
        thin = self._thin(shell)
        return self.cascade.solve(shell, wall.drive(self._modes).columns.recovered(thin.tangential, thin.axial) * volts)

    def _driven(self, shell: int, volts: ComplexArray | float, own: WallAnswer) -> WallAnswer:
        """Return what a wall does with what a voltage adds to it that its faces do not tell."""
        wall = self._problem.shells[shell]
        if not isinstance(wall, ElasticWall):
            v, u = slid_of(wall, self._modes, self._s)
            return own._replace(tangential=own.tangential + v * volts, axial=own.axial + (0.0 if u is None else u) * volts)
        given = self._given(shell, wall)
        normal, tangential, hoop, *potentials = given.shown * volts
        potentials = [a + b for a, b in zip(own.potentials, [*potentials, given.heard * volts, volts], strict=True)]
        return WallAnswer(own.normal + normal, own.tangential + tangential, own.hoop + hoop, potentials, own.faces)

    def sensed(self, shell: int, answer: WallAnswer) -> ComplexArray:
        """Return what the law of a wall reads of what the wall does, V."""
        wall = self._problem.shells[shell]
        if isinstance(wall, ElasticWall):
            return answer.potentials[sensed_place(wall)]
        read = wall.sensor_gain(self._modes).columns
        return np.asarray(read.w * answer.normal + read.v * answer.tangential + (0.0 if read.u is None else read.u) * answer.axial)

    def _given(self, shell: int, wall: ElasticWall) -> UnderVoltage:
        if shell not in self._volts:
            given = wall.under_voltage(self._modes, self._s, wall.asked_of_port)
            self._volts[shell] = given._replace(shown=wall.signs_of(wall.asked_of_port)[..., 0] * given.shown)
        return self._volts[shell]

    def _together(self, each: Sequence[Sequence[FaceMotion]]) -> list[WallAnswer]:
        """Return what all walls do in several motions of their faces at once."""
        faces = [FaceMotion(*(sum(parts[1:], parts[0]) for parts in zip(*moving, strict=True))) for moving in zip(*each, strict=True)]
        return [read(reading, moving, self._some) for reading, moving in zip(self._reading, faces, strict=True)]


def read(reading: ComplexArray | WallOperator, faces: FaceMotion, some: slice = slice(None)) -> WallAnswer:
    """Return what a wall does whose faces move so; ``reading`` is some of what it shows by :func:`port`."""
    if isinstance(reading, WallOperator):
        axial = 0.0 if reading.axial is None else reading.axial * faces.outer
        return WallAnswer(faces.outer, reading.tangential * faces.outer, 0.0, [], faces, axial)
    normal, tangential, *more = reading[:, 0] * faces.load_inner + reading[:, 1] * faces.load_outer
    if some == MOTION:
        return WallAnswer(normal, tangential, 0.0, [], faces, given=more[0] if more else None)
    return WallAnswer(normal, tangential, more[0], more[1:], faces)


def sensed_place(wall: ElasticWall) -> int:
    """Return the place of what its law reads among the potentials of a wall under control."""
    place = wall.layer_number("sensor")
    assert place is not None
    return place


def port(wall: ShellModel, modes: Modes, s: ComplexArray, some: slice = slice(None)) -> tuple[FaceReceptance, ComplexArray | WallOperator]:
    """Return how a wall answers, and what it shows: per load on either face, (3 or more, 2, orders, nodes), or of one W per W.

    Of walls of solids ``some`` of that alone, if asked for; with their motion alone comes the voltage that a law of their own gives.
    """
    if not isinstance(wall, ElasticWall):
        return wall.receptance(modes, s), wall.operator(modes, s)
    return wall.two_port(modes, s, some, gives=some == MOTION and wall.gains is not None)


def reading_of(wall: ShellModel, modes: Modes, s: ComplexArray, some: slice = slice(None)) -> ComplexArray | WallOperator:
    """Return what a wall shows by :func:`port` without how it answers."""
    if not isinstance(wall, ElasticWall):
        return wall.operator(modes, s)
    return wall.reading(modes, s, some, gives=some == MOTION and wall.gains is not None)


MOTION, STRESS, POTENTIALS = slice(0, 2), slice(2, 3), slice(3, None)
"""Places of what a wall shows: W and V, the hoop stress at its design depth, and potentials."""


class Written(NamedTuple):
    """What walls show beside the motion of their references, as it has been put down (:class:`SolidSpectra`)."""

    faces: ComplexArray
    hoop: ComplexArray
    potentials: ComplexArray


class Unread:
    """What walls show beside the motion of their references, read from the loads on the faces when it is first asked for.

    Many runs never do. Voltages from without are no loads.

    Parameters
    ----------
    problem : Problem
        Its walls resolve the waves of the grid.
    grid : LaplaceGrid
    modes : Modes
    normal : ndarray, shape (shells, parities, M + 1, nodes)
        W.
    loads : ndarray, shape (2, shells, parities, M + 1, nodes)
    """

    def __init__(self, problem: Problem, grid: LaplaceGrid, modes: Modes, normal: ComplexArray, loads: ComplexArray) -> None:
        self.problem, self._grid, self._modes, self._normal, self._loads = problem, grid, modes, normal, loads

    @cached_property
    def faces(self) -> ComplexArray:
        """Displacements of the faces: w_a = sum_b H_ab r_b q_b, where they move alike W."""
        found = np.stack([self._normal, self._normal])

        def work(wall: ElasticWall, shell: int, block: slice) -> None:
            h, (inner, outer) = wall.receptance(self._modes, self._grid.nodes[block]), wall.wetted
            on_inner, on_outer = (r * q for r, q in zip((inner, outer), self._loads[:, shell, ..., block], strict=True))
            found[0, shell, ..., block] = h.inner * on_inner + h.across * on_outer
            found[1, shell, ..., block] = h.back * on_inner + h.outer * on_outer

        self._each(work, slice(0))
        return found

    @cached_property
    def hoop(self) -> ComplexArray:
        """Hoop stress at the design depths."""
        return np.asarray(self._shown(STRESS, 1)[0])

    @cached_property
    def potentials(self) -> ComplexArray:
        """Open-circuit voltages."""
        return self._shown(POTENTIALS, _layers(self.problem))

    def _shown(self, some: slice, count: int) -> ComplexArray:
        found = np.zeros((count, *self._normal.shape), np.complex128)

        def work(wall: ElasticWall, shell: int, block: slice) -> None:
            per_load = wall.reading(self._modes, self._grid.nodes[block], some)
            inner, outer = self._loads[:, shell, ..., block]
            for row, (by_inner, by_outer) in zip(found, per_load, strict=False):  # a wall may have fewer layers
                row[shell, ..., block] = by_inner * inner + by_outer * outer

        self._each(work, some)
        return found

    def _each(self, work: Callable[[ElasticWall, int, slice], None], some: slice) -> None:
        """Do the work, for which some of what walls show is read, for each wall of solids at each block of nodes."""
        make_shapes(self.problem, self._modes, self._grid.nodes, some)

        def of_block(block: slice) -> None:
            for shell, wall in enumerate(self.problem.shells):
                if isinstance(wall, ElasticWall):
                    work(wall, shell, block)

        with one_blas_thread():
            map_node_blocks(node_blocks(self._grid, self._modes.max_order), of_block, None, "motion within the walls")


@dataclass(frozen=True, eq=False)
class SolidSpectra:
    """Transforms under the sources of a structure some of whose walls have two faces.

    Attributes
    ----------
    normal, tangential : ndarray, shape (shells, parities, M + 1, nodes)
        W and V of the reference surfaces.
    loads : ndarray, shape (2, shells, parities, M + 1, nodes)
        Loads on the inner and the outer faces, positive inward.
    beside : Written or Unread
        What else walls show: it has been put down, or is read when it is first asked for.
    asked : ndarray, shape (shells, parities, M + 1, nodes), or None
        Voltages that the laws of solid walls give, where they are not among the potentials that have been put down.
    """

    normal: ComplexArray
    tangential: ComplexArray
    loads: ComplexArray
    beside: Written | Unread
    asked: ComplexArray | None = None

    @property
    def faces(self) -> ComplexArray:
        """Displacements of the inner and the outer faces, positive inward, shape (2, shells, parities, M + 1, nodes)."""
        return self.beside.faces

    @property
    def hoop(self) -> ComplexArray:
        """Hoop stress of elastic walls at their design depths, in rho_e c_e^2, shape (shells, parities, M + 1, nodes); 0 of others."""
        return self.beside.hoop

    @property
    def potentials(self) -> ComplexArray:
        """Open-circuit voltages of the piezoelectric layers of elastic walls, V, from the inside out; 0 of walls with fewer.

        Shape (layers, shells, parities, M + 1, nodes).
        """
        return self.beside.potentials

    def voltage(self, shell: int, wall: ElasticWall) -> ComplexArray:
        """Return the voltage that the law of a solid wall gives, shape (parities, M + 1, nodes)."""
        return np.asarray(self.potentials[wall.shown_potentials - 1, shell] if self.asked is None else self.asked[shell])

    def put(self, parity: int, nodes: slice, answers: Sequence[WallAnswer]) -> None:
        """Put down what all walls do, in one parity at a slice of the nodes; what thin walls do not show stays 0."""
        for shell, wall in enumerate(answers):
            self.put_read(shell, parity, nodes, wall)
            for side in (0, 1):
                self.loads[side, shell, parity, :, nodes] = wall.faces[2 + side]
                if isinstance(self.beside, Written):
                    self.beside.faces[side, shell, parity, :, nodes] = wall.faces[side]

    def put_read(self, shell: int, parity: int, nodes: slice, wall: WallAnswer) -> None:
        """Put down what one wall shows of itself."""
        at = (shell, parity, slice(None), nodes)
        self.normal[at], self.tangential[at] = wall.normal, wall.tangential
        if wall.given is not None and self.asked is not None:
            self.asked[at] = wall.given
        if isinstance(wall.hoop, np.ndarray):
            self.beside.hoop[at] = wall.hoop
        for layer, potential in enumerate(wall.potentials):
            self.beside.potentials[(layer, *at)] = potential

    def plus(self, other: SolidSpectra) -> SolidSpectra:
        """Return both motions together; parities that one of them lacks are at rest there."""
        normal, tangential, loads = (_together(getattr(self, x), getattr(other, x)) for x in ("normal", "tangential", "loads"))
        beside = Written(*(_together(getattr(self, name), getattr(other, name)) for name in Written._fields))
        return SolidSpectra(normal, tangential, loads, beside)

    @property
    def layers(self) -> int:
        """How many potentials there are."""
        return len(self.beside.potentials) if isinstance(self.beside, Written) else _layers(self.beside.problem)

    @property
    def nbytes(self) -> int:
        """Bytes beside W and V, of all that may be read."""
        return 2 * self.loads.nbytes + (1 + self.layers) * self.normal.nbytes + (0 if self.asked is None else self.asked.nbytes)


def _together(a: ComplexArray, b: ComplexArray) -> ComplexArray:
    """Return the sum of two spectra (..., parities, orders, nodes), of which one may have one parity only."""
    more, fewer = (a, b) if a.shape[-3] >= b.shape[-3] else (b, a)
    total = more.copy()
    total[..., : fewer.shape[-3], :, :] += fewer
    return total


class FacedMotion(NamedTuple):
    """Transforms of the displacements of the faces and the loads on them, each (2, shells, parities, orders, nodes)."""

    faces: ComplexArray
    loads: ComplexArray


def _layers(problem: Problem) -> int:
    """Return how many potentials the wall that shows most has."""
    return max(wall.shown_potentials for wall in problem.shells if isinstance(wall, ElasticWall))


def nothing_moves(problem: Problem, parities: int, orders: int, nodes: int) -> SolidSpectra:
    """Return transforms of walls at rest, of a structure some of whose walls have two faces."""
    shape = (len(problem.shells), parities, orders, nodes)
    layers = _layers(problem)
    normal, tangential, hoop = (np.zeros(shape, np.complex128) for _ in range(3))  # apart: memory is had again by what is not too large
    faces, loads = (np.zeros((2, *shape), np.complex128) for _ in range(2))
    return SolidSpectra(normal, tangential, loads, Written(faces, hoop, np.zeros((layers, *shape), np.complex128)))


def room_for(problem: Problem, grid: LaplaceGrid, modes: Modes, loads: ComplexArray) -> tuple[SolidSpectra, slice]:
    """Return where to put all that walls do under loads on their faces, known or to be put there too, and what of it is read now.

    W and V, and the voltages that laws give; all but the motion of the faces where voltages come from without, in loops that the solver
    closes.
    """
    normal, tangential = (np.empty(loads.shape[1:], np.complex128) for _ in range(2))
    beside = Unread(problem, grid, modes, normal, loads)
    controlled = [wall for wall in problem.shells if wall.shows_control and isinstance(wall, ElasticWall)]
    if all(wall.gains is not None and not wall.closed_by_solver for wall in controlled):
        return SolidSpectra(normal, tangential, loads, beside, np.zeros_like(normal) if controlled else None), MOTION
    vars(beside).update(hoop=np.zeros_like(normal), potentials=np.zeros((_layers(problem), *normal.shape), np.complex128))
    return SolidSpectra(normal, tangential, loads, beside), slice(None)


def make_shapes(problem: Problem, modes: Modes, s: ComplexArray, some: slice = slice(None)) -> None:
    """Make what all blocks of nodes share of walls with two faces, of which ``some`` is read, before all threads ask for it."""
    for wall in problem.shells:
        if isinstance(wall, ElasticWall):
            port(wall, modes, s[:1], some)


def solid_spectra(problem: Problem, grid: LaplaceGrid, modes: Modes, loads: SurfaceLoads, progress: Progress | None = None) -> SolidSpectra:
    """Return all transforms of a structure under the loads of its sources.

    Parameters
    ----------
    problem : Problem
    grid : LaplaceGrid
    modes : Modes
    loads : SurfaceLoads
    progress : callable, optional
    """
    shape = (2, len(problem.shells), loads.parities, modes.count, grid.nodes.size)
    found, read_now = room_for(problem, grid, modes, np.empty(shape, np.complex128))
    make_shapes(problem, modes, grid.nodes, read_now)

    def work(block: slice) -> None:
        system = FacedSystem(problem, grid.nodes[block], modes, read_now)
        for parity, load in enumerate(loads(system.radial, block)):
            found.put(parity, block, system.under_sources(load))

    with one_blas_thread():  # small products on all threads
        map_node_blocks(node_blocks(grid, modes.max_order), work, progress, "frequencies")
    return found
