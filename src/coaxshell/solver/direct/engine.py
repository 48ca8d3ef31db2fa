"""The direct engine: central differences in time and history sums over all earlier accelerations, O(M N^2).

It is the paper's scheme, vectorised over modes: the baseline in speed comparisons and an independent check. At step n

    M W''_n + (K q_n)_w + c W'_n + sum_j w_{n-j} W''_j = load_n + forces_n,     W''_n = (W_{n+1} - 2 W_n + W_{n-1})/dt^2,

with velocities centred, so that only the present accelerations couple (one small matrix a mode) and dampers couple interface points
(one matrix for all steps). Springs are explicit, which bounds the step; an unstable one is refused before the march.
"""

from __future__ import annotations

import numpy as np

from coaxshell.errors import InputError
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.progress import Progress
from coaxshell.solver.direct.interface import ExplicitInterface
from coaxshell.solver.direct.loads import surface_loads
from coaxshell.solver.direct.modal import ModalStep
from coaxshell.solver.direct.result import DirectResult
from coaxshell.solver.direct.weights import fluid_weights
from coaxshell.solver.interface.absorbers import AbsorberSet
from coaxshell.solver.scaling import Problem

_REPORT_EVERY = 50
_GROWTH = 1e6


def march_directly(
    problem: Problem, grid: LaplaceGrid, max_order: int, absorbers: AbsorberSet, *, saturate: bool = False, progress: Progress | None = None
) -> DirectResult:
    """Return the modal histories of a system by time marching.

    Raises
    ------
    InputError
        If the step is unstable for the shells' stiffness or for the absorbers'.
    """
    parities = absorbers.parities
    modal = ModalStep(problem, grid, max_order, parities)
    load = np.zeros((parities, max_order + 1, grid.time.size))
    sources = surface_loads(problem, grid, max_order)
    load[: sources.shape[0]] = sources
    weights = fluid_weights(problem, grid, modal.orders)
    modal.couple(weights[..., 0])
    interface = ExplicitInterface(problem, absorbers, modal, saturate)
    interface.require_stable(grid.time_step)
    result = DirectResult.empty(problem, grid, max_order, absorbers, saturate)
    history = _Accelerations(weights, parities)
    limit = _GROWTH * max(float(np.abs(load).max()), 1e-300)
    for n in range(grid.time.size):
        demand = modal.demand(load[..., n]) - history.earlier()
        acceleration = interface.step(demand)
        history.push(acceleration)
        result.record(n, modal, interface)
        modal.advance(acceleration)
        if progress is not None and (n + 1) % _REPORT_EVERY == 0:
            progress((n + 1) / grid.time.size, "time steps")
        if not np.abs(acceleration).max() < limit:
            grows = f"{grid.time_step:g} is unstable: the motion grows without bound from t = {grid.time[n]:.3g}"
            raise InputError("time_step", grows, f'use {grid.time_step / 2:g} or engine = "spectral"')
    return result


class _Accelerations:
    """All earlier normal accelerations and their history sums."""

    def __init__(self, weights: FloatArray, parities: int) -> None:
        shells, _, modes, steps = weights.shape
        self._backward = np.ascontiguousarray(weights[..., ::-1])
        self._pairs = [(i, j) for i in range(shells) for j in range(shells) if np.any(weights[i, j])]
        self._all = np.zeros((shells, parities, modes, steps))
        self._step = 0

    def earlier(self) -> FloatArray:
        """Return sum_{j<n} w_{n-j} W''_j, shape (shells, parities, M + 1)."""
        total = np.zeros(self._all.shape[:-1])
        n, steps = self._step, self._all.shape[-1]
        if n:
            for i, j in self._pairs:
                recent = self._backward[i, j, :, steps - 1 - n : steps - 1]
                for parity in range(total.shape[1]):
                    total[i, parity] += np.einsum("mk,mk->m", recent, self._all[j, parity, :, :n])
        return total

    def push(self, acceleration: FloatArray) -> None:
        """Append the accelerations of the present step."""
        self._all[..., self._step] = acceleration
        self._step += 1
