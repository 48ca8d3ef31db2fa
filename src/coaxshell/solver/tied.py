"""Feedback that ties walls or orders to each other: what its answer is in orders and on the segments, beside absorbers or alone.

Without absorbers the loops are closed at every node. With them the electrodes' voltages are those of the loops whatever the links do:
the points that these hold move by R f under their forces f,

    R = R_0 + B (1 - H K C)^-1 H K A,

R_0 of the walls without feedback, A what the patterns read per force and B how the points move per volt of a pattern
(:mod:`coaxshell.solver.tied_points`). Linear links are solved with R at the nodes, all others marched with the kernels that R has.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from coaxshell.errors import InputError
from coaxshell.model.gains import segments_of
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.progress import Progress
from coaxshell.solver.electrode_loops import ElectrodeLoops
from coaxshell.solver.electrode_patterns import Patterns, patterns_of
from coaxshell.solver.faced_voltages import moved_by_voltages
from coaxshell.solver.interface.absorbers import AbsorberSet, InterfacePoints
from coaxshell.solver.interface.linear import forces_at
from coaxshell.solver.interface.march import MarchResult
from coaxshell.solver.links.any_law import march_interface
from coaxshell.solver.links.histories import LawHistories, middles_transform
from coaxshell.solver.scaling import Problem
from coaxshell.solver.solved_spectra import SolvedSpectra
from coaxshell.solver.structure_spectra import Moved, StructureSpectra
from coaxshell.solver.tied_points import StructureOfTies, surfaces_moved, whole_receptance
from coaxshell.solver.voltage_response import VoltageResponse, driven, of_all, read_of, response_of

_BLOCK_BYTES = 32 * 1024 * 1024
"""Of the matrices between all points, at a few nodes at a time."""


def require_resolved(problem: Problem, max_order: int) -> None:
    """Raise InputError if there are more segments than orders of a run."""
    cut = segments_of(problem.system)
    if cut is not None and cut > max_order:
        found = f"{cut} segments push on order {cut} as well, and the run ends at {max_order}"
        raise InputError("control.segments", found, f"use modes={cut} or more, or at most {max_order} segments")


@dataclass(frozen=True, eq=False)
class TiedLoops:
    """The loops of a structure at the nodes of a run.

    Attributes
    ----------
    structure : StructureSpectra
    response : VoltageResponse
    patterns : Patterns
    loops : ElectrodeLoops
    """

    structure: StructureSpectra
    response: VoltageResponse
    patterns: Patterns
    loops: ElectrodeLoops

    @classmethod
    def of(cls, structure: StructureSpectra, parities: int = 1) -> TiedLoops:
        """Return the loops under the sources and under forces of so many parities."""
        response, parities = response_of(structure), max(parities, structure.open_loop.normal.shape[1])
        patterns = patterns_of(structure.problem, response.shells, structure.modes.orders, parities)
        return cls(structure, response, patterns, ElectrodeLoops.of(structure.problem, response, patterns, structure.grid.nodes))

    def answer(self, pressure: ComplexArray | None = None) -> tuple[Moved, ComplexArray, ComplexArray]:
        """Return motion, voltages in orders and those of patterns, under the sources and pressures (shells, parities, M + 1, nodes)."""
        bare = self.structure.open_loop
        free = Moved(bare.normal, bare.tangential, bare.solid) if pressure is None else bare.forced_spectra(pressure)
        found = self.loops.voltages(self.patterns.readings(read_of(self.structure, free)))
        voltage: ComplexArray = of_all(self.structure.problem, self.response, self.patterns.in_orders(found))
        return self.moved(free, voltage, pressure), voltage, found

    def moved(self, free: Moved, voltage: ComplexArray, pressure: ComplexArray | None) -> Moved:
        """Return the motion without voltages, *free*, and that by voltages in orders together."""
        if free.solid is None:
            return driven(self.structure, self.response, voltage, pressure)
        bare = self.structure.open_loop
        whole = free.solid.plus(moved_by_voltages(bare.problem, bare.grid, bare.modes, voltage))
        return Moved(whole.normal, whole.tangential, whole)

    def on_segments(self, found: ComplexArray) -> FloatArray | None:
        """Return the voltages of the segments of all shells, V, (shells, N, T), from those of patterns; None where nothing is cut."""
        if not self.patterns.cut:
            return None
        cut = np.einsum("nq,iqt->int", self.patterns.evaluate, self.structure.grid.invert(found))
        cut[:, list(self.patterns.dead)] = 0.0
        every: FloatArray = of_all(self.structure.problem, self.response, cut)
        return every


def solve_tied(
    structure: StructureSpectra, absorbers: AbsorberSet, progress: Progress | None = None, *, exact: bool | None = None
) -> SolvedSpectra:
    """Return the answer of a structure whose feedback runs from wall to wall, or from segment to segment, with its absorbers.

    ``exact`` None chooses: linear absorbers in the Laplace domain, anything nonlinear by the march.
    """
    grid, loops = structure.grid, TiedLoops.of(structure, absorbers.parities if absorbers.count else 1)
    moved, voltage, of_patterns = loops.answer()
    if not absorbers.count:
        force, displacement = np.zeros((0, 2, grid.time.size)), np.zeros((0, grid.time.size))
        segments = loops.on_segments(of_patterns)
        return SolvedSpectra(structure, absorbers, *moved, force, displacement, voltage=voltage, segments=segments)
    points = InterfacePoints(structure.problem, absorbers, structure.modes)
    if absorbers.is_linear if exact is None else exact:
        forces, masses = _linear(loops, absorbers, points, moved)
        of_every = absorbers.of_every(grid.invert(forces), grid.invert(masses))
        return replace(under_forces(structure, absorbers, points.project(forces), *of_every, loops=loops), exact=(forces, masses))
    seen = StructureOfTies(structure, absorbers, moved, loops.patterns)
    result = march_interface(seen, absorbers, progress=progress)
    spectrum = points.project(_transform(structure, result))
    of_every = absorbers.of_every(result.force, result.mass_displacement)
    found = under_forces(structure, absorbers, spectrum, *of_every, result.laws, loops)
    return replace(found, iterations=result.iterations, seen=seen)


def under_forces(
    structure: StructureSpectra,
    absorbers: AbsorberSet,
    pressure: ComplexArray,
    force: FloatArray,
    displacement: FloatArray,
    laws: LawHistories | None = None,
    loops: TiedLoops | None = None,
) -> SolvedSpectra:
    """Return the answer to the sources and to modal pressures of absorbers, (shells, parities, M + 1, nodes), whose histories are given."""
    loops = loops or TiedLoops.of(structure, pressure.shape[1])
    moved, voltage, found = loops.answer(pressure)
    segments = loops.on_segments(found)
    return SolvedSpectra(structure, absorbers, *moved, force, displacement, laws=laws, voltage=voltage, segments=segments)


def _transform(structure: StructureSpectra, result: MarchResult) -> ComplexArray:
    grid = structure.grid
    return grid.transform_linear(result.force) if result.laws is None else middles_transform(grid, result.laws.force)


def _linear(loops: TiedLoops, absorbers: AbsorberSet, points: InterfacePoints, alone: Moved) -> tuple[ComplexArray, ComplexArray]:
    """Return the transforms of the forces and of the masses' displacements of linear absorbers, exact up to the modal truncation."""
    bare, nodes = loops.structure.open_loop, loops.structure.grid.nodes
    excited = points.evaluate(surfaces_moved(bare.problem, alone))
    force, mass = np.empty_like(excited), np.empty_like(excited[: absorbers.count])
    whole = whole_receptance(loops.structure, points, loops.patterns)
    width = max(4, _BLOCK_BYTES // (16 * points.count**2))
    for start in range(0, nodes.size, width):
        some = slice(start, start + width)
        receptance = np.moveaxis(whole[..., some], -1, 0)
        force[:, some], mass[:, some] = forces_at(absorbers, nodes[some], receptance, excited[:, some])
    return force, mass
