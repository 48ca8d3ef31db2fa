"""Voltages of electrodes that stop at a limit, marched beside the linear answer (theory manual, "Limited voltages").

With a the voltages that the law asks for, u = clip(a) those given, of which delta = u - a is the lack, and a_0 what is asked for without
any limit, all in patterns that are loops of their own (:mod:`coaxshell.solver.electrode_patterns`),

    a = a_0 + K * delta,      K = (1 - H C)^-1 - 1,      delta = clip(a) - a,

a convolution in time whose lack alone is marched: where no limit is reached the answer is the linear one, digit by digit. Weights of K are
those of the trapezoidal rule, K at s = (2/dt)(1 - z)/(1 + z) (Ch. Lubich, Numer. Math. 52 (1988) 129), which makes no energy and answers
any law and delay as the walls and fluids do, with all frequencies brought below pi/dt.

A step itself is a = b + K_0 delta(a), solved in :mod:`coaxshell.solver.limited_step`. Dead segments are those whose limit is 0.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import fft

from coaxshell.errors import InputError
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.convolution import History, HistorySum, KernelTable
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.progress import Progress
from coaxshell.numerics.threads import WORKERS
from coaxshell.solver.dimensions import limits_left_out
from coaxshell.solver.electrode_loops import ElectrodeLoops, times
from coaxshell.solver.electrode_patterns import Patterns, patterns_of
from coaxshell.solver.interface.absorbers import AbsorberSet
from coaxshell.solver.interface.saturation import voltage_limit
from coaxshell.solver.limited_step import LimitedStep
from coaxshell.solver.scaling import Problem
from coaxshell.solver.solved_spectra import SolvedSpectra
from coaxshell.solver.structure_spectra import Moved, StructureSpectra
from coaxshell.solver.voltage_response import VoltageResponse, controlled, driven, of_all, read_without, response_of

BLOCK = 16
"""Steps whose lack adds to each other directly."""
_DAMPED = 1e-9
"""What returns after a period of the weights."""
_STRONGEST = 0.9999
"""Part of a lack that comes back within its own step, at most: feedback ten thousand times as strong as the wall's inertia."""


@dataclass(frozen=True, eq=False)
class LimitedMarch:
    """Constants of a march.

    Attributes
    ----------
    patterns : Patterns
    limits : ndarray, shape (walls, points)
        V; 0 on dead segments.
    weights : ndarray, shape (walls, walls, patterns, T)
        Of K.
    moving : bool
        Whether limits are those of a change since the step before, as of charges whose current is limited
        (:mod:`coaxshell.solver.limited_currents`), instead of the voltage's own.
    """

    patterns: Patterns
    limits: FloatArray
    weights: FloatArray
    moving: bool = False

    def lack(self, asked: FloatArray, progress: Progress | None = None) -> tuple[FloatArray, int]:
        """Return delta, (walls, patterns, T), from what is asked for without limits, and the iterations of all steps."""
        step = LimitedStep(self.patterns, self.limits, self.weights[..., 0])

        def solve(known: FloatArray) -> tuple[FloatArray, int]:
            delta, taken = step.solve(known[:, 0])
            return delta[:, None], taken

        found, iterations = march_lack(solve, self.weights, asked[:, None], progress, moving=self.moving)
        return found[:, 0], iterations


def march_lack(
    solve: Callable[[FloatArray], tuple[FloatArray, int]],
    weights: FloatArray,
    asked: FloatArray,
    progress: Progress | None = None,
    *,
    moving: bool = False,
) -> tuple[FloatArray, int]:
    """Return delta, (walls, parities, patterns, T), from what is asked for without limits, and the iterations of all steps.

    Parameters
    ----------
    solve : callable
        What :meth:`LimitedStep.solve` does, with parities along the axis.
    weights : ndarray, shape (walls, walls, patterns, T)
        Of K.
    asked : ndarray, shape (walls, parities, patterns, T)
    progress : callable, optional
    moving : bool
        Whether limits are those of a change since the step before.
    """
    steps, present, before = asked.shape[-1], weights[..., 0], np.zeros(asked.shape[:-1])
    found, sums, history, iterations = np.zeros_like(asked), HistorySum(KernelTable(weights), asked.shape[1]), History(), 0
    for start in range(0, steps, BLOCK):
        block = slice(start, min(start + BLOCK, steps))
        size = block.stop - start
        known = asked[..., block].copy()
        if history.step:
            known += sums.forcing(history, size)
        for n in range(size):
            delta, taken = solve(known[..., n] - before)
            iterations += taken
            if moving:
                before = known[..., n] + delta + np.einsum("ijq,jpq->ipq", present, delta)
            if taken:
                found[..., start + n] = delta
                known[..., n + 1 :] += np.einsum("ijqt,jpq->ipqt", weights[..., 1 : size - n], delta)
        history, _ = sums.push(history, found[..., block])
        if progress is not None:
            progress(block.stop / steps, f"{'currents' if moving else 'voltages'} at their limit")
    return found, iterations


