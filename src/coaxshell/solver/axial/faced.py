"""Walls whose faces move differently, in one wave along the axis: the cascade (:mod:`coaxshell.solver.cascade`) at a wavenumber.

Every wall is read where stations read it, its amplitudes in the order of :data:`READ`: W, V and U, and of an elastic wall the stresses at
its design depth, 0 of others, whose stresses are made of the motion and its derivatives along the axis.

Where feedback ties walls or orders to each other a wave is that without feedback, whose driven layers answer voltages that are given to
them; :mod:`coaxshell.solver.axial.tied_faces` closes the loops.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from coaxshell.acoustics.basis import Modes
from coaxshell.numerics.arrays import ComplexArray
from coaxshell.numerics.blas_threads import one_blas_thread
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.threads import map_on_threads
from coaxshell.solver.axial.families import Family, outside_loads
from coaxshell.solver.cascade import CascadeSystem, FaceMotion
from coaxshell.solver.scaling import Problem
from coaxshell.structure.elastic_wall import ElasticWall
from coaxshell.structure.electroded_wall import slid_of
from coaxshell.structure.shell_model import SOLID_STRESSES, FaceReceptance, Gain, ShellModel, WallOperator
from coaxshell.structure.solid_ports import DrivenPort

READ = ("w", "v", "u", *SOLID_STRESSES)
"""What a wall is read for, before the potentials of its piezoelectric layers."""


class FacedWave:
    """All walls and fluids at some modes and a block of Laplace nodes.

    Parameters
    ----------
    problem : Problem
    s : ndarray, shape (nodes,)
    modes : Modes
        Of a real wavenumber.
    reads : bool
        Whether elastic walls are read, or their faces alone.
    opened : bool
        Whether all walls are without feedback, and the solver closes the loop of each.
    """

    def __init__(self, problem: Problem, s: ComplexArray, modes: Modes, *, reads: bool = True, opened: bool = False) -> None:
        self.problem, self.modes, self.s = problem, modes, s
        self._readings: list[ComplexArray | WallOperator] = []
        self._driven: dict[int, DrivenPort] = {}
        receptances = []
        for i, wall in enumerate(problem.shells):
            if isinstance(wall, ElasticWall):
                if wall.closed_by_solver or (opened and wall.gains is not None):
                    receptance, reading, self._driven[i] = wall.driven_port(modes, s, reads=reads)
                else:
                    receptance, reading = wall.station_port(modes, s, reads=reads)
                self._readings.append(reading)
            else:
                operator = wall.passive(modes, s) if opened else wall.operator(modes, s)
                self._readings.append(operator)
                receptance = _alike(wall, operator) if wall.moves else wall.receptance(modes, s)
            receptances.append(receptance)
        self.cascade = CascadeSystem(problem, s, modes, walls=receptances)

    def faces(self, family: Family, grid: LaplaceGrid, block: slice) -> list[list[FaceMotion]]:
        """Return what the faces of all walls do under the sources or the forces of a family, for each parity around."""
        on_outermost = outside_loads(family, self.cascade.radial, grid, block)
        forces = {} if family.forces is None else family.forces.loads(self.problem, self.modes, odd=family.odd_forces)
        found = []
        for parity in range(family.parities):
            each = [self.cascade.solve_outside(on_outermost[parity])] if on_outermost else []
            each += [self.under_pressure(surface, pressures[parity]) for surface, pressures in forces.items()]
            found.append(each[0] if len(each) == 1 else [_together(moving) for moving in zip(*each, strict=True)])
        return found

    def under_pressure(self, surface: int, load: ComplexArray | float) -> list[FaceMotion]:
        """Return what the faces of all walls do under an inward pressure on one of the surfaces on which links act, by its number."""
        shell, side, _ = self.problem.surfaces[surface]
        return self.cascade.solve(shell, load, side)

    def under_voltage(self, shell: int) -> list[FaceMotion]:
        """Return what the faces of all walls do under a volt that is given to the actuators of one."""
        if shell in self._driven:
            return self.cascade.solve_free(shell, *self._driven[shell].given.faces)
        operator = self._operator(shell)
        load = self.problem.shells[shell].drive(self.modes).columns.recovered(operator.tangential, operator.axial)
        return self.cascade.solve(shell, load)

    def sensed(self, shell: int, moving: FaceMotion, volts: float = 0.0, reading: Gain | None = None) -> ComplexArray:
        """Return what the law of a wall reads of its motion, V, under a voltage of its own, or of a thin one another *reading*."""
        if shell in self._driven:
            driven = self._driven[shell]
            by_loads = driven.sensed[0] * moving.load_inner + driven.sensed[1] * moving.load_outer
            return np.asarray(by_loads + driven.given.heard * volts)
        wall, operator = self.problem.shells[shell], self._operator(shell)
        gain, (v, u) = (wall.sensor_gain(self.modes) if reading is None else reading).columns, slid_of(wall, self.modes, self.s)
        slid = gain.v * v + (0.0 if gain.u is None or u is None else gain.u * u)
        return np.asarray(gain.recovered(operator.tangential, operator.axial) * moving.outer + slid * volts)

    def _operator(self, shell: int) -> WallOperator:
        found = self._readings[shell]
        assert isinstance(found, WallOperator)
        return found

    def read(self, faces: list[FaceMotion], layers: int, voltage: ComplexArray | None = None) -> ComplexArray:
        """Return what all walls are read for, (9 + layers, shells, orders, nodes), from the motion of their faces and the loads on them.

        ``voltage`` is what is given to the actuators of all walls, V, (shells, orders, nodes), where the solver closes their loops.
        """
        found = np.zeros((len(READ) + layers, len(faces), *faces[0].outer.shape), np.complex128)
        for i, (reading, moving) in enumerate(zip(self._readings, faces, strict=True)):
            if isinstance(reading, WallOperator):
                self._read_thin(found[:, i], self.problem.shells[i], reading, moving.outer, None if voltage is None else voltage[i])
            else:
                count = min(len(reading), len(found))
                np.multiply(reading[:count, 0], moving.load_inner, out=found[:count, i])
                found[:count, i] += reading[:count, 1] * moving.load_outer
                if voltage is not None and i in self._driven:
                    self._add_given(found[:, i], self._driven[i], voltage[i])
        return found

    def _add_given(self, found: ComplexArray, driven: DrivenPort, volts: ComplexArray) -> None:
        """Add what a voltage makes an elastic wall show, and that itself after what the law reads."""
        shown = driven.given.shown
        for row, each in zip(found, (*shown, driven.given.heard, 1.0), strict=False):
            row += each * volts

    def _read_thin(
        self, found: ComplexArray, wall: ShellModel, operator: WallOperator, w: ComplexArray, volts: ComplexArray | None
    ) -> None:
        v = operator.tangential * w
        u = np.zeros_like(w) if operator.axial is None else operator.axial * w
        if volts is not None and wall.gains is not None:
            slid, along = slid_of(wall, self.modes, self.s)
            v, u = v + slid * volts, u + (0.0 if along is None else along * volts)
        found[:3] = w, v, u
        for number, per in enumerate(wall.shown_voltages(self.modes, self.s)[: len(found) - len(READ)]):
            found[len(READ) + number] = per.v * v + per.w * w + (0.0 if per.u is None else per.u * u)
        if volts is not None and wall.shows_control and len(found) > len(READ):
            found[len(READ) + wall.shown_potentials - 1] = volts


def _together(moving: tuple[FaceMotion, ...]) -> FaceMotion:
    """Return the sum of several motions of one wall."""
    return FaceMotion(*(np.sum(parts, axis=0) for parts in zip(*moving, strict=True)))


def _alike(wall: ShellModel, operator: WallOperator) -> FaceReceptance:
    """Return the receptance of a wall with one W."""
    both = np.reciprocal(wall.radius * operator.impedance)
    return FaceReceptance(both, both, both, operator.impedance)


def make_shapes(problem: Problem, modes: Sequence[Modes]) -> None:
    """Make what all blocks of nodes share of elastic walls, on all threads: once, as long as these modes are in use."""
    solids = [wall for wall in problem.shells if isinstance(wall, ElasticWall)]
    pairs = [(wall, one) for one in modes for wall in solids]
    if pairs:
        with one_blas_thread():  # many small matrices
            list(map_on_threads(lambda pair: pair[0].prepare_stations(pair[1]), pairs))
