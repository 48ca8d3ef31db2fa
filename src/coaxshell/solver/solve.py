"""One verb: solve a system at a resolution. Prepared first, so that many absorber sets can share all that is linear."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from coaxshell.acoustics.basis import Modes
from coaxshell.errors import InputError
from coaxshell.model.absorbers import Absorber, AbsorberRing
from coaxshell.model.system import System
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.progress import Progress
from coaxshell.solver import checks, estimates, recompute
from coaxshell.solver.actuation import pressure_asked
from coaxshell.solver.cost import require_room
from coaxshell.solver.dimensions import require_dimensions
from coaxshell.solver.excitation import source_parities
from coaxshell.solver.finite import numerical_failures, require_finite_stages
from coaxshell.solver.interface.absorbers import absorber_set
from coaxshell.solver.interface.linked import AbsorberSolution, interface_of, solve_linked
from coaxshell.solver.mode_choice import resolve_modes
from coaxshell.solver.scaling import Problem, dimensionless
from coaxshell.solver.settings import Settings
from coaxshell.solver.shared_parts import SharedParts, shared_parts
from coaxshell.solver.solution import ModalSolution
from coaxshell.solver.spectral import Stopwatch
from coaxshell.solver.stability import require_stable
from coaxshell.solver.structure_spectra import StructureSpectra
from coaxshell.solver.tension import tensions


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
    return Prepared(system, settings, progress).solve()


class Prepared:
    """A structure solved once under its sources, ready for any number of absorber sets.

    Parameters
    ----------
    system : System or Problem
        Its own absorbers are only the default of ``solve``. A dimensionless problem may differ from its system's.
    settings : Settings
    progress : callable, optional
    shared : SharedParts, optional
        Where parts that other systems share are found and left.
    like : Prepared, optional
        Another one at the same settings, whose parts are shared if they are the same.

    Raises
    ------
    InputError
        If the engine is not available or the feedback is unstable.
    """

    def __init__(
        self,
        system: System | Problem,
        settings: Settings,
        progress: Progress | None = None,
        *,
        shared: SharedParts | None = None,
        like: Prepared | None = None,
    ) -> None:
        if settings.engine != "spectral":
            raise InputError("engine", f"{settings.engine!r} cannot be prepared", 'use engine="spectral"')
        self._stopwatch, self._notes = Stopwatch(), list[str]()
        self._progress, self._shared, self._asked = progress, shared, settings
        self.problem = system if isinstance(system, Problem) else dimensionless(system)
        require_dimensions(self.problem.system, settings)
        if like is not None and like.differs_by_absorbers(self.problem):
            self._adopt(like)
            return
        grid = LaplaceGrid(settings.time_step / settings.refinement, settings.steps * settings.refinement)
        require_room(self.problem, settings, retunable=shared is not None)
        order = self._order(grid, settings)
        self.settings: Settings = replace(settings, modes=order)
        if settings.modes == "auto":
            require_room(self.problem, self.settings, retunable=shared is not None)
        units = like.structure.units if like is not None and like.same_structure(self.problem, order) else None
        if units is None:
            require_stable(self.problem, order, settings.duration, shared)
            self._stopwatch.lap("stability of the feedback")
        self.structure: StructureSpectra = StructureSpectra(self.problem, grid, Modes.up_to(order), progress, shared=shared, units=units)

    def _adopt(self, like: Prepared) -> None:
        """Take over everything from one that differs at most in its absorbers."""
        self.settings, self.structure = like.settings, like.structure
        self._notes = like._notes

    def same_structure(self, problem: Problem, max_order: int) -> bool:
        """Return whether a problem differs at most in its sources, absorbers and field limits."""
        own = self.problem
        same = all(getattr(own, name) == getattr(problem, name) for name in ("shells", "fluids", "scales", "point_force_shares"))
        return same and max_order == self.structure.modes.max_order

    def differs_by_absorbers(self, problem: Problem) -> bool:
        """Return whether a problem differs at most in its absorbers."""
        same = problem.system.replace(absorbers=()) == self.problem.system.replace(absorbers=())
        return same and problem.sources == self.problem.sources and self.same_structure(problem, self.structure.modes.max_order)

    def retuned(self, system: System | Problem) -> Prepared:
        """Return what is prepared for a changed system, sharing what is unchanged; the first call makes what later ones share.

        Raises
        ------
        InputError
            If the feedback is unstable.
        """
        if self._shared is None:
            self._shared = shared_parts()
        return Prepared(system, self._asked, self._progress, shared=self._shared, like=self)

    def _order(self, grid: LaplaceGrid, settings: Settings) -> int:
        order, notes = resolve_modes(self.problem, grid, settings, self._shared)
        self._notes += notes
        self._stopwatch.lap("choosing the number of modes")
        return order

    def solve(self, absorbers: Iterable[Absorber] | AbsorberRing | None = None, progress: Progress | None = None) -> ModalSolution:
        """Return the modal histories with the given absorbers; with the system's own if None.

        Raises
        ------
        InputError
            If an absorber does not fit the system or the force law cannot be marched at this step.
        """
        system = self.problem.system if absorbers is None else self.problem.system.replace(absorbers=absorbers)
        problem, structure = replace(self.problem, system=system), self.structure
        if absorbers is not None:
            require_room(problem, self.settings)
        recompute.let_go()
        with numerical_failures(structure.grid):
            return self._solved(problem, progress or self._progress)

    def _solved(self, problem: Problem, progress: Progress | None) -> ModalSolution:
        """Return the modal histories of a problem that differs at most in its absorbers."""
        system, structure, stopwatch = problem.system, self.structure, self._stopwatch
        grid = structure.grid
        linked: AbsorberSolution | None = None
        warnings = list(self._notes)
        saturate = system.control is not None and system.control.saturation
        if system.absorber_list or saturate:
            passive = structure.open_loop if saturate else structure
            passive.solve(units=True)
            stopwatch.lap("modal system at all Laplace nodes")
            links = absorber_set(problem, system.absorber_list, source_parities(system.sources))
            linked = solve_linked(structure, links, progress, saturate=saturate)
            normal, tangential = linked.normal, linked.tangential
            stopwatch.lap("absorbers and saturation")
            require_finite_stages(structure, linked)
            warnings += checks.absorbers(passive, links, linked, self.settings.refinement)
        else:
            normal, tangential = structure.normal, structure.tangential
            stopwatch.lap("modal system at all Laplace nodes")
            require_finite_stages(structure, None)
        order, keep = structure.modes.max_order, slice(None, None, self.settings.refinement)
        w, v = grid.invert(normal)[..., keep], grid.invert(tangential)[..., keep]
        rates: list[FloatArray | None] = [None, None]
        if any(shell.gains is not None for shell in problem.shells):
            rates = [grid.invert(x * grid.nodes)[..., keep] for x in (normal, tangential)]
        stopwatch.lap("inverse transform")
        interface = None if linked is None else interface_of(structure, links, linked, w, keep)
        if saturate and interface is not None and rates[0] is not None and rates[1] is not None:
            interface = replace(interface, asked=pressure_asked(problem, w, v, rates[0], rates[1]))
        moved = structure.open_loop if linked is not None and linked.actuation is not None else structure
        error_estimates = estimates.estimated_errors(moved, (normal, tangential), (w, v), self.settings.time_step, interface)
        stopwatch.lap("error estimates")
        warnings += checks.before(problem, grid, order) + checks.after(problem, error_estimates, self.settings)
        warnings += checks.tension(problem, tensions(problem, grid, normal))
        stopwatch.lap("pressure on the walls")
        timings, self._stopwatch = stopwatch.seconds, Stopwatch()
        solution = ModalSolution(problem, self.settings, grid.time[keep], w, v, error_estimates, (), timings, rates[0], rates[1])
        if linked is not None and system.absorber_list:
            solution = replace(solution, absorber_displacement=linked.displacement[:, keep], absorber_force=linked.force[..., keep])
        if saturate:
            solution = replace(solution, control_correction=_lack(solution, linked, keep))
        solution = replace(solution, warnings=tuple(warnings + checks.actuators(solution)))
        recompute.keep_at_hand(solution, structure, linked)
        return solution


def _lack(solution: ModalSolution, linked: AbsorberSolution | None, keep: slice) -> FloatArray:
    """Return the modal pressure that saturating actuators gave, less what the linear law asks for at the motion found."""
    if linked is None or linked.actuation is None:
        return np.zeros_like(solution.normal)
    w_rate, v_rate = solution.normal_rate, solution.tangential_rate
    assert w_rate is not None
    assert v_rate is not None
    return linked.actuation[..., keep] - pressure_asked(solution.problem, solution.normal, solution.tangential, w_rate, v_rate)
