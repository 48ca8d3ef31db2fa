"""How far a run of the spectral engine can be trusted: its error estimates and its physics warnings."""

from __future__ import annotations

from dataclasses import replace

from coaxshell.model.gains import saturates
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.progress import Progress
from coaxshell.solver import checks, estimates, limited_currents
from coaxshell.solver.finite import numerical_failures
from coaxshell.solver.interface.linked import interface_of
from coaxshell.solver.mode_choice import tolerance_missed
from coaxshell.solver.settings import Settings
from coaxshell.solver.solution import Judgement, ModalSolution
from coaxshell.solver.solved_spectra import SolvedSpectra
from coaxshell.solver.spectral import Stopwatch
from coaxshell.solver.tension import tensions


def judgement(
    solution: ModalSolution,
    *,
    solved: SolvedSpectra,
    asked_for: Settings,
    asked: FloatArray | None,
    progress: Progress | None = None,
) -> Judgement:
    """Return estimates and warnings of a run, from its histories and its transforms; their times are added to the run's.

    Parameters
    ----------
    solution : ModalSolution
    solved : SolvedSpectra
        What its histories were inverted from.
    asked_for : Settings
        With ``modes`` as they were asked for.
    asked : ndarray, shape (shells, parities, M + 1, T), or None
        Modal pressures that the control law asked for, where actuators may saturate.
    progress : callable, optional

    Raises
    ------
    InputError
        If numbers far out of the usual overflow.
    """
    with numerical_failures(solved.grid):
        return _judgement(solution, solved, asked_for, asked, progress)


def _judgement(
    solution: ModalSolution, solved: SolvedSpectra, asked_for: Settings, asked: FloatArray | None, progress: Progress | None
) -> Judgement:
    problem, settings, stopwatch = solution.problem, solution.settings, Stopwatch(solution.timings)
    structure, order = solved.structure, solved.modes.max_order
    interface = interface_of(solved, solution.normal, slice(None, None, settings.refinement), asked)
    spectra, histories = (solved.normal, solved.tangential), (solution.normal, solution.tangential)
    errors = estimates.estimated_errors(solved.passive, spectra, histories, settings.time_step, interface, progress)
    if solved.defect is not None:
        defect = estimates.march_defect(solved.grid, solved.defect, histories, settings.time_step)
        errors = replace(errors, march=errors.march + defect)  # of the links' march, where they were marched, and of the limits'
    stopwatch.lap("error estimates")
    warnings = [*structure.notes, *checks.absorbers(solved, settings.refinement), *checks.before(problem, solved.grid, order)]
    warnings += tolerance_missed(asked_for, order, errors, saturating=saturates(problem.system))
    warnings += checks.after(problem, errors, settings) + checks.tension(
        problem, tensions(problem, solved.grid, *solved.face_motion, structure.returned)
    )
    stopwatch.lap("pressure on the walls")
    warnings += [*checks.actuators(solution), *limited_currents.warnings_of(solved)]
    return Judgement(errors, (*warnings, *checks.ideal_loop(problem, settings)))
