"""Energy of the shells and work of their actuators, dimensionless (unit rho_e c_e^2 a^2 per length)."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.response.energy.motion import Motion
from coaxshell.response.energy.work import SurfaceWork
from coaxshell.structure.thin import WallStiffness, bending_strain, open_circuit_stiffness, wall_stiffness


class ShellEnergy(NamedTuple):
    """Kinetic, strain and piezoelectric energy of one shell, each of shape (kept instants,), in rho_e c_e^2 a^2 per length."""

    kinetic: FloatArray
    strain: FloatArray
    piezoelectric: FloatArray


def shell_energy(motion: Motion, shell: int) -> ShellEnergy | None:
    """Return the energies of one shell; None for a rigid one.

    kinetic (R/2) sum beta pi M (dW/dt^2 + dV/dt^2); strain (R/2) sum beta pi (V, W) K (V, W) with the layers' own membrane,
    cross and bending stiffness; piezoelectric the same with sum_j kappa_j k k', the open-circuit stiffening.
    """
    wall = motion.problem.shells[shell]
    if wall.section is None:
        return None
    w, v, dw, dv = (x[..., motion.kept] for x in motion.histories(shell))
    weight = 0.5 * wall.radius * motion.circle
    scale = motion.problem.scales.length / motion.problem.scales.pressure
    elastic = wall_stiffness(replace(wall.section, piezoelectric=()), motion.orders)
    electric = sum((open_circuit_stiffness(x, motion.orders, wall.section.radius) for x in wall.section.piezoelectric), 0.0 * weight)
    bend_v, bend_w = bending_strain(motion.orders, wall.section.radius)
    bending = bend_v[:, None] * v + bend_w[:, None] * w
    return ShellEnergy(
        kinetic=wall.mass * (_square(weight, dw, dw) + _square(weight, dv, dv)),
        strain=scale * _quadratic(weight, elastic, v, w),
        piezoelectric=scale * _square(weight * electric, bending, bending),
    )


def _square(weight: FloatArray, a: FloatArray, b: FloatArray) -> FloatArray:
    return np.asarray(np.einsum("m,hmt,hmt->t", weight, a, b), dtype=np.float64)


def _quadratic(weight: FloatArray, k: WallStiffness, v: FloatArray, w: FloatArray) -> FloatArray:
    return _square(weight * k.vv, v, v) + 2.0 * _square(weight * k.vw, v, w) + _square(weight * k.ww, w, w)


def actuator_work(motion: Motion) -> FloatArray:
    """Return the work that the actuators of all shells have taken from them, shape (T,).

    Minus the integral of the actuators' pressure times dw/dt over the surfaces: the linear law's (Eqs. 4, 17) or, where the
    voltage saturates, what was given.
    """
    problem, grid, s = motion.problem, motion.grid, motion.grid.nodes
    given = motion.spectra.actuation
    total = np.zeros(grid.time.size)
    for i, shell in enumerate(problem.shells):
        if shell.gains is None:
            continue
        if given is not None:
            pressure = grid.transform_linear(given[i])
        else:
            gain_v, gain_w = problem.sensor_gain(i, motion.orders[:, None])
            volts = gain_v * motion.spectra.tangential[i] + gain_w * motion.spectra.normal[i]
            pressure = problem.actuator_pressure(i) * (shell.gains.proportional + shell.gains.derivative * s) * volts
        total -= SurfaceWork(grid, shell.radius * motion.circle, motion.normal_velocity[i])(pressure)
    return total
