"""What a run costs before it is begun: bytes of the arrays that stand side by side at its worst, seconds from counts of operations.

The unit of memory is one complex number for each order and Laplace node (about one a step), a plane: spectra, compliance and kernels
are multiples of it. Stages follow each other, so the largest of them counts. How many arrays a block of the solver works with, and
how long an operation takes, was measured; seconds hold within a factor of 3, bytes within 1.5.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

from coaxshell.model.system import System
from coaxshell.numerics.cost import Cost
from coaxshell.numerics.threads import WORKERS
from coaxshell.solver.faced_forces import PARTS
from coaxshell.solver.interface.linear_many import POINTS
from coaxshell.solver.run_size import COMPLEX, REAL, Size, size_of
from coaxshell.solver.scaling import Problem, dimensionless
from coaxshell.solver.settings import MAX_MODES, Settings
from coaxshell.solver.shared_parts import ROOM
from coaxshell.solver.spatial_cost import spatial_cost

_BLOCK_PAIRS = 64 * 1024
"""Order-node pairs that a thread works on at a time."""
_RECEPTANCE_BYTES, _PAIR_BYTES = 8 * 1024 * 1024, 64 * 1024 * 1024
_TIED_BYTES = 32 * 1024 * 1024
_BLOCK_UNKNOWNS, _LONGEST_BLOCK = 512, 32
_REFLECTION = 1e-8
"""Seconds of a pair of orders at a node in Graf's sum."""
_SAMPLE_STRIDE = 8
"""One node in so many is used for the estimate of what the orders left out would add."""


def run_cost(system: System | Problem, settings: Settings, *, retunable: bool = False) -> Cost:
    """Return what a run of a system costs, its error estimates included.

    Parameters
    ----------
    system : System or Problem
    settings : Settings
        "auto" counts as 300 orders.
    retunable : bool
        Whether it keeps what :meth:`coaxshell.response.PreparedSystem.retuned` shares.
    """
    size = size_of(dimensionless(system, settings.dimensions, settings) if isinstance(system, System) else system, settings)
    if settings.dimensions == 3:
        return spatial_cost(system if isinstance(system, System) else system.system, settings, size)
    direct = settings.engine == "direct"
    memory = _direct_bytes(size) if direct else _spectral_bytes(size)
    if settings.modes == "auto":
        memory = max(memory, _sampled_bytes(size, 2.0 * MAX_MODES))
    kept = min(float(ROOM), (3.0 * size.shells + 2.0) * size.plane) if retunable else 0.0
    seconds = _direct_seconds(size) if direct else _reflected_seconds(size)
    return Cost(memory + kept + size.shapes + 200.0 * size.samples, seconds + 2e-5 * size.samples)


def require_room(problem: Problem, settings: Settings, *, retunable: bool = False) -> None:
    """Raise InputError if a run does not fit into the memory that is free; it says which orders or which step would.

    As long as it is not known how many orders "auto" finds, the search for them is what has to fit.
    """
    cost = run_cost(problem, settings, retunable=retunable)
    if settings.modes == "auto":
        cost = Cost(_sampled_bytes(size_of(problem, settings), 2.0 * MAX_MODES))
    if cost.fits:
        return
    shells, modes = len(problem.shells), settings.modes
    orders = f"orders chosen by {modes!r}" if modes == "auto" else f"orders 0 to {modes:,}"
    instants = f"{settings.steps * settings.refinement + 1:,} instants"
    what = f"a run of {shells} shell{'s' * (shells > 1)}, {orders} and {instants}"
    cost.require(what, _smaller(problem, settings))


def _smaller(problem: Problem, settings: Settings) -> str:
    """Return the number of orders and the time step that fit, if there are any, each for itself."""
    remedies = []
    if settings.modes != "auto":
        fewer = _largest(4, int(settings.modes), lambda modes: run_cost(problem, replace(settings, modes=modes)).fits)
        remedies += [f"modes={_rounded_down(fewer)}"] if fewer else []
    steps = settings.steps

    def fits(count: int) -> bool:
        return run_cost(problem, replace(settings, time_step=settings.duration / count)).fits

    coarser = _largest(100, steps, fits) if steps > 100 else 0
    if coarser:
        remedies += [f"time_step={settings.duration / _rounded_down(coarser):.2g}"]
        remedies += [f"duration={float(f'{settings.time_step * _rounded_down(coarser):.2g}'):g}"]
    return f"use {' or '.join(remedies)}" if remedies else "use fewer orders and a coarser step"


