"""The interface march: absorbers with any force law, one small implicit solve a step.

Unknown are only the forces f at the points where absorbers touch shells and the velocities of their masses. The shells and
fluids enter through their velocity kernels,

    dw/dt = (dw/dt)_linear + k * f,

by product integration; springs and masses are stepped by the trapezoidal rule. The step weights keep the positive real
part of the kernel and the trapezoidal rule keeps energy, so no step is unstable, however stiff or damped the absorbers.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from coaxshell.acoustics.operators import FloatArray
from coaxshell.solver.absorbers import AbsorberSet, InterfacePoints
from coaxshell.solver.history import HistorySum, KernelTable
from coaxshell.solver.newton import InterfaceNewton, StepState

_REPORT_EVERY = 100


@dataclass(frozen=True)
class MarchResult:
    """Histories of one march.

    Attributes
    ----------
    force : ndarray, shape (2N, T)
        Line forces at the interface points (dimensionless), positive inward.
    mass_displacement, mass_velocity : ndarray, shape (N, T)
        q and dq/dt.
    modal_pressure : ndarray, shape (shells, halves, M + 1, T)
        The forces' modal pressures on every shell.
    iterations : int
        Newton iterations in all.
    """

    force: FloatArray
    mass_displacement: FloatArray
    mass_velocity: FloatArray
    modal_pressure: FloatArray
    iterations: int


def march(
    absorbers: AbsorberSet,
    points: InterfacePoints,
    table: KernelTable,
    linear_displacement: FloatArray,
    linear_velocity: FloatArray,
    time_step: float,
    progress: Callable[[float, str], None] | None = None,
) -> MarchResult:
    """March the interface over all times of the linear response.

    Parameters
    ----------
    absorbers, points
        The absorbers and where they touch the shells.
    table : KernelTable
        Step weights of the velocity kernels, shape (shells, shells, M + 1, T).
    linear_displacement, linear_velocity : ndarray, shape (2N, T)
        w and dw/dt at the interface points without absorbers.
    time_step : float
    """
    count, steps = absorbers.count, linear_velocity.shape[1]
    history = HistorySum(table, points.halves)
    newton = InterfaceNewton(absorbers, points.immediate(table.present), time_step)
    force, mass = np.zeros((2, count, steps)), np.zeros((2, count, steps))
    displacement, velocity = (np.ascontiguousarray(x.T).reshape(steps, 2, count) for x in (linear_displacement, linear_velocity))
    state = StepState.at_rest(count)
    iterations = 0
    for n in range(steps):
        if n > 0:
            excited = points.evaluate(history.present()).reshape(2, count)
            iterations += newton.step(state, excited, displacement[n], velocity[n])
        force[..., n], mass[0, :, n], mass[1, :, n] = state.force, state.mass_displacement, state.mass_velocity
        history.push(points.project(state.force.ravel()))
        if progress is not None and (n + 1) % _REPORT_EVERY == 0:
            progress((n + 1) / steps, "interface march")
    return MarchResult(force.reshape(2 * count, steps), mass[0], mass[1], history.inputs, iterations)
