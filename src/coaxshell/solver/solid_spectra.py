"""Transforms of what walls with two faces do under the sources, by the cascade of all walls and fluids (:mod:`coaxshell.solver.cascade`).

A wall is read at its reference surface (W, V, and the hoop stress at its design depth) and at its faces (what the fluids feel); the loads
on the faces give everything within it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
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
from coaxshell.solver.shared_parts import SharedParts
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

    Thin walls tell U besides, where there is an axial wavenumber.
    """

    normal: ComplexArray
    tangential: ComplexArray
    hoop: ComplexArray | float
    potentials: list[ComplexArray]
    faces: FaceMotion
    axial: ComplexArray | float = 0.0


class FacedSystem:
    """All walls and fluids at some orders and a block of Laplace nodes, each wall read at its reference surface.

    Parameters
    ----------
    problem : Problem
    s : ndarray, shape (nodes,)
    modes : Modes
    """

    def __init__(self, problem: Problem, s: ComplexArray, modes: Modes) -> None:
        self._problem, self._s, self._modes = problem, s, modes
        ports = [_port(wall, modes, s) for wall in problem.shells]
        self.cascade = CascadeSystem(problem, s, modes, walls=[receptance for receptance, _ in ports])
        self.radial = self.cascade.radial
        self._reading: list[ComplexArray | WallOperator] = [reading for _, reading in ports]
        self._volts: dict[int, UnderVoltage] = {}

    def under_sources(self, load: ComplexArray) -> list[WallAnswer]:
        """Return what all walls do under a pressure on the surface that the exterior fluid wets."""
        return [self._answer(reading, faces) for reading, faces in zip(self._reading, self.cascade.solve_outside(load), strict=True)]

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
        return [self._answer(reading, moving) for reading, moving in zip(self._reading, faces, strict=True)]

    def _answer(self, reading: ComplexArray | WallOperator, faces: FaceMotion) -> WallAnswer:
        if isinstance(reading, WallOperator):
            axial = 0.0 if reading.axial is None else reading.axial * faces.outer
            return WallAnswer(faces.outer, reading.tangential * faces.outer, 0.0, [], faces, axial)
        normal, tangential, hoop, *potentials = reading[:, 0] * faces.load_inner + reading[:, 1] * faces.load_outer
        return WallAnswer(normal, tangential, hoop, potentials, faces)


def sensed_place(wall: ElasticWall) -> int:
    """Return the place of what its law reads among the potentials of a wall under control."""
    place = wall.layer_number("sensor")
    assert place is not None
    return place


def _port(wall: ShellModel, modes: Modes, s: ComplexArray) -> tuple[FaceReceptance, ComplexArray | WallOperator]:
    """Return how a wall answers, and what it shows: per load on either face, (3 or more, 2, orders, nodes), or of one W per W."""
    return wall.two_port(modes, s) if isinstance(wall, ElasticWall) else (wall.receptance(modes, s), wall.operator(modes, s))


@dataclass(frozen=True, eq=False)
class SolidSpectra:
    """Transforms under the sources of a structure some of whose walls have two faces.

    Attributes
    ----------
    normal, tangential : ndarray, shape (shells, parities, M + 1, nodes)
        W and V of the reference surfaces.
    hoop : ndarray, same shape
        Hoop stress of elastic walls at their design depths, in rho_e c_e^2; 0 of others.
    faces, loads : ndarray, shape (2, shells, parities, M + 1, nodes)
        Displacements of the inner and the outer faces and the loads on them, positive inward.
    potentials : ndarray, shape (layers, shells, parities, M + 1, nodes)
        Open-circuit voltages of the piezoelectric layers of elastic walls, V, from the inside out; 0 of walls with fewer.
    """

    normal: ComplexArray
    tangential: ComplexArray
    hoop: ComplexArray
    faces: ComplexArray
    loads: ComplexArray
    potentials: ComplexArray

    def put(self, parity: int, nodes: slice, answers: Sequence[WallAnswer]) -> None:
        """Put down what all walls do, in one parity at a slice of the nodes; what thin walls do not show stays 0."""
        for shell, wall in enumerate(answers):
            at = (shell, parity, slice(None), nodes)
            self.normal[at], self.tangential[at] = wall.normal, wall.tangential
            if isinstance(wall.hoop, np.ndarray):
                self.hoop[at] = wall.hoop
            for layer, potential in enumerate(wall.potentials):
                self.potentials[(layer, *at)] = potential
            for side in (0, 1):
                self.faces[(side, *at)], self.loads[(side, *at)] = wall.faces[side], wall.faces[2 + side]

    def plus(self, other: SolidSpectra) -> SolidSpectra:
        """Return both motions together; parities that one of them lacks are at rest there."""
        parts = (self.normal, self.tangential, self.hoop, self.faces, self.loads, self.potentials)
        others = (other.normal, other.tangential, other.hoop, other.faces, other.loads, other.potentials)
        return SolidSpectra(*(_together(a, b) for a, b in zip(parts, others, strict=True)))

    @property
    def nbytes(self) -> int:
        """Bytes beside W and V."""
        return self.hoop.nbytes + self.faces.nbytes + self.loads.nbytes + self.potentials.nbytes


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


def nothing_moves(problem: Problem, parities: int, orders: int, nodes: int) -> SolidSpectra:
    """Return transforms of walls at rest, of a structure some of whose walls have two faces."""
    shape = (len(problem.shells), parities, orders, nodes)
    layers = max(wall.shown_potentials for wall in problem.shells if isinstance(wall, ElasticWall))
    motion, faces, potentials = (np.zeros((n, *shape), np.complex128) for n in (3, 4, layers))
    return SolidSpectra(motion[0], motion[1], motion[2], faces[:2], faces[2:], potentials)


def make_shapes(problem: Problem, modes: Modes, s: ComplexArray) -> None:
    """Make what all blocks of nodes share of walls with two faces, before all threads ask for it."""
    for wall in problem.shells:
        if isinstance(wall, ElasticWall):
            wall.two_port(modes, s[:1])


def solid_spectra(
    problem: Problem,
    grid: LaplaceGrid,
    modes: Modes,
    shared: SharedParts | None = None,
    progress: Progress | None = None,
    returned: ComplexArray | None = None,
) -> SolidSpectra:
    """Return all transforms of a structure under its sources.

    Parameters
    ----------
    problem : Problem
    grid : LaplaceGrid
    modes : Modes
    shared : SharedParts, optional
        Where modal loads are found, or left for others.
    progress : callable, optional
    returned : ndarray, shape (parities, M + 1, nodes), optional
        Load of what the planes of the sea send back.
    """
    loads = SurfaceLoads(problem, grid, modes, shared, returned)
    found = nothing_moves(problem, loads.parities, modes.count, grid.nodes.size)
    make_shapes(problem, modes, grid.nodes)

    def work(block: slice) -> None:
        system = FacedSystem(problem, grid.nodes[block], modes)
        for parity, load in enumerate(loads(system.radial, block)):
            found.put(parity, block, system.under_sources(load))

    with one_blas_thread():  # small products on all threads
        map_node_blocks(node_blocks(grid, modes.max_order), work, progress, "frequencies")
    return found
