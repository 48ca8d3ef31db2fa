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
from coaxshell.numerics.differences import work_along
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
    """Power of the amplifiers of one wall over time, W and VA, each (T,), and ``energy``, what they have given by the end, J."""

    shell: int
    real: FloatArray
    apparent: FloatArray
    energy: float

    @property
    def largest_real(self) -> float:
        """Largest magnitude of the real power."""
        return float(np.abs(self.real).max())

    @property
    def largest_apparent(self) -> float:
        """Largest apparent power."""
        return float(self.apparent.max())


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
    products, energies = {i: np.zeros((3, grid.time.size)) for i in walls}, dict.fromkeys(walls, 0.0)
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
                found, energy = _of_solids(motion, i, wall)
            else:
                found, energy = _of_driven(driven_at(motion, i, wall), grid)
            products[i] += wave.length * found
            energies[i] += wave.length * energy
        if progress is not None:
            progress((j + 1.0) / length.count, f"axial wavenumber {j + 1:,} of {length.count:,}")
    scales, kept = problem.scales, slice(None, None, solution.settings.refinement)
    unit = scales.line_energy if length.uniform else scales.energy
    watts = unit / scales.time
    each = [LengthPower(i, watts * ui[kept], watts * np.sqrt(uu * ii)[kept], unit * energies[i]) for i, (ui, uu, ii) in products.items()]
    return each, "per metre of length" if length.uniform else "over the whole length"


def _of_driven(driven: DrivenWall, grid: LaplaceGrid) -> tuple[FloatArray, float]:
    """Return the integrals of u i, u^2 and i^2 over a wall in one wave, (3, T), and the energy given, both per length."""
    strained = sum((one for one, _ in driven.charges), np.zeros_like(driven.volts))
    held = np.full((driven.weight.size, 1), sum(capacitance for _, capacitance in driven.charges))
    return _over_circle(grid, driven.weight, driven.volts, strained, held, driven.charging)


def _over_circle(
    grid: LaplaceGrid, weight: FloatArray, volts: ComplexArray, strained: ComplexArray, held: FloatArray, charging: ComplexArray
) -> tuple[FloatArray, float]:
    """Return the integrals of u i, u^2 and i^2, (3, T), of the charge of strain and of what *charging* brings to capacitances *held*.

    And the energy given by the end: the integral of u over the charge of strain, and what the capacitances hold.
    """

    def over(one: FloatArray, other: FloatArray) -> FloatArray:
        return np.asarray(np.einsum("m,hmt,hmt->t", weight, one, other))

    u, i = grid.invert(volts.copy()), grid.invert((strained + held * volts) * grid.nodes)
    found, field = np.stack([over(u, i), over(u, u), over(i, i)]), u
    if charging is not volts:
        slow, fast = (grid.invert(held * one * grid.nodes) for one in (volts, charging))
        field = grid.invert(charging.copy())
        found += np.stack([over(field, fast) - over(u, slow), over(field, field) - over(u, u), over(fast, fast) - over(slow, slow)])
    stored = 0.5 * held[:, 0] * (field[..., -1] ** 2 - field[..., 0] ** 2)
    given = work_along(u, grid.invert(strained.copy())) + stored
    return found, float(np.einsum("m,hm->", weight, given))


def _of_solids(motion: Motion, shell: int, wall: ElasticWall) -> tuple[FloatArray, float]:
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
