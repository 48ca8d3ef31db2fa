"""Limits at every point of walls as fixed points of their equation, step by step, without transforms or conjugate gradients."""

from __future__ import annotations

from typing import NamedTuple, Self

import numpy as np
from numpy.testing import assert_allclose

from coaxshell.solver.axial.lack import Channels
from coaxshell.solver.axial.limited_surface import WallSurface


class DensePoints(NamedTuple):
    """Values of all waves at the points of a wall, (points, amplitudes), and waves of values there."""

    evaluate: np.ndarray
    project: np.ndarray

    @classmethod
    def of(cls, surface: WallSurface, channels: Channels, parities: int) -> Self:
        """Return them of a surface."""
        values = np.eye(parities * channels.count).reshape(-1, parities, channels.count)
        evaluate = np.stack([(surface.along(surface.gridded(one)) @ surface.evaluate).ravel() for one in values], axis=1)
        weight = np.repeat(surface.series.weights, surface.evaluate.shape[1])
        return cls(evaluate, np.linalg.pinv(evaluate.T @ (weight[:, None] * evaluate)) @ (evaluate.T * weight))  # no wave is sin 0

    def require_lack(self, found: np.ndarray, weights: np.ndarray, asked: np.ndarray, limit: float, *, moving: bool = False) -> None:
        """Assert that a march found, (walls, parities, channels, T), what is cut off what is asked for, or off its change."""
        walls, steps = len(found), found.shape[-1]
        before = np.zeros((walls, len(self.evaluate)))
        for n in range(steps):
            volts = asked[..., n].copy()
            for back in range(n + 1):
                volts += np.einsum("ijc,jpc->ipc", weights[..., back], found[..., n - back])
            there = volts.reshape(walls, -1) @ self.evaluate.T - before
            lack = (np.clip(there, -limit, limit) - there) @ self.project.T
            assert_allclose(found[..., n].reshape(walls, -1), lack, atol=1e-8)
            if moving:
                before = (volts + found[..., n]).reshape(walls, -1) @ self.evaluate.T
