"""What a run in three dimensions costs: every axial wavenumber is a run in two dimensions, of which the sums at the stations are kept.

Line absorbers keep kernels and histories of every wavenumber too.
"""

from __future__ import annotations

import math
from dataclasses import replace

from coaxshell.model.system import System
from coaxshell.numerics.cost import Cost
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.threads import WORKERS
from coaxshell.solver.axial.blocks import BLOCK_NODES
from coaxshell.solver.axial.faced import READ
from coaxshell.solver.axial.limited_wave import axial_parities, even_about
from coaxshell.solver.axial.line_march import block_steps
from coaxshell.solver.axial.lines import LineLayout, line_layout
from coaxshell.solver.axial.sampling import AxialSampling, axial_sampling
from coaxshell.solver.axial.tied_wave import motion_parities
from coaxshell.solver.faced_forces import PARTS
from coaxshell.solver.orders_left_out import COUPLED_POINTS
from coaxshell.solver.run_size import COMPLEX, REAL, Size
from coaxshell.solver.sampled_orders import NODES
from coaxshell.solver.scaling import Problem, dimensionless
from coaxshell.solver.settings import Settings
from coaxshell.solver.solid_spectra import band
from coaxshell.structure.elastic_wall import ElasticWall
from coaxshell.structure.shell_model import SOLID_STRESSES

_FIELDS = 9
"""Transforms kept at each station: three displacements, four derivatives along the axis, potentials of two layers."""
_WORKING = 40.0
"""Arrays of orders and nodes of a block that a thread works with, for each shell."""
_SIDE_BY_SIDE = 1000
"""Nodes below which threads take turns: there are two blocks, and NumPy lets others run only beside loops of more than 500 numbers."""
_NANOSECONDS = 1e-9
_PER_SHAPE, _PER_TERM = 40e-9, 10e-9
"""Seconds of the shapes of a wave, per their number to the power 2.5, and of what each adds at a node."""
_INCLINED = 2e-4
"""Seconds of the equations of a wall of 48 displacements at one order and node of an inclined wave, without shapes."""
_INCLINED_DRIVEN = 2.8
"""How much longer it takes where the wall is under control."""
_WAVE = 5e-3
"""Seconds that a wavenumber takes at a few orders and nodes, each time that it is solved."""
_TIED = 1.6
"""How much longer a wave takes whose orders or walls feedback ties to each other."""
_PER_FORCE = 0.35e-6
"""Seconds that a force at one point takes at an order and node, where electrodes are cut."""
_BELTS = 1.6
"""How much longer it takes than that where electrodes are cut along the axis."""
_LIMITED, _LIMITED_SOLIDS = 4.2, 2.5
"""How much longer waves take where voltages stop at a limit: asked for, looped within a step, shown, estimated; how much more solids."""
_TURN = 5e-5
"""Seconds of a turn between waves and points of a wall, besides its products."""
_STEP = 2e-3
"""Seconds of a step of the march of a single absorber along the axis, by Newton's method."""


def sampling_of(system: System, settings: Settings, highest_order: int) -> AxialSampling:
    """Return the axial wavenumbers of a run, *highest_order* in the place of "auto"; InputError for a period that is too short."""
    return _sampling(dimensionless(system, dimensions=3, settings=settings), settings, highest_order)


def _sampling(problem: Problem, settings: Settings, highest_order: int) -> AxialSampling:
    return axial_sampling(problem, replace(settings, modes=highest_order))


def spatial_cost(system: System, settings: Settings, size: Size) -> Cost:
    """Return the cost of a run in three dimensions, given the *size* of the same run in two; InputError for a period that is too short."""
    grid = LaplaceGrid(settings.time_step / settings.refinement, settings.steps * settings.refinement)
    problem = dimensionless(system, dimensions=3, settings=settings).resolving(band(grid))
    sampling = _sampling(problem, settings, size.orders - 1)
    pairs = float(sampling.tops.sum() + sampling.tops.size) * size.nodes
    stations, amplitudes = len(settings.stations), size.shells * motion_parities(problem)
    solids, points = _solids_cost(problem, sampling, size), bool(system.point_absorbers)
    fields = _FIELDS + (len(SOLID_STRESSES) if size.solids else 0)
    kept = stations * amplitudes * (fields * (size.plane + size.history) + 6.0 * size.plane)
    turns = 2.0 if size.nodes < _SIDE_BY_SIDE else 1.0
    lines = _lines_cost(line_layout(problem, sampling), size, pairs) if system.absorber_list else Cost(0.0)
    waves = turns * pairs * 0.3e-6 * size.shells * (_TIED if problem.tied else 1.0) * (_BELTS if problem.belts else 1.0)
    forces = 2 * (len(system.absorber_list) + len(system.point_absorbers)) if problem.cut else 0
    waves += turns * pairs * _PER_FORCE * forces
    limits = _limits_cost(problem, sampling, size, pairs) if size.controlled else Cost(0.0)
    if limits.memory:
        waves *= _LIMITED if problem.tied else _LIMITED * _TIED  # whose loops the solver closes too
    again = _passes(problem, size) if lines.seconds or points else 0.0  # for what absorbers feel and do
    return Cost(
        lines.memory
        + solids.memory
        + limits.memory
        + kept
        + size.shells * (6.0 * size.plane + WORKERS * _WORKING * size.plane * min(0.5, BLOCK_NODES / size.nodes)),
        lines.seconds
        + limits.seconds
        + solids.seconds * (1.0 + again + (_LIMITED_SOLIDS if limits.memory else 0.0))
        + 0.1
        + _WAVE * len(sampling.modes)
        + waves * (1.0 + (again + 1.0 if points else 0.0))
        + turns * pairs * 2e-9 * fields * stations * amplitudes,
    )


