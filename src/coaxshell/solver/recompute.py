"""Laplace-domain amplitudes of a finished run, made again from its description and its interface forces.

A run keeps modal histories only. Whatever else is linear in the motion (velocities, pressures, energies) follows from the
transforms of W and V, which cost about as much as a bare run and need not be stored. A refined run keeps a part of its instants:
what was marched between them is marched again.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.actuation import pressure_given
from coaxshell.solver.cost import require_room
from coaxshell.solver.excitation import source_parities
from coaxshell.solver.interface.absorbers import AbsorberSet, absorber_set
from coaxshell.solver.interface.link_motion import LinkMotion, exact_motion, marched_motion
from coaxshell.solver.interface.linked import AbsorberSolution, modal_pressure_of, solve_linked
from coaxshell.solver.prepared import StructureSpectra
from coaxshell.solver.scaling import Problem
from coaxshell.solver.solution import ModalSolution


@dataclass(frozen=True)
class SolvedSpectra:
    """Transforms of the motion of a finished run.

    Attributes
    ----------
    problem : Problem
    grid : LaplaceGrid
        That on which the run was solved: its ``time`` has ``refinement`` steps to one of the run's; ``invert`` gives histories on it.
    max_order : int
    normal, tangential : ndarray, shape (shells, parities, M + 1, nodes)
        W and V.
    links : LinkMotion or None
        Histories of the absorbers, if there are any.
    actuation : ndarray, shape (shells, parities, M + 1, T), or None
        Modal pressure that saturating actuators gave, None where the linear law held throughout.
    refinement : int
        Steps of the grid to one that the run kept.
    """

    problem: Problem
    grid: LaplaceGrid
    max_order: int
    normal: ComplexArray
    tangential: ComplexArray
    links: LinkMotion | None = None
    actuation: FloatArray | None = None
    refinement: int = 1


def spectra_of(solution: ModalSolution) -> SolvedSpectra:
    """Return the transforms of W and V of a finished run; InputError if instants of it are missing."""
    solution.need_every_instant("what is computed from its transforms (field, energy)")
    modes, refinement = solution.settings.modes, solution.settings.refinement
    assert isinstance(modes, int)
    problem = solution.problem
    grid = LaplaceGrid(solution.settings.time_step / refinement, (solution.time.size - 1) * refinement)
    structure = StructureSpectra(problem, grid, modes)
    links = absorber_set(problem, problem.system.absorber_list, source_parities(problem.system.sources))
    linked = _linked(structure, links, solution)
    if linked is None:
        return SolvedSpectra(problem, grid, modes, structure.linear.normal, structure.linear.tangential, refinement=refinement)
    motion: LinkMotion | None = None
    if linked.exact is not None:
        motion = exact_motion(links, grid, *linked.exact)
    elif links.count:
        motion = marched_motion(links, grid.time_step, linked.force, linked.displacement)
    return SolvedSpectra(problem, grid, modes, linked.normal, linked.tangential, motion, linked.actuation, refinement)


def _linked(structure: StructureSpectra, links: AbsorberSet, solution: ModalSolution) -> AbsorberSolution | None:
    """Return the answer with absorbers and saturation, as it was solved or from the forces kept; None if there are neither."""
    force, displacement, actuation = solution.absorber_force, solution.absorber_displacement, pressure_given(solution)
    if actuation is None and not links.count:
        return None
    if solution.settings.refinement > 1 or (links.is_linear and actuation is None):
        require_room(structure.problem, solution.settings)  # a saved run may come from a larger machine
        return solve_linked(structure, links, saturate=actuation is not None)
    if actuation is not None:
        structure = structure.open_loop
    pressure = 0.0 if actuation is None else actuation
    if force is None or displacement is None:
        force, displacement = np.zeros((0, 2, solution.time.size)), np.zeros((0, solution.time.size))
    if links.count:
        pressure = pressure + modal_pressure_of(structure, links, force)
    normal, tangential = structure.forced_spectra(structure.grid.transform_linear(np.asarray(pressure)))
    return AbsorberSolution(normal, tangential, force, displacement, actuation, 0)
