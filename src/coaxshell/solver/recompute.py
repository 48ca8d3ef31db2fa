"""The transforms of a finished run: those that it was solved with, or made again from its description and its interface forces.

A run keeps modal histories only. Whatever else is linear in the motion (velocities, pressures, energies) follows from the
transforms of W and V, which cost about as much as a bare run and need not be stored. A refined run keeps a part of its instants:
what was marched between them is marched again. A solution that is still in the process that solved it has it all at hand
(:attr:`coaxshell.solver.solution.ModalSolution.spectra`); the transforms are the same, bit by bit: both come from the same operations.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from coaxshell.acoustics.basis import Modes
from coaxshell.model.gains import limits_voltages
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.actuation import pressure_given, saturated
from coaxshell.solver.cost import require_room
from coaxshell.solver.excitation import source_parities
from coaxshell.solver.interface.absorbers import AbsorberSet, InterfacePoints, absorber_set
from coaxshell.solver.interface.linked import modal_pressure_of, solve_linked
from coaxshell.solver.links.histories import LawHistories, middles_transform
from coaxshell.solver.reflections import reflected
from coaxshell.solver.solution import ModalSolution
from coaxshell.solver.solved_spectra import SolvedSpectra
from coaxshell.solver.structure_spectra import StructureSpectra
from coaxshell.solver.tied import under_forces


def marches(solution: ModalSolution) -> bool:
    """Return whether forces of a run were marched: those of nonlinear absorbers or of saturated actuators."""
    return not _links(solution).is_linear or saturated(solution)


def spectra_of(solution: ModalSolution, *, continued: bool = False) -> SolvedSpectra:
    """Return the transforms of W and V of a finished run; InputError if instants of it are missing.

    Parameters
    ----------
    solution : ModalSolution
    continued : bool
        Continue the marched forces beyond the run's end by value and slope, faded by cos^2. What acts after the end moves nothing before
        it; but forces that are cut off there make the acceleration jump, and the band limit spreads half of the jump and its overshoot
        over the last instants of the run. Fields and energies are those of the forces as they were marched.
    """
    solution.need_every_instant("what is computed from its transforms (field, energy, velocity and acceleration of shells)")
    kept, refinement = solution.spectra, solution.settings.refinement
    structure = _structure(solution) if kept is None else kept.structure
    links, actuation = _links(solution), pressure_given(solution)
    limited = limits_voltages(structure.problem.system)  # forces and voltages depend on each other: both again
    if not limited and refinement == 1 and (actuation is not None or not links.is_linear) and not links.of_any_law:
        force, displacement = solution.absorber_force, solution.absorber_displacement
        if force is None or displacement is None:
            force, displacement = np.zeros((0, 2, solution.time.size)), np.zeros((0, solution.time.size))
        acted = partial(_of_forces, links=links, force=force, displacement=displacement, actuation=actuation, continued=continued)
        return acted(structure) if kept is not None else reflected(structure, acted)
    if kept is None:
        if links.count or actuation is not None:
            require_room(structure.problem, solution.settings)  # a saved run may come from a larger machine
        kept = reflected(structure, lambda one: solve_linked(one, links, saturate=actuation is not None))
    if continued and kept.marched and kept.asked is None and (kept.voltage is None or links.count):
        return _of_forces(kept.structure, links, kept.force, kept.displacement, kept.actuation, continued, kept.laws)
    return kept


def _structure(solution: ModalSolution) -> StructureSpectra:
    settings, modes = solution.settings, solution.settings.modes
    assert isinstance(modes, int)
    grid = LaplaceGrid(settings.time_step / settings.refinement, (solution.time.size - 1) * settings.refinement)
    return StructureSpectra(solution.problem, grid, Modes.up_to(modes))


def _links(solution: ModalSolution) -> AbsorberSet:
    if solution.spectra is not None:
        return solution.spectra.absorbers
    system = solution.problem.system
    return absorber_set(solution.problem, system.absorber_list, source_parities(solution.problem))


def _of_forces(
    structure: StructureSpectra,
    links: AbsorberSet,
    force: FloatArray,
    displacement: FloatArray,
    actuation: FloatArray | None,
    continued: bool,
    laws: LawHistories | None = None,
) -> SolvedSpectra:
    """Return the answer to forces that were marched, the absorbers' and the actuators'."""
    grid, pressure = structure.grid, np.asarray(0.0 if actuation is None else actuation)
    if laws is not None:
        pressure = InterfacePoints(structure.problem, links, structure.modes).project(laws.force)
    elif links.count:
        pressure = pressure + modal_pressure_of(structure, links, force)
    spectrum = grid.transform_linear(pressure) if laws is None else middles_transform(grid, pressure)
    if continued:
        spectrum += grid.continuation(pressure)
    if structure.problem.tied:
        return under_forces(structure, links, spectrum, force, displacement, laws)
    moved = (structure if actuation is None else structure.open_loop).forced_spectra(spectrum)
    return SolvedSpectra(structure, links, *moved, force, displacement, actuation, laws=laws)
