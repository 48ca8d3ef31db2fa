"""Feedback that ties walls or orders to each other: what its answer is in orders and on the segments of electrodes."""

from __future__ import annotations

import numpy as np

from coaxshell.errors import InputError
from coaxshell.model.gains import segments_of
from coaxshell.numerics.arrays import ComplexArray
from coaxshell.solver.electrode_loops import ElectrodeLoops
from coaxshell.solver.electrode_patterns import patterns_of
from coaxshell.solver.interface.absorbers import AbsorberSet
from coaxshell.solver.scaling import Problem
from coaxshell.solver.solved_spectra import SolvedSpectra
from coaxshell.solver.structure_spectra import StructureSpectra
from coaxshell.solver.voltage_response import driven, of_all, read_without, response_of


def require_resolved(problem: Problem, max_order: int) -> None:
    """Raise InputError if there are more segments than orders of a run."""
    cut = segments_of(problem.system)
    if cut is not None and cut > max_order:
        found = f"{cut} segments push on order {cut} as well, and the run ends at {max_order}"
        raise InputError("control.segments", found, f"use modes={cut} or more, or at most {max_order} segments")


def solve_tied(structure: StructureSpectra, absorbers: AbsorberSet) -> SolvedSpectra:
    """Return the answer of a structure whose feedback runs from wall to wall, or from segment to segment."""
    problem, grid = structure.problem, structure.grid
    response, without = response_of(structure), read_without(structure)
    patterns = patterns_of(problem, response.shells, structure.modes.orders, without.shape[1])
    found = ElectrodeLoops.of(problem, response, patterns, grid.nodes).voltages(patterns.readings(without))
    segments = None
    if patterns.cut:
        volts = np.einsum("nq,iqt->int", patterns.evaluate, grid.invert(found))
        volts[:, list(patterns.dead)] = 0.0
        segments = of_all(problem, response, volts)
    voltage: ComplexArray = of_all(problem, response, patterns.in_orders(found))
    force, displacement = np.zeros((0, 2, grid.time.size)), np.zeros((0, grid.time.size))
    moved = driven(structure, response, voltage)
    return SolvedSpectra(structure, absorbers, *moved, force, displacement, voltage=voltage, segments=segments)
