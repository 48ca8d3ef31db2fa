"""From a system to a solution by the direct engine."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from coaxshell.acoustics.basis import Modes
from coaxshell.errors import InputError
from coaxshell.model.gains import saturates
from coaxshell.model.system import System
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.progress import Progress
from coaxshell.solver import checks
from coaxshell.solver.cost import require_room
from coaxshell.solver.dimensions import require_cubic_springs, require_mid_surfaces, require_two_dimensions
from coaxshell.solver.direct.engine import march_directly
from coaxshell.solver.direct.result import DirectResult
from coaxshell.solver.estimates import ORDERS_FACTOR
from coaxshell.solver.excitation import source_parities
from coaxshell.solver.finite import numerical_failures
from coaxshell.solver.interface.absorbers import AbsorberSet, InterfacePoints, absorber_set
from coaxshell.solver.mode_choice import resolve_modes
from coaxshell.solver.orders_left_out import Interface, left_out, surface_norms
from coaxshell.solver.rounds import rounds
from coaxshell.solver.scaling import Problem, dimensionless
from coaxshell.solver.settings import Settings
from coaxshell.solver.solution import Estimates, ModalSolution
from coaxshell.solver.spectral import Stopwatch
from coaxshell.solver.stability import require_stable
from coaxshell.solver.structure_spectra import StructureSpectra
from coaxshell.solver.tension import spectra_of_motion, tensions, watched


def solve_by_marching(system: System, settings: Settings, progress: Progress | None = None) -> ModalSolution:
    """Return the modal histories of a system by the direct engine.

    Velocities are central differences of the recorded motion; the error of the time step is not estimated (NaN): compare two
    steps, or the spectral engine.

    Raises
    ------
    InputError
        If the feedback or the step is unstable, a source lies off the plane, or the fluids wet true faces.
    """
    stopwatch = Stopwatch()
    require_two_dimensions(system, settings)
    require_mid_surfaces(system)
    require_cubic_springs(system, "the direct engine", 'use engine="spectral", or leave it out')
    problem = dimensionless(system, settings=settings)
    require_steps(problem)
    _require_no_return(problem, settings.duration)
    grid = LaplaceGrid(settings.time_step / settings.refinement, settings.steps * settings.refinement)
    require_room(problem, settings)
    order, warnings = resolve_modes(problem, grid, settings)
    if settings.modes == "auto":
        require_room(problem, replace(settings, modes=order))
    require_stable(problem, order, settings.duration)
    stopwatch.lap("stability of the feedback")
    links = absorber_set(problem, system.absorber_list, source_parities(problem))
    saturate = saturates(system)
    with numerical_failures(grid):
        result = march_directly(problem, grid, order, links, saturate=saturate, progress=progress)
    stopwatch.lap("time steps")
    w, v = result.normal, result.tangential
    left_out = _left_out(problem, grid, order, links, result)
    error_estimates = Estimates(left_out, np.full_like(left_out, np.nan), np.full_like(left_out, np.nan))
    stopwatch.lap("error estimates")
    keep = slice(None, None, settings.refinement)
    solution = ModalSolution(
        problem, replace(settings, modes=order), grid.time[keep], w[..., keep], v[..., keep], error_estimates, (), stopwatch.seconds
    )
    if any(shell.gains is not None for shell in problem.shells):
        rates = [np.gradient(x, grid.time_step, axis=-1, edge_order=2)[..., keep] for x in (w, v)]
        solution = replace(solution, normal_rate=rates[0], tangential_rate=rates[1])
    if system.absorber_list:
        displacement, force = result.absorber_displacement[links.member], result.absorber_force[links.member]
        solution = replace(solution, absorber_displacement=displacement[:, keep], absorber_force=force[..., keep])
    if result.correction is not None:
        solution = replace(solution, control_correction=result.correction[..., keep])
    if watched(problem):
        warnings += checks.tension(problem, tensions(problem, grid, spectra_of_motion(grid, w)))
        stopwatch.lap("pressure on the walls")
    warnings += checks.before(problem, grid, order) + checks.after(problem, error_estimates, solution.settings) + checks.actuators(solution)
    return replace(solution, warnings=tuple(warnings))


def require_steps(problem: Problem) -> None:
    """Raise InputError if a wall is none that is stepped."""
    for wall in problem.shells:
        wall.stiffness(Modes.up_to(0))


def _require_no_return(problem: Problem, duration: float) -> None:
    """Raise InputError if what the shells scatter comes back from the planes of the sea within the run."""
    planned = rounds(problem, duration)
    if planned.needed:
        until = planned.exact_until(0)
        found = f"what the shells scatter is back from the sea's surface or bottom at t = {until:.4g}, which the direct engine leaves out"
        raise InputError("sea", found, f'use duration={until:.4g}, or engine="spectral"')


def _left_out(problem: Problem, grid: LaplaceGrid, order: int, links: AbsorberSet, result: DirectResult) -> FloatArray:
    """Return the printed error by the orders left out; compliances are those of the Laplace domain."""
    interface = None
    if links.count:
        force = result.absorber_force.swapaxes(0, 1)
        walls = InterfacePoints(problem, links, Modes.up_to(order)).evaluate(result.normal).reshape(force.shape)
        stretch = result.absorber_displacement - walls
        interface = Interface(links, force.reshape(2 * links.count, -1), stretch, result.correction, marched=True)
    histories = result.normal, result.tangential
    spectra = grid.transform(result.normal), grid.transform(result.tangential)
    whole = surface_norms(*histories) * grid.time_step
    return ORDERS_FACTOR * left_out(StructureSpectra(problem, grid, Modes.up_to(order)), spectra, whole, interface)
