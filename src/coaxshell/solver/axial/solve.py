"""One verb in three dimensions: solve a system at its stations."""

from __future__ import annotations

from contextlib import nullcontext
from dataclasses import replace
from functools import partial

import numpy as np

from coaxshell.acoustics.sources import PlaneGeometry
from coaxshell.errors import InputError
from coaxshell.model.gains import limits_currents, saturates
from coaxshell.model.system import System
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.progress import Progress, of_stage
from coaxshell.solver.axial.blocks import BlockMap, Workplace, node_blocks, on_threads
from coaxshell.solver.axial.faced import READ, make_shapes
from coaxshell.solver.axial.feedback_ahead import require_fronts_before_feedback
from coaxshell.solver.axial.forces import WallForces
from coaxshell.solver.axial.judgement import JudgedFrom, judge_when_read
from coaxshell.solver.axial.limited import LimitedSolution, solve_limited_waves
from coaxshell.solver.axial.line_solve import LineSolution, solve_lines
from coaxshell.solver.axial.lines import line_layout, require_lines_alone
from coaxshell.solver.axial.linked import PointSolution, point_structure, solve_points
from coaxshell.solver.axial.mode_choice import resolved_sampling
from coaxshell.solver.axial.points import point_layout
from coaxshell.solver.axial.sampling import AxialSampling
from coaxshell.solver.axial.solution import SpatialSolution, StationSpectra
from coaxshell.solver.axial.stability import require_stable_waves, waves_asked
from coaxshell.solver.axial.sums import SQUARES, station_sums
from coaxshell.solver.cost import require_room
from coaxshell.solver.dimensions import limits_left_out
from coaxshell.solver.scaling import Problem, dimensionless
from coaxshell.solver.settings import Settings
from coaxshell.solver.shared_parts import SharedParts
from coaxshell.solver.solid_spectra import band
from coaxshell.solver.solution import KEPT_BYTES, Estimates
from coaxshell.solver.spectral import Stopwatch


def solve_spatial(
    system: System,
    settings: Settings,
    progress: Progress | None = None,
    workplace: Workplace | None = None,
    fluids: SharedParts | None = None,
) -> SpatialSolution:
    """Return the modal histories of a system at its stations.

    Parameters
    ----------
    system : System
    settings : Settings
        Of three dimensions.
    progress : callable, optional
        Told how far the run is; its estimates and warnings are made when they are first read.
    workplace : Workplace, optional
        Where blocks of Laplace nodes are worked on, all cores of this machine by default. The answer does not depend on it.
    fluids : SharedParts, optional
        Where the added masses of the fluids are found, or left for the next run, if there is room for all of them: for runs on the threads
        of this process whose fluids, radii and resolution stay.

    Raises
    ------
    InputError
        If the system has what three dimensions do not know, its feedback is unstable, or the axial period is too short.
    """
    stopwatch = Stopwatch()
    progress = progress or (None if workplace is None else workplace.progress)
    grid = laplace_grid(settings)
    problem = dimensionless(system, dimensions=3, settings=settings).resolving(band(grid))
    require_known(problem, settings)
    sampling, notes = resolved_sampling(problem, grid, settings)
    stopwatch.lap("choosing the number of modes")
    period = sampling.period * problem.scales.length
    settings = replace(settings, modes=sampling.max_order, axial_modes=sampling.highest, axial_period=period)
    require_room(problem, settings)
    require_stable_waves(problem, waves_asked(problem, grid, sampling), settings.duration)
    require_fronts_before_feedback(problem, grid, sampling.max_order)
    stopwatch.lap("stability of the feedback")
    run = {"scenario": system.canonical(), "resolution": settings.arguments()}
    with nullcontext(on_threads) if workplace is None else workplace.mapping(run) as on:
        waves = with_shapes(problem, _with_fluids(problem, grid, sampling, fluids), on)
        linked = _linked(problem, grid, waves, progress, on)
        stopwatch.lap("absorbers")
        forces = None if linked is None else linked.forces
        spectra, squares = _summed(problem, grid, waves, settings, forces, progress, on)
        del waves, forces
    if isinstance(linked, LineSolution | LimitedSolution):
        linked = linked.with_waves(sampling)  # which keep neither shapes nor fluids
    stopwatch.lap("axial wavenumbers at all Laplace nodes")
    keep = slice(None, None, settings.refinement)
    histories = {name: grid.invert(spectrum)[..., keep] for name, spectrum in (spectra | _voltage_rates(problem, grid, spectra)).items()}
    stopwatch.lap("inverse transform")
    motion = StationSpectra(grid, spectra["w"], spectra["v"])
    unknown = Estimates.unknown(len(problem.shells))
    solution = SpatialSolution(problem, settings, grid.time[keep], sampling, histories, unknown, (), stopwatch.seconds)
    if linked is not None:
        solution.forces.append(linked.forces)
    if isinstance(linked, PointSolution):
        solution = replace(solution, absorber_displacement=linked.displacement[..., keep], absorber_force=linked.force[..., keep])
    if isinstance(linked, LineSolution):
        force, moved_masses = linked.at(solution.stations / problem.scales.length)
        solution = replace(solution, line_displacement=moved_masses[..., keep], line_force=force[..., keep])
    if motion.normal.nbytes + motion.tangential.nbytes <= KEPT_BYTES:
        solution = replace(solution, spectra=motion)
    judge_when_read(solution, JudgedFrom(grid, squares, motion, linked, notes))
    return solution


