"""Velocity kernels in time: the normal velocity of shell i after a unit impulse of modal pressure on shell j, as step weights.

Forces are taken linear between steps and the kernel is integrated exactly against them (product integration): the weight at
lag k is the kernel sampled after convolution with a hat two steps wide, whose transform is (sinh(s dt/2)/(s dt/2))^2. The hat's
transform is positive, so the weights keep the positive real part of the kernel: they cannot make energy.

A shell answers an impulse by jumping to the velocity 1/M and being slowed by the fluids on its faces, so s C_ii(s) falls only
like 1/s. Its two leading terms are inverted in closed form,

    s C_ii(s) = (1/M)/(s + b) + O(1/s^3),    b = (R_out + R_in + c)/M,

R the specific impedances rho c of the fluids times r/R, r the radius that each wets, M and c mass and damping with which the wall answers
at once (:meth:`coaxshell.structure.shell_model.ShellModel.leading`: its own, and the derivative feedback's); the rest is smooth enough for
the inverse FFT. Off-diagonal kernels start smoothly, after the transit of the gap.
"""

from __future__ import annotations

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray, real_product
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.modes import Modes
from coaxshell.solver.scaling import Problem
from coaxshell.structure.control_law import ControlGains


def initial_decay(problem: Problem, index: int, modes: Modes) -> FloatArray:
    """Return b, shape (orders, 1): the rate at which fluids, derivative feedback and its own losses slow a shell just after an impulse."""
    wall = problem.shells[index].leading(modes)
    return (np.full((modes.count, 1), resistance(problem, index)) + wall.damping) / wall.mass


def resistance(problem: Problem, index: int) -> float:
    """Return the load on W by which the fluids on the faces of a shell resist its velocity at once: the sum of rho c r/R."""
    pairs = zip(problem.fluids[index : index + 2], problem.shells[index].leverage, strict=True)
    return sum(fluid.density / fluid.slowness * leverage for fluid, leverage in pairs if fluid is not None)


def velocity_weights(problem: Problem, grid: LaplaceGrid, compliance: ComplexArray, modes: Modes | None = None) -> FloatArray:
    """Return the weights of modal pressures 0, 1, 2, ... steps ago in the present modal velocities.

    Parameters
    ----------
    problem : Problem
    grid : LaplaceGrid
    compliance : ndarray, shape (shells, shells, orders, nodes)
        C_ij.
    modes : Modes, optional
        Its orders and axial wavenumber; orders 0, 1, ... of the plane problem unless given.

    Returns
    -------
    ndarray, shape (shells, shells, M + 1, T)
        dW_i/dt(t_n) = sum_k weights[i, j, m, k] P_j(t_{n-k}).
    """
    count, modes = compliance.shape[0], modes or Modes.up_to(compliance.shape[2] - 1)
    weights = np.empty((count, count, modes.count, grid.time.size))
    hat = grid.hat * grid.time_step
    for i in range(count):
        for j in range(count):
            spectrum = compliance[i, j] * grid.nodes
            if i == j and problem.shells[i].moves:
                mass, decay = problem.shells[i].leading(modes).mass, initial_decay(problem, i, modes)
                weights[i, j] = grid.invert((spectrum - 1.0 / (mass * (grid.nodes + decay))) * hat)
                weights[i, j] += exponential_weights(decay, grid) / mass
            else:
                weights[i, j] = grid.invert(spectrum * hat)
    return weights


def combined_velocity_weights(
    problem: Problem, grid: LaplaceGrid, compliance: ComplexArray, pair: tuple[int, int], shares: FloatArray
) -> FloatArray:
    """Return step weights of :func:`velocity_weights` of a pair of shells, combined over the orders before they are inverted.

    Parameters
    ----------
    problem : Problem
    grid : LaplaceGrid
    compliance : ndarray, shape (M + 1, nodes)
        C_ij of the pair.
    pair : tuple of int
        i and j.
    shares : ndarray, shape (rows, M + 1)

    Returns
    -------
    ndarray, shape (rows, T)
        sum_m shares[:, m] weights[i, j, m].
    """
    i, j = pair
    spectrum = real_product(shares, compliance)
    spectrum *= grid.nodes
    leads = i == j and problem.shells[i].moves
    if leads:
        modes = Modes.up_to(compliance.shape[0] - 1)
        decays, kind = np.unique(initial_decay(problem, i, modes)[:, 0], return_inverse=True)
        of_kind = shares @ np.eye(decays.size)[kind.ravel()] / problem.shells[i].leading(modes).mass
        spectrum -= of_kind @ (1.0 / (grid.nodes + decays[:, None]))
    weights = grid.invert(spectrum * (grid.hat * grid.time_step))
    return weights + of_kind @ exponential_weights(decays[:, None], grid) if leads else weights


