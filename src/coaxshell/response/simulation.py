"""The one call from a system to its response, its prepared form for many absorber sets on one structure, and responses from files."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import Unpack

from coaxshell import solver
from coaxshell.errors import InputError
from coaxshell.model.absorbers import Absorber, AbsorberRing, PointAbsorber
from coaxshell.model.loading import SystemLike, as_system
from coaxshell.model.system import System
from coaxshell.numerics.keywords import showing
from coaxshell.numerics.progress import Progress
from coaxshell.response.response import Response
from coaxshell.response.storage import load_solution
from coaxshell.solver.axial.blocks import Workplace
from coaxshell.solver.cost import require_room
from coaxshell.solver.finite import require_finite_solution, require_finite_stations
from coaxshell.solver.scaling import Problem, dimensionless
from coaxshell.solver.settings import Settings, SettingsKeywords
from coaxshell.solver.shared_parts import SharedParts, shared_parts
from coaxshell.solver.solution import ModalSolution
from coaxshell.solver.structure_spectra import StructureSpectra


@showing(SettingsKeywords, Settings)
def simulate(
    system: SystemLike,
    *,
    progress: Progress | None = None,
    execution: Workplace | None = None,
    **keywords: Unpack[SettingsKeywords],
) -> Response:
    """Return the response of a system to its sources.

    Parameters
    ----------
    system : System, str or Path
        A description, the name of a preset ("bare") or the path of a scenario file ("my.toml").
    duration, time_step : float or str
        In acoustic transit times a/c_e, a the outermost radius and c_e the sound speed outside; or times as text, "3 ms".
    modes : int or "auto"
        Highest circumferential order M; "auto" chooses it by *tolerance*, saturating actuators as if they followed the linear law.
    engine : str
        "spectral" or "direct".
    tolerance : float
        Relative error aimed at by ``modes="auto"``.
    refinement : int
        The run is made at time_step/refinement and every refinement-th instant is kept: for stiff absorbers.
    dimensions, stations, axial_modes, axial_period
        See :class:`coaxshell.Settings`: 2, all alike along the axis, or 3, answered at axial positions (m).
    settings : Settings or mapping, optional
        All of these at once, or a table of some; those given beside it change it.
    progress : callable, optional
        Called with the fraction done (0 to 1) and the name of the stage.
    execution : Execution, optional
        See :class:`coaxshell.Execution`: where the work of a run in three dimensions is done, by default on all cores of this machine,
        and where finished parts of it are kept. The answer is the same to the last bit.

    Returns
    -------
    Response
        A :class:`~coaxshell.response.spatial.SpatialResponse`, read at its stations, with ``dimensions=3``.

    Raises
    ------
    InputError
        If a setting is not allowed, there is no such preset or file, or an execution cannot be had.
    """
    system = as_system(system)
    settings = Settings.asked(system, keywords)
    if settings.dimensions == 3:
        from coaxshell.response.spatial import SpatialResponse
        from coaxshell.solver.axial.solve import solve_spatial

        return SpatialResponse(solve_spatial(system, settings, progress, execution))
    if execution is not None:
        raise InputError("execution", "has no effect on a run in two dimensions", "leave it out, or use dimensions=3")
    return Response(solver.solve(system, settings=settings, progress=progress))


class PreparedSystem:
    """A structure solved once, ready for any number of absorber sets; made by :func:`prepare`."""

    def __init__(
        self,
        problem: Problem,
        settings: Settings,
        progress: Progress | None = None,
        *,
        shared: SharedParts | None = None,
        like: StructureSpectra | None = None,
    ) -> None:
        self.problem, self._settings, self._progress = problem, settings, progress
        self.structure = solver.prepare(problem, settings, progress, shared=shared, like=like)

    @property
    def system(self) -> System:
        """The system it was prepared for."""
        return self.problem.system

    @property
    def settings(self) -> Settings:
        """The resolution, with the number of modes resolved."""
        return replace(self._settings, modes=self.structure.modes.max_order)

    def simulate(
        self,
        absorbers: Iterable[Absorber | PointAbsorber] | AbsorberRing | None = None,
        *,
        progress: Progress | None = None,
    ) -> Response:
        """Return the response with the given absorbers, with the system's own if None, without any if empty.

        Equal to ``simulate(system.replace(absorbers=absorbers))`` at a fraction of its cost.

        Raises
        ------
        InputError
            If an absorber does not fit the system.
        """
        problem = self.problem
        if absorbers is not None:
            problem = replace(problem, system=problem.system.replace(absorbers=absorbers))
            require_room(problem, self.settings)
        return Response(solver.solve_prepared(self.structure, problem, self._settings, progress or self._progress))

    def retuned(self, system: SystemLike) -> PreparedSystem:
        """Return a prepared system for a changed description, at the same settings; everything that the change leaves alone is shared.

        A change of absorbers shares all of it; of sources, the structure's answers to forces; of gains or layers, the fluids, the
        incident waves and, where the nodes of the contour stay, half of the stability check. The answers are those of a fresh
        :func:`prepare`. What is shared takes at most half a gigabyte, the longest unused let go first; one prepared as retunable has
        it from the start, any other from its first call on. Retune the one returned, or the same one again, for every step of a
        slider or of an optimisation.

        Parameters
        ----------
        system : System

        Raises
        ------
        InputError
            If the feedback is unstable.
        """
        return PreparedSystem(
            dimensionless(as_system(system), settings=self._settings), self._settings, self._progress, like=self.structure
        )


@showing(SettingsKeywords, Settings)
def prepare(
    system: SystemLike,
    *,
    retunable: bool = False,
    progress: Progress | None = None,
    **keywords: Unpack[SettingsKeywords],
) -> PreparedSystem:
    """Solve once all that does not depend on the absorbers: shells, fluids, sources and feedback.

    The other parameters are those of :func:`simulate`. The linear response and the compliance kernels are computed when first
    needed and kept, about 0.3 GB at the paper's resolution.

    Parameters
    ----------
    retunable : bool
        Keep from the start what :meth:`PreparedSystem.retuned` shares, so that already its first call finds it.

    Raises
    ------
    InputError
        If a setting is not allowed or the feedback is unstable.
    """
    system = as_system(system)
    settings = Settings.asked(system, keywords)
    return PreparedSystem(dimensionless(system, settings=settings), settings, progress, shared=shared_parts() if retunable else None)


def load_response(path: str | Path) -> Response:
    """Return the response saved in a file, equal bit by bit to the one that was saved.

    Raises
    ------
    InputError
        If there is no such file, or it is not ours, cut short, damaged (NaN or infinity in an array too), or of a newer format.
    """
    solution = load_solution(path)
    if isinstance(solution, ModalSolution):
        require_finite_solution(solution, str(path), "write the file again")
        return Response(solution)
    from coaxshell.response.spatial import SpatialResponse

    require_finite_stations(solution, str(path), "write the file again")
    return SpatialResponse(solution)
