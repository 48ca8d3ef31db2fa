"""History-sum weights of the response functions: each integrated exactly against accelerations linear between steps.

The trapezoidal rule applied to sampled response functions would meet their fronts, reflections and, for a disc, the logarithmic
singularity at the focus time; integrating them exactly against hats is the same sum with better weights at the same cost.
"""

from __future__ import annotations

import numpy as np

from coaxshell.acoustics.basis import Modes, RadialBasis
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.coupling import fluid_matrix
from coaxshell.solver.kernels import exponential_weights, resistance
from coaxshell.solver.scaling import Problem
from coaxshell.solver.spectral import map_node_blocks, node_blocks

_DECAY = 1.0
"""Rate of the exponential that carries a response function's front at t = 0 while the rest is inverted by FFT."""


def fluid_weights(problem: Problem, grid: LaplaceGrid, orders: FloatArray) -> FloatArray:
    """Return the weights of normal accelerations 0, 1, 2, ... steps ago in minus the net inward pressures.

    Returns
    -------
    ndarray, shape (shells, shells, M + 1, T)
    """
    count = len(problem.shells)
    spectrum = np.zeros((count, count, orders.size, grid.nodes.size), np.complex128)

    def work(block: slice) -> None:
        fluids = fluid_matrix(problem, RadialBasis(Modes(orders), grid.nodes[block]))
        for i in range(count):
            spectrum[i, i, :, block] = fluids.diagonal[i]
            if i + 1 < count:
                spectrum[i, i + 1, :, block], spectrum[i + 1, i, :, block] = fluids.upper[i], fluids.lower[i + 1]

    map_node_blocks(node_blocks(grid, orders.size - 1), work, None, "response functions")
    weights = np.empty((count, count, orders.size, grid.time.size))
    for i in range(count):
        impedance = resistance(problem, i)
        for j in range(count):
            front = impedance if i == j else 0.0
            weights[i, j] = front_weights(grid, spectrum[i, j], np.full((orders.size, 1), front))
    return weights


def scattering_weights(grid: LaplaceGrid, modes: Modes) -> FloatArray:
    """Return the weights of past modal velocities b_m in the rigidly scattered pressure, p_d = s b K_m/(s K_m'), (M + 1, T).

    K_m/K_m' tends to -1 at once (a plane wave reflects); only the rest has a memory.
    """
    memory = grid.nodes * RadialBasis(modes, grid.nodes).surface.exterior + 1.0
    weights = front_weights(grid, memory, np.full((modes.count, 1), 0.5))
    weights[:, 0] -= 1.0
    return weights


def front_weights(grid: LaplaceGrid, spectrum: ComplexArray, front: FloatArray) -> FloatArray:
    """Return the hat weights of a response whose value just after t = 0 is ``front``, shape (M + 1, 1)."""
    smooth = spectrum - front / (grid.nodes + _DECAY)
    return grid.invert(smooth * (grid.hat * grid.time_step)) + front * exponential_weights(np.full_like(front, _DECAY), grid)