def voltage_law(problem: Problem, index: int, s: ComplexArray, ratio: ComplexArray) -> ComplexArray:
    """Return the voltage asked for per W of a controlled shell, (k_p + k_d s) times its sensor's gain (Eqs. 17, 20).

    ``ratio`` is V/W of the shell, shape (M + 1, nodes).
    """
    wall = problem.shells[index]
    assert wall.gains is not None
    modes = Modes.up_to(ratio.shape[0] - 1)
    sensor = wall.sensor_gain(modes).columns
    return np.asarray(wall.gains.at(s, modes) * sensor.recovered(ratio), dtype=np.complex128)


def sensor_rate_weights(
    problem: Problem, grid: LaplaceGrid, compliance: ComplexArray, ratio: ComplexArray, controlled: list[int]
) -> FloatArray:
    """Return the step weights of modal pressures in the rates of the sensors' voltages, shape (controlled, shells, M + 1, T).

    The leading term, the sensor's gain on W times (1/M)/(s + b), is inverted in closed form. ``ratio`` is V/W of the shells, shape
    (shells, M + 1, nodes).
    """
    count, max_order = compliance.shape[0], compliance.shape[2] - 1
    weights = np.empty((len(controlled), count, max_order + 1, grid.time.size))
    hat, modes = grid.hat * grid.time_step, Modes.up_to(max_order)
    for row, i in enumerate(controlled):
        sensor = problem.shells[i].sensor_gain(modes).columns
        sensed = grid.nodes * sensor.recovered(ratio[i])
        decay, leading = initial_decay(problem, i, modes), sensor.w / problem.shells[i].leading(modes).mass
        for j in range(count):
            if i == j:
                weights[row, j] = grid.invert((sensed * compliance[i, j] - leading / (grid.nodes + decay)) * hat)
                weights[row, j] += leading * exponential_weights(decay, grid)
            else:
                weights[row, j] = grid.invert(sensed * compliance[i, j] * hat)
    return weights


def voltage_weights(problem: Problem, rates: FloatArray, controlled: list[int], time_step: float) -> FloatArray:
    """Return the step weights of modal pressures in the voltages asked for from those in the rates of the sensors' (Eq. 17).

    k_d times those of the rates, and k_p times their trapezoidal sums: the rates' weights keep the positive real part of their kernel and
    the trapezoidal rule keeps energy, where weights of the sensors' voltages themselves, displacements, would do neither.
    """
    weights = np.empty_like(rates)
    for row, i in enumerate(controlled):
        gains = problem.shells[i].gains
        assert isinstance(gains, ControlGains)  # no other law saturates
        weights[row] = gains.derivative * rates[row] + gains.proportional * trapezoidal_sums(rates[row], time_step)
    return weights


def trapezoidal_sums(rate: FloatArray, time_step: float) -> FloatArray:
    """Return the step weights of a quantity from those of its rate (last axis), x_n = x_{n-1} + (dt/2)(dx_n + dx_{n-1})."""
    sums = np.cumsum(rate, axis=-1)
    return np.asarray((sums - 0.5 * rate) * time_step)


def exponential_weights(decay: FloatArray, grid: LaplaceGrid) -> FloatArray:
    """Return the product-integration weights of e^{-b t}, shape (M + 1, T), for decays b of shape (M + 1, 1).

    At lag 0 the integral of e^{-b t}(1 - t/dt) over one step, dt (x - 1 + e^{-x})/x^2 with x = b dt; at lag k
    dt ((1 - e^{-x})/x)^2 e^{-x (k - 1)}: dt e^{-b t} (sinh(x/2)/(x/2))^2 without its overflow, for walls as light as they may be.
    """
    x = decay * grid.time_step
    divisor = np.where(x == 0.0, 1.0, x)
    mean = np.where(x == 0.0, 1.0, -np.expm1(-x) / divisor)
    weights: FloatArray = grid.time_step * mean**2 * np.exp(-x * np.maximum(np.arange(grid.time.size) - 1.0, 0.0))
    small = np.clip(x, -1.0, 1.0)
    series = 0.5 - small / 6.0 + small**2 / 24.0  # the closed form cancels for small x
    closed = (1.0 - mean) / divisor
    weights[:, 0] = grid.time_step * np.where(np.abs(x) < 1e-3, series, closed)[:, 0]
    return weights
