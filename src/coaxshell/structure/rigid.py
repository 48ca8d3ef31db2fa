"""A wall that does not move, w = v = 0."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.modes import Modes
from coaxshell.structure.shell_model import FaceReceptance, ShellModel, WallEnergy, WallMotion, WallOperator, WallStiffness


@dataclass(frozen=True, kw_only=True)
class RigidWall(ShellModel):
    """A rigid core or cylinder: its impedance is infinite."""

    mass: float = math.inf

    @property
    def moves(self) -> bool:
        """False."""
        return False

    def passive(self, modes: Modes, s: ComplexArray) -> WallOperator:
        """Return an infinite impedance and V = 0."""
        shape = modes.count, s.size
        return WallOperator(np.full(shape, np.inf + 0j), np.zeros(shape, np.complex128))

    def receptance(self, modes: Modes, s: ComplexArray) -> FaceReceptance:
        """Return zeros."""
        still = np.zeros((modes.count, s.size), np.complex128)
        return FaceReceptance(still, still, still)

    def highest_frequency(self, modes: Modes) -> FloatArray:
        """Return zeros: nothing resonates."""
        return np.zeros_like(modes.orders)

    def stiffness(self, modes: Modes) -> WallStiffness:
        """Return zeros: it is held by its mass."""
        return WallStiffness(*(np.zeros_like(modes.orders) for _ in range(3)))

    def energy(self, motion: WallMotion) -> WallEnergy:
        """Return zeros."""
        return WallEnergy(*(np.zeros(motion.w.shape[-1]) for _ in range(3)))
