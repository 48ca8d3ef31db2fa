"""Histories that the direct engine records as it goes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.direct.modal import ModalStep
from coaxshell.solver.interface.absorbers import AbsorberSet
from coaxshell.solver.scaling import Problem

if TYPE_CHECKING:
    from coaxshell.solver.direct.interface import ExplicitInterface


@dataclass(frozen=True)
class DirectResult:
    """Modal histories (shells, parities, M + 1, T), absorbers' (N, ...) and the corrections of saturated actuators."""

    normal: FloatArray
    tangential: FloatArray
    absorber_displacement: FloatArray
    absorber_force: FloatArray
    correction: FloatArray | None

    @classmethod
    def empty(cls, problem: Problem, grid: LaplaceGrid, max_order: int, absorbers: AbsorberSet, saturate: bool) -> DirectResult:
        """Return a record to be filled."""
        shape = (len(problem.shells), absorbers.parities, max_order + 1, grid.time.size)
        count, steps = absorbers.count, grid.time.size
        correction = np.zeros(shape) if saturate else None
        return cls(np.zeros(shape), np.zeros(shape), np.zeros((count, steps)), np.zeros((count, 2, steps)), correction)

    def record(self, n: int, modal: ModalStep, interface: ExplicitInterface) -> None:
        """Write down step n, before the shells are advanced."""
        self.normal[..., n], self.tangential[..., n] = modal.w, modal.v
        if interface.count:
            self.absorber_displacement[:, n] = interface.q_now
            self.absorber_force[:, :, n] = interface.force.T
        if self.correction is not None:
            self.correction[..., n] = interface.correction