def _limits_cost(problem: Problem, sampling: AxialSampling, size: Size, pairs: float) -> Cost:
    """Return what voltages add that stop at a limit: loops and past of every order and wavenumber, and transforms at every step."""
    around, along = motion_parities(problem), axial_parities(problem, even_about(problem))
    channels, walls = around * pairs / size.nodes, float(size.controlled)
    memory = channels * REAL * size.instants * (4.0 * walls**2 + 5.0 * walls * along)
    points = max(4.0 * size.orders, 180.0) * around * 2.0 * along * len(sampling.modes)
    step = 80.0 * walls * (_TURN + points * size.orders * around * 0.3 * _NANOSECONDS)
    past = 25.0 * walls**2 * along * channels * math.log2(size.instants + 2) * _NANOSECONDS
    return Cost(memory, size.instants * (step + past))


def _passes(problem: Problem, size: Size) -> float:
    """Return how many more times absorbers have walls of elastic solids solved: their faces alone, for a march at finer steps too."""
    marched = size.nonlinear or not all(one.cubic_stiffness == 0.0 and one.law is None for one in problem.system.point_absorbers)
    return (0.5 + (0.5 * PARTS if marched else 0.0)) if problem.two_faced else 0.0


def _solids_cost(problem: Problem, sampling: AxialSampling, size: Size) -> Cost:
    """Return what elastic walls add: their shapes in every wave, which blocks share, and the sums over them at every node."""
    memory = seconds = 0.0
    waves = float(sampling.tops.sum() + sampling.tops.size)
    for wall in problem.shells:
        if not isinstance(wall, ElasticWall):
            continue
        shapes, rows = wall.shape_count(size.orders - 1.0, 0.0), 3.0 + len(READ) + len(wall.piezoelectric)
        if any(getattr(source, "inclination", 0.0) for source in problem.system.sources):
            unknowns = 3.0 + 3.0 * sum(wall.degree_of(layer, size.orders - 1.0) for layer in wall.layers)
            driven = _INCLINED_DRIVEN if wall.closes_a_loop else 1.0
            seconds += (size.orders * size.nodes) * _INCLINED * (unknowns / 48.0) ** 2 * driven
        memory += REAL * waves * shapes * rows + WORKERS * 4.0 * rows * size.plane * min(0.5, BLOCK_NODES / size.nodes)
        seconds += waves * (_PER_SHAPE * shapes**2.5 + size.nodes * shapes * _PER_TERM)
    return Cost(memory, seconds)


def _lines_cost(layout: LineLayout, size: Size, pairs: float) -> Cost:
    """Return what line absorbers add: their forces at every wavenumber, and if they are marched kernels and histories of the classes."""
    waves, points, axial = len(layout.sampling.modes), 2 * layout.absorbers.count, layout.axial_parities
    along = waves * points * axial
    spectra, histories = COMPLEX * along * size.nodes, REAL * along * size.instants
    one_wave = WORKERS * size.surfaces**2 * (6.0 + (PARTS if size.solids and size.nonlinear else 0.0)) * size.plane
    solving = pairs * 0.3e-6 * size.shells * 1.5 + _WAVE * waves
    exact = waves * size.nodes * (4.0 * points**2 * (layout.classes.count + points)) * _NANOSECONDS
    together = exact if points <= COUPLED_POINTS else 0.0
    softness = 1.6 * _WAVE * waves + 2.0 * (solving + together) / NODES.step
    if not size.nonlinear:
        systems = WORKERS * 6.0 * COMPLEX * size.nodes * points**2
        return Cost(3.0 * spectra + 2.5 * histories + one_wave + systems, solving + exact + softness)
    channels = waves * layout.classes.count
    kernels = REAL * size.surfaces**2 * channels * size.instants
    parities = layout.absorbers.parities * axial
    past = 2.0 * size.surfaces * parities * REAL * channels * size.instants
    steps = block_steps(layout.absorbers.count)
    matrices = 2.5 * REAL * waves * (steps * points) ** 2
    past_seconds = 25.0 * size.surfaces**2 * channels * parities * math.log2(size.instants + 2)
    products = waves * axial * (60.0 * points**2 + 150.0 * points)
    march = size.instants * (_STEP + (past_seconds + products) * _NANOSECONDS)
    planned = 1e-4 * waves * steps  # answers of a block at every wavenumber, for the run and for the error of its step
    seconds = solving + 1.4 * march + 2.0 * planned + softness
    return Cost(5.0 * kernels + past + matrices + 6.0 * histories + 2.5 * spectra + one_wave, seconds)