def _voltage_rates(problem: Problem, grid: LaplaceGrid, spectra: dict[str, ComplexArray]) -> dict[str, ComplexArray]:
    """Return the transforms of the derivatives by time of piezoelectric layers' voltages, which derivative feedback reads."""
    if all(wall.gains is None or wall.shows_control for wall in problem.shells):
        return {}
    voltages = {name: spectrum for name, spectrum in spectra.items() if name.startswith("potential ")}
    return {name.replace("potential", "potential_rate"): spectrum * grid.nodes for name, spectrum in voltages.items()}


def station_spectra(solution: SpatialSolution) -> StationSpectra:
    """Return the transforms of W and V at the stations of a finished run, solved again where they have not been kept."""
    if solution.spectra is not None:
        return solution.spectra
    solution.at(0).need_every_instant("what is computed from its transforms (velocity and acceleration of shells)")
    grid = laplace_grid(solution.settings)
    waves = with_shapes(solution.problem, solution.sampling, on_threads)
    spectra, _ = _summed(solution.problem, grid, waves, solution.settings, forces_of(solution), None, on_threads)
    return StationSpectra(grid, spectra["w"], spectra["v"])


def histories_within(solution: SpatialSolution, shell: int, depth: float) -> dict[str, FloatArray]:
    """Return W, V, U and all stresses at a depth of an elastic wall at all stations of a finished run, whose waves are solved once more.

    Arrays (stations, parities, M + 1, T) by the names of the fields, dimensionless; those left out are zero.

    Parameters
    ----------
    solution : SpatialSolution
    shell : int
    depth : float
        Outward from the middle of the wall, in a.

    Raises
    ------
    InputError
        If instants of the run are missing, or there is no room for it.
    """
    solution.at(0).need_every_instant("what stands within an elastic wall away from its middle")
    require_room(solution.problem, solution.settings)
    wall = solution.problem.shells[shell]
    shells = tuple(replace(wall, depth_read=depth) if one is wall else one for one in solution.problem.shells)  # type: ignore[call-arg]
    problem, grid = replace(solution.problem, shells=shells), laplace_grid(solution.settings)
    waves = with_shapes(problem, solution.sampling, on_threads)
    spectra, _ = _summed(problem, grid, waves, solution.settings, forces_of(solution), None, on_threads)
    keep = slice(None, None, solution.settings.refinement)
    return {name: grid.invert(spectra[name][:, shell])[..., keep] for name in READ if name in spectra}


def forces_of(solution: SpatialSolution, sampling: AxialSampling | None = None) -> WallForces | None:
    """Return the transforms of what absorbers, or amplifiers at their limit, do in a finished run; None without any.

    Solved again if the run was loaded, or where they are known at its wavenumbers alone and those of another *sampling* are wanted, whose
    forces the run keeps too: the last ones asked for.

    Raises
    ------
    InputError
        If there is no room for them.
    """
    problem, settings, wanted = solution.problem, solution.settings, sampling or solution.sampling
    for kept in solution.forces:
        if kept.sampling is None or kept.sampling.period == wanted.period:
            return kept
    if solution.forces:
        require_room(problem, replace(settings, axial_period=wanted.period * problem.scales.length))
    linked = _linked(problem, laplace_grid(settings), with_shapes(problem, wanted, on_threads), None, on_threads)
    if linked is None:
        return None
    linked = linked.with_waves(wanted) if isinstance(linked, LineSolution | LimitedSolution) else linked
    del solution.forces[1:]
    solution.forces.append(linked.forces)
    return linked.forces


