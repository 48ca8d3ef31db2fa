"""One verb: solve a system at a resolution with an engine."""

from __future__ import annotations

from dataclasses import replace

from coaxshell.acoustics.bessel_ratios import ComplexArray
from coaxshell.acoustics.laplace_grid import LaplaceGrid
from coaxshell.errors import InputError
from coaxshell.model.system import System
from coaxshell.solver import checks, estimates
from coaxshell.solver.scaling import Problem, dimensionless
from coaxshell.solver.settings import Settings
from coaxshell.solver.solution import Estimates, ModalSolution
from coaxshell.solver.spectral import Progress, Stopwatch, linear_spectra


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
        If the engine cannot solve this system.
    """
    settings = settings or Settings()
    if settings.engine == "direct":
        raise InputError("engine", '"direct" is not available yet', 'use engine="spectral"')
    if system.absorber_list:
        raise InputError("absorbers", f"{len(system.absorber_list)} given", "absorbers cannot be solved yet; leave them out")
    problem = dimensionless(system)
    return _spectral(problem, settings, progress)


def _spectral(problem: Problem, settings: Settings, progress: Progress | None) -> ModalSolution:
    stopwatch = Stopwatch()
    grid = LaplaceGrid(settings.time_step, settings.steps)
    chosen = settings.modes
    warnings: list[str] = []
    if chosen == "auto":
        chosen, remaining = estimates.choose_modes(problem, grid, settings.tolerance)
        if remaining > settings.tolerance:
            warnings.append(
                f'modes="auto": {chosen} orders, the most that are allowed, leave an estimated {remaining:.2g} of the stress, more than '
                f"the tolerance {settings.tolerance:g}; accept it or shorten the source's spectrum (a longer rise_time)"
            )
        stopwatch.lap("choosing the number of modes")
    settings = replace(settings, modes=chosen)
    spectra = linear_spectra(problem, grid, chosen, progress)
    normal, tangential = spectra.normal, spectra.tangential
    stopwatch.lap("modal system at all Laplace nodes")
    trust = _estimates(problem, grid, normal, tangential, chosen)
    stopwatch.lap("error estimates")
    w, v = grid.invert(normal), grid.invert(tangential)
    stopwatch.lap("inverse transform")
    warnings += checks.before(problem, grid, chosen) + checks.after(problem, trust, chosen)
    return ModalSolution(problem, settings, grid.time, w, v, trust, tuple(warnings), stopwatch.seconds)


def _estimates(problem: Problem, grid: LaplaceGrid, normal: ComplexArray, tangential: ComplexArray, max_order: int) -> Estimates:
    orders = estimates.sampled_orders(problem, max_order + 1)
    above = estimates.modal_norms(problem, grid, orders)
    below = estimates.computed_norms(normal, tangential)
    displacement, stress = (
        estimates.relative(estimates.tail_above(max_order, orders, high), estimates.surface_total(low))
        for high, low in zip(above, below, strict=True)
    )
    return Estimates(displacement, stress, estimates.window_error(grid, normal))
