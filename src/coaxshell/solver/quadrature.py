"""Step weights of orders whose membrane vibrates faster than the step resolves: convolution quadrature by the trapezoidal rule.

Product integration samples the kernel, and needs its spectrum up to where it has fallen off. Of an order whose membrane frequency lies
near the highest frequency of the step, or above it, that cannot be had: weights cut out of the band ring before their time, lose the
positive real part of the kernel, and the march grows. The trapezoidal rule's own weights w_k, for a kernel of transform K(s),

    sum_k w_k zeta^k = K(s~),      s~ = (2/dt) (1 - zeta)/(1 + zeta),

have it for any step, because Re s~ > 0 wherever |zeta| < 1: every stability of the continuous system is theirs. They move frequencies to
(2/dt) tan(omega dt/2), which is why well resolved orders are left to product integration.

C. Lubich, Convolution quadrature and discretized operational calculus I, Numer. Math. 52 (1988) 129-145.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from coaxshell.acoustics.basis import Modes
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.coupling import ModalSystem
from coaxshell.solver.scaling import Problem
from coaxshell.solver.spectral import map_node_blocks, node_blocks

RESOLVED = 0.6
"""Fraction of the highest frequency up to which a membrane's is left to product integration; the roll-off begins at 0.8."""


def unresolved_orders(problem: Problem, grid: LaplaceGrid, modes: Modes) -> npt.NDArray[np.bool_]:
    """Return which orders have a shell whose fastest motion the step does not resolve: shape (orders,)."""
    late = np.zeros(modes.count, dtype=bool)
    for wall in problem.shells:
        late |= wall.fastest_rate(modes) > RESOLVED * grid.nyquist
    return late


def trapezoidal_weights(problem: Problem, grid: LaplaceGrid, modes: Modes, sensors: list[int]) -> tuple[FloatArray, FloatArray]:
    """Return the step weights of modal pressures in the normal velocities, and in the rates of the sensors' voltages of some shells.

    Parameters
    ----------
    problem : Problem
    grid : LaplaceGrid
    modes : Modes
    sensors : list of int
        Shells whose sensors are read.

    Returns
    -------
    velocity : ndarray, shape (shells, shells, orders, T)
    rate : ndarray, shape (len(sensors), shells, orders, T)
    """
    count, nodes = len(problem.shells), (2.0 / grid.time_step) * np.tanh(0.5 * grid.time_step * grid.nodes)
    gains = [problem.shells[i].sensor_gain(modes).columns for i in sensors]
    velocity = np.empty((count, count, modes.count, nodes.size), np.complex128)
    rate = np.empty((len(sensors), count, modes.count, nodes.size), np.complex128)

    def work(block: slice) -> None:
        s = np.asarray(nodes[block], dtype=np.complex128)
        modal = ModalSystem(problem, s, modes)
        for j in range(count):
            normal = modal.solve(j, 1.0)
            for i, w in enumerate(normal):
                velocity[i, j, :, block] = s * w
            for row, (i, gain) in enumerate(zip(sensors, gains, strict=True)):
                rate[row, j, :, block] = s * gain.recovered(modal.shells[i].tangential) * normal[i]

    map_node_blocks(node_blocks(grid, modes.count), work, None, "kernels")
    whole = np.ones(nodes.size)
    return grid.invert(velocity, whole) * grid.time_step, grid.invert(rate, whole) * grid.time_step
