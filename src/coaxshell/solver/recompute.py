"""Laplace-domain amplitudes of a finished run, made again from its description and its interface forces.

A run keeps modal histories only. Whatever else is linear in the motion (velocities, pressures, energies) follows from the
transforms of W and V, which cost about as much as a bare run and need not be stored. A refined run keeps a part of its instants:
what was marched between them is marched again. Of the run solved last in this process all that is needed for it stays at hand, as long as
its solution is in use.
"""

from __future__ import annotations

import weakref
from dataclasses import dataclass
from typing import Any

import numpy as np

from coaxshell.acoustics.basis import Modes
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.actuation import pressure_given
from coaxshell.solver.cost import require_room
from coaxshell.solver.excitation import source_parities
from coaxshell.solver.interface.absorbers import AbsorberSet, absorber_set
from coaxshell.solver.interface.link_motion import LinkMotion, exact_motion, marched_motion
from coaxshell.solver.interface.linked import AbsorberSolution, modal_pressure_of, solve_linked
from coaxshell.solver.scaling import Problem
from coaxshell.solver.shared_parts import ROOM
from coaxshell.solver.solution import ModalSolution
from coaxshell.solver.structure_spectra import StructureSpectra


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


@dataclass(frozen=True)
class _AtHand:
    """What the run solved last was made from, and its answer with absorbers and saturation, if it has any."""

    solution: weakref.ref[ModalSolution]
    structure: StructureSpectra
    linked: AbsorberSolution | None


_last: list[_AtHand] = []
"""None or one of them."""


def keep_at_hand(solution: ModalSolution, structure: StructureSpectra, linked: AbsorberSolution | None) -> None:
    """Keep what a run was made from until the next run, or as long as its solution is in use; nothing larger than half a gigabyte.

    The transforms made from it are those made from the description alone, bit by bit: both come from the same operations.
    """
    shells, parities, modes, _ = solution.normal.shape
    planes = 2 * shells * parities + (0 if linked is None else shells * (shells + 1))
    if 16 * planes * modes * structure.grid.nodes.size <= ROOM:
        _last[:] = [_AtHand(weakref.ref(solution, _let_go), structure, linked)]


def let_go() -> None:
    """Let go of what the last run was made from."""
    _last.clear()


def _let_go(reference: Any) -> None:
    _last[:] = [one for one in _last if one.solution is not reference]


def marches(solution: ModalSolution) -> bool:
    """Return whether forces of a run were marched: those of nonlinear absorbers or of saturated actuators."""
    system = solution.problem.system
    links = absorber_set(solution.problem, system.absorber_list, source_parities(system.sources))
    return (links.count > 0 and not links.is_linear) or pressure_given(solution) is not None


def spectra_of(solution: ModalSolution, *, continued: bool = False) -> SolvedSpectra:
    """Return the transforms of W and V of a finished run; InputError if instants of it are missing.

    Parameters
    ----------
    solution : ModalSolution
    continued : bool
        Continue the marched forces beyond the run's end by value and slope, faded by cos^2. What acts after the end moves nothing before
        it; but forces that are cut off there make the acceleration jump, and the band limit spreads half of the jump and its overshoot
        over the last instants of the run. Fields and energies are those of the forces as they were marched; the links' own motion is
        left out.
    """
    solution.need_every_instant("what is computed from its transforms (field, energy, velocity and acceleration of shells)")
    modes, refinement = solution.settings.modes, solution.settings.refinement
    assert isinstance(modes, int)
    problem = solution.problem
    grid = LaplaceGrid(solution.settings.time_step / refinement, (solution.time.size - 1) * refinement)
    known = next((one for one in _last if one.solution() is solution), None)
    structure = StructureSpectra(problem, grid, Modes.up_to(modes)) if known is None else known.structure
    links = absorber_set(problem, problem.system.absorber_list, source_parities(problem.system.sources))
    linked = _linked(structure, links, solution, None if known is None else known.linked, continued)
    if linked is None:
        return SolvedSpectra(problem, grid, modes, structure.normal, structure.tangential, refinement=refinement)
    motion: LinkMotion | None = None
    if linked.exact is not None:
        motion = exact_motion(links, grid, *linked.exact)
    elif links.count and not continued:
        motion = marched_motion(links, grid.time_step, linked.force, linked.displacement)
    return SolvedSpectra(problem, grid, modes, linked.normal, linked.tangential, motion, linked.actuation, refinement)


def _linked(
    structure: StructureSpectra, links: AbsorberSet, solution: ModalSolution, solved: AbsorberSolution | None, continued: bool
) -> AbsorberSolution | None:
    """Return the answer with absorbers and saturation, as it was solved or from the forces kept; None if there are neither."""
    force, displacement, actuation = solution.absorber_force, solution.absorber_displacement, pressure_given(solution)
    if actuation is None and not links.count:
        return None
    if solution.settings.refinement > 1 or (links.is_linear and actuation is None):
        if solved is None:
            require_room(structure.problem, solution.settings)  # a saved run may come from a larger machine
            solved = solve_linked(structure, links, saturate=actuation is not None)
        if solved.exact is not None or not continued:
            return solved
        force, displacement, actuation = solved.force, solved.displacement, solved.actuation
    if actuation is not None:
        structure = structure.open_loop
    pressure = np.asarray(0.0 if actuation is None else actuation)
    if force is None or displacement is None:
        force, displacement = np.zeros((0, 2, solution.time.size)), np.zeros((0, solution.time.size))
    if links.count:
        pressure = pressure + modal_pressure_of(structure, links, force)
    spectrum = structure.grid.transform_linear(pressure)
    if continued:
        value, slope = _beyond_end(structure.grid)
        rate = 3.0 * pressure[..., -1:] - 4.0 * pressure[..., -2:-1] + pressure[..., -3:-2]
        spectrum += pressure[..., -1:] * value + rate / (2.0 * structure.grid.time_step) * slope
    normal, tangential = structure.forced_spectra(spectrum)
    return AbsorberSolution(normal, tangential, force, displacement, actuation, 0)


def _beyond_end(grid: LaplaceGrid) -> tuple[ComplexArray, ComplexArray]:
    """Return the transforms of 1 and t - T after the last instant T, each faded over half a run and linear between the steps."""
    count = max(1, min(grid.samples - grid.time.size, grid.steps // 2))
    later = np.arange(1, count + 1)
    fade = np.cos(0.5 * np.pi * later / (count + 1)) ** 2
    samples = np.zeros((2, grid.samples))
    samples[:, grid.steps + later] = fade * np.stack([np.ones(count), grid.time_step * later])
    samples *= grid.time_step * np.exp(-grid.shift * grid.time_step * np.arange(grid.samples))
    value, slope = grid.hat * np.fft.rfft(samples, axis=-1)
    return value, slope
