"""Power of the amplifiers of a three-dimensional run over the whole length of the shells, by Parseval's theorem as its energy.

Of wall i, with u and i the transforms of its actuators' voltage and current per area at each axial wavenumber k_j and the weights of
:mod:`coaxshell.response.energy.whole_length`,

    P(t) = L [P(k_0) + (1/2) sum_j P(k_j)],      P(k) = oint u i ds,      S = (int u^2 dA  int i^2 dA)^(1/2) >= |P|.

Charges of elastic walls are those of their driven layers, in orders; segments of thin ones are taken one by one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coaxshell.errors import InputError
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.progress import Progress
from coaxshell.response.energy.electrodes import DrivenWall, driven_at
from coaxshell.response.energy.motion import Motion
from coaxshell.response.energy.solid_transducers import capacitances, strokes, volts_of
from coaxshell.response.energy.whole_length import along_the_length
from coaxshell.solver.axial.motion import wave_motions
from coaxshell.solver.axial.solution import SpatialSolution
from coaxshell.structure.elastic_wall import ElasticWall
from coaxshell.structure.electroded_wall import ElectrodedWall
from coaxshell.structure.shell_model import ShellModel


@dataclass(frozen=True)
class LengthPower:
    """Power of the amplifiers of one wall over time, W and VA, each (T,), and ``step``, s."""

    shell: int
    real: FloatArray
    apparent: FloatArray
    step: float

    @property
    def largest_real(self) -> float:
        """Largest magnitude of the real power."""
        return float(np.abs(self.real).max())

    @property
    def largest_apparent(self) -> float:
        """Largest apparent power."""
        return float(self.apparent.max())

    @property
    def energy(self) -> float:
        """What was given by the end, J."""
        return float(np.trapezoid(self.real, dx=self.step))


def length_power(solution: SpatialSolution, progress: Progress | None = None) -> tuple[list[LengthPower], str]:
    """Return the power of every wall whose actuators are driven between electrodes, and along what it counts.

    Parameters
    ----------
    solution : SpatialSolution
    progress : callable, optional
        Called with the fraction done and the name of the stage.

    Raises
    ------
    InputError
        If no wall is driven between electrodes, and as :func:`coaxshell.response.energy.whole_length.require_balanced`.
    """
    problem = solution.problem
    walls = [i for i, wall in enumerate(problem.shells) if wall.gains is not None and _holds_charges(wall)]
    if not walls:
        raise InputError("whole_length", "no wall is driven between electrodes, whose charge is known", "leave it out")
    length = along_the_length(solution, progress)
    grid = length.grid
    products = {i: np.zeros((3, grid.time.size)) for i in walls}
    for j, wave in enumerate(wave_motions(problem, length.sampling, grid, length.forces)):
        motion = Motion(
            *(problem, grid, wave.modes, wave.normal, wave.tangential, wave.axial, 1, wave.incident),
            voltage=wave.voltage,
            solid=wave.solid,
            around=wave.around,
            charged=wave.charged,
        )
        for i in walls:
            wall = problem.shells[i]
            if isinstance(wall, ElasticWall):
                products[i] += wave.length * _of_solids(motion, i, wall)
            else:
                products[i] += _products(driven_at(motion, i, wall), grid, wave.length)
        if progress is not None:
            progress((j + 1.0) / length.count, f"axial wavenumber {j + 1:,} of {length.count:,}")
    scales, kept = problem.scales, slice(None, None, solution.settings.refinement)
    watts = (scales.line_energy if length.uniform else scales.energy) / scales.time
    step = solution.settings.time_step * scales.time
    found = [LengthPower(i, watts * one[0, kept], watts * np.sqrt(one[1, kept] * one[2, kept]), step) for i, one in products.items()]
    return found, "per metre of length" if length.uniform else "over the whole length"


def _products(driven: DrivenWall, grid: LaplaceGrid, length: float) -> FloatArray:
    """Return the integrals of u i, u^2 and i^2 over a wall in one wave, (3, T)."""
    strained = sum((one for one, _ in driven.charges), np.zeros_like(driven.volts))
    held = np.full((driven.weight.size, 1), sum(capacitance for _, capacitance in driven.charges))
    return _over_circle(grid, length * driven.weight, driven.volts, strained, held, driven.charging)


def _over_circle(
    grid: LaplaceGrid, weight: FloatArray, volts: ComplexArray, strained: ComplexArray, held: FloatArray, charging: ComplexArray
) -> FloatArray:
    """Return the integrals of u i, u^2 and i^2, (3, T), of the charge of strain and of what *charging* brings to capacitances *held*."""

    def over(one: FloatArray, other: FloatArray) -> FloatArray:
        return np.asarray(np.einsum("m,hmt,hmt->t", weight, one, other))

    u, i = grid.invert(volts.copy()), grid.invert((strained + held * volts) * grid.nodes)
    found = np.stack([over(u, i), over(u, u), over(i, i)])
    if charging is volts:
        return found
    slow, fast = (grid.invert(held * one * grid.nodes) for one in (volts, charging))
    field = grid.invert(charging.copy())
    return found + np.stack([over(field, fast) - over(u, slow), over(field, field) - over(u, u), over(fast, fast) - over(slow, slow)])


def _of_solids(motion: Motion, shell: int, wall: ElasticWall) -> FloatArray:
    """Return the same of an elastic wall per length, by the charge per radian that all of its actuators hold under one voltage."""
    volts, every, grid = volts_of(motion, shell), wall.transducers, motion.grid
    assert volts is not None
    assert every is not None
    acting = np.flatnonzero(every.acting)
    moved, capacitance = strokes(motion, shell, volts), capacitances(wall, motion)
    given, strained = volts[acting[0]], sum((moved[j] for j in acting), np.zeros_like(volts[0]))
    charging = given if motion.charged is None else motion.charged[:, None] * given
    return _over_circle(grid, motion.circle, given, strained, capacitance[acting].sum(axis=0)[:, None], charging)


def _holds_charges(wall: ShellModel) -> bool:
    """Return whether a wall has actuators between electrodes."""
    if isinstance(wall, ElasticWall):
        every = wall.transducers
        return every is not None and every.electrodes and bool(every.actuators)
    return isinstance(wall, ElectrodedWall)
