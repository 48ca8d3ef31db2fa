"""Voltages that stop at their limit in three dimensions, marched beside the linear answer (theory manual, "Limited voltages").

Electrodes, and the paper's transducers, vary freely along the axis: every wave and pattern is a loop of its own, which clipping at every
point of the walls ties to all others. As in two dimensions the lack delta = clip(a) - a alone is marched,

    a = a_0 + K * delta,      K = (1 - H K C)^-1 - 1,

a_0 and K of each wave and pattern, delta at the points of :mod:`coaxshell.solver.axial.limited_surface`. Images of the sources are cut as
the sources are, and stay as far away.

Where currents stop a is the charge asked for over C, alpha, K that of :mod:`coaxshell.solver.limited_currents`, and what is cut is the
change of the charge since the step before, delta = clip(alpha_n - beta_(n-1)) - (alpha_n - beta_(n-1)), beta = alpha + delta.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property, partial
from itertools import pairwise

import numpy as np
from scipy import fft

from coaxshell.model.gains import limits_currents
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.progress import Progress, of_stage
from coaxshell.numerics.threads import WORKERS
from coaxshell.solver.axial.blocks import BLOCK_NODES, BlockMap, node_blocks, on_threads
from coaxshell.solver.axial.lack import Channels, VoltageLack, lack_of, wave_patterns
from coaxshell.solver.axial.limited_surface import SurfaceStep, WallSurface
from coaxshell.solver.axial.limited_wave import axial_parities, even_about, loop_kernel, voltages_asked
from coaxshell.solver.axial.sampling import AxialSampling
from coaxshell.solver.limited_currents import largest_steps
from coaxshell.solver.limited_voltages import limits_of, march_lack, require_fine, trapezoidal_nodes
from coaxshell.solver.scaling import Problem

_CHANNELS = 256
"""Channels whose weights are made together."""


@dataclass(frozen=True, eq=False)
class LimitedSolution:
    """What amplifiers lack in a run.

    Attributes
    ----------
    problem : Problem
    grid : LaplaceGrid
    forces : VoltageLack
    lack : ndarray, shape (walls under control, axial parities, channels, T)
        Amplitudes of delta, V.
    iterations : int
        Of all steps together.
    """

    problem: Problem
    grid: LaplaceGrid
    forces: VoltageLack
    lack: FloatArray
    iterations: int
    laws: None = None

    def with_waves(self, sampling: AxialSampling) -> LimitedSolution:
        """Return the same with other objects for the waves of the run, which keep no shapes of elastic walls."""
        forces = replace(self.forces, channels=replace(self.forces.channels, sampling=sampling))
        return replace(self, forces=forces)

    @cached_property
    def error(self) -> float:
        """By how much what is cut off the answer differs from what was marched, relative to it: the waves are solved once more."""
        asked = _asked(self.problem, self.grid, self.forces.channels, self.forces.origin, self.forces, on_threads, None)["asked"]
        surface, limits = _surface(self.problem, self.grid, self.forces.channels, self.forces.axial_parities)
        off = whole = 0.0
        found = self.grid.invert(asked)
        if limits_currents(self.problem.system):
            found[..., 1:] -= found[..., :-1] + self.lack[..., :-1]
        for volts, lack in zip(np.moveaxis(found, -1, 0), np.moveaxis(self.lack, -1, 0), strict=True):
            if not lack.any():
                continue
            for wall, limit in enumerate(limits):
                away = -lack[wall]
                along = surface.along(surface.gridded(volts[wall]))
                if (rows := surface.beyond(along, limit)).size:
                    there = along[rows] @ surface.evaluate
                    away = away + surface.amplitudes(np.clip(there, -limit, limit) - there, rows)
                off, whole = off + float((away**2).sum()), whole + float((lack[wall] ** 2).sum())
        return float(np.sqrt(off / whole))


def solve_limited_waves(
    problem: Problem, grid: LaplaceGrid, sampling: AxialSampling, on: BlockMap, progress: Progress | None = None
) -> LimitedSolution | None:
    """Return what amplifiers lack whose voltages or currents stop at a limit; None where none reaches it.

    Raises
    ------
    InputError
        If feedback is so strong within a step that its limit cannot be found.
    """
    channels, origin = Channels.of(problem, sampling), even_about(problem)
    parities = axial_parities(problem, origin)
    surface, limits = _surface(problem, grid, channels, parities)
    moving = limits_currents(problem.system)
    found = _asked(problem, grid, channels, origin, None, on, progress)
    free = grid.invert(found["linear" if "linear" in found else "asked"])
    if not _reached(surface, limits, np.diff(free, axis=-1, prepend=0.0) if moving else free):
        return None
    asked = grid.invert(found.pop("asked"))
    del found, free
    weights = _weights(problem, grid, channels, on, progress)
    require_fine(grid, weights)
    step = SurfaceStep(surface, limits, weights[..., 0].copy())
    lack, iterations = march_lack(step.solve, weights, asked, progress, moving=moving)
    return LimitedSolution(problem, grid, lack_of(channels, grid.transform_continued(lack), origin), lack, iterations)


def _surface(problem: Problem, grid: LaplaceGrid, channels: Channels, parities: int) -> tuple[WallSurface, FloatArray]:
    """Return the points of the walls and the limit at each of those around, (walls, points around), of charges that of a step."""
    patterns = wave_patterns(problem, channels.sampling.modes[0])
    limits = limits_of(problem, patterns)
    if limits_currents(problem.system):
        limits = largest_steps(problem, grid.time_step)[:, None] * np.ones_like(limits)
    return WallSurface(patterns, channels, parities), limits


def _asked(
    problem: Problem,
    grid: LaplaceGrid,
    channels: Channels,
    origin: float,
    lack: VoltageLack | None,
    on: BlockMap,
    progress: Progress | None,
) -> dict[str, ComplexArray]:
    """Return what the loops ask for, from blocks of nodes in turn."""
    blocks = node_blocks(grid)
    whole: dict[str, ComplexArray] = {}
    work = partial(voltages_asked, problem, grid, channels.sampling, channels, origin, lack)
    for block, part in zip(blocks, on(work, blocks, of_stage(progress, "voltages asked for")), strict=True):
        for name, values in part.items():
            if name not in whole:
                whole[name] = np.empty((*values.shape[:-1], grid.nodes.size), np.complex128)
            whole[name][..., block] = values
    return whole


def _reached(surface: WallSurface, limits: FloatArray, volts: FloatArray) -> bool:
    """Return whether any of some voltages (walls, parities, channels, T) exceeds its limit; rounding does not count."""
    most = max(float(limits.max()), float(np.abs(volts).max()))
    for wall, limit in enumerate(limits):
        sums = np.abs(volts[wall]).sum(axis=(0, 1))
        for instant in np.flatnonzero(sums > float(limit.min())):
            along = surface.along(surface.gridded(volts[wall, ..., instant]))
            rows = surface.beyond(along, limit)
            if (np.abs(along[rows] @ surface.evaluate) - limit > 1e-9 * most).any():
                return True
    return False


def _weights(problem: Problem, grid: LaplaceGrid, channels: Channels, on: BlockMap, progress: Progress | None) -> FloatArray:
    """Return the weights of K by the trapezoidal rule, (walls, walls, channels, T)."""
    s, growth = trapezoidal_nodes(grid)
    parts = max(2, round(s.size / BLOCK_NODES))
    edges = np.linspace(0, s.size, parts + 1).astype(int)
    blocks = [slice(int(a), int(b)) for a, b in pairwise(edges)]
    work = partial(loop_kernel, problem, channels.sampling, s, channels)
    kernel = np.concatenate([one["kernel"] for one in on(work, blocks, of_stage(progress, "loops within a step"))], axis=-1)
    count = int(fft.next_fast_len(grid.steps + 1, real=True))
    weights = np.empty((*kernel.shape[:-1], growth.size))
    for first in range(0, channels.count, _CHANNELS):
        some = slice(first, first + _CHANNELS)
        weights[:, :, some] = fft.irfft(kernel[:, :, some], count, axis=-1, workers=WORKERS)[..., : growth.size] * growth
    return weights