def _rounded_down(number: int) -> int:
    """Return a whole number of at most two digits followed by zeros."""
    digits = int(10.0 ** max(0, len(str(number)) - 2))
    return number // digits * digits


def _largest(low: int, high: int, fits: Callable[[int], bool]) -> int:
    """Return about the largest number between two ends that fits, 0 if even the smallest does not."""
    if not fits(low):
        return 0
    while high - low > max(1, low // 50):
        middle = (low + high) // 2
        low, high = (middle, high) if fits(middle) else (low, middle)
    return low


def _block_bytes(size: Size, nodes: int) -> float:
    """Return what all threads together work with when so many nodes are solved in blocks."""
    pairs = size.orders * nodes
    blocks = max(1, round(pairs / max(64 * size.orders, _BLOCK_PAIRS)))
    return min(WORKERS, blocks) * (10.0 + 12.0 * size.shells) * COMPLEX * pairs / blocks


def _sampled_bytes(size: Size, top: float) -> float:
    """Return what the estimate of left-out orders works with: ratios at every order up to *top*, at one node in eight."""
    return (4.0 + 2.6 * size.shells) * COMPLEX * (top + 1.0) * size.nodes / _SAMPLE_STRIDE


def _spectral_bytes(size: Size) -> float:
    """Return the largest of the stages of the spectral engine."""
    n, plane = size.shells, size.plane
    linear = (2.0 + size.solids) * n * size.source_parities * plane
    linear *= 2.0 if size.reflections else 1.0  # a round's own and the one before
    units = size.surfaces**2 + (2.0 * n * size.surfaces if size.solids else n)  # of solids the loads on all faces
    structure = linear + (units * plane if size.linked else 0.0)
    ports = 1.5 * (2.0 * size.solids - 1.0) * n * COMPLEX * _BLOCK_PAIRS * WORKERS if size.solids else 0.0  # rows of what solids answer
    solved = structure + size.tabulated * 5.5 * plane + _block_bytes(size, size.nodes) + ports
    tabulated = structure + size.tabulated * (9.0 * plane + 35.0 * size.orders * size.nodes)
    stages = [solved, tabulated, structure + COMPLEX * 513 * size.orders * (10.0 + 12.0 * n) * size.feedback]
    held = structure
    if size.linked:
        forced = (2.0 + size.solids) * n * size.parities * plane
        forces = REAL * 6.0 * size.points * size.instants
        working, left = _marched_bytes(size) if size.marched else _exact_bytes(size)
        working += _tied_bytes(size)
        stages += [held + working + forces, held + left + forces + forced + 2.0 * n * size.parities * plane]
        held += left + forces + forced
    amplitudes = n * max(size.parities, size.source_parities)
    rates = 2.0 * amplitudes * size.history if size.feedback else 0.0
    stages += [held + _sampled_bytes(size, size.sampled_top)]
    kept = 2.0 + (size.solids - 4.0 if size.solids else 0.0)  # histories: neither faces nor the loads on them
    stages += [held + amplitudes * (kept * size.history + 2.5 * plane) + rates + (amplitudes * plane if size.feedback else 0.0)]
    return max(stages)


def _marched_bytes(size: Size) -> tuple[float, float]:
    """Return what the interface march works with, and what of it stays."""
    n, outputs = size.surfaces, size.surfaces + size.controlled
    pairs = outputs * n
    unknowns = size.points + size.controlled * size.parities * size.orders
    length = 1
    while 2 * length <= _LONGEST_BLOCK and 2 * length * unknowns <= _BLOCK_UNKNOWNS:
        length *= 2
    longest = length * 2 ** int(math.log2(max(1, size.instants // length)))
    rates = size.controlled * n * size.history  # of the sensors, kept for the error of the step
    kernels = pairs * size.history + rates
    left = kernels + 2.0 * n * size.source_parities * size.history + 3.0 * pairs * COMPLEX * size.orders * longest
    state = (n + outputs + n) * size.parities * size.history + 2.0 * size.controlled * size.parities * size.history
    matrices = REAL * (8.0 * (length * unknowns) ** 2 + pairs * size.orders * (length**2 + 340.0))
    circle = 128.0 * (size.parities * size.orders) ** 2 if size.controlled else 0.0
    transforms = 1.5 * COMPLEX * size.orders * longest * (pairs + n * size.parities)
    making = 4.5 * size.plane  # one pair of surfaces at a time
    if size.solids:
        making = PARTS * (n * n + 4.5) * size.plane  # of all, at finer steps
    return max(left + state + matrices + circle + transforms, kernels + making), left


def _exact_bytes(size: Size) -> tuple[float, float]:
    """Return what linear absorbers work with, and what of it stays."""
    spectra = 3.0 * COMPLEX * size.points * size.nodes
    if size.ring or size.patterns:
        return spectra + (0.0 if size.patterns else 14.0 * size.plane), 0.0
    width = min(size.nodes, max(4, int(_RECEPTANCE_BYTES / (COMPLEX * size.points**2))))
    blocks = math.ceil(size.nodes / width)
    shares = REAL * float(size.points) ** 2 * size.orders  # of all pairs, which are kept where they are few
    few = shares <= _PAIR_BYTES
    each = COMPLEX * width * (3.5 * size.points**2 + (0.0 if few else size.parities * size.points * size.orders))
    return spectra + (shares if few else 0.0) + min(WORKERS, blocks) * each, 0.0


def _tied_bytes(size: Size) -> float:
    """Return what receptances of all pairs of points take beside feedback that ties orders or walls: whole, and blocks of them."""
    if not size.patterns:
        return 0.0
    whole = COMPLEX * float(size.points) ** 2 * size.nodes
    return 4.0 * whole if size.marched else whole + 2.0 * min(whole, _TIED_BYTES)


def _direct_bytes(size: Size) -> float:
    """Return what the direct engine works with: weights, accelerations and motion at all instants, and their transforms."""
    n, parities = size.shells, max(size.parities, size.source_parities)
    motion = (4.0 if size.feedback else 2.0) * n * parities * size.history
    marching = (2.0 * n * n + n * parities + parities) * size.history + motion
    estimating = motion + 2.5 * n * parities * size.plane + _sampled_bytes(size, size.sampled_top)
    return max(marching, estimating)


def _shared_seconds(size: Size) -> float:
    """Return the time that error estimates and the stability of a feedback take."""
    estimate = 0.5e-6 * size.shells * (size.sampled_top + 1.0) * size.nodes / _SAMPLE_STRIDE
    return 0.02 + estimate + (1.5e-6 * size.orders * 2000 * size.shells / 2.0 if size.feedback else 0.0)


def _reflected_seconds(size: Size) -> float:
    """Return the time of the spectral engine, whose runs are solved again for each reflection in the sea."""
    once, pairs = _spectral_seconds(size), float(size.orders * size.nodes)
    return once + size.reflections * (once + _REFLECTION * pairs * size.orders * size.source_parities)


def _spectral_seconds(size: Size) -> float:
    """Return the time of the spectral engine."""
    pairs, parities = float(size.orders * size.nodes), max(size.parities, size.source_parities)
    seconds = _shared_seconds(size) + 0.6e-6 * size.shells * pairs + 0.1e-6 * size.shells * parities * pairs
    if not size.linked:
        return seconds
    seconds += 0.2e-6 * size.shells**2 * pairs
    if size.patterns:
        seconds += size.nodes * 2e-9 * size.points**2 * size.patterns
    if not size.marched:
        per_node = 2e-6 * size.points if size.ring and not size.patterns else _unequal_seconds(size)
        return seconds + size.nodes * per_node
    outputs = size.shells + size.controlled
    kernels = outputs * size.shells * size.orders if size.controlled else size.kernels
    sums = 2.5e-8 * kernels * size.parities * math.log2(size.instants + 2)
    limits = 4.5e-8 * (size.controlled * size.parities * size.orders) ** 2
    return seconds + size.instants * (1.2e-4 + sums + 1.5e-8 * size.points**2 + limits)


def _unequal_seconds(size: Size) -> float:
    """Return the time of linear absorbers that are no ring at one node: by matrices of all points, or of many by iteration."""
    dense = 2e-10 * size.points**2 * size.orders * size.parities + 1e-10 * size.points**3
    if size.patterns:
        return dense + 2.5e-9 * size.points**3
    iterated = 2e-8 * size.points * size.orders * size.parities
    return min(dense, iterated) if size.points >= POINTS and size.surfaces == 2 else dense


def _direct_seconds(size: Size) -> float:
    """Return the time of the direct engine, which grows with the square of the number of steps."""
    parities, pairs = max(size.parities, size.source_parities), size.shells**2
    return _shared_seconds(size) + 0.6e-9 * float(size.instants) ** 2 * size.orders * pairs * parities + 4e-4 * size.instants
