"""One verb: solve a system at a resolution. Its structure is prepared first, so that many absorber sets can share all that is linear."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from coaxshell.acoustics.basis import Modes
from coaxshell.errors import InputError
from coaxshell.model.feedback import Feedback
from coaxshell.model.gains import limits_voltages, saturates
from coaxshell.model.parts import laws_of
from coaxshell.model.system import System
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.finite import require_finite
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.progress import Progress
from coaxshell.solver.actuation import pressure_asked, voltage_asked
from coaxshell.solver.cost import require_room
from coaxshell.solver.dimensions import require_two_dimensions
from coaxshell.solver.excitation import source_parities
from coaxshell.solver.finite import FINER, numerical_failures, require_finite_stages
from coaxshell.solver.interface.absorbers import absorber_set
from coaxshell.solver.interface.linked import solve_linked
from coaxshell.solver.judgement import judgement
from coaxshell.solver.mode_choice import resolve_modes
from coaxshell.solver.reflections import reflected
from coaxshell.solver.scaling import Problem, dimensionless
from coaxshell.solver.settings import Settings
from coaxshell.solver.shared_parts import SharedParts
from coaxshell.solver.solid_spectra import SolidSpectra
from coaxshell.solver.solution import Estimates, ModalSolution
from coaxshell.solver.spectral import Stopwatch
from coaxshell.solver.stability import require_stable
from coaxshell.solver.structure_spectra import StructureSpectra
from coaxshell.solver.tied_stability import require_stable_ties


def solve(system: System, *, settings: Settings | None = None, progress: Progress | None = None) -> ModalSolution:
    """Return the modal histories of a system.

    Parameters
    ----------
    system : System
    settings : Settings, optional
        Resolution and engine; the paper's by default.
    progress : callable, optional
        Called with the finished fraction and the name of the stage.

    Raises
    ------
    InputError
        If the engine cannot solve this system, its feedback is unstable or its absorbers cannot be marched at this step.
    """
    settings = settings or Settings()
    if settings.engine == "direct":
        from coaxshell.solver.direct.solve import solve_by_marching

        return solve_by_marching(system, settings, progress)
    problem, stopwatch = dimensionless(system, settings=settings), Stopwatch()
    return solve_prepared(prepare(problem, settings, progress, stopwatch=stopwatch), problem, settings, progress, stopwatch)


def prepare(
    problem: Problem,
    settings: Settings,
    progress: Progress | None = None,
    *,
    shared: SharedParts | None = None,
    like: StructureSpectra | None = None,
    stopwatch: Stopwatch | None = None,
) -> StructureSpectra:
    """Return the spectra of a problem's structure, ready for any number of absorber sets; nothing of them is computed yet.

    Parameters
    ----------
    problem : Problem
    settings : Settings
        Its ``modes`` are chosen here where they are "auto".
    progress : callable, optional
    shared : SharedParts, optional
        Where parts that other structures share are found and left.
    like : StructureSpectra, optional
        Another one at the same settings, whose parts are shared where they are the same; where all are, it is returned.
    stopwatch : Stopwatch, optional

    Raises
    ------
    InputError
        If the engine is not available, the run does not fit into the memory or the feedback is unstable.
    """
    if settings.engine != "spectral":
        raise InputError("engine", f"{settings.engine!r} cannot be prepared", 'use engine="spectral"')
    require_two_dimensions(problem.system, settings)
    if like is not None and like.same_but_absorbers(problem):
        return like
    stopwatch = stopwatch or Stopwatch()
    shared = shared if like is None else like.share()
    grid = LaplaceGrid(settings.time_step / settings.refinement, settings.steps * settings.refinement)
    require_room(problem, settings, retunable=shared is not None)
    order, notes = resolve_modes(problem, grid, settings, shared)
    stopwatch.lap("choosing the number of modes")
    if settings.modes == "auto":
        require_room(problem, replace(settings, modes=order), retunable=shared is not None)
    same = like is not None and like.same_structure(problem) and like.modes.max_order == order
    if not same:
        if problem.tied:
            require_stable_ties(problem, order, settings.duration)
        else:
            require_stable(problem, order, settings.duration, shared)
        stopwatch.lap("stability of the feedback")
    units = like.units if like is not None and same else None
    return StructureSpectra(problem, grid, Modes.up_to(order), progress, shared=shared, units=units, notes=tuple(notes))


def solve_prepared(
    structure: StructureSpectra, problem: Problem, settings: Settings, progress: Progress | None = None, stopwatch: Stopwatch | None = None
) -> ModalSolution:
    """Return the modal histories of a problem that differs from a prepared structure's at most in its absorbers.

    Parameters
    ----------
    structure : StructureSpectra
    problem : Problem
    settings : Settings
        Those that the structure was prepared at.
    progress : callable, optional
    stopwatch : Stopwatch, optional
        What it has measured already counts too.

    Raises
    ------
    InputError
        If an absorber does not fit the system, or two dimensions, or the force law cannot be marched at this step.
    """
    require_two_dimensions(problem.system, settings)
    with numerical_failures(structure.grid):
        return _solved(structure, problem, settings, progress, stopwatch or Stopwatch())


def _solved(
    structure: StructureSpectra, problem: Problem, asked_for: Settings, progress: Progress | None, stopwatch: Stopwatch
) -> ModalSolution:
    settings = replace(asked_for, modes=structure.modes.max_order)
    system, grid, keep = problem.system, structure.grid, slice(None, None, settings.refinement)
    links = absorber_set(problem, system.absorber_list, source_parities(problem))
    saturate = saturates(system) and not limits_voltages(system)
    bare = saturates(system) or problem.tied
    (structure.open_loop if bare else structure).solve(units=links.count > 0 or (bare and not problem.two_faced))
    stopwatch.lap("modal system at all Laplace nodes")
    solved = reflected(structure, lambda one: solve_linked(one, links, progress, saturate=saturate), progress)
    structure = solved.structure
    if links.count or saturates(system):
        stopwatch.lap("absorbers and saturation")
    require_finite_stages(solved)
    w, v = (grid.invert(x)[..., keep] for x in (solved.normal, solved.tangential))
    correction = np.zeros_like(w) if saturate else None
    w_rate = v_rate = asked = voltage = None
    by_order = not any(isinstance(law, Feedback) for law in laws_of(system)) and not problem.two_faced and solved.voltage is None
    if laws_of(system) and not by_order:
        voltage = grid.invert(voltage_asked(solved))[..., keep]
    elif any(shell.gains is not None for shell in problem.shells):
        w_rate, v_rate = (grid.invert(x * grid.nodes)[..., keep] for x in (solved.normal, solved.tangential))
        if saturate:
            asked = pressure_asked(problem, w, v, w_rate, v_rate)
            correction = correction if solved.actuation is None else solved.actuation[..., keep] - asked
    stopwatch.lap("inverse transform")
    solution = ModalSolution(
        problem,
        settings,
        grid.time[keep],
        w,
        v,
        Estimates.unknown(len(problem.shells)),
        timings=stopwatch.seconds,
        normal_rate=w_rate,
        tangential_rate=v_rate,
        absorber_displacement=solved.displacement[:, keep] if links.count else None,
        absorber_force=solved.force[..., keep] if links.count else None,
        control_correction=correction,
        control_voltage=voltage,
        segment_voltage=None if solved.segments is None else solved.segments[..., keep],
    )
    solution.keep(solved)
    if solved.solid is not None:
        for name in ("hoop", "potentials") if solved.solid.layers else ("hoop",):
            solution.make_when_read(name, partial(_of_solids, solved.solid, name, grid, keep))
    solution.judge_when_read(partial(judgement, solved=solved, asked_for=asked_for, asked=asked, progress=progress))
    return solution


def _of_solids(solid: SolidSpectra, name: str, grid: LaplaceGrid, keep: slice) -> FloatArray:
    """Return the histories of what walls of solids show beside their motion, at the instants that are kept."""
    found = grid.invert(getattr(solid, name))[..., keep]
    require_finite(found, name, remedy=FINER)
    return found
