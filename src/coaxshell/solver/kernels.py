"""Velocity kernels in time: the normal velocity of shell i after a unit impulse of modal pressure on shell j.

A shell answers an impulse by jumping to the velocity 1/M and being slowed by the fluids on its faces, so the transform
s C_ii(s) falls only like 1/s. Its two leading terms are inverted in closed form,

    s C_ii(s) = (1/M)/(s + b) + O(1/s^3),    b = (R_out + R_in + c)/M,

R the specific impedances rho c of the fluids and c the modal damping of the derivative feedback; the rest is smooth enough for
the inverse FFT. Off-diagonal kernels start smoothly, after the transit of the gap.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from coaxshell.acoustics.bessel_ratios import ComplexArray
from coaxshell.acoustics.laplace_grid import LaplaceGrid
from coaxshell.acoustics.operators import all_orders
from coaxshell.solver.scaling import Problem

FloatArray = npt.NDArray[np.float64]


def initial_decay(problem: Problem, index: int, max_order: int) -> FloatArray:
    """Return b, shape (M + 1, 1): the rate at which fluids and derivative feedback slow a shell just after an impulse."""
    shell = problem.shells[index]
    resistance = sum(fluid.density / fluid.slowness for fluid in problem.fluids[index : index + 2] if fluid is not None)
    decay = np.full((max_order + 1, 1), resistance)
    if shell.gains is not None:
        _, sensor_w = problem.sensor_gain(index, all_orders(max_order)[:, None])
        decay = decay - problem.actuator_pressure(index) * shell.gains.derivative * sensor_w
    return decay / shell.mass


def velocity_kernels(problem: Problem, grid: LaplaceGrid, compliance: ComplexArray) -> FloatArray:
    """Return the velocity kernels at the grid's times, shape (shells, shells, M + 1, T).

    At t = 0 the diagonal holds the value just after the impulse, 1/M.
    """
    count, max_order = compliance.shape[0], compliance.shape[2] - 1
    kernels = np.zeros((count, count, max_order + 1, grid.time.size))
    for i in range(count):
        for j in range(count):
            spectrum = compliance[i, j] * grid.nodes
            if i == j and problem.shells[i].section is not None:
                mass, decay = problem.shells[i].mass, initial_decay(problem, i, max_order)
                smooth = grid.invert(spectrum - 1.0 / (mass * (grid.nodes + decay)))
                kernels[i, j] = smooth + np.exp(-decay * grid.time) / mass
                kernels[i, j, :, 0] = 1.0 / mass
            else:
                kernels[i, j] = grid.invert(spectrum)
                kernels[i, j, :, 0] = 0.0
    return kernels