def limits_of(problem: Problem, patterns: Patterns) -> FloatArray:
    """Return the limit at each point of each wall under control, V, (walls, points)."""
    points = len(patterns.evaluate)
    limits = np.array([[voltage_limit(problem, i)] * points for i in controlled(problem)])
    limits[:, list(patterns.dead)] = 0.0
    return limits


def may_stop(problem: Problem) -> bool:
    """Return whether voltages, or currents, can stop at a limit in runs of as many dimensions with the same sources and absorbers.

    Those of one law: several are not known to.
    """
    if isinstance(problem.system.control, tuple):
        return False
    return problem.dimensions == 2 or limits_left_out(problem.system) is None


def trapezoidal_nodes(grid: LaplaceGrid) -> tuple[ComplexArray, FloatArray]:
    """Return s = (2/dt)(1 - z)/(1 + z) at half a circle of z, and the growth of weights by the steps of it, (T,)."""
    steps = grid.steps + 1
    count = int(fft.next_fast_len(steps, real=True))
    radius = _DAMPED ** (1.0 / count)
    z = radius * np.exp(-2j * np.pi * np.arange(count // 2 + 1) / count)
    return np.asarray(2.0 / grid.time_step * (1.0 - z) / (1.0 + z)), radius ** -np.arange(float(steps))


def step_weights(structure: StructureSpectra, patterns: Patterns) -> FloatArray:
    """Return the weights of K, shape (walls, walls, patterns, T)."""
    problem = structure.problem

    def kernel(s: ComplexArray) -> ComplexArray:
        loops = ElectrodeLoops.of(problem, VoltageResponse.at(problem.open_loop, problem, structure.modes, s), patterns, s)
        found = np.moveaxis(loops.inverse, (2, 3), (0, 1)).copy()
        for wall in range(found.shape[0]):
            found[wall, wall] -= 1.0
        return found

    return inverted_weights(structure, kernel)


def inverted_weights(structure: StructureSpectra, kernel: Callable[[ComplexArray], ComplexArray]) -> FloatArray:
    """Return the weights of a kernel, (walls, walls, patterns, T), from its values at some nodes."""
    grid = structure.grid
    s, growth = trapezoidal_nodes(grid)
    whole = np.concatenate([kernel(s[start : start + 128]) for start in range(0, s.size, 128)], axis=-1)
    count = int(fft.next_fast_len(grid.steps + 1, real=True))
    return np.asarray(fft.irfft(whole, count, axis=-1, workers=WORKERS)[..., : growth.size] * growth)


def require_fine(grid: LaplaceGrid, weights: FloatArray) -> None:
    """Raise InputError if all of a lack would come back within its own step."""
    present = np.moveaxis(weights[..., 0], -1, 0)
    if float(-np.linalg.eigvals(present).real.min()) > _STRONGEST:
        found = f"{grid.time_step:g} is too long a step for voltages that stop at their limit: feedback turns over within it"
        raise InputError("time_step", found, f"use time_step = {grid.time_step / 4:.2g}, or four times the refinement, or lower gains")


@dataclass(frozen=True, eq=False)
class VoltageLimits:
    """Amplifiers whose voltages are limited, in patterns.

    Attributes
    ----------
    structure : StructureSpectra
    patterns : Patterns
    """

    structure: StructureSpectra
    patterns: Patterns

    @cached_property
    def limits(self) -> FloatArray:
        """The limit at each point, V, (walls, points)."""
        return limits_of(self.structure.problem, self.patterns)

    def held(self, free: Moved) -> ComplexArray | float:
        """Return what a motion without voltages adds to what is limited, in patterns: nothing."""
        return 0.0

    def reached(self, voltage: ComplexArray, held: ComplexArray | float) -> bool:
        """Return whether a limit is exceeded by voltages, (walls, patterns, nodes), that none stops."""
        return bool(beyond(at_points(self.patterns, self.structure.grid.invert(voltage)), self.limits).any())

    def demanded(self, asked: ComplexArray, held: ComplexArray | float) -> FloatArray:
        """Return what is marched against the limits, (walls, patterns, T), where nothing is lacking."""
        return self.structure.grid.invert(asked)

    def march(self) -> LimitedMarch:
        """Return the march of what is lacking."""
        march = LimitedMarch(self.patterns, self.limits, step_weights(self.structure, self.patterns))
        require_fine(self.structure.grid, march.weights)
        return march

    def off(self, given: ComplexArray, asked: ComplexArray, lack: FloatArray, held: ComplexArray | float) -> FloatArray:
        """Return by how much what is cut off an answer differs from what was marched, in patterns."""
        return self._cut_off(self.structure.grid.invert(asked)) - lack

    def _cut_off(self, asked: FloatArray) -> FloatArray:
        """Return what the limits cut off values in patterns, (walls, patterns, T)."""
        there, limits = at_points(self.patterns, asked), self.limits[..., None]
        return np.asarray(np.einsum("qn,int->iqt", self.patterns.project, np.clip(there, -limits, limits) - there))

    def shown(self, given: ComplexArray, asked: ComplexArray) -> tuple[ComplexArray, FloatArray]:
        """Return the voltages in patterns, and at points, that an answer shows: what is asked for, which is cut where it is read."""
        volts = at_points(self.patterns, self.structure.grid.invert(asked))
        volts[:, list(self.patterns.dead)] = 0.0
        return asked, volts


def walls_held(problem: Problem, lack: FloatArray) -> tuple[int, ...]:
    """Return the walls whose amplifiers were held at their limit, by number, from what each lacks, (walls under control, ...)."""
    return tuple(i for i, own in zip(controlled(problem), lack, strict=True) if own.any())


def solve_limited(structure: StructureSpectra, absorbers: AbsorberSet, progress: Progress | None = None) -> SolvedSpectra | None:
    """Return the answer of a structure whose electrodes' voltages stop at their limit; None where none reaches it.

    Raises
    ------
    InputError
        If feedback is so strong within a step that its limit cannot be found.
    """
    response, read = response_of(structure), read_without(structure)
    patterns = patterns_of(structure.problem, response.shells, structure.modes.orders, read.shape[1])
    return solve_alone(structure, absorbers, response, VoltageLimits(structure, patterns), patterns.readings(read), 0.0, progress)


def solve_alone(
    structure: StructureSpectra,
    absorbers: AbsorberSet,
    response: VoltageResponse,
    limits: VoltageLimits,
    read: ComplexArray,
    held: ComplexArray | float,
    progress: Progress | None = None,
) -> SolvedSpectra | None:
    """Return the answer of a structure without absorbers whose amplifiers stop at limits; None where none is reached.

    Parameters
    ----------
    structure : StructureSpectra
    absorbers : AbsorberSet
        Empty.
    response : VoltageResponse
    limits : VoltageLimits
    read : ndarray, shape (walls, patterns, nodes)
        What sensors read without voltages.
    held : ndarray, same shape, or float
        What that motion adds to what is limited.
    progress : callable, optional

    Raises
    ------
    InputError
        If feedback is so strong within a step that its limit cannot be found.
    """
    problem, grid, patterns = structure.problem, structure.grid, limits.patterns
    loops = ElectrodeLoops.of(problem, response, patterns, grid.nodes)
    if not limits.reached(loops.voltages(read), held):
        return None
    free = loops.asked(read)
    lack, iterations = limits.march().lack(limits.demanded(free, held), progress)
    lacking = grid.transform_continued(lack)
    given = free + times(loops.inverse, lacking)
    off = limits.off(given, given - lacking, lack, held)
    shown, volts = limits.shown(given, given - lacking)
    voltage = of_all(problem, response, patterns.in_orders(given))
    return SolvedSpectra(
        structure,
        absorbers,
        *driven(structure, response, voltage),
        force=np.zeros((0, 2, grid.time.size)),
        displacement=np.zeros((0, grid.time.size)),
        iterations=iterations,
        voltage=voltage,
        asked=of_all(problem, response, patterns.in_orders(shown)),
        segments=of_all(problem, response, volts) if patterns.cut else None,
        defect=driven_alone(structure, response, patterns, times(loops.inverse, grid.transform_linear(off))),
        held=walls_held(problem, lack),
    )


def at_points(patterns: Patterns, voltage: FloatArray) -> FloatArray:
    """Return voltages at the points, (walls, points, T), from those in patterns."""
    found: FloatArray = np.einsum("nq,iqt->int", patterns.evaluate, voltage, optimize=True)
    return found


def beyond(volts: FloatArray, limits: FloatArray) -> FloatArray:
    """Return by how much voltages exceed limits, 0 where they do not; rounding, as of dead segments, does not count."""
    over = np.abs(volts) - limits[..., None]
    return np.where(over > 1e-9 * max(float(limits.max()), float(np.abs(volts).max())), over, 0.0)


def driven_alone(
    structure: StructureSpectra, response: VoltageResponse, patterns: Patterns, voltage: ComplexArray
) -> tuple[ComplexArray, ComplexArray]:
    """Return the motion under voltages in patterns alone, without sources."""
    in_orders = of_all(structure.problem, response, patterns.in_orders(voltage))
    under, whole = driven(structure, response, np.zeros_like(in_orders)), driven(structure, response, in_orders)
    return whole.normal - under.normal, whole.tangential - under.tangential
