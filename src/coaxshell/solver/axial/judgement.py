"""How far a run in three dimensions can be trusted: its error estimates and its physics warnings."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import NamedTuple

from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.cache import held_bytes
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver import checks
from coaxshell.solver.axial import belt_edges
from coaxshell.solver.axial.feedback_ahead import moved_ahead
from coaxshell.solver.axial.lack import without_lack
from coaxshell.solver.axial.left_out import estimated_errors
from coaxshell.solver.axial.limited import LimitedSolution
from coaxshell.solver.axial.line_softness import softened_lines
from coaxshell.solver.axial.line_solve import LineSolution
from coaxshell.solver.axial.linked import PointSolution
from coaxshell.solver.axial.softened import Softened, softened
from coaxshell.solver.axial.solution import SpatialSolution, StationSpectra
from coaxshell.solver.limited_currents import warnings_of_held
from coaxshell.solver.limited_voltages import walls_held
from coaxshell.solver.solution import KEPT_BYTES, Judgement
from coaxshell.solver.spectral import Stopwatch
from coaxshell.solver.station_currents import warnings_at


class JudgedFrom(NamedTuple):
    """What a run is judged from besides its histories.

    Attributes
    ----------
    grid : LaplaceGrid
    squares : ndarray, shape (2, shells, 2, M + 1)
        Mean squares along the axis of all that was added up, all nodes together, under sources and under forces.
    motion : StationSpectra
        Transforms at the stations.
    linked : PointSolution, LineSolution, LimitedSolution or None
        What the absorbers, or amplifiers at their limit, did.
    notes : sequence of str
        Warnings of the choice of orders.
    """

    grid: LaplaceGrid
    squares: FloatArray
    motion: StationSpectra
    linked: PointSolution | LineSolution | LimitedSolution | None
    notes: Sequence[str]


def judge_when_read(solution: SpatialSolution, given: JudgedFrom) -> None:
    """Leave estimates and warnings of a run to be made when either is first read; now where what they take is more than runs keep."""
    solution.judge_when_read(partial(judgement, given=given))
    if held_bytes((given.motion, given.linked)) > KEPT_BYTES:
        _ = solution.estimates


def judgement(solution: SpatialSolution, given: JudgedFrom) -> Judgement:
    """Return estimates and warnings of a run, whose times are added to the run's."""
    problem, settings, linked = solution.problem, solution.settings, given.linked
    stopwatch = Stopwatch(solution.timings)
    forces, force_error = (None, 0.0) if linked is None else (without_lack(linked.forces), linked.error)
    moved, soft = (solution.fields["w"], solution.fields["v"]), _softened(solution, given)
    estimates = estimated_errors(
        problem, given.grid, solution.sampling, given.squares, given.motion, moved, soft, forces, force_error=force_error
    )
    stopwatch.lap("error estimates")
    warnings = [*given.notes, *checks.before(problem, given.grid, solution.sampling.max_order)]
    warnings += moved_ahead(problem, given.grid, solution.sampling.max_order)
    warnings += checks.after(problem, estimates, settings) + checks.ideal_loop(problem, settings)
    if linked is not None and linked.laws is not None:
        warnings += checks.swinging_on_laws(linked.laws.angle, given.grid.time_step, settings.refinement)
    if isinstance(linked, LimitedSolution):
        warnings += warnings_of_held(problem, walls_held(problem, linked.lack))
    stations = [solution.at(i) for i in range(len(settings.stations))]
    edges = belt_edges.remarks(problem, solution.sampling.highest, stations, settings.stations)
    return Judgement(estimates, (*warnings, *checks.actuators(*stations), *warnings_at(*stations), *edges))


def _softened(solution: SpatialSolution, given: JudgedFrom) -> Softened | None:
    """Return what the absorbers do with the waves left out, None if there are none."""
    problem, linked = solution.problem, given.linked
    if isinstance(linked, PointSolution):
        return softened(problem, given.grid, solution.sampling, linked)
    return softened_lines(problem, given.grid, linked) if isinstance(linked, LineSolution) else None
