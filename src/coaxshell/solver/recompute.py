"""Laplace-domain amplitudes of a finished run, made again from its description and its interface forces.

A run keeps modal histories only. Whatever else is linear in the motion (velocities, pressures, energies) follows from the
transforms of W and V, which cost about as much as a bare run and need not be stored.
"""

from __future__ import annotations

from dataclasses import dataclass

from coaxshell.acoustics.bessel_ratios import ComplexArray
from coaxshell.acoustics.laplace_grid import LaplaceGrid
from coaxshell.solver.absorbers import absorber_set
from coaxshell.solver.actuation import pressure_given
from coaxshell.solver.excitation import needs_sine_half
from coaxshell.solver.linked import modal_pressure_of, solve_linked
from coaxshell.solver.prepared import PreparedStructure
from coaxshell.solver.scaling import Problem
from coaxshell.solver.solution import ModalSolution


@dataclass(frozen=True)
class SolvedSpectra:
    """Transforms of the motion of a finished run.

    Attributes
    ----------
    problem : Problem
    grid : LaplaceGrid
        Its ``time`` is the run's time axis; ``invert`` gives histories on it.
    max_order : int
    normal, tangential : ndarray, shape (shells, halves, M + 1, nodes)
        W and V.
    """

    problem: Problem
    grid: LaplaceGrid
    max_order: int
    normal: ComplexArray
    tangential: ComplexArray


def spectra_of(solution: ModalSolution) -> SolvedSpectra:
    """Return the transforms of W and V of a finished run; InputError if instants of it are missing."""
    solution.need_every_instant("what is computed from its transforms (field, energy)")
    modes = solution.settings.modes
    assert isinstance(modes, int)
    problem = solution.problem
    grid = LaplaceGrid(solution.settings.time_step, solution.time.size - 1)
    structure = PreparedStructure(problem, grid, modes)
    pressure = pressure_given(solution)
    if pressure is not None:
        structure = structure.open_loop
    if solution.absorber_force is not None:
        links = absorber_set(problem, problem.system.absorber_list, 2 if needs_sine_half(problem.system.sources) else 1)
        if links.is_linear and pressure is None:
            linked = solve_linked(structure, links)  # exact, as it was solved
            return SolvedSpectra(problem, grid, modes, linked.normal, linked.tangential)
        forces = modal_pressure_of(structure, links, solution.absorber_force)
        pressure = forces if pressure is None else forces + pressure
    if pressure is None:
        return SolvedSpectra(problem, grid, modes, structure.linear.normal, structure.linear.tangential)
    return SolvedSpectra(problem, grid, modes, *structure.forced_spectra(grid.transform_linear(pressure)))