def laplace_grid(settings: Settings) -> LaplaceGrid:
    """Return the nodes and instants of a run, its refinement included."""
    return LaplaceGrid(settings.time_step / settings.refinement, settings.steps * settings.refinement)


def with_shapes(problem: Problem, sampling: AxialSampling, on: BlockMap) -> AxialSampling:
    """Return the same waves, whose modes keep the shapes of elastic walls as long as what is returned is in use."""
    if not problem.two_faced:
        return sampling
    waves = replace(sampling)
    if on is on_threads:
        make_shapes(problem, [*waves.modes, *([] if problem.belts is None else [waves.far])])
    return waves


def _with_fluids(problem: Problem, grid: LaplaceGrid, sampling: AxialSampling, fluids: SharedParts | None) -> AxialSampling:
    """Return waves that share the added masses of their fluids, where these have room: some alone would only push each other out."""
    entries = 3 * len(problem.shells) - 2
    needed = 16 * entries * grid.nodes.size * sum(modes.count for modes in sampling.modes)
    if fluids is None or problem.two_faced or problem.tied or needed > fluids.most:
        return sampling
    return replace(sampling, fluids=fluids)


def _linked(
    problem: Problem, grid: LaplaceGrid, sampling: AxialSampling, progress: Progress | None, on: BlockMap
) -> PointSolution | LineSolution | LimitedSolution | None:
    """Return what absorbers, or amplifiers at their limit, do; None if there are none."""
    if saturates(problem.system):
        return solve_limited_waves(problem, grid, sampling, on, progress)
    if problem.system.absorber_list:
        return solve_lines(line_layout(problem, sampling), grid, on, progress)
    if not problem.system.point_absorbers:
        return None
    blocks = node_blocks(grid)
    return solve_points(point_structure(problem, grid, sampling, point_layout(problem), blocks, on, progress), progress)


def _summed(
    problem: Problem,
    grid: LaplaceGrid,
    sampling: AxialSampling,
    settings: Settings,
    forces: WallForces | None,
    progress: Progress | None,
    on: BlockMap,
) -> tuple[dict[str, ComplexArray], FloatArray]:
    """Return the transforms of the motion at all stations, and its mean squares along the axis, from those of blocks of nodes in turn."""
    stations = np.array(settings.stations) / problem.scales.length
    blocks = node_blocks(grid)
    work = partial(station_sums, problem, grid, sampling, stations, forces)
    spectra: dict[str, ComplexArray] = {}
    squares: FloatArray = np.zeros(1)
    for block, part in zip(blocks, on(work, blocks, of_stage(progress, "axial wavenumbers")), strict=True):
        squares = squares + part.pop(SQUARES)
        for name, values in part.items():
            whole = spectra.setdefault(name, np.zeros((*values.shape[:-1], grid.nodes.size), np.complex128))
            whole[..., block] = values
    return spectra, squares


def require_known(problem: Problem, settings: Settings) -> None:
    """Refuse what belongs to two dimensions, and stations that an inclined wave has passed before t = 0."""
    system = problem.system
    require_lines_alone(problem, settings)
    if saturates(system):
        _require_limits(problem)
    for source, geometry in zip(problem.emitters, problem.sources, strict=True):
        if not isinstance(geometry, PlaneGeometry):
            continue
        for z in settings.stations:
            early = -(z / problem.scales.length * geometry.trace_slowness + source.delay / problem.scales.time)
            if early > 0.0:
                where = f"{z:g} m is passed by the inclined wave {early:.3g} transits before t = 0, when it reaches the head at z = 0"
                needed = early * problem.scales.time + source.delay
                raise InputError("stations", where, f"give the source a delay of {needed:.3g} s or more, or use stations behind z = 0")


def _require_limits(problem: Problem) -> None:
    """Refuse what cannot be beside voltages or currents that stop at their limit in three dimensions."""
    found, where, told = (
        limits_left_out(problem.system),
        "saturation",
        "use saturation = false, which warns where a voltage exceeds its limit",
    )
    if limits_currents(problem.system):
        where, told = "current_saturation", "use current_saturation = false and read control_effort"
    if found is not None:
        raise InputError(f"control.{where}", found[0], f"{told}, or {found[1]}")
