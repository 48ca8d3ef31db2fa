"""What the interface answers within a block of steps, linear parts of the absorbers included.

With the trapezoidal rule everything is linear but n(z). The link's law is f = c dD/dt + k D + n(D), D = q - w, and within a block

    f = b + [c (u - v) + k (q - w)] of the block's own forces,      b = c (dD/dt)_free + k D_free + n(D),
    v = sum_l K_l f_{-l},     w, q the trapezoidal integrals of v, u,     (2 m/dt)(u - u_{-1}) + S + S_{-1} = 0,   S = f_0 + f_1,

"free" being the motion if the block had no forces. A massless absorber has S = 0 at every instant instead of the balance between
two. One unit of b (or of what an actuator lacks) at the first step gives by recursion what it causes at all others.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.solver.interface.absorbers import AbsorberSet


@dataclass(frozen=True)
class LinkConstants:
    """Constants of N absorbers at one time step.

    Attributes
    ----------
    damping, stiffness : ndarray, shape (2N,)
        c and k + kappa of every link, 0 of those that there are not.
    auxiliary_stiffness : ndarray, shape (N,)
        kappa: stiffness lent to massless absorbers that have nothing but cubic springs, without which b would not determine them.
    inertia, mobility : ndarray, shape (N,)
        2 m/dt, and its inverse, 0 for a massless one.
    half_step : float
        dt/2.
    """

    damping: FloatArray
    stiffness: FloatArray
    auxiliary_stiffness: FloatArray
    inertia: FloatArray
    mobility: FloatArray
    half_step: float

    @property
    def count(self) -> int:
        """Number N of the absorbers."""
        return int(self.inertia.size)

    @classmethod
    def of(cls, absorbers: AbsorberSet, own: FloatArray, time_step: float) -> LinkConstants:
        """Return the constants; ``own``, shape (2N,), are the points' velocities per force there within the same step."""
        heavy = absorbers.mass > 0
        mobility = np.divide(0.5 * time_step, absorbers.mass, out=np.zeros(absorbers.count), where=heavy)
        bare = ~heavy & (absorbers.damping == 0) & (absorbers.linear == 0)
        auxiliary_stiffness = np.where(bare, 2e-3 / (time_step * max(float(own.max(initial=0.0)), 1e-300)), 0.0)
        damping, stiffness = np.tile(absorbers.damping, 2), np.tile(absorbers.linear + auxiliary_stiffness, 2)
        if absorbers.elements is not None:
            damping, stiffness = damping * absorbers.elements.present, stiffness * absorbers.elements.present
        return cls(
            damping,
            stiffness,
            auxiliary_stiffness,
            2.0 * absorbers.mass / time_step,
            mobility,
            0.5 * time_step,
        )


@dataclass(frozen=True)
class BlockResponse:
    """Kernels over the lags of a block, from unit inputs to what they cause.

    Attributes
    ----------
    stretch : ndarray, shape (lags, ..., 2N, inputs)
        D.
    force : ndarray, shape (lags, ..., 2N, inputs)
        f.
    mass_velocity : ndarray, shape (lags, ..., N, inputs)
        u.
    """

    stretch: FloatArray
    force: FloatArray
    mass_velocity: FloatArray


def block_response(links: LinkConstants, kernels: FloatArray, imposed: FloatArray) -> BlockResponse:
    """Return the kernels for unit inputs b at every link, followed by further inputs that move the points.

    Parameters
    ----------
    links : LinkConstants
    kernels : ndarray, shape (lags, ..., 2N, 2N)
        K_l: velocities at the points per force l steps ago; of one system or of many whose links are alike.
    imposed : ndarray, shape (lags, ..., 2N, further)
        Velocities at the points per further input l steps ago.
    """
    lags, *systems, points, further = imposed.shape
    n, half, columns = links.count, links.half_step, points + further
    pairs = np.tile(np.eye(n), (2, 1))
    stiffness = links.stiffness[:, None]
    tangent = links.damping[:, None] + half * stiffness
    within = np.empty((*systems, points + n, points + n))
    within[..., :points, :points], within[..., :points, points:] = np.eye(points) + tangent * kernels[0], -tangent * pairs
    within[..., points:, :points], within[..., points:, points:] = pairs.T, np.diag(links.inertia)
    inverse = np.linalg.inv(within)
    found = BlockResponse(*(np.empty((lags, *systems, rows, columns)) for rows in (points, points, n)))
    w, v, q, u, f = (np.zeros((*systems, rows, columns)) for rows in (points, points, n, n, points))
    unit = np.concatenate([np.eye(points), np.zeros((points, further))], axis=1)
    carry = np.where(links.inertia > 0, 1.0, 0.0)[:, None]
    for lag in range(lags):
        excited = (kernels[1 : lag + 1] @ found.force[:lag][::-1]).sum(axis=0)
        excited[..., points:] += imposed[lag]
        known_w, known_q = w + half * v, q + half * u
        law = stiffness * (pairs @ known_q - known_w) - tangent * excited
        if lag == 0:
            law += unit
        balance = links.inertia[:, None] * u - carry * (pairs.T @ f)
        answer = inverse @ np.concatenate([law, balance], axis=-2)
        f, u = answer[..., :points, :], answer[..., points:, :]
        v = excited + kernels[0] @ f
        w, q = known_w + half * v, known_q + half * u
        found.stretch[lag], found.force[lag], found.mass_velocity[lag] = pairs @ q - w, f, u
    return found


def block_toeplitz(kernels: FloatArray) -> FloatArray:
    """Return the matrix (lags * rows, lags * columns) that convolves a block with kernels (lags, rows, columns), step by step."""
    lags, rows, columns = kernels.shape
    matrix = np.zeros((lags, rows, lags, columns))
    for start in range(lags):
        matrix[start:, :, start] = kernels[: lags - start]
    return matrix.reshape(lags * rows, lags * columns)
